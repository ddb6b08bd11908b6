// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <lacuna/core/difference.hpp>
#include <lacuna/laws/damping.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// Input of a program and content of a checkpoint agree, or one line names the difference. Calls after
/// load_checkpoint() take effect from there on.

using namespace setups;

namespace {

std::string const file = "restart.bin";

/// Message of a load_checkpoint() that fails; the simulation does not change.
template <class Model>
std::string answer(lacuna::simulation<Model>& sim) {
    auto const before = lacuna::state_hash(sim);
    try {
        lacuna::load_checkpoint(file, sim);
    } catch (lacuna::checkpoint_error const& e) {
        std::string const message = e.what();
        REQUIRE(lacuna::state_hash(sim) == before);
        REQUIRE(message.find('\n') == std::string::npos);
        REQUIRE(message.rfind("checkpoint " + file + ": ", 0) == 0);
        return message;
    }
    return "accepted";
}

struct wet : lacuna::default_model<2> {
    using damping = lacuna::combined_damping;
    using flow = lacuna::explicit_flow;
};
struct wet_implicit : wet {
    using flow = lacuna::implicit_flow;
};
struct wet_in_single : lacuna::default_model<2, float> {
    using damping = lacuna::viscous_damping;
    using flow = lacuna::explicit_flow;
};
struct space_in_single : lacuna::default_model<3, float> {
    using damping = lacuna::local_damping;
};

/// Two rows, bonded along the lower.
template <class Model>
lacuna::packing<typename Model::real, Model::dim> rows() {
    using real = typename Model::real;
    lacuna::packing<real, Model::dim> p;
    for (int k = 0; k < 6; ++k) {
        lacuna::vec<real, Model::dim> at{};
        at[0] = real(k % 3);
        at[1] = real(k / 3) * real(0.95);
        p.add(at, real(0.5));
        if (k == 1 || k == 2) p.bonds.push_back({k - 1, k});
    }
    return p;
}

template <class Model>
auto plain_parameters() {
    lacuna::simulation_parameters<Model> p;
    p.materials.resize(2, p.materials[0]);
    lacuna::vec<double, Model::dim> floor{}, up{};
    floor[1] = -0.5;
    up[1] = 1;
    if constexpr (!Model::domain::periodic)
        p.walls = {{floor, up, p.materials[0].contact}, {-floor * 9.0, -up, p.materials[0].contact}};
    else p.domain.period[0] = 3;
    p.bonds.resize(2);
    for (auto& b : p.bonds) b.normal_stiffness = b.shear_stiffness = b.tensile_force = b.shear_force = 1e6;
    p.time_step = 1e-6;
    p.interactions.initial_contact_tolerance = 0.2;
    return p;
}

template <class Model>
auto make_pores() {
    return [](auto points, auto const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii);
    };
}

template <class Model>
lacuna::simulation<Model> filled(lacuna::simulation_parameters<Model> const& p,
                                 lacuna::packing<typename Model::real, Model::dim> const& packing = rows<Model>()) {
    lacuna::simulation<Model> sim(packing, p);
    if constexpr (lacuna::has_fluid<Model>) sim.fill_pores(make_pores<Model>());
    return sim;
}

template <class Model>
struct change {
    std::string path; // by hand
    std::function<void(lacuna::simulation_parameters<Model>&)> make;
};

/// Numbers, flags and choices in parameters.
template <class T>
std::size_t leaves(T& value) {
    if constexpr (lacuna::detail::is_list<T>) {
        std::size_t sum = 0;
        for (int k = 0; k < int(value.size()); ++k) sum += leaves(value[decltype(value.size())(k)]);
        return sum;
    } else if constexpr (std::is_aggregate_v<T>) {
        std::size_t sum = 0;
        lacuna::for_each_member(value, [&](auto& member) { sum += leaves(member); });
        return sum;
    } else {
        return 1;
    }
}

