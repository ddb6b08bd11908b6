// SPDX-License-Identifier: BSD-3-Clause
// refused: contact_law

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using contact_law = lacuna::frictional_spring;
#else
    using contact_law = lacuna::no_damping;
#endif
};

lacuna::simulation<my_model>* use = nullptr;
