// SPDX-License-Identifier: BSD-3-Clause
// refused: the bond law's evaluate() needs: an answer with broken and broken_in_tension

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using bond_law = lacuna::brittle_spring_bond;
#else
    using bond_law = lacuna::frictional_spring; // its answer does not say whether the bond fails
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
