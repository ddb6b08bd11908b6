// SPDX-License-Identifier: BSD-3-Clause
#include "watched.hpp"

namespace lacuna_run {

/// Hertzian contacts and parallel bonds in space.
template <>
std::unique_ptr<runner> make_particle_runner<3, double, lacuna::hertz_mindlin>(scenario const& s) {
    if (s.simulation.bond == bond_law::brittle_spring && !s.bonds.pairs.empty()) throw fuzz::other_kind();
    return std::make_unique<fuzz::watched_runner<run_model<3, double, lacuna::hertz_mindlin, lacuna::parallel_bond>>>(
        s);
}

} // namespace lacuna_run
