// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <lacuna/pores/explicit_flow.hpp>
#include <lacuna/pores/implicit_flow.hpp>

#include "particle_runner.hpp"

namespace lacuna_run {

template <int Dim, class Real, class Contact, class Bond>
std::unique_ptr<runner> make_with_bond(scenario const& s) {
    if constexpr (Dim == 2) {
        if (s.water && s.water->implicit)
            return std::make_unique<
                particle_runner<run_model<Dim, Real, Contact, Bond, lacuna::implicit_flow_with<chosen_aperture>>>>(s);
        if (s.water)
            return std::make_unique<
                particle_runner<run_model<Dim, Real, Contact, Bond, lacuna::explicit_flow_with<chosen_aperture>>>>(s);
    }
    return std::make_unique<particle_runner<run_model<Dim, Real, Contact, Bond, lacuna::no_flow>>>(s);
}

template <int Dim, class Real, class Contact>
std::unique_ptr<runner> make_particle_runner(scenario const& s) {
    if (s.simulation.bond == bond_law::parallel_bond) return make_with_bond<Dim, Real, Contact, lacuna::parallel_bond>(s);
    return make_with_bond<Dim, Real, Contact, lacuna::brittle_spring_bond>(s);
}

} // namespace lacuna_run
