// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "particle_runner.hpp"

namespace lacuna_run {

template <int Dim, class Real, class Contact>
std::unique_ptr<runner> make_particle_runner(scenario const& s) {
    if (s.simulation.bond == bond_law::parallel_bond)
        return std::make_unique<particle_runner<run_model<Dim, Real, Contact, lacuna::parallel_bond>>>(s);
    return std::make_unique<particle_runner<run_model<Dim, Real, Contact, lacuna::brittle_spring_bond>>>(s);
}

} // namespace lacuna_run
