// SPDX-License-Identifier: BSD-3-Clause
// refused: domain_policy

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using domain = lacuna::periodic_domain;
#else
    using domain = lacuna::symplectic_euler;
#endif
};

lacuna::simulation<my_model>* use = nullptr;
