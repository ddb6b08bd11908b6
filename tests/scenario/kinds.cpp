// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "reference.hpp"
#include "scenario/program.hpp"

/// \file
/// Dimensions, precisions and contact laws that a scenario can name, and all files that a run can write.

using program::folder;
using program::table;

namespace {

std::string case_text(std::string const& name) {
    return program::read_file(std::string(LACUNA_RUN_CASES) + "/" + name + ".toml");
}

/// The text with each occurrence of `old` replaced.
std::string with(std::string text, std::string const& old, std::string const& replacement) {
    std::size_t count = 0;
    for (auto at = text.find(old); at != std::string::npos; at = text.find(old, at + replacement.size()), ++count)
        text.replace(at, old.size(), replacement);
    if (count == 0) throw std::invalid_argument("no " + old + " in the scenario");
    return text;
}

table run_text(std::string const& name, std::string const& text) {
    folder const here(name);
    here.write("case.toml", text);
    auto const ran = here.run("--quiet case.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    return table(here / "out/probes.csv");
}

double deepest(table const& t) {
    auto const x0 = t.column("position.x[0]"), x1 = t.column("position.x[1]");
    double most = 0;
    for (std::size_t k = 0; k < x0.size(); ++k) most = std::max(most, 1 - (x1[k] - x0[k]));
    return most;
}
double strongest(table const& t) {
    auto const force = t.column("contact.normal_force[0-1]");
    return -*std::min_element(force.begin(), force.end());
}

} // namespace

TEST_CASE("collision of two discs in single precision (1a)", "[cases][reference]") {
    auto const t = run_text("collision_float", case_text("collision_float"));
    REQUIRE_THAT(deepest(t), WithinRel(reference("1a.delta_max"), 5e-3));
    REQUIRE_THAT(strongest(t), WithinRel(reference("1a.F_max"), 5e-3));
    REQUIRE_THAT(t.last("velocity.x[0]"), WithinRel(-0.05 * reference("1a.e"), 1e-3));
    // The number has single precision.
    double const x = t.last("position.x[0]");
    REQUIRE(x == double(float(x)));
}

TEST_CASE("a sphere hits a wall and does not slip, in double and in single precision (1d)", "[cases][reference]") {
    std::string const id = "1d.no_slip_sphere_ks/kn=0.5";
    auto const text = case_text("oblique_sphere");
    for (bool const single : {false, true}) {
        // A longer step in single precision: with the short one rounding would show, at 0.01 m/s and 0.5 m from the
        // origin.
        auto const t = run_text(single ? "oblique_sphere_float" : "oblique_sphere",
                                single ? with(with(with(text, "dimension = 3", "dimension = 3\nreal = \"float\""),
                                                   "time_step = 1e-5", "time_step = 5e-4"),
                                              "12000", "240")
                                       : text);
        double const within = single ? 1e-2 : 2e-3;
        REQUIRE(t.last("wall.force.z[0]") == 0);
        // v_t is (0.003, 0.004), 0.005 m/s: it keeps its direction, and the spin is at right angles to it.
        double const after = reference(id, "vt_after/vt"), turning = reference(id, "omegaR_after/vt");
        REQUIRE_THAT(t.last("velocity.x[0]"), WithinRel(0.003 * after, within));
        REQUIRE_THAT(t.last("velocity.y[0]"), WithinRel(0.004 * after, within));
        REQUIRE_THAT(t.last("spin[0]") * 0.5, WithinRel(0.005 * turning, within));
        REQUIRE_THAT(std::fabs(t.last("spin.x[0]")) * 0.5, WithinRel(0.004 * turning, within));
        REQUIRE_THAT(t.last("spin.z[0]"), WithinAbs(0, 1e-9));
    }
}

TEST_CASE("Hertzian collisions, in space and in the plane, in double and in single precision", "[cases]") {
    double const mass = 1000.0 * 4.0 / 3 * 3.14159265358979323846 * 0.125 / 2,
                 stiffness = 4.0 / 3 * 1e8 / (2 * 0.91) * 0.5;
    double const depth = std::pow(1.25 * mass * 0.01 / stiffness, 0.4);
    auto const space = case_text("hertz");
    auto plane = with(space, "dimension = 3", "dimension = 2\nmass = \"sphere\"");
    for (char const* three : {"[0.0, 0.0, 0.0]", "[1.0, 0.0, 0.0]", "[0.05, 0.0, 0.0]", "[-0.05, 0.0, 0.0]"}) {
        std::string const all = three;
        plane = with(plane, all, all.substr(0, all.size() - 6) + "]");
    }
    for (bool const single : {false, true})
        for (bool const flat : {false, true}) {
            auto text = flat ? plane : space;
            // A longer step in single precision: with the short one rounding would show.
            if (single)
                text = with(with(with(text, "time_step = 2.22955e-05", "time_step = 2.22955e-04"), "steps = 2400",
                                 "steps = 240"),
                            "[simulation]", "[simulation]\nreal = \"float\"");
            auto const t = run_text(std::string("hertz") + (flat ? "_plane" : "") + (single ? "_float" : ""), text);
            double const within = single ? 1e-2 : 1e-3;
            REQUIRE_THAT(deepest(t), WithinRel(depth, within));
            REQUIRE_THAT(strongest(t), WithinRel(stiffness * std::pow(depth, 1.5), within));
            REQUIRE_THAT(t.last("velocity.x[0]"), WithinRel(-0.05, within));
            REQUIRE_THAT(t.last("velocity.x[1]"), WithinRel(0.05, within));
        }
}

TEST_CASE("a run writes the same files with 1, 2 and 4 threads, and when it is resumed", "[program][checkpoint]") {
    std::string const whole = case_text("block");
    folder const one("block");
    one.write("case.toml", whole);
    auto const ran = one.run("--quiet case.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    auto const names = one.files();
    std::vector<std::string> const expected{
        "case.toml",
        "out/bonds-000000000000.vtp", "out/bonds-000000000200.vtp", "out/bonds-000000000400.vtp", "out/bonds.pvd",
        "out/checkpoint.bin", "out/events.csv",
        "out/particles-000000000000.vtp", "out/particles-000000000200.vtp", "out/particles-000000000400.vtp",
        "out/particles.pvd",
        "out/picture-000000000000.png", "out/picture-000000000000.svg", "out/picture-000000000400.png",
        "out/picture-000000000400.svg",
        "out/pores-000000000000.vtp", "out/pores-000000000200.vtp", "out/pores-000000000400.vtp", "out/pores.pvd",
        "out/probes.csv", "out/summary.json"};
    REQUIRE(names == expected);
    table const probes(one / "out/probes.csv");
    REQUIRE(probes.last("count.broken_tension") + probes.last("count.broken_shear") > 3);
    REQUIRE(probes.last("energy.friction") > 0);
    REQUIRE(std::fabs(probes.last("energy.residual")) < 1e-2 * probes.last("energy.external"));

    for (int const threads : {2, 4}) {
        folder const more("block_threads");
        more.write("case.toml", with(whole, "steps = 400", "steps = 400\nthreads = " + std::to_string(threads)));
        REQUIRE(more.run("--quiet case.toml").status == 0);
        for (auto const& name : names)
            if (name != "case.toml") REQUIRE(program::read_file(more / name) == program::read_file(one / name));
    }

    // From the checkpoint of step 260, and from those of other steps.
    for (int const at : {0, 201, 399, 400}) {
        folder const first("block_first"), second("block_second");
        if (at > 0) {
            first.write("case.toml", with(whole, "checkpoint_every = 260", "checkpoint_every = " + std::to_string(at)));
            REQUIRE(first.run("--quiet case.toml").status == 0);
        }
        second.write("case.toml", whole);
        auto const from = (at > 0 ? first : one) / "out/checkpoint.bin";
        auto const resumed = second.run("--quiet --restart '" + from.string() + "' case.toml");
        INFO(at << " " << resumed.err);
        REQUIRE(resumed.status == 0);
        for (char const* name : {"out/probes.csv", "out/events.csv", "out/summary.json"})
            REQUIRE(program::read_file(second / name) == program::read_file(one / name));
    }
}

TEST_CASE("a checkpoint that does not belong to a scenario is refused", "[program][checkpoint][refusal]") {
    folder const here("block_refused");
    std::string const whole =
        with(with(case_text("block"), "steps = 400", "steps = 3"), "checkpoint_every = 260", "checkpoint_every = 1");
    here.write("case.toml", whole);
    REQUIRE(here.run("--quiet case.toml").status == 0);
    auto const refused = [&](std::string const& text, std::string const& file, std::string const& message) {
        folder const other("block_refused_by");
        other.write("case.toml", text);
        auto const ran = other.run("--restart '" + (here / file).string() + "' case.toml");
        INFO(ran.err);
        REQUIRE(ran.status == 2);
        REQUIRE_THAT(ran.err, contains_text(message));
        REQUIRE(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
        REQUIRE(other.files() == std::vector<std::string>{"case.toml"});
    };
    refused(with(whole, "friction = 0.2", "friction = 0.3"), "out/checkpoint.bin",
            "it was made with materials.disc.friction = 0.2, the deck says 0.3");
    refused(with(whole, "[simulation]", "[simulation]\nreal = \"float\""), "out/checkpoint.bin",
            "it was made with simulation.real = \"double\", the deck says \"float\"");
    refused(whole, "out/probes.csv", "not a checkpoint of Lacuna");
    refused(whole, "out/nothing.bin", "cannot read");
    here.write("half.bin", program::read_file(here / "out/checkpoint.bin").substr(0, 5000));
    refused(whole, "half.bin", "truncated");
}

TEST_CASE("VTK files and pictures show the state of the run", "[program]") {
    folder const here("block_shown");
    here.write("case.toml", case_text("block"));
    REQUIRE(here.run("--quiet case.toml").status == 0);
    auto const summary = nlohmann::json::parse(program::read_file(here / "out/summary.json"));
    auto const bodies = program::read_file(here / "out/particles-000000000400.vtp");
    auto const pores = program::read_file(here / "out/pores-000000000400.vtp");
    REQUIRE_THAT(bodies, contains_text("<VTKFile type=\"PolyData\"") && contains_text("NumberOfPoints=\"54\"") &&
                             contains_text("Name=\"radius\"") && contains_text("Name=\"velocity\""));
    REQUIRE_THAT(pores, contains_text("NumberOfPolys=\"" + std::to_string(summary.at("pores").size()) + "\"") &&
                            contains_text("Name=\"pressure\""));
    // Two triangles for each square of a lattice of 9 by 6 discs, and one in each notch of the sides, where every
    // second row stands back: two on the left, two on the right.
    REQUIRE(summary.at("pores").size() == 84);
    auto const series = program::read_file(here / "out/pores.pvd");
    for (char const* step : {"0000", "0200", "0400"})
        REQUIRE_THAT(series, contains_text(std::string("pores-00000000") + step));
    auto const png = program::read_file(here / "out/picture-000000000400.png");
    REQUIRE(png.size() > 10000);
    REQUIRE(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    auto const broken = table(here / "out/events.csv").rows.size();
    REQUIRE_THAT(program::read_file(here / "out/events.csv"), contains_text("tension") || contains_text("shear"));
    REQUIRE(broken == std::size_t(table(here / "out/probes.csv").last("count.broken_tension") +
                                  table(here / "out/probes.csv").last("count.broken_shear")));
}