/// Each change is refused by its name.
/// \param uncovered number of members that no change covers
template <class Model>
void check_changes(std::vector<change<Model>> const& changes, std::size_t uncovered) {
    auto p = plain_parameters<Model>();
    REQUIRE(changes.size() + uncovered == leaves(p)); // a new member needs a line
    lacuna::save_checkpoint(file, filled<Model>(p));
    for (auto const& c : changes) {
        auto q = p;
        c.make(q);
        auto sim = filled<Model>(q);
        INFO(c.path);
        CHECK_THAT(answer(sim), contains_text("it was made with other settings: " + c.path + " = "));
    }
    p.threads = 2;
    p.keep_pair_forces = false;
    p.guards.motion_limit = 0.2;
    auto sim = filled<Model>(p);
    CHECK(answer(sim) == "accepted");
    CHECK(sim.settings().guards.motion_limit == 0.2);
}
/// Guards decide when a run ends, not on its results: they may differ.
constexpr std::size_t guards = 9;

template <class Model>
std::vector<change<Model>> common_changes() {
    std::vector<change<Model>> all;
    for (std::size_t m = 0; m < 2; ++m) {
        std::string const name = "materials[" + std::to_string(m) + "].";
        all.push_back({name + "density", [m](auto& p) { p.materials[m].density *= 2; }});
        all.push_back(
            {name + "contact.normal_stiffness", [m](auto& p) { p.materials[m].contact.normal_stiffness *= 2; }});
        all.push_back(
            {name + "contact.shear_stiffness", [m](auto& p) { p.materials[m].contact.shear_stiffness *= 2; }});
        all.push_back({name + "contact.friction", [m](auto& p) { p.materials[m].contact.friction += 0.1; }});
        all.push_back({name + "bond.normal_stiffness", [m](auto& p) { p.materials[m].bond.normal_stiffness *= 2; }});
        all.push_back({name + "bond.shear_stiffness", [m](auto& p) { p.materials[m].bond.shear_stiffness *= 2; }});
        all.push_back({name + "bond.tensile_strength", [m](auto& p) { p.materials[m].bond.tensile_strength = 7e8; }});
        all.push_back({name + "bond.shear_strength", [m](auto& p) { p.materials[m].bond.shear_strength = 7e8; }});
        std::string const bond = "bonds[" + std::to_string(m) + "].";
        all.push_back({bond + "normal_stiffness", [m](auto& p) { p.bonds[m].normal_stiffness = 2e6; }});
        all.push_back({bond + "shear_stiffness", [m](auto& p) { p.bonds[m].shear_stiffness.reset(); }});
        all.push_back({bond + "tensile_force", [m](auto& p) { p.bonds[m].tensile_force = 2e6; }});
        all.push_back({bond + "shear_force", [m](auto& p) { p.bonds[m].shear_force = 2e6; }});
        all.push_back({bond + "strength_factor", [m](auto& p) { p.bonds[m].strength_factor = 2; }});
    }
    all.push_back({"thickness", [](auto& p) { p.thickness = 2; }});
    for (int axis = 0; axis < Model::dim; ++axis)
        all.push_back({"gravity[" + std::to_string(axis) + "]", [axis](auto& p) { p.gravity[axis] = -9.81; }});
    all.push_back({"fluid_density", [](auto& p) { p.fluid_density = 1; }});
    all.push_back({"interactions.skin", [](auto& p) { p.interactions.skin = 0.2; }});
    all.push_back(
        {"interactions.initial_contact_tolerance", [](auto& p) { p.interactions.initial_contact_tolerance = 0.3; }});
    all.push_back({"interactions.contacts", [](auto& p) { p.interactions.contacts = false; }});
    for (std::size_t w = 0; w < (Model::domain::periodic ? 0 : 2); ++w) {
        std::string const name = "walls[" + std::to_string(w) + "].";
        for (int axis = 0; axis < Model::dim; ++axis) {
            all.push_back(
                {name + "point[" + std::to_string(axis) + "]", [=](auto& p) { p.walls[w].point[axis] += 1e-9; }});
            all.push_back(
                {name + "normal[" + std::to_string(axis) + "]", [=](auto& p) { p.walls[w].normal[axis] += 1e-9; }});
        }
        all.push_back(
            {name + "material.normal_stiffness", [w](auto& p) { p.walls[w].material.normal_stiffness *= 2; }});
        all.push_back({name + "material.shear_stiffness", [w](auto& p) { p.walls[w].material.shear_stiffness *= 2; }});
        all.push_back({name + "material.friction", [w](auto& p) { p.walls[w].material.friction += 0.1; }});
    }
    all.push_back({"remeshing.rule", [](auto& p) { p.remeshing.rule = lacuna::remesh_rule::when_needed; }});
    all.push_back({"remeshing.interval", [](auto& p) { p.remeshing.interval = 7; }});
    all.push_back({"remeshing.on_broken_bond", [](auto& p) { p.remeshing.on_broken_bond = true; }});
    all.push_back({"time_step", [](auto& p) { p.time_step = 2e-6; }});
    all.push_back({"safety", [](auto& p) { p.safety = 0.3; }});
    all.push_back({"follow_critical_step", [](auto& p) { p.follow_critical_step = false; }});
    all.push_back({"velocities_on_time", [](auto& p) { p.velocities_on_time = !p.velocities_on_time; }});
    all.push_back({"allow_unstable_step", [](auto& p) { p.allow_unstable_step = true; }});
    all.push_back({"start_time", [](auto& p) { p.start_time = 1; }});
    return all;
}

