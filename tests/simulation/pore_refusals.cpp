// SPDX-License-Identifier: BSD-3-Clause
//
// If no pores can be made from the particles, messages name these by the caller's numbers, not by internal indices.

#include "catch.hpp"
#include "simulation/setups.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <lacuna/core/text.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;

namespace {

template <int Dim, class Real>
struct wet_model : default_model<Dim, Real> {
    using flow = explicit_flow;
};

template <int Dim, class Real>
struct body {
    using model = wet_model<Dim, Real>;
    packing<Real, Dim> discs{};

    void add(vec<double, Dim> const& x, double r = 0.5) { discs.add(convert<Real>(x), Real(r)); }

    simulation<model> load() const {
        auto p = setups::springs<model>(1e4, 5e3);
        p.time_step = 1e-4;
        p.guards.resolution = false;
        return simulation<model>(discs, p);
    }
    /// Refusal of these particles.
    template <class Make>
    std::string refusal(Make const& make) const {
        try {
            auto run = load();
            // Otherwise the two numberings could not be distinguished.
            bool sorted = false;
            for (std::size_t k = 0; k < run.size(); ++k) sorted = sorted || run.particles().id(k) != std::int32_t(k);
            CHECK(sorted);
            run.fill_pores(make);
        } catch (std::invalid_argument const& bad) {
            return bad.what();
        }
        return "accepted";
    }
    std::string refusal() const {
        return refusal([](points_view<Real, Dim> points, Real const* radii) {
            return make_pore_network(triangulate_body(points, radii), points, radii);
        });
    }
    /// Name of a particle in messages: "3 at (1, 2)".
    std::string name(std::size_t k) const {
        std::string text = std::to_string(k) + " at (";
        for (int axis = 0; axis < Dim; ++axis)
            text.append(axis == 0 ? "" : ", ").append(to_text(double(discs.position[k][axis])));
        return text + ")";
    }
};

/// Internal indices of the corners with ids 0 to Dim.
template <class Real, int Dim>
pore_mesh<Dim> mesh_of(std::array<std::int32_t, std::size_t(Dim) + 1> const& corners) {
    pore_mesh<Dim> mesh;
    mesh.simplices = {corners};
    mesh.neighbours.resize(1);
    mesh.neighbours[0].fill(-1);
    return mesh;
}

/// Particles in the reverse of the order in which a simulation stores them.
template <int Dim, class Real>
body<Dim, Real> row(int count, double spacing) {
    body<Dim, Real> b;
    for (int k = count; k-- > 0;) {
        vec<double, Dim> x{};
        x[0] = spacing * k;
        if (Dim == 3) x[1] = k % 2;
        b.add(x);
    }
    return b;
}

template <int Dim, class Real>
void check() {
    INFO(Dim << "D, " << (sizeof(Real) == 4 ? "float" : "double"));
    auto const flat = row<Dim, Real>(6, 1);
    std::string const where = Dim == 2 ? "on one line" : "in one plane";
    CHECK_THAT(flat.refusal(), contains_text("number of pores = 0") && contains_text(flat.name(0)) &&
                                   contains_text(flat.name(5)) && contains_text(where));

    auto apart = row<Dim, Real>(5, 40);
    vec<double, Dim> beside{};
    beside[0] = 200;
    beside[Dim - 1] = 30;
    apart.add(beside);
    CHECK_THAT(apart.refusal(), contains_text("number of pores = 0") && contains_text(apart.name(4)) &&
                                    contains_text(apart.name(5)) && contains_text("too far from each other"));

    auto few = row<Dim, Real>(Dim, 1);
    CHECK_THAT(few.refusal(), contains_text("particles around it, and there are " + std::to_string(Dim)));

    // Two coinciding particles in a packing that has pores without them.
    auto twice = row<Dim, Real>(4, 1);
    vec<double, Dim> above{};
    above[0] = 0.5;
    above[Dim - 1] = 0.8;
    twice.add(above);
    twice.discs.add(twice.discs.position[1], twice.discs.radius[1]);
    CHECK_THAT(twice.refusal(), contains_text("particles 1 and 5 are at the same position"));

    // A mesh that the program makes itself.
    auto const made = flat.refusal([&](points_view<Real, Dim> points, Real const* radii) {
        std::array<std::int32_t, std::size_t(Dim) + 1> corners{};
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t c = 0; c < corners.size(); ++c)
                if (points[i] == flat.discs.position[c]) corners[c] = std::int32_t(i);
        if (Dim == 3) {
            // Without a reference size either, the pore is refused.
            std::vector<Real> none(points.size(), std::numeric_limits<Real>::min());
            return make_pore_network(mesh_of<Real, Dim>(corners), points, none.data());
        }
        return make_pore_network(mesh_of<Real, Dim>(corners), points, radii);
    });
    for (std::size_t c = 0; c <= std::size_t(Dim); ++c) CHECK_THAT(made, contains_text(flat.name(c)));
    CHECK_THAT(made, contains_text("size of the pore between the particles"));

    // On one circle or sphere, a fitting mesh is found.
    auto round = row<Dim, Real>(2, 1);
    for (int k = 2; k < (Dim == 2 ? 4 : 8); ++k) {
        vec<double, Dim> x{};
        for (int axis = 0; axis < Dim; ++axis) x[axis] = (k >> axis) & 1;
        round.add(x);
    }
    if (Dim == 3) round.discs.position[0] = convert<Real>(vec<double, Dim>{1}), round.discs.position[1] = {};
    CHECK(round.refusal() == "accepted");

    if (sizeof(Real) == 4) return; // its range has no number that large
    auto vast = row<Dim, Real>(5, 1);
    vast.add(beside);
    vast.discs.position[1][0] = Real(1e75);
    CHECK_THAT(vast.refusal(), contains_text("position of particle 1 = 1e+75: must be from -1e70 to 1e70 m"));
}

} // namespace

TEST_CASE("particles without pores are named by the caller's numbers", "[fluid][refusal]") {
    check<2, double>();
    check<3, float>();
}

TEST_CASE("a run that moves all particles onto a line ends at the next mesh, and the message has their numbers",
          "[fluid][refusal]") {
    using model = wet_model<2, double>;
    packing<double, 2> discs;
    for (int k = 2; k-- > 0;) discs.add({1.2 * k, 0}, 0.4);
    discs.add({0.6, 0.8}, 0.4);
    auto p = setups::springs<model>(1e4, 5e3);
    p.time_step = 1e-3;
    p.remeshing = {remesh_rule::when_needed, 10};
    simulation<model> run(discs, p);
    REQUIRE(run.particles().id(0) != 0);
    run.fill_pores([](points_view<double, 2> points, double const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii);
    });
    for (std::size_t k = 0; k < 3; ++k) run.fix(k);
    run.set_velocity(0, {2, 0});
    run.set_velocity(2, {0, -2});
    // After 0.4 s all lie on the line from particle 1 to particle 0, and slightly earlier there is no void between
    // them.
    try {
        run.run(1000);
        FAIL("it went on");
    } catch (unstable_run const& bad) {
        INFO(bad.what());
        CHECK(bad.step() > 200);
        CHECK(bad.step() < 400);
        CHECK_THAT(bad.what(), contains_text("new mesh of the pores after step ") &&
                                   contains_text("number of pores = 0") &&
                                   contains_text("from particle 1 at (0, 0) m to particle 0 at ("));
    }
}
