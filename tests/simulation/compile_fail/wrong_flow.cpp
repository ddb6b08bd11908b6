// SPDX-License-Identifier: BSD-3-Clause
// refused: the flow needs: template <class Real, int Dim> class solver

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
#ifdef LACUNA_GOOD
    using flow = lacuna::no_flow;
#else
    using flow = lacuna::no_damping;
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
