// SPDX-License-Identifier: BSD-3-Clause
// refused: flow_policy

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using flow = lacuna::no_flow;
#else
    using flow = lacuna::no_damping;
#endif
};

lacuna::simulation<my_model>* use = nullptr;
