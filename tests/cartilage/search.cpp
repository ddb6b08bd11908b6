// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cartilage/specimen/particle_kinds.hpp"
#include "cartilage/study/search.hpp"
#include "cartilage/study/study_json.hpp"

using namespace cartilage;

namespace {

constexpr double longest = 40e-9;         // s, duration of a synthetic run
constexpr double latest = 0.99 * longest; // s, last time at which it meets a criterion

/// A packing with known loads. Each criterion is met from its load on: at that load at the last moment of a run, at
/// higher loads at a time in inverse proportion to the load. Runs between bad_from and bad_to are invalid. Counts its
/// runs.
struct synthetic_packing {
    double first, capacity, complete;
    double bad_from = 1e9, bad_to = 0;
    std::map<double, double> simulated{}; // time, s, by load
    int calls = 0;

    static std::optional<double> time_of(double from, double load) {
        return load >= from ? std::optional(latest * from / load) : std::nullopt;
    }
    double time() const {
        double sum = 0;
        for (auto const& [load, t] : simulated) sum += t;
        return sum;
    }

    load_run operator()(double load, criterion c) {
        ++calls;
        load_run p;
        p.load_MPa = load;
        double& done = simulated[load];
        std::optional<double> const times[] = {time_of(first, load), time_of(capacity, load),
                                               time_of(complete, load)};
        double const until = times[int(c)].value_or(longest);
        // A run is continued, never restarted.
        if (until <= done) throw std::logic_error("run restarted");
        p.end_time = done = until;
        p.first_layer_fraction = std::min(1.0, 0.5 * load / capacity) * until / longest;
        if (load >= bad_from && load <= bad_to) {
            p.invalid = "synthetic";
            p.ended = "invalid";
            return p;
        }
        auto const so_far = [&](criterion which) {
            auto const& t = times[int(which)];
            return t && *t <= until ? t : std::nullopt;
        };
        p.first_crack_time = so_far(criterion::first_crack);
        p.capacity_time = so_far(criterion::capacity);
        p.complete_time = so_far(criterion::complete);
        p.ended = meets(p, c) ? name_of(c) : "limit";
        return p;
    }
};

packing_result search(synthetic_packing& packing, load_range const& range = {}) {
    return find_thresholds(range, [&](double load, criterion c) { return packing(load, c); });
}

bool within_a_step(double found, double truth) { return found >= truth && found < truth * 1.021; }

} // namespace

TEST_CASE("The grid of loads covers the range in equal ratios no larger than the resolution") {
    load_range range;
    // ln(200) / ln(1.02) = 267.6
    CHECK(range.steps() == 268);
    CHECK(range.load(0) == 5);
    CHECK(range.load(268) == 1000);
    for (int k = 1; k <= 268; ++k) {
        CHECK(range.load(k) / range.load(k - 1) < 1.02 + 1e-3); // four digits of each load
        CHECK(range.load(k) > range.load(k - 1));
        CHECK(range.nearest_index(range.load(k)) == k);
    }
    // sqrt(5 * 1000) lies in the middle.
    CHECK(range.load(134) == 70.71);
    CHECK(range.nearest_index(1) == 0);
    CHECK(range.nearest_index(1e6) == 268);
    range.highest_MPa = 5;
    CHECK_THROWS_AS(range.steps(), std::invalid_argument);
    range.highest_MPa = 1000;
    range.resolution = 0;
    CHECK_THROWS_AS(range.steps(), std::invalid_argument);
}

TEST_CASE("The search finds each load to one step, for any load and any guess") {
    for (double const guess : {5.0, 45.0, 1000.0})
        for (double const first : {5.5, 12.0, 44.0, 170.0, 700.0})
            for (double const ratio : {1.0, 1.01, 1.3, 4.0}) {
                synthetic_packing packing{first, first * ratio, first * ratio * ratio};
                load_range range;
                range.first_guess = {guess, guess, guess};
                auto const r = search(packing, range);
                REQUIRE(r.found.first_crack_MPa);
                CHECK(within_a_step(*r.found.first_crack_MPa, packing.first));
                if (packing.capacity <= 1000) {
                    REQUIRE(r.found.capacity_MPa);
                    CHECK(within_a_step(*r.found.capacity_MPa, packing.capacity));
                    CHECK(r.found.no_capacity.empty());
                } else {
                    CHECK_FALSE(r.found.capacity_MPa);
                    CHECK(r.found.no_capacity == "above 1000 MPa");
                }
                CHECK(r.found.complete_MPa.has_value() == (packing.complete <= 1000));
                // Nine halvings of 268 steps for each load, and a few runs for the first bracket.
                CHECK(packing.calls <= 3 * 15);
            }
}

