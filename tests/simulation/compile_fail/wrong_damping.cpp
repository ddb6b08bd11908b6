// SPDX-License-Identifier: BSD-3-Clause
// refused: the damping needs: struct parameters

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using damping = lacuna::local_damping;
#else
    using damping = lacuna::frictional_spring;
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
