// SPDX-License-Identifier: BSD-3-Clause
//
// A consumer with all warnings on: it includes all usable headers (every_header.hpp), simulates several models and
// brings some to equilibrium.

#include "every_header.hpp"

#ifdef CONSUMER_HAS_ALL_HEADERS

#include <cstdio>
#include <type_traits>

template <int Dim, class Real, class Flow>
struct wet : lacuna::default_model<Dim, Real> {
    using flow = Flow;
    using contact_law = lacuna::hertz_mindlin;
    using bond_law = lacuna::parallel_bond;
};
template <int Dim, class Real>
struct dry : lacuna::default_model<Dim, Real> {};
template <int Dim, class Real>
struct rolling : lacuna::default_model<Dim, Real> {
    using contact_law = lacuna::rolling_spring;
    using bond_law = lacuna::parallel_bond;
};

template <class Model>
void use() {
    lacuna::packing<typename Model::real, Model::dim> packing;
    lacuna::simulation_parameters<Model> p;
    lacuna::simulation<Model> sim(packing, p);
    if constexpr (lacuna::has_fluid<Model>)
        sim.fill_pores([](auto points, auto const* radii) {
            return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii);
        });
    lacuna::crack_record<lacuna::break_event<Model::dim>> cracks;
    lacuna::vtk_series<> frames("frames", 10);
    sim.run(3, cracks, frames);
    lacuna::save_checkpoint("checkpoint.bin", sim, cracks);
    lacuna::load_checkpoint("checkpoint.bin", sim, cracks);
    if constexpr (std::is_same_v<typename Model::real, double> && !lacuna::carries_moment<typename Model::contact_law>)
        std::printf("%g\n", lacuna::equilibrium<Model>(sim).solve().unbalanced);
    std::printf("%g %g\n", sim.time(), sim.limits().critical());
}

int main() {
    use<dry<2, double>>();
    use<dry<3, float>>();
    use<rolling<2, float>>();
    use<rolling<3, double>>();
    use<wet<2, double, lacuna::explicit_flow>>();
    use<wet<3, float, lacuna::explicit_flow>>();
    use<wet<3, double, lacuna::implicit_flow>>();
}

#else
int main() {}
#endif
