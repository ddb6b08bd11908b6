// SPDX-License-Identifier: BSD-3-Clause

#include <lacuna/observe/crack_record.hpp>

#include "catch.hpp"
#include "reference.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// Bond area is 2 * 0.5 m * 1 m: strengths in Pa are limits in N.
lacuna::simulation_parameters<plane> unit_springs(double tensile = never, double shear = never, double ks = 1) {
    return springs<plane>(1, ks, 0, unit_density(2), tensile, shear);
}

} // namespace

TEST_CASE("a chain pulled slowly breaks at N F_c / k", "[fracture]") {
    // Limit and speed are a thousandth of those of the set-up, so that the strain stays small.
    double const small = 1e-3, speed = 1e-4 * small;
    auto p = unit_springs(small);
    p.time_step = 0.5;
    lacuna::simulation<plane> run(chain<2>(21), p);
    run.fix(0);
    run.fix(20);
    run.set_velocity(20, {speed, 0});
    lacuna::crack_record<lacuna::break_event<2>> cracks;
    while (cracks.events().empty() && run.steps() < 500000) run.run(1, cracks);
    REQUIRE(cracks.events().size() == 1);
    auto const& e = cracks.events()[0];
    REQUIRE_THAT(speed * e.time / small, WithinRel(reference("8a.quasistatic", "u_c"), 1e-3));
    REQUIRE_THAT(e.normal_force / small, WithinRel(reference("8a.quasistatic", "force_before"), 1e-3));
    REQUIRE(e.mode == lacuna::bond_state::broken_in_tension);
}

TEST_CASE("a suddenly pulled chain overshoots", "[fracture]") {
    // 60 discs: no echo from the far end within the time of the peak.
    auto const pull = [](double speed, double strength) {
        auto p = unit_springs(strength);
        p.time_step = 0.01;
        lacuna::simulation<plane> run(chain<2>(60), p);
        run.fix(59);
        run.set_velocity(59, {speed, 0});
        return run;
    };
    SECTION("force in the first bond") {
        double const speed = 0.01;
        auto run = pull(speed, never);
        double highest = 0, at = 0;
        while (run.time() < 4) {
            double const now = run.time();
            run.step();
            double const force = force_along_x(run, 58, 59);
            if (force > highest) highest = force, at = now;
        }
        REQUIRE_THAT(highest / speed, WithinRel(reference("8b.pull_overshoot", "F_max_first_bond/(v sqrt(km))"), 1e-4));
        REQUIRE_THAT(at, WithinAbs(reference("8b.pull_overshoot", "t_max"), 0.02));
    }
    SECTION("critical speed") {
        double const critical = reference("8b.pull_overshoot", "v_crit_first_bond");
        for (double const factor : {0.995, 1.005}) {
            auto run = pull(factor * critical, 1);
            bool broken = false;
            while (run.time() < reference("8b.pull_overshoot", "t_max") + 0.05) {
                run.step();
                for (auto const& e : run.events()) broken = broken || e.bond == 58;
            }
            REQUIRE(broken == (factor > 1));
        }
    }
}

TEST_CASE("a bond sheared without rotation breaks at sigma_s A_c / k_s", "[fracture]") {
    double const strength = 1e-6, speed = 1e-6;
    auto p = unit_springs(never, strength);
    p.time_step = 1e-3;
    bool const rotations_locked = GENERATE(true, false);
    lacuna::simulation<plane> run(chain<2>(2), p);
    run.fix(0);
    run.fix(1, {.x = true, .y = true, .rotation = rotations_locked});
    run.set_velocity(1, {0, speed});
    // A free disc rolls instead: its shear force oscillates with amplitude v sqrt(k_s I) / lever, 0.7 v here.
    if (!rotations_locked) run.set_velocity(1, {0, speed / 2});
    std::vector<lacuna::break_event<2>> events;
    for (int n = 0; n < 5000; ++n) {
        run.step();
        events.insert(events.end(), run.events().begin(), run.events().end());
    }
    if (!rotations_locked) {
        REQUIRE(events.empty());
        return;
    }
    REQUIRE(events.size() == 1);
    REQUIRE(events[0].mode == lacuna::bond_state::broken_in_shear);
    // The first position beyond the limit; a sum of 1000 slips may be a rounding above it.
    REQUIRE((events[0].step == 1000 || events[0].step == 1001));
    double const offset = speed * events[0].time;
    REQUIRE_THAT(offset / strength, WithinAbs(reference("8c.shear_break", "u_s"), 1.001e-3));
    REQUIRE_THAT(events[0].shear_force, WithinRel(offset, 1e-6));
}

