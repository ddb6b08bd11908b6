// SPDX-License-Identifier: BSD-3-Clause
// refused: the domain needs: static constexpr bool periodic

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using domain = lacuna::periodic_domain;
#else
    using domain = lacuna::symplectic_euler;
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
