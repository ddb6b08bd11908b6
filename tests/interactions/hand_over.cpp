// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// Two discs of radius 0.5 whose second follows a prescribed path; k_n = k_s = 1, bond area 1.
struct bench {
    lacuna::simulation<plane> run;
    std::vector<lacuna::break_event<2>> events;

    bench(double distance, bool bonded, double tensile, double shearing, double friction, double tolerance = 0,
          double skin = 0.1)
        : run([&] {
              auto p = springs<plane>(1, 1, friction, unit_density(2), tensile, shearing);
              p.interactions.initial_contact_tolerance = tolerance;
              p.interactions.skin = skin;
              p.time_step = 1e-3;
              lacuna::packing<double, 2> two;
              two.add({0, 0}, 0.5);
              two.add({distance, 0}, 0.5);
              if (bonded) two.bonds.push_back({0, 1});
              lacuna::simulation<plane> s(two, p);
              s.fix(0);
              s.fix(1);
              return s;
          }()) {}

    /// Moves the second disc by (dx, dy) in `steps` steps. One more step evaluates the forces at its new position.
    void move(double dx, double dy, int steps) {
        run.set_velocity(1, {dx / (steps * 1e-3), dy / (steps * 1e-3)});
        for (int n = 0; n < steps; ++n) advance();
        run.set_velocity(1, {});
        advance();
    }
    void advance() {
        auto const arm = run.position(1) - run.position(0);
        double const before = normal;
        run.step();
        events.insert(events.end(), run.events().begin(), run.events().end());
        auto const force = pair_force(run, 0, 1), n = arm / norm(arm);
        normal = dot(force, n);
        shear = dot(force, perpendicular(n));
        // A spring's force changes by at most stiffness times path; a change from bond to contact may only reduce it.
        if (run.steps() > 1) jump = std::max(jump, std::fabs(normal) - std::fabs(before) - norm(arm - last_arm));
        last_arm = arm;
    }
    /// Forces of the last step on the first disc: normal positive in tension, shear along n rotated by +90 degrees.
    double normal = 0, shear = 0;
    double jump = -1; ///< largest growth of the normal force beyond stiffness times path
    lacuna::vec<double, 2> last_arm{};
};

} // namespace

TEST_CASE("after a tension failure there is no force until the pair touches again", "[hand-over]") {
    bench b(1, true, 0.01, never, 0.5);
    b.move(0.0101, 0, 101);
    REQUIRE(b.events.size() == 1);
    auto const& e = b.events[0];
    REQUIRE(e.mode == lacuna::bond_state::broken_in_tension);
    REQUIRE(e.bond == 0);
    REQUIRE(e.particles == std::array<std::int32_t, 2>{0, 1});
    // The first position beyond 0.01: a multiple of 1e-4, up to a rounding of the sum.
    REQUIRE_THAT(e.time, WithinAbs(0.1, 1.01e-3));
    REQUIRE(e.step == std::llround(e.time / 1e-3));
    REQUIRE_THAT(e.normal_force, WithinAbs(0.01, 1.01e-4));
    REQUIRE_THAT(e.shear_force, WithinAbs(0, 1e-15));
    REQUIRE_THAT(e.energy, WithinRel(e.normal_force * e.normal_force / 2, 1e-12));
    REQUIRE_THAT(e.position[0], WithinRel(e.normal_force / 2 + 0.5, 1e-12)); // half the distance
    REQUIRE_THAT(e.position[1], WithinAbs(0, 1e-15));
    REQUIRE(b.normal == 0);
    b.move(0.05, 0, 100);
    REQUIRE(b.normal == 0);
    b.move(-0.0601, 0, 100);
    REQUIRE_THAT(b.normal, WithinAbs(0, 1e-12)); // they just touch at r_i + r_j
    REQUIRE_THAT(b.shear, WithinAbs(0, 1e-15));
    b.move(-0.02, 0, 100);
    REQUIRE_THAT(b.normal, WithinRel(-0.02, 1e-9));
    b.move(0, 0.005, 100); // k_s u = 0.005 < mu N = 0.01: sticks, starting from zero
    REQUIRE_THAT(b.shear, WithinRel(0.005, 3e-2));
    REQUIRE(b.jump < 1e-12);
}

