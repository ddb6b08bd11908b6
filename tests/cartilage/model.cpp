// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "cartilage/run/ending.hpp"
#include "cartilage/run/load_specimen.hpp"

using namespace cartilage;

namespace {

options request(std::string const& set = {}, lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface) {
    options o;
    o.zone = zone;
    o.length_um = 84;
    o.height_um = 42;
    o.load_MPa = 30;
    o.pair_forces = true;
    set_choices(o.choices, set, "test");
    if (o.choices.duration > 0) o.duration_ns = o.choices.duration;
    return o;
}

struct energy_watch {
    static constexpr lacuna::stage stages = lacuna::stage::step;
    static constexpr bool needs_energy = true;
    template <class Simulation>
    void on_step(Simulation const&) {}
};

template <class Model>
auto run(options const& o, long long steps) {
    auto sim = load_specimen<Model>(build_specimen(o), o);
    energy_watch watch;
    sim->run(steps, watch);
    return sim;
}

/// Downward force on a loaded particle in the first step, over its loaded area, Pa. All pairs are still at rest.
template <class Model>
double load_on(options const& o, double area(double radius, double thickness)) {
    auto const s = build_specimen(o);
    auto const sim = run<Model>(o, 1);
    auto const id = std::size_t(s.loaded.front());
    return -sim->force(id)[1] / area(sim->radius(id), s.thickness);
}

double disc_face(double r, double) { return std::numbers::pi * r * r; }
double strip_face(double r, double t) { return 2 * r * t; }

} // namespace

TEST_CASE("the load is its pressure times the chosen area, and rises as chosen") {
    CHECK_THAT(load_on<dry_model>(request(), disc_face), WithinRel(30e6, 1e-9));
    CHECK_THAT(load_on<dry_model>(request("load_area = strip"), strip_face), WithinRel(30e6, 1e-9));
    CHECK_THAT(load_on<dry_model>(request("load_area = strip\nthickness = 7"),
                                  [](double r, double) { return 2 * r * 7e-6; }),
               WithinRel(30e6, 1e-9));
    CHECK_THAT(load_on<dry_model>(request("ramp_time = 1"), disc_face), WithinAbs(0, 1e-6));
    // During the ramp the load is proportional to time.
    auto const o = request("ramp_time = 0.1");
    auto const s = build_specimen(o);
    auto const sim = run<dry_model>(o, 4);
    auto const id = std::size_t(s.loaded.front());
    auto const k = sim->particles().internal(id);
    double const full = 30e6 * std::numbers::pi * sim->radius(id) * sim->radius(id);
    // The load of a step is that at its beginning.
    double const share = (sim->time() - sim->time_step()) / 0.1e-9;
    REQUIRE(share > 0.05);
    CHECK_THAT(-double(sim->particles().load(std::size_t(k))[1]), WithinRel(share * full, 1e-9));
}

TEST_CASE("the time step is the requested share of the bound") {
    auto o = request();
    auto const usual = run<dry_model>(o, 1);
    CHECK_THAT(usual->time_step(), WithinRel(0.4 * usual->limits().critical(), 1e-6));
    o.step_share = 0.8;
    CHECK_THAT(run<dry_model>(o, 1)->time_step(), WithinRel(2 * usual->time_step(), 1e-12));
    // A requested step is used; an unstable step needs --allow-unstable-step.
    o.time_step_ps = 14.39;
    CHECK_THROWS_WITH(load_specimen<dry_model>(build_specimen(o), o),
                      contains_text("--time-step: time_step = 1.439e-11: must be at most the stable limit") &&
                          contains_text("--allow-unstable-step"));
    o.allow_unstable_step = true;
    auto const unstable = load_specimen<dry_model>(build_specimen(o), o);
    CHECK_THAT(unstable->time_step(), WithinRel(14.39e-12, 1e-12));
    CHECK(unstable->time_step() > unstable->limits().critical());
}

TEST_CASE("a platen moves as one, a free load does not") {
    for (bool const platen : {true, false}) {
        auto const o = request(platen ? "load = platen" : "");
        auto const s = build_specimen(o);
        auto const sim = run<dry_model>(o, 150);
        double slowest = 1e300, fastest = -1e300, momentum = 0, mass = 0;
        for (auto const id : s.loaded) {
            double const v = sim->velocity(std::size_t(id))[1];
            slowest = std::min(slowest, v);
            fastest = std::max(fastest, v);
            momentum += sim->mass(std::size_t(id)) * v;
            mass += sim->mass(std::size_t(id));
        }
        double const mean = momentum / mass;
        CHECK(mean < -0.01);
        CHECK((fastest - slowest < 1e-9 * std::fabs(mean)) == platen);
        CHECK(std::fabs(sim->energy().residual()) < 1e-3 * sim->energy().largest());
        if (!platen) continue;
        // The platen accelerates under the sum of the forces on it.
        auto const more = run<dry_model>(o, 151);
        auto const first = std::size_t(s.loaded[0]);
        double const gained = more->velocity(first)[1] - sim->velocity(first)[1];
        double next = 0;
        for (auto const id : s.loaded) next += more->force(std::size_t(id))[1];
        CHECK_THAT(gained, WithinRel(next / mass * more->time_step(), 1e-9));
    }
}

