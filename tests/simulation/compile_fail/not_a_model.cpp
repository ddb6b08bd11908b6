// SPDX-License-Identifier: BSD-3-Clause
// refused: a model's dim must be 2 or 3

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifndef LACUNA_GOOD
    static constexpr int dim = 4;
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