template <class Model>
void add_flow(std::vector<change<Model>>& all) {
    all.push_back({"mass", [](auto& p) { p.mass = lacuna::mass_model::sphere; }});
    all.push_back({"flow.bulk_modulus", [](auto& p) { p.flow.bulk_modulus = 1e9; }});
    all.push_back({"flow.conductivity", [](auto& p) { p.flow.conductivity = 2e-9; }});
    all.push_back({"flow.minimum_volume_fraction", [](auto& p) { p.flow.minimum_volume_fraction = 2e-3; }});
    all.push_back({"flow.initial_pressure", [](auto& p) { p.flow.initial_pressure = 1; }});
    all.push_back({"flow.skip_ratio", [](auto& p) { p.flow.skip_ratio = 1e5; }});
    all.push_back({"flow.substeps", [](auto& p) { p.flow.substeps = 2; }});
    all.push_back({"flow.interval", [](auto& p) { p.flow.interval = 2; }});
    all.push_back({"flow.merge_conductance", [](auto& p) { p.flow.merge_conductance = 1e9; }});
    all.push_back({"flow.aperture.residual_aperture", [](auto& p) { p.flow.aperture.residual_aperture *= 2; }});
    all.push_back({"flow.aperture.half_force", [](auto& p) { p.flow.aperture.half_force *= 2; }});
    all.push_back({"flow.aperture.gap_factor", [](auto& p) { p.flow.aperture.gap_factor = 0.5; }});
}

} // namespace

TEST_CASE("each setting that differs is named, with fluid and walls", "[checkpoint][refusal]") {
    auto explicit_ones = common_changes<wet>();
    add_flow(explicit_ones);
    explicit_ones.push_back({"flow.minimum_pressure", [](auto& p) { p.flow.minimum_pressure = -1e5; }});
    explicit_ones.push_back({"damping.local", [](auto& p) { p.damping.local = 0.1; }});
    explicit_ones.push_back({"damping.mass", [](auto& p) { p.damping.mass = 0.1; }});
    explicit_ones.push_back({"damping.viscous", [](auto& p) { p.damping.viscous = 0.1; }});
    // Not covered: bending_stiffness of two bonds, which this law does not take; threads, keep_pair_forces.
    check_changes<wet>(explicit_ones, 5 + guards);

    auto implicit_ones = common_changes<wet_implicit>();
    add_flow(implicit_ones);
    implicit_ones.push_back({"flow.factorisation_tolerance", [](auto& p) { p.flow.factorisation_tolerance = 0.1; }});
    implicit_ones.push_back({"flow.solver_tolerance", [](auto& p) { p.flow.solver_tolerance = 1e-9; }});
    implicit_ones.push_back({"damping.local", [](auto& p) { p.damping.local = 0.1; }});
    implicit_ones.push_back({"damping.mass", [](auto& p) { p.damping.mass = 0.1; }});
    implicit_ones.push_back({"damping.viscous", [](auto& p) { p.damping.viscous = 0.1; }});
    // ... and minimum_pressure, which is infinite in implicit flow.
    check_changes<wet_implicit>(implicit_ones, 6 + guards);
}