TEST_CASE("masses, strengths and links as chosen") {
    double const pi = std::numbers::pi;
    auto const s = build_specimen(request());
    auto const of_mass = [&](char const* set) {
        auto const o = request(set);
        return load_specimen<dry_model>(build_specimen(o), o)->mass(std::size_t(s.loaded[0]));
    };
    double const r = s.discs.radius[std::size_t(s.loaded[0])];
    CHECK_THAT(of_mass(""), WithinRel(2000 * pi * r * r * 3.5e-6, 1e-12));
    CHECK_THAT(of_mass("thickness = 1"), WithinRel(2000 * pi * r * r * 1e-6, 1e-12));
    CHECK_THAT(of_mass("mass = sphere"), WithinRel(2000 * 4 / 3.0 * pi * r * r * r, 1e-12));

    CHECK(bond_strengths(s, request().choices).empty());
    auto const smaller = [](specimen const& one, std::size_t b) {
        auto const [i, j] = one.discs.bonds[b];
        return std::min(one.discs.radius[std::size_t(i)], one.discs.radius[std::size_t(j)]);
    };
    auto const discs = bond_strengths(s, request("bond_area = disc").choices);
    REQUIRE(discs.size() == s.discs.bonds.size());
    CHECK_THAT(*discs[3].tensile_force, WithinRel(2e8 * pi * smaller(s, 3) * smaller(s, 3), 1e-12));
    CHECK(discs[3].shear_force == discs[3].tensile_force);

    auto const linked = request("fibre_links = 0.5\nmatrix_links = 0.25", lacuna::cartilage_zone::whole);
    options tall = linked;
    tall.height_um = 75;
    auto const w = build_specimen(tall);
    REQUIRE(w.matrix_links > 100);
    auto const values = bond_strengths(w, tall.choices);
    REQUIRE(values.size() == w.discs.bonds.size());
    std::size_t const of_fibres = values.size() - w.fibre_links - w.matrix_links;
    for (std::size_t b = 0; b < values.size(); ++b) {
        auto const [i, j] = w.discs.bonds[b];
        // Table 1 by material. Beside a free particle only the fibre's strength counts.
        double const table[] = {1e300, 2e8, 9e8, 1e9};
        double const strength =
            std::min(table[w.discs.material[std::size_t(i)]], table[w.discs.material[std::size_t(j)]]);
        double const share = b < of_fibres ? 1 : b < of_fibres + w.fibre_links ? 0.5 : 0.25;
        REQUIRE_THAT(*values[b].tensile_force, WithinRel(share * strength * 2 * smaller(w, b) * 3.5e-6, 1e-12));
    }
}

TEST_CASE("walls, friction, damping, fluid and boundary as chosen") {
    auto const o = request("wall_distance = 0\nfriction = 0.3\nlocal_damping = 0.4");
    auto const sim = run<dry_model>(o, 60);
    CHECK_THAT(sim->settings().walls[0].point[0], WithinAbs(0, 1e-15));
    CHECK_THAT(sim->settings().walls[1].point[0], WithinRel(84e-6, 1e-12));
    CHECK(sim->settings().materials[2].contact.friction == 0.3);
    CHECK(sim->energy().damping > 0);
    CHECK(run<dry_model>(request(), 60)->energy().damping == 0);

    auto const wet = request("conductivity = 1e-8\naperture = 20\nhalf_force = 1e-3\ngap_factor = 0.5\n"
                             "merge_conductance = 1e-25\nminimum_pressure = -1e5");
    auto const p = load_specimen<wet_model>(build_specimen(wet), wet)->settings().flow;
    CHECK(p.conductivity == 1e-8);
    CHECK_THAT(p.aperture.residual_aperture, WithinRel(2e-8, 1e-12));
    CHECK(p.aperture.half_force == 1e-3);
    CHECK(p.aperture.gap_factor == 0.5);
    CHECK(p.merge_conductance == 1e-25);
    CHECK(p.minimum_pressure == -1e5);

    auto const drained = [&](char const* set) {
        auto const one = request(set);
        auto const s = build_specimen(one);
        auto const loaded = load_specimen<wet_model>(s, one);
        auto const& net = loaded->flow().network();
        auto const x = loaded->particles().positions();
        std::array<int, 3> count{}; // at the top, at the bottom, between
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t) {
            double const y =
                0.5 * (x[std::size_t(net.throat_particle[0][t])][1] + x[std::size_t(net.throat_particle[1][t])][1]);
            ++count[y > s.height - 4e-6 ? 0 : y < 3e-6 ? 1 : 2];
        }
        return count;
    };
    auto const all = drained("");
    CHECK(all[0] > 15);
    CHECK(all[1] == 0);
    CHECK(all[2] > 10);
    auto const top = drained("drainage = top");
    CHECK(top[0] > 15);
    CHECK(top[1] + top[2] <= 2); // a corner may be lower
    CHECK(drained("drainage = sealed") == std::array<int, 3>{0, 0, 0});
}

