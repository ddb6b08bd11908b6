// SPDX-License-Identifier: BSD-3-Clause
#include "watched.hpp"

namespace lacuna_run {

/// Frictional and brittle springs in the plane, dry, or with explicit or implicit flow.
template <>
std::unique_ptr<runner> make_particle_runner<2, double, lacuna::frictional_spring>(scenario const& s) {
    if (s.simulation.bond == bond_law::parallel_bond) throw fuzz::other_kind();
    return std::make_unique<
        fuzz::watched_runner<run_model<2, double, lacuna::frictional_spring, lacuna::brittle_spring_bond>>>(s);
}

} // namespace lacuna_run
