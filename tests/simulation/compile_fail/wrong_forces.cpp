// SPDX-License-Identifier: BSD-3-Clause
// refused: a body force must be callable as: vec<double, dim> force(acted_particle<dim> const&) const

#include <lacuna/simulation.hpp>

struct wind {
#ifdef LACUNA_GOOD
    lacuna::vec<double, 2> operator()(lacuna::acted_particle<2> const& p) const { return p.velocity * -1.0; }
#else
    lacuna::vec<double, 2> operator()(lacuna::vec<double, 2> const& velocity) const { return velocity * -1.0; }
#endif
};

struct my_model : lacuna::default_model<2> {
    using forces = lacuna::body_force<wind>;
};

void use(lacuna::simulation<my_model>& run) { run.step(); }
