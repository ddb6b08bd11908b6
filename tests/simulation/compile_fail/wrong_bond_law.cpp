// SPDX-License-Identifier: BSD-3-Clause
// refused: bond_law

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using bond_law = lacuna::brittle_spring_bond;
#else
    using bond_law = lacuna::frictional_spring; // its answer does not say whether the bond fails
#endif
};

lacuna::simulation<my_model>* use = nullptr;