TEST_CASE("each setting that differs is named, in single precision, in 3D, in a periodic domain",
          "[checkpoint][refusal]") {
    auto space = common_changes<space_in_single>();
    std::erase_if(space, [](auto const& c) { return c.path == "remeshing.rule"; }); // always `never` in 3D
    space.push_back({"mass", [](auto& p) { p.mass = lacuna::mass_model::disc; }});
    space.push_back({"damping.factor", [](auto& p) { p.damping.factor = 0.1; }});
    check_changes<space_in_single>(space, 5 + guards);

    auto periodic = common_changes<ring>();
    periodic.push_back({"mass", [](auto& p) { p.mass = lacuna::mass_model::sphere; }});
    periodic.push_back({"domain.period[0]", [](auto& p) { p.domain.period[0] = 4; }});
    periodic.push_back({"domain.period[1]", [](auto& p) { p.domain.period[1] = 9; }});
    check_changes<ring>(periodic, 4 + guards);
}

TEST_CASE("particles, bonds and pores that differ are named", "[checkpoint][refusal]") {
    auto const p = plain_parameters<wet>();
    lacuna::save_checkpoint(file, filled<wet>(p));
    auto const after = [&](auto const& spoil) {
        auto packing = rows<wet>();
        spoil(packing);
        auto sim = filled<wet>(p, packing);
        return answer(sim);
    };
    CHECK_THAT(after([](auto& q) { q.radius[4] = 0.49; }),
               contains_text("other particles: particles.radius[4] = 0.5, here 0.49"));
    CHECK_THAT(after([](auto& q) { q.material[5] = 1; }),
               contains_text("other particles: particles.material[5] = 0, here 1"));
    CHECK_THAT(after([](auto& q) { q.density = {1000, 1000, 1000, 2000, 1000, 1000}; }),
               contains_text("other particles: particles.mass[3] = "));
    CHECK_THAT(after([](auto& q) {
                   q.add({5, 5}, 0.5);
               }),
               contains_text("particles.radius = 6 entries, here 7 entries"));
    CHECK_THAT(after([](auto& q) { q.bonds[1] = {1, 4}; }), contains_text("other bonds: bonds[1][1] = 2, here 4"));
    CHECK_THAT(after([](auto& q) { q.position[3][0] += 1e-12; }), contains_text("particles at other positions"));
    CHECK(after([](auto&) {}) == "accepted");

    auto const with_pores = [&](auto const& rule, double pressure) {
        lacuna::simulation<wet> sim(rows<wet>(), p);
        sim.fill_pores([&](auto points, double const* radii) {
            auto net = lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii, rule);
            net.pressure[1] = pressure;
            return net;
        });
        return sim;
    };
    auto const sealed = [](auto const&...) {
        return lacuna::throat_boundary<double>{lacuna::boundary_kind::sealed, 0};
    };
    auto const drained = [](auto const&...) {
        return lacuna::throat_boundary<double>{lacuna::boundary_kind::drained, 0};
    };
    auto const drained_higher = [](auto const&...) {
        return lacuna::throat_boundary<double>{lacuna::boundary_kind::drained, 5};
    };
    lacuna::save_checkpoint(file, with_pores(sealed, 0));
    auto open = with_pores(drained, 0), pressed = with_pores(sealed, 3), same = with_pores(sealed, 0);
    CHECK_THAT(answer(open), contains_text("other pores"));
    CHECK_THAT(answer(pressed), contains_text("filled with other pressures"));
    CHECK(answer(same) == "accepted");
    lacuna::save_checkpoint(file, with_pores(drained, 0));
    auto higher = with_pores(drained_higher, 0);
    CHECK_THAT(answer(higher), contains_text("filled with other pressures"));
}