TEST_CASE("mixed loading meets the rectangle of the safety zone", "[fracture]") {
    double const small = 1e-6;
    for (int const psi : {0, 15, 26, 27, 30, 44, 46, 60, 75, 90})
        for (std::string const key : {"kn=ks,sn=ss", "kn=ks,ss=0.5sn"}) {
            INFO("psi = " << psi << ", " << key);
            std::string const path = "psi=" + std::to_string(psi);
            double const expected = reference("8d.mixed_path", path, key, 0);
            std::string const mode = reference_node("8d.mixed_path", path, key, 1).get<std::string>();
            auto p = unit_springs(small, small * (key == "kn=ks,sn=ss" ? 1 : 0.5));
            p.time_step = 1e-3;
            lacuna::simulation<plane> run(chain<2>(2), p);
            run.fix(0);
            run.fix(1);
            double const angle = psi * pi / 180;
            run.set_velocity(1, {small * std::cos(angle), small * std::sin(angle)});
            while (run.events().empty() && run.steps() < 2000) run.step();
            REQUIRE(run.events().size() == 1);
            REQUIRE_THAT(run.events()[0].time, WithinAbs(expected, 1.01e-3));
            REQUIRE((run.events()[0].mode == lacuna::bond_state::broken_in_tension) == (mode == "tension"));
        }
}

TEST_CASE("compression never breaks a bond in tension, and shear strength does not depend on it", "[fracture]") {
    double const small = 1e-6;
    auto p = unit_springs(small, small);
    p.time_step = 1e-3;
    lacuna::simulation<plane> run(chain<2>(2), p);
    run.fix(0);
    run.fix(1);
    run.set_velocity(1, {-2 * small, 0}); // twice the limit: the force is capped
    while (run.time() < 0.9995) run.step();
    run.set_velocity(1, {0, small});
    double const turned = run.time();
    while (run.events().empty() && run.steps() < 4000) run.step();
    REQUIRE(run.events().size() == 1);
    auto const& e = run.events()[0];
    REQUIRE(e.mode == lacuna::bond_state::broken_in_shear);
    REQUIRE_THAT(e.time - turned, WithinAbs(reference("8d.envelope_points", "F_n=-1"), 1.01e-3));
    REQUIRE_THAT(e.normal_force, WithinRel(-small, 1e-6));
}

TEST_CASE("a cycle of friction dissipates 4 mu N (u0 - mu N / k_s)", "[fracture][friction]") {
    double const load = 100, mu = 0.3, ks = 1e4, u0 = 0.01;
    bool const two_discs = GENERATE(true, false);
    auto p = springs<plane>(1e4, ks, mu, 1e-3);
    // A quarter of a cycle takes 2500 steps. On large discs the path changes the distance by u0^2 / 4R only.
    double const radius = 50, overlap = load / 1e4, dt = 1e-3, speed = u0 / (2500 * dt);
    p.time_step = dt;
    lacuna::packing<double, 2> packing;
    packing.add({0, radius - overlap}, radius);
    if (two_discs)
        packing.add({0, -radius}, radius);
    else
        p.walls = {{{0, 0}, {0, 1}, p.materials[0].contact}};
    lacuna::simulation<plane> run(packing, p);
    for (std::size_t k = 0; k < packing.size(); ++k) run.fix(k);

    double strongest = 0, work = 0, old_force = 0;
    auto const move = [&](double v, int steps) {
        run.set_velocity(0, {v, 0});
        for (int n = 0; n < steps; ++n) {
            run.step_with_energy();
            double const force = two_discs ? -pair_force(run, 0, 1)[0] : run.walls().force(0)[0];
            work += 0.5 * (force + old_force) * v * dt;
            old_force = force;
            strongest = std::max(strongest, std::fabs(force));
        }
    };
    move(speed, 2500);
    double const first_quarter = run.energy().friction;
    move(-speed, 5000);
    move(speed, 2500);
    double const before = run.energy().friction;
    work = 0;
    move(speed, 2500);
    move(-speed, 5000);
    move(speed, 2500);
    double const per_cycle = run.energy().friction - before;
    REQUIRE_THAT(per_cycle, WithinRel(reference("8f.friction_loop", "area"), two_discs ? 2e-4 : 1e-4));
    REQUIRE_THAT(work, WithinRel(reference("8f.friction_loop", "area"), 1e-3));
    REQUIRE_THAT(first_quarter, WithinRel(reference("8f.friction_loop", "first_quarter_dissipation"), 1e-3));
    REQUIRE_THAT(strongest, WithinRel(reference("8f.friction_loop", "max_force"), two_discs ? 2e-4 : 1e-4));
    REQUIRE(std::fabs(run.energy().residual()) < 1e-3 * run.energy().largest());
}

TEST_CASE("a path shorter than mu N / k_s does not slip", "[fracture][friction]") {
    auto p = springs<plane>(1e4, 1e4, 0.3, 1e-3);
    p.walls = {{{0, 0}, {0, 1}, p.materials[0].contact}};
    p.time_step = 1e-3;
    lacuna::packing<double, 2> one;
    one.add({0, 0.49}, 0.5);
    lacuna::simulation<plane> run(one, p);
    run.fix(0);
    double const path = 0.999 * reference("8f.friction_loop", "no_slip_if_u0<");
    for (double const sign : {1.0, -1.0, -1.0, 1.0}) {
        run.set_velocity(0, {sign * path / (1000 * p.time_step), 0});
        for (int n = 0; n < 1000; ++n) run.step_with_energy();
    }
    REQUIRE_THAT(run.energy().friction, WithinAbs(0, 1e-12));
}