TEST_CASE("after a shear failure the pair is a frictional contact at once", "[hand-over]") {
    double const friction = 0.5;
    bench b(1, true, never, 0.02, friction);
    b.move(-0.01, 0, 100);
    REQUIRE_THAT(b.normal, WithinRel(-0.01, 1e-9));
    b.move(0, 0.0195, 195);
    REQUIRE(b.events.empty());
    double const normal = b.normal;
    b.move(0, 0.0010, 10);
    REQUIRE(b.events.size() == 1);
    auto const& e = b.events[0];
    REQUIRE(e.mode == lacuna::bond_state::broken_in_shear);
    REQUIRE_THAT(std::fabs(e.shear_force), WithinRel(0.02, 1e-2));
    REQUIRE_THAT(e.normal_force, WithinRel(normal, 2e-2));
    REQUIRE_THAT(e.energy, WithinRel((0.02 * 0.02 + 0.01 * 0.01) / 2, 2e-2));
    // The normal force stays, Coulomb's limit clips the shear force; small rotations of the normal affect both.
    REQUIRE_THAT(b.normal, WithinRel(normal, 3e-2));
    REQUIRE_THAT(b.shear, WithinRel(friction * std::fabs(normal), 5e-2));
    REQUIRE(b.jump < 1e-12);
}

TEST_CASE("a pair whose bond fails in shear under tension separates", "[hand-over]") {
    bench b(1, true, never, 0.02, 0.5);
    b.move(0.01, 0, 100);
    b.move(0, 0.022, 220);
    REQUIRE(b.events.size() == 1);
    REQUIRE(b.events[0].mode == lacuna::bond_state::broken_in_shear);
    REQUIRE(b.events[0].normal_force > 0.0099);
    REQUIRE(b.normal == 0);
    REQUIRE(b.shear == 0);
    REQUIRE(b.jump < 1e-12);
}

TEST_CASE("beyond the compressive limit the force is capped, and the bond remains and shortens", "[hand-over]") {
    bench b(1, true, 0.01, never, 0.5);
    b.move(-0.03, 0, 300);
    REQUIRE(b.events.empty());
    REQUIRE_THAT(b.normal, WithinRel(-0.01, 1e-12));
    b.move(0.01, 0, 100);
    REQUIRE_THAT(b.normal, WithinAbs(0, 1e-12)); // rest length 0.98: 0.02 of plastic shortening
    b.move(0.005, 0, 100);
    REQUIRE_THAT(b.normal, WithinRel(0.005, 1e-9));
    b.move(0.0052, 0, 52);
    REQUIRE(b.events.size() == 1); // fails in tension while the discs still overlap by 0.01
    REQUIRE(b.events[0].mode == lacuna::bond_state::broken_in_tension);
    REQUIRE(b.normal == 0);
    b.move(-0.002, 0, 20); // back: a new contact from zero force, at the distance of the failure
    REQUIRE_THAT(b.normal, WithinAbs(-0.002, 2.01e-4));
    REQUIRE(b.jump < 1e-12);
}

TEST_CASE("no force jumps up when a pair breaks, separates or touches again", "[hand-over]") {
    // Bonds that are made at touching distance, with an overlap, and with a gap; initial contacts within the tolerance.
    for (double const distance : {1.0, 0.99, 1.01})
        for (bool const bonded : {true, false})
            for (double const shear : {0.002, never}) {
                INFO("distance " << distance << ", bonded " << bonded << ", shear strength " << shear);
                bench b(distance, bonded, 0.004, shear, 0.3, 0.03);
                b.advance();
                REQUIRE_THAT(b.normal, WithinAbs(0, 1e-15)); // starts at zero force
                b.move(-0.003, 0, 100);
                REQUIRE_THAT(b.normal, WithinRel(-0.003, 1e-9));
                b.move(0, 0.004, 100);  // shears, and breaks if its strength is finite
                b.move(0.012, 0, 200);  // separates or breaks
                b.move(0.03, 0, 200);
                REQUIRE(b.normal == 0);
                b.move(-0.06, 0, 400);
                REQUIRE(b.normal < -0.001);
                b.move(0, -0.01, 100);
                b.move(0.08, 0, 400);
                REQUIRE(b.normal == 0);
                REQUIRE(b.events.size() == (bonded ? 1 : 0));
                REQUIRE(b.jump < 1e-12);
            }
}