TEST_CASE("A good guess and the choice of short runs save most of the run time") {
    // At least six runs: for each load one that does not meet its criterion and one that meets it at its end. Halving
    // the range takes eight runs for each load, of 0.2 to 1 of the longest duration.
    for (double const off : {0.8, 1.0, 1.25}) {
        synthetic_packing packing{25, 110, 200};
        load_range range;
        range.first_guess = {25 * off, 110 * off, 200 * off};
        search(packing, range);
        CHECK(packing.time() > 6 * 0.97 * longest);
        CHECK(packing.time() < 19 * longest);
    }
    // Loads above the range need only one run at the end of the range, for both criteria.
    synthetic_packing strong{170, 1500, 1200};
    load_range range;
    range.first_guess = {170, 1500, 1500};
    auto const r = search(strong, range);
    CHECK(r.found.no_capacity == "above 1000 MPa");
    CHECK(r.found.no_complete == "above 1000 MPa");
    int above_first = 0;
    for (load_run const& p : r.runs) above_first += p.ran_to_end() && p.first_crack_time.has_value();
    CHECK(above_first == 1);
}

TEST_CASE("Complete damage is found if it comes before the capacity") {
    for (double const capacity : {600.0, 2000.0}) {
        synthetic_packing packing{170, capacity, 300};
        auto const r = search(packing);
        REQUIRE(r.found.complete_MPa);
        CHECK(within_a_step(*r.found.first_crack_MPa, 170));
        CHECK(within_a_step(*r.found.complete_MPa, 300));
        CHECK(r.found.no_complete.empty());
        CHECK(r.found.capacity_MPa.has_value() == (capacity < 1000));
        if (r.found.capacity_MPa) CHECK(within_a_step(*r.found.capacity_MPa, 600));
    }
}

TEST_CASE("Loads outside the range are missing, and the reason names the side") {
    synthetic_packing strong{2000, 3000, 4000};
    auto const above = search(strong);
    CHECK_FALSE(above.found.first_crack_MPa);
    CHECK(above.found.no_first_crack == "above 1000 MPa");
    CHECK(above.found.no_capacity == "above 1000 MPa");
    CHECK(above.found.no_complete == "above 1000 MPa");
    synthetic_packing weak{1, 2, 3};
    auto const below = search(weak);
    CHECK_FALSE(below.found.first_crack_MPa);
    CHECK(below.found.no_first_crack == "below 5 MPa");
    CHECK(below.found.no_complete == "below 5 MPa");
}

TEST_CASE("The search avoids invalid runs") {
    // The invalid loads are fewer than the invalid runs that end the search.
    synthetic_packing packing{44, 80, 200};
    packing.bad_from = 50;
    packing.bad_to = 53;
    auto const r = search(packing);
    REQUIRE(r.found.capacity_MPa);
    CHECK(within_a_step(*r.found.first_crack_MPa, 44));
    CHECK(within_a_step(*r.found.capacity_MPa, 80));
    CHECK(within_a_step(*r.found.complete_MPa, 200));

    // All runs around the load sought are invalid.
    synthetic_packing hidden{44, 80, 200};
    hidden.bad_from = 60;
    hidden.bad_to = 1000;
    auto const h = search(hidden);
    CHECK(within_a_step(*h.found.first_crack_MPa, 44));
    CHECK_FALSE(h.found.capacity_MPa);
    CHECK(h.found.no_capacity.find("do not count") != std::string::npos);
    int invalid = 0;
    for (load_run const& p : h.runs) invalid += p.invalid.has_value();
    CHECK(invalid > 0);
}

TEST_CASE("The first crack is never above the other loads, whatever the outcomes") {
    // Outcomes without any order, from the digits of the load.
    for (std::uint64_t salt = 1; salt < 200; ++salt) {
        std::map<double, load_run> runs;
        auto const r = find_thresholds({}, [&](double load, criterion c) {
            auto const noise = std::uint64_t(load * 1000) * 0x9e3779b97f4a7c15u * salt;
            int const reached = int((noise >> 40) % 4);
            load_run p;
            p.load_MPa = load;
            if (reached > 0) p.first_crack_time = 1e-9;
            if (reached > 1) p.capacity_time = 2e-9;
            if (reached > 2) p.complete_time = 3e-9;
            p.ended = meets(p, c) ? name_of(c) : "limit";
            p.end_time = time_met(p, c).value_or(longest);
            if (!p.ran_to_end()) {
                if (c < criterion::complete) p.complete_time.reset();
                if (c < criterion::capacity) p.capacity_time.reset();
            }
            return p;
        });
        double const first = r.found.first_crack_MPa.value_or(r.found.no_first_crack[0] == 'b' ? 0 : 1e9);
        double const capacity = r.found.capacity_MPa.value_or(r.found.no_capacity[0] == 'b' ? 0 : 1e9);
        double const complete = r.found.complete_MPa.value_or(r.found.no_complete[0] == 'b' ? 0 : 1e9);
        CHECK(first <= capacity);
        CHECK(first <= complete);
        // The criterion is met at the load found, and not at the next lower load.
        auto const at = [&](double load) {
            return std::find_if(r.runs.begin(), r.runs.end(), [&](load_run const& p) { return p.load_MPa == load; });
        };
        for (auto const& [load, c] : {std::pair(r.found.first_crack_MPa, criterion::first_crack),
                                      std::pair(r.found.capacity_MPa, criterion::capacity),
                                      std::pair(r.found.complete_MPa, criterion::complete)}) {
            if (!load) continue;
            auto const yes = at(*load), no = at(load_range{}.load(load_range{}.nearest_index(*load) - 1));
            REQUIRE(yes != r.runs.end());
            REQUIRE(no != r.runs.end());
            CHECK(meets(*yes, c));
            CHECK((no->ran_to_end() && !meets(*no, c)));
        }
        for (std::size_t k = 1; k < r.runs.size(); ++k) CHECK(r.runs[k - 1].load_MPa < r.runs[k].load_MPa);
    }
}

