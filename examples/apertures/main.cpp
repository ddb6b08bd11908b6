// SPDX-License-Identifier: BSD-3-Clause
//
// apertures [stem]: loads one bonded pair with water on both sides from 0.1 mN of tension to 0.3 mN of compression,
// once with each aperture law. Writes stem.csv and stem.png, and prints the states at +-0.1 mN.

#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include <lacuna/core/text.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/core/whole_file.hpp>
#include <lacuna/particles/packing.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation.hpp>

#include "picture.hpp"

namespace {

template <class Aperture>
struct pair_model : lacuna::default_model<2> {
    using flow = lacuna::explicit_flow_with<Aperture>;
};

constexpr double radius = 1.5e-6, thickness = 3.5e-6, stiffness = 1e4; // m, m, N/m
constexpr double viscosity = 1e-3;                                     // of water, Pa s
constexpr double step_gap = 1e-10;                                     // change of the gap in one step, m

/// The pair, one disc above the other, and two smaller discs that close a pore on each side.
lacuna::packing<double, 2> make_discs() {
    lacuna::packing<double, 2> p;
    double const aside = std::sqrt(3.0) * radius;
    p.add({0, -radius}, radius);
    p.add({0, radius}, radius);
    p.add({-aside, 0}, 0.9 * radius);
    p.add({aside, 0}, 0.9 * radius);
    p.bonds.push_back({0, 1});
    return p;
}

template <class Aperture>
apertures::curve squeeze(std::string const& law, typename Aperture::parameters const& aperture) {
    using model = pair_model<Aperture>;
    auto const discs = make_discs();
    lacuna::simulation_parameters<model> p;
    auto& material = p.materials.front();
    material.density = 1000;
    material.contact.normal_stiffness = material.contact.shear_stiffness = stiffness;
    material.bond.normal_stiffness = material.bond.shear_stiffness = stiffness;
    material.bond.tensile_strength = material.bond.shear_strength = std::numeric_limits<double>::infinity();
    p.thickness = thickness;
    p.time_step = 1e-8;
    p.flow.aperture = aperture;
    p.flow.conductivity = thickness / (12 * viscosity);
    lacuna::simulation<model> sim(discs, p);
    for (std::size_t i = 0; i < discs.size(); ++i) sim.fix(i);
    sim.fill_pores([](auto points, double const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii);
    });

    double const speed = 0.5 * step_gap / p.time_step;
    auto const move = [&](double direction, int steps, auto const& record) {
        sim.set_velocity(0, {0, -direction * speed});
        sim.set_velocity(1, {0, direction * speed});
        for (int s = 0; s < steps; ++s) {
            double const gap = sim.position(1)[1] - sim.position(0)[1] - 2 * radius;
            sim.step();
            record(gap);
        }
    };
    move(1, 100, [](double) {});
    apertures::curve result{law, {}};
    // Throat 0 is that of the pair: all others are on the boundary.
    move(-1, 401, [&](double gap) {
        auto const& net = sim.flow().network();
        result.samples.push_back({sim.pair_force(0, 1)[1], gap, net.aperture[0], net.conductance[0]});
    });
    return result;
}

void save_table(std::string const& path, std::vector<apertures::curve> const& curves) {
    lacuna::whole_file file(path);
    file.write("law,normal_force_N,gap_m,aperture_m,conductance_m3_per_Pa_s\n");
    for (auto const& c : curves)
        for (auto const& s : c.samples) {
            std::string line = c.law;
            for (double const x : {s.force, s.gap, s.aperture, s.conductance}) line += lacuna::formatted(",%.9e", x);
            file.write(line + "\n");
        }
    file.commit();
}

} // namespace

int main(int argc, char** argv) {
    if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
        std::fputs("apertures [stem]: writes stem.csv and stem.png; default stem: \"apertures\"\n", stderr);
        return 2;
    }
    try {
        std::string const stem = argc == 2 ? argv[1] : "apertures";
        std::vector<apertures::curve> const curves{
            squeeze<lacuna::constant_aperture>("constant", {1e-8}),
            squeeze<lacuna::contact_force_aperture>("contact_force", {1e-8, 1e-4, 1}),
            squeeze<lacuna::cubic_crack_aperture>("cubic_crack", {1e-8, 1}),
            squeeze<lacuna::exponential_aperture>("exponential", {1e-8, 1e-9, 1e-4, 1})};
        save_table(stem + ".csv", curves);
        apertures::save_picture(stem + ".png", curves);
        std::printf("%-14s %10s %10s %10s\n", "law", "force/nN", "aperture/fm", "C/(1e-27 m3/(Pa s))");
        for (auto const& c : curves)
            for (double const force : {-1e-4, 1e-4})
                for (auto const& s : c.samples)
                    if (std::fabs(s.force - force) < 1e-9)
                        std::printf("%-14s %10.0f %10.0f %10.0f\n", c.law.c_str(), 1e9 * s.force, 1e15 * s.aperture,
                                    1e27 * s.conductance);
    } catch (std::exception const& e) {
        std::fprintf(stderr, "apertures: %s\n", e.what());
        return 1;
    }
}