TEST_CASE("a pair of the initial packing starts at zero force and later touches at r_i + r_j", "[hand-over]") {
    for (double const distance : {0.995, 1.005}) {
        bench b(distance, false, never, never, 0.3, 0.02);
        b.move(-0.001, 0, 100);
        REQUIRE_THAT(b.normal, WithinRel(-0.001, 1e-9));
        b.move(0.02, 0, 100);
        REQUIRE(b.normal == 0);
        b.move(0.981 - distance, 0, 100); // to distance 1
        REQUIRE_THAT(b.normal, WithinAbs(0, 1e-12));
        b.move(-0.001, 0, 100);
        REQUIRE_THAT(b.normal, WithinRel(-0.001, 1e-9));
    }
    bench outside(0.98, false, never, never, 0.3, 0.02); // beyond the tolerance: its overlap is a force
    outside.advance();
    REQUIRE_THAT(outside.normal, WithinRel(-0.02, 1e-9));
}

TEST_CASE("both limits in one step: the larger ratio wins", "[hand-over]") {
    for (bool const tension : {true, false}) {
        bench b(1, true, tension ? 0.010 : 0.012, tension ? 0.012 : 0.010, 0.5);
        b.run.set_velocity(1, {20, 20}); // in one step to (0.02, 0.02): ratios 2 and 1.67
        b.advance();
        REQUIRE(b.events.empty());
        b.advance();
        REQUIRE(b.events.size() == 1);
        REQUIRE((b.events[0].mode == lacuna::bond_state::broken_in_tension) == tension);
    }
}

TEST_CASE("histories survive neighbour rebuilds bit by bit", "[hand-over]") {
    // Four discs in a row, sliding and sticking; two others fly freely. A tiny skin causes a search in nearly every
    // step, a huge one only in the first.
    auto const play = [](double skin) {
        auto p = springs<plane>(1, 0.8, 0.4, unit_density(2));
        p.interactions.skin = skin;
        p.time_step = 0.02;
        lacuna::packing<double, 2> some;
        for (int k = 0; k < 4; ++k) some.add({0.985 * k, 0.02 * (k % 2)}, 0.5);
        some.add({0.5, 2.5}, 0.4);
        some.add({2.5, -1.2}, 0.4);
        lacuna::simulation<plane> run(some, p);
        run.set_velocity(0, {0.01, 0.004});
        run.set_velocity(3, {-0.01, 0.01});
        run.set_velocity(4, {0.005, -0.02});
        run.set_velocity(5, {0.0, 0.002});
        run.set_spin(1, {0.01});
        bool stuck = false, slid = false;
        for (int n = 0; n < 4000; ++n) {
            double const before = run.energy().friction;
            run.step_with_energy();
            bool const slides = run.energy().friction > before + 1e-12;
            slid = slid || slides;
            stuck = stuck || (!slides && run.energy().strain > 0);
        }
        REQUIRE(slid);
        REQUIRE(stuck);
        return std::pair{run.pairs().neighbors().build_count(), std::vector{run.position(0), run.position(1),
                         run.position(2), run.position(3), run.position(4), run.position(5)}};
    };
    auto const [often, one] = play(0.001);
    auto const [once, other] = play(10);
    REQUIRE(often > 100);
    REQUIRE(once == 1);
    for (std::size_t k = 0; k < one.size(); ++k) REQUIRE(one[k] == other[k]);
}
