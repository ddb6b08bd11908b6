// SPDX-License-Identifier: BSD-3-Clause
// refused: the integrator needs: static void advance<WithEnergy, Damping>

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using integrator = lacuna::symplectic_euler;
#else
    using integrator = lacuna::no_damping;
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