TEST_CASE("A study as text is the same study, bit for bit") {
    study_result s;
    s.choices = "a = 1\nb = \"x\"\n";
    s.code = "0123";
    s.dry = true;
    s.step_share = 0.8;
    s.length_um = 0.1 + 0.2;
    s.lowest_MPa = 0.1;
    packing_result r;
    r.zone = lacuna::cartilage_zone::deep;
    r.seed = UINT64_MAX;
    r.found.first_crack_MPa = 1.0 / 3;
    r.found.no_capacity = "above 1000 MPa";
    load_run p;
    p.load_MPa = 45.1;
    p.end_time = 4e-8 / 3;
    p.ended = "capacity";
    p.first_crack_time = 1e-9 / 7;
    p.energy_residual_fraction = -1.25e-5 / 3;
    p.invalid = "why \\ not";
    p.cracks = {{1e-9 / 3, 1e-5 / 7, 2e-4 / 9, true, 3}, {2e-9, 0, 0, false, -1}};
    p.layers = {{"deep", 2, 40, 7, 3e-9 / 11}, {"deep", 3, 1, 0, std::nullopt}};
    load_run sound;
    sound.load_MPa = 100;
    sound.ended = "limit";
    r.runs = {p, sound};
    s.packings = {r};
    snapshot shot;
    shot.figure = "11";
    shot.run = p;
    shot.fronts = {{1e-10 / 3, 2, {5e-6, 15e-6}, {-1e6 / 3, 0}, {2e5 / 3, -0.0}}};
    shot.damage.right = 1.2e-4;
    shot.damage.top = 3e-4 / 7;
    shot.damage.particles = {{{1e-6 / 3, 2e-6}, 1.5e-6, cartilage::fibre_particle}};
    shot.damage.bonds = {{{0, 1}, {2, 1.0 / 3}}};
    shot.damage.cracks = {{{1, 2}, {0, 1}, lacuna::scene::break_mode::shear}};
    shot.damage.pores = {{{1, 2}, -1e5 / 3}};
    shot.damage.loads = {{{1, 2}, {0, -1}}};
    shot.damage.walls = shot.damage.supports = {{{0, 1}, {2, 3}}};
    shot.damage.zones = {{0, 1e-4, "deep"}};
    shot.damage.title = "Title";
    shot.damage.captions = {"one", "two"};
    s.snapshots = {shot};

    std::string const text = text_of(s);
    study_result const back = study_from(text);
    CHECK(text_of(back) == text);
    REQUIRE(back.packings.size() == 1);
    CHECK(back.length_um == s.length_um);
    CHECK(back.step_share == 0.8);
    CHECK(back.packings[0].seed == UINT64_MAX);
    CHECK(back.packings[0].found.first_crack_MPa == 1.0 / 3);
    CHECK(back.packings[0].runs[0].first_crack_time == p.first_crack_time);
    CHECK(back.packings[0].runs[0].cracks[0].x == 1e-5 / 7);
    CHECK(back.packings[0].runs[0].cracks[0].shear);
    CHECK(back.packings[0].runs[0].layers[0].half_broken_time == 3e-9 / 11);
    CHECK(back.packings[0].runs[0].invalid == "why \\ not");
    CHECK_FALSE(back.packings[0].runs[1].invalid);
    CHECK(back.snapshots[0].fronts[0].stress[0] == -1e6 / 3);
    CHECK(back.snapshots[0].damage.top == 3e-4 / 7);
    CHECK(back.snapshots[0].damage.cracks[0].mode == lacuna::scene::break_mode::shear);
    CHECK(back.snapshots[0].damage.zones[0].name == "deep");

    CHECK_THROWS_AS(study_from(text.substr(0, text.size() / 2)), std::runtime_error);
    CHECK_THROWS_AS(study_from("{}"), std::runtime_error);
    CHECK_THROWS_AS(study_from("[1, 2]"), std::runtime_error);
}