namespace {

/// Calls before the first step, one of each kind.
template <class Model>
struct calls {
    using simulation = lacuna::simulation<Model>;
    static constexpr int dim = Model::dim;
    double push = 3, ramp = 2e-6, speed = 0.01, spin = 0.2, pull = 0.02, plate_axis = 1, wall = 0.1, stress = 5,
           pressure = 7;
    bool hold_rotation = true;

    void loads(simulation& s) const {
        lacuna::vec<double, dim> force{};
        force[0] = push;
        s.apply(3, force, {}, ramp);
        s.apply(4, force * 2.0);
    }
    void axes(simulation& s) const { s.fix(0, {true, true, true, hold_rotation}); }
    void velocities(simulation& s) const {
        lacuna::vec<double, dim> v{};
        v[0] = speed;
        s.set_velocity(1, v);
        lacuna::vec<double, lacuna::rotation_dim<dim>> w{};
        w[0] = spin;
        s.set_spin(5, w);
        v[0] = pull;
        s.prescribe_velocity(2, v, 5e-6);
    }
    void plates(simulation& s) const {
        std::vector<std::size_t> const joined{4, 5};
        s.attach_to_rigid_plate(joined, int(plate_axis));
    }
    void walls(simulation& s) const {
        lacuna::vec<double, dim> v{};
        v[1] = wall;
        s.move_wall(0, v, 4e-6);
        lacuna::wall_servo<dim> servo;
        servo.stress = stress;
        servo.area = 2;
        servo.max_speed = 0.1;
        s.servo_wall(1, servo);
    }
    void fluid([[maybe_unused]] simulation& s) const {
        if constexpr (lacuna::has_fluid<Model>) s.flow().set_pressure(0, typename Model::real(pressure));
    }
    void all(simulation& s) const {
        loads(s);
        axes(s);
        velocities(s);
        plates(s);
        walls(s);
        fluid(s);
    }
    void backwards(simulation& s) const {
        fluid(s);
        walls(s);
        plates(s);
        velocities(s);
        axes(s);
        loads(s);
    }
};

template <class Model>
void check_calls() {
    auto p = plain_parameters<Model>();
    p.mass = Model::dim == 3 ? lacuna::mass_model::sphere : lacuna::mass_model::disc;
    auto const with = [&](calls<Model> const& calls_made) {
        auto sim = filled<Model>(p);
        calls_made.all(sim);
        return sim;
    };
    calls<Model> const calls_made;
    auto whole = with(calls_made);
    whole.run(6);
    for (int const at : {0, 3}) {
        auto first = with(calls_made);
        if (at > 0) first.run(6, stop_after{at});
        lacuna::save_checkpoint(file, first);
        INFO("after " << at << " steps");
        // The same calls in another order, or no calls at all, give the same bits.
        auto other = filled<Model>(p), bare = filled<Model>(p);
        calls_made.backwards(other);
        for (auto* sim : {&other, &bare}) {
            REQUIRE(answer(*sim) == "accepted");
            sim->run(6 - at);
            REQUIRE(lacuna::state_hash(*sim) == lacuna::state_hash(whole));
        }
        auto const refused = [&](auto const& change, std::string const& kind) {
            calls<Model> changed;
            change(changed);
            auto sim = with(changed);
            INFO(kind);
            CHECK_THAT(answer(sim), contains_text("it was made with other " + kind + " than were given before"));
        };
        refused([](auto& c) { c.push = 30; }, "loads");
        refused([](auto& c) { c.ramp = 3e-6; }, "loads");
        refused([](auto& c) { c.hold_rotation = false; }, "fixed axes");
        refused([](auto& c) { c.speed = 0; }, "velocities");
        refused([](auto& c) { c.spin = 0.3; }, "velocities");
        refused([](auto& c) { c.pull = 0.03; }, "velocities");
        refused([](auto& c) { c.plate_axis = 0; }, "rigid plates");
        refused([](auto& c) { c.wall = 0.2; }, "motions of walls");
        refused([](auto& c) { c.stress = 6; }, "motions of walls");
        if (lacuna::has_fluid<Model>) {
            refused([](auto& c) { c.pressure = 8; }, "pressures and sources of the fluid");
            refused([](auto& c) { c.pressure = 0; }, "pressures and sources of the fluid"); // as without a call
        }
        // A single kind of call that was not made for the checkpoint.
        auto without = filled<Model>(p);
        without.run(at);
        lacuna::save_checkpoint(file, without);
        auto late = filled<Model>(p);
        calls_made.loads(late);
        CHECK_THAT(answer(late), contains_text("other loads than"));
        auto held = filled<Model>(p);
        held.fix(0);
        CHECK_THAT(answer(held), contains_text("other fixed axes than"));
    }
    std::remove(file.c_str());
}

} // namespace

