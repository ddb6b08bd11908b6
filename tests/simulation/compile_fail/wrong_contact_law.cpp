// SPDX-License-Identifier: BSD-3-Clause
// refused: the law needs: struct material

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using contact_law = lacuna::frictional_spring;
#else
    using contact_law = lacuna::no_damping;
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
