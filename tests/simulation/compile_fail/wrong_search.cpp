// SPDX-License-Identifier: BSD-3-Clause
// refused: the search needs: void pairs

#include <lacuna/simulation.hpp>

template <class Real, int Dim>
struct half_a_search {
    using real_type = Real;
    static constexpr int dim = Dim;
    void build(lacuna::points_view<Real, Dim> const&, Real);
};

struct my_model : lacuna::default_model<2> {
#ifndef LACUNA_GOOD
    template <class Real, int Dim>
    using search = half_a_search<Real, Dim>;
#endif
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