TEST_CASE("bonds with a moment and fast fluids have separate models") {
    auto const name = [](char const* set, bool dry) {
        return visit_model(request(set).choices, dry, []<class Model>(std::type_identity<Model>) {
            return std::string(lacuna::carries_moment<typename Model::bond_law> ? "beam" : "spring") +
                   (lacuna::has_fluid<Model> ? " wet" : " dry") +
                   (std::is_same_v<typename Model::flow, lacuna::implicit_flow> ? " implicit" : "");
        });
    };
    CHECK(name("", true) == "spring dry");
    CHECK(name("", false) == "spring wet");
    CHECK(name("bond_moment = 1", true) == "beam dry");
    CHECK(name("bond_moment = 1", false) == "beam wet implicit");
    CHECK(name("conductivity = 83", false) == "beam wet implicit");
    CHECK(name("conductivity = 83", true) == "spring dry");
    auto const beam = request("bond_moment = 0.5");
    CHECK(load_specimen<dry_beam_model>(build_specimen(beam), beam)->settings().materials[1].bond.bending_ratio == 0.5);
    // Without moment and almost without flow both models give the same displacement of the loaded row.
    auto const plain = request();
    auto const s = build_specimen(plain);
    auto const one = run<wet_model>(plain, 100);
    auto const other = run<wet_beam_model>(plain, 100);
    REQUIRE_THAT(other->time(), WithinRel(one->time(), 1e-9));
    for (auto const id : s.loaded) {
        double const sunk = one->position(std::size_t(id))[1] - s.discs.position[std::size_t(id)][1];
        CHECK_THAT(other->position(std::size_t(id))[1] - s.discs.position[std::size_t(id)][1],
                   WithinRel(sunk, 1e-6));
    }
}

TEST_CASE("a run ends as chosen") {
    ending fixed(request("duration = 3"));
    CHECK_THAT(fixed.longest(), WithinRel(3e-9, 1e-12));
    CHECK_FALSE(fixed.is_quiet(0, 1, 0));
    ending quiet(request("longest = 12\nquiet_fraction = 0.01\nquiet_time = 2"));
    CHECK_THAT(quiet.longest(), WithinRel(12e-9, 1e-12));
    CHECK_FALSE(quiet.is_quiet(1, 1e-9, 0));       // the largest so far
    CHECK_FALSE(quiet.is_quiet(0.011, 5e-9, 1e-9)); // still moving
    CHECK_FALSE(quiet.is_quiet(0.009, 5e-9, 3.5e-9)); // broke a moment ago
    CHECK(quiet.is_quiet(0.009, 5.6e-9, 3.5e-9));
}

TEST_CASE("specimens as chosen") {
    using lacuna::cartilage_zone;
    CHECK(build_specimen(request("packing = lattice")).statistics.mean_coordination > 5);
    auto const equal = build_specimen(request("radii = equal"));
    CHECK_THAT(*std::min_element(equal.discs.radius.begin(), equal.discs.radius.end()), WithinRel(1.75e-6, 1e-12));
    CHECK_THAT(*std::max_element(equal.discs.radius.begin(), equal.discs.radius.end()), WithinRel(1.75e-6, 1e-12));
    CHECK(build_specimen(request("fibre_layers = 2")).fibres.size() == 2);
    CHECK(build_specimen(request("fibre_spacing = 2.5")).fibres.size() > build_specimen(request()).fibres.size());
    CHECK_THAT(build_specimen(request("fill = 0.7")).statistics.area_fraction, WithinAbs(0.7, 0.01));
    CHECK(build_specimen(request("contact_tolerance = 0.002")).statistics.max_overlap <= 0.002);
    CHECK(build_specimen(request("fibre_links = 1", cartilage_zone::middle)).matrix_links == 0);
    options tall = request("deep_fraction = 0.5\nsurface_fraction = 0.25", cartilage_zone::whole);
    tall.height_um = 100;
    auto const whole = build_specimen(tall);
    CHECK_THAT(whole.deep_top, WithinRel(50e-6, 1e-12));
    CHECK_THAT(whole.middle_top, WithinRel(75e-6, 1e-12));
    options const middle = request("middle_fibre_length = 20", cartilage_zone::middle);
    auto const s = build_specimen(middle);
    for (auto const& f : s.fibres) CHECK(f.particles.size() <= 7); // of 20 um
}