TEST_CASE("calls before load_checkpoint() agree with the checkpoint, or are refused by kind", "[checkpoint][refusal]") {
    check_calls<wet>();
    check_calls<wet_in_single>();
    check_calls<space_in_single>();
}

TEST_CASE("calls after load_checkpoint() take effect from there on, and can be resumed again", "[checkpoint]") {
    // Two discs that touch nothing, 2 kg each: a load of F N for t s gives F t / m.
    auto p = springs<plane>(1, 1, 0, unit_density(2) * 2, 1, 1);
    p.time_step = 0.01;
    lacuna::packing<double, 2> two;
    two.add({0, 0}, 0.5);
    two.add({0, 3}, 0.5);
    lacuna::simulation<plane> first(two, p);
    double const mass = first.mass(0);
    first.apply(0, {2, 0}, 0, 1.0); // up to 2 N within 1 s
    first.apply(1, {1, 0});
    first.run(50);
    lacuna::save_checkpoint(file, first);

    lacuna::simulation<plane> second(two, p);
    lacuna::load_checkpoint(file, second);
    second.apply(0, {5, 0}, 0, 0.5); // from the present 1 N to 5 N within 0.5 s
    second.apply(1, {0, 0});         // load removed
    second.run(20);
    lacuna::save_checkpoint(file, second);

    lacuna::simulation<plane> third(two, p);
    third.apply(0, {2, 0}, 0, 1.0); // the same call as for the first
    third.apply(1, {1, 0});
    lacuna::load_checkpoint(file, third);
    std::remove(file.c_str());
    second.run(130);
    third.run(130);
    REQUIRE(lacuna::state_hash(third) == lacuna::state_hash(second));
    // Sums over the steps, with the force at the beginning of each: k/50 of a half ramp, then from 1 to 5, then 5.
    double impulse = 0;
    for (int k = 0; k < 200; ++k) impulse += 0.01 * (k < 50 ? 2 * k / 100.0 : k < 100 ? 1 + 4 * (k - 50) / 50.0 : 5.0);
    REQUIRE_THAT(third.velocity(0)[0], WithinRel(impulse / mass, 1e-12));
    REQUIRE_THAT(third.velocity(1)[0], WithinRel(0.5 / mass, 1e-12));
}

TEST_CASE("a released particle keeps its velocity and moves freely", "[driving]") {
    auto p = springs<plane>(1, 1, 0, unit_density(2), 1, 1);
    p.time_step = 0.01;
    p.gravity = {0, -2};
    lacuna::packing<double, 2> one;
    one.add({0, 0}, 0.5);
    lacuna::simulation<plane> run(one, p);
    run.prescribe_velocity(0, {1, 0}, 1.0);
    run.run(50);
    double const v = run.velocity(0)[0];
    REQUIRE_THAT(v, WithinAbs(0.495, 1e-12)); // mean of the last step of a ramp of 1 m/s in 1 s
    run.release(0, {false, false, false, true});
    run.run(10);
    REQUIRE(run.velocity(0)[0] == v);
    REQUIRE_THAT(run.velocity(0)[1], WithinAbs(-0.2, 1e-12));
}
