// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include <lacuna/observe/crack_record.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;
using run_type = lacuna::simulation<plane>;

namespace {

struct diary {
    static constexpr lacuna::stage stages =
        lacuna::stage::start | lacuna::stage::step | lacuna::stage::breakage | lacuna::stage::end;
    std::string text{};
    long long last = 1000;
    void on_start(run_type const& s) { text += "start" + std::to_string(s.steps()) + " "; }
    lacuna::run_control on_step(run_type const& s) {
        text += "step" + std::to_string(s.steps()) + " ";
        return s.steps() >= last ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }
    void on_break(lacuna::break_event<2> const& e, run_type const&) {
        text += "break" + std::to_string(e.bond) + "@" + std::to_string(e.step) + " ";
    }
    void on_end(run_type const& s) { text += "end" + std::to_string(s.steps()) + " "; }
};
struct counter {
    static constexpr lacuna::stage stages = lacuna::stage::step;
    int steps = 0;
    void on_step(run_type const&) { ++steps; }
};
struct energy_watch {
    static constexpr lacuna::stage stages = lacuna::stage::step;
    static constexpr bool needs_energy = true;
    double kinetic = -1;
    void on_step(run_type const& s) { kinetic = s.energy().kinetic; }
};

/// Needs the ledger in all steps but two.
struct sampler {
    static constexpr lacuna::stage stages = lacuna::stage::step;
    std::vector<double> fracture{};
    bool needs_energy_in(long long step) const { return step < 5 || step >= 7; }
    void on_step(run_type const& s) { fracture.push_back(s.energy().fracture); }
};

/// The second disc pulled by 0.004 per step: the bond's limit of 0.01 N is exceeded in the position after 3 steps.
run_type pulled() {
    auto p = springs<plane>(1, 1, 0, unit_density(2), 0.01);
    p.time_step = 0.1;
    p.start_time = 5;
    run_type run(chain<2>(2), p);
    run.fix(0);
    run.fix(1);
    run.set_velocity(1, {0.04, 0});
    return run;
}

} // namespace

TEST_CASE("stages are called in their order", "[observer]") {
    auto run = pulled();
    diary d;
    REQUIRE(run.run(5, d) == 5);
    REQUIRE(d.text == "start0 step1 step2 step3 break0@3 step4 step5 end5 ");
    REQUIRE(run.steps() == 5);
    REQUIRE_THAT(run.time(), WithinRel(5.5, 1e-15));
}

TEST_CASE("an observer stops a run, after all have seen the step", "[observer]") {
    auto run = pulled();
    diary d{{}, 2};
    counter c;
    REQUIRE(run.run(100, d, c) == 2);
    REQUIRE(c.steps == 2);
    REQUIRE(d.text == "start0 step1 step2 end2 ");
    REQUIRE(run.run(1, c, d) == 1); // it continues from its last step
    REQUIRE(run.steps() == 3);
}

TEST_CASE("observers see events, and energies when they need them", "[observer]") {
    auto run = pulled();
    lacuna::crack_record<lacuna::break_event<2>> cracks;
    energy_watch e;
    run.run(10, cracks, e);
    REQUIRE(cracks.events().size() == 1);
    REQUIRE_THAT(cracks.events()[0].time, WithinRel(5.3, 1e-14));
    REQUIRE_THAT(cracks.events()[0].normal_force, WithinRel(0.012, 1e-12));
    REQUIRE_THAT(e.kinetic, WithinRel(0.5 * 0.04 * 0.04, 1e-12));
}

TEST_CASE("an observer gets energies in the steps that it names", "[observer]") {
    auto run = pulled();
    sampler part;
    run.run(9, part);
    // In step number 3 the bond loses 0.012^2 / 2 J, less the work 0.012 * 0.004 / 2 that its missing force would have
    // done: a step uses the mean of the forces before and after it, and the force after it is zero.
    double const loss = 0.5 * 0.012 * 0.012 - 0.5 * 0.012 * 0.004;
    std::vector<double> const lost{0, 0, 0, loss, loss, loss, loss, 0, 0};
    REQUIRE(part.fracture.size() == lost.size());
    for (std::size_t k = 0; k < lost.size(); ++k) REQUIRE_THAT(part.fracture[k], WithinAbs(lost[k], 1e-12));
    REQUIRE_THAT(run.energy().initial, WithinRel(0.5 * 0.04 * 0.04, 1e-12));

    // Another observer that needs energies in every step gets them in every step.
    auto both = pulled();
    sampler again;
    energy_watch always;
    both.run(9, again, always);
    for (std::size_t k = 0; k < lost.size(); ++k)
        REQUIRE_THAT(again.fracture[k], WithinAbs(k < 3 ? 0 : loss, 1e-12));
}

TEST_CASE("observers as lambdas: every() and at_end()", "[observer]") {
    auto run = pulled();
    std::vector<long long> seen;
    std::string end;
    run.run(7, lacuna::every(3, [&](auto const& s) { seen.push_back(s.steps()); }),
            lacuna::at_end([&](run_type const& s) { end = "end" + std::to_string(s.steps()); }));
    CHECK(seen == std::vector<long long>{3, 6});
    CHECK(end == "end7");
    // Steps are those of the simulation, not of the call.
    run.run(3, lacuna::every(5, [&](auto const& s) { seen.push_back(s.steps()); }));
    CHECK(seen == std::vector<long long>{3, 6, 10});
    auto const taken = run.run(100, lacuna::every(4, [](auto const& s) {
        return s.steps() >= 16 ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }));
    CHECK(taken == 6);
    CHECK_THROWS_WITH(lacuna::every(0, [](auto const&) {}), contains_text("every.interval = 0: must be >= 1"));
}

TEST_CASE("a local class without a list of stages observes with the hooks that it has", "[observer]") {
    struct watcher {
        int steps = 0, breaks = 0;
        void on_step(run_type const&) { ++steps; }
        void on_break(lacuna::break_event<2> const&, run_type const&) { ++breaks; }
    } watch;
    auto run = pulled();
    run.run(8, watch);
    CHECK(watch.steps == 8);
    CHECK(watch.breaks == 1);
}
