// SPDX-License-Identifier: BSD-3-Clause
// refused: plane_or_space<M::dim>

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifndef LACUNA_GOOD
    static constexpr int dim = 4;
#endif
};

lacuna::simulation<my_model>* use = nullptr;
