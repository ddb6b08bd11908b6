// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "cartilage/study/study_fronts.hpp"
#include "cartilage/study/study_series.hpp"
#include "cartilage/study/study_table.hpp"

using namespace cartilage;

namespace {

load_run run_at(double load, char const* ended, std::optional<double> first_crack = {}, double broken = 0) {
    load_run p;
    p.load_MPa = load;
    p.ended = ended;
    p.end_time = 10e-9;
    p.first_crack_time = first_crack;
    p.broken_fraction = broken;
    return p;
}

packing_result packing_of(std::uint64_t seed, std::vector<load_run> runs, std::optional<double> first = {}) {
    packing_result r;
    r.seed = seed;
    r.found.first_crack_MPa = first;
    r.runs = std::move(runs);
    return r;
}

std::vector<packing_result const*> pointers(std::vector<packing_result> const& all) {
    std::vector<packing_result const*> found;
    for (auto const& p : all) found.push_back(&p);
    return found;
}

} // namespace

TEST_CASE("table 3 counts packings that hold, that fail below the range, and that no run decides") {
    study_result study;
    load_run unsound = run_at(1000, "invalid");
    unsound.invalid = "energy";
    study.packings = {packing_of(1, {}, 40),
                      packing_of(2, {}, 50),
                      packing_of(3, {}, 60),
                      packing_of(4, {run_at(1000, "quiet")}),          // holds
                      packing_of(5, {run_at(5, "first_crack", 1e-9)}), // fails below the range
                      packing_of(6, {unsound}),
                      packing_of(7, {run_at(500, "quiet")})};
    auto const cells = table3(study);
    REQUIRE(cells.size() == 3);
    table3_cell const& first = cells[0];
    CHECK(first.count() == 5);
    CHECK(first.none == 1);
    CHECK(first.invalid == 2);
    // -inf, 40, 50, 60, inf
    CHECK(first.median == 50);
    CHECK(first.first_quartile == 40);
    CHECK(first.third_quartile == 60);
    CHECK(std::isinf(first.of_median.high));
    CHECK(first.paper.value() == 45);
    CHECK(first.paper_percentile.value() == 40);
    std::string const csv = table3_csv(cells, study);
    CHECK_THAT(csv, contains_text("surface,first crack,5,2,1,50.0,40.0,60.0,< 5,> 1000,45,40.0\n"));
    // Of the capacity it is only known that one packing holds.
    CHECK_THAT(csv, contains_text("surface,capacity,1,6,1,> 1000,> 1000,> 1000,> 1000,> 1000,48,0.0\n"));
}

TEST_CASE("a run that stops at its first crack does not decide the capacity at the highest load") {
    study_result study;
    study.packings = {packing_of(1, {run_at(1000, "first_crack", 1e-9)}, 700)};
    auto const cells = table3(study);
    CHECK(cells[0].count() == 1);
    CHECK(cells[1].count() == 0);
    CHECK(cells[1].invalid == 1);
    CHECK_THAT(table3_csv(cells, study), contains_text("surface,capacity,0,1,0,,,,,,48,\n"));
}

TEST_CASE("the paper's loads are those of its Table 3 and of the text beside Figure 12") {
    using lacuna::cartilage_zone;
    CHECK(paper_load(cartilage_zone::deep, threshold::capacity).value() == 57);
    CHECK(paper_load(cartilage_zone::whole, threshold::first_crack).value() == 46);
    CHECK_FALSE(paper_load(cartilage_zone::whole, threshold::complete));
}

TEST_CASE("damage against load: valid runs to the end, and their median between loads") {
    load_run unsound = run_at(300, "duration", 1e-9, 0.9);
    unsound.invalid = "energy";
    std::vector<packing_result> const packings{
        packing_of(1, {run_at(400, "limit", 1e-9, 0.4), run_at(100, "quiet", {}, 0.0),
                       run_at(200, "capacity", 1e-9, 0.3), unsound}),
        packing_of(2, {run_at(100, "quiet", {}, 0.1), run_at(400, "quiet", 1e-9, 0.2)}),
        packing_of(3, {run_at(200, "quiet", {}, 0.5)}), packing_of(4, {run_at(50, "complete", 1e-9, 1)})};
    auto const all = damage_series(pointers(packings));
    REQUIRE(all.size() == 3);
    REQUIRE(all[0].size() == 2);
    CHECK(all[0][0][0] == 100);
    CHECK(all[0][1][1] == 40);
    auto const middle = median_series(all);
    REQUIRE(middle.size() == 3);
    CHECK_THAT(middle[0][1], WithinAbs(5, 1e-12));
    // Halfway between 100 and 400 on a logarithmic axis: 20, 15, and the third packing's 50.
    CHECK(middle[1][0] == 200);
    CHECK_THAT(middle[1][1], WithinAbs(20, 1e-9));
    CHECK_THAT(middle[2][1], WithinAbs(30, 1e-12));
}

TEST_CASE("first cracks: elastic and later ones, slope within a packing") {
    auto const at = [](double load, double time) { return run_at(load, "first_crack", time); };
    std::vector<packing_result> const packings{packing_of(1, {at(100, 5e-9), at(25, 10e-9), at(900, 1e-9)}),
                                               packing_of(2, {at(100, 6e-9), at(400, 3e-9), run_at(20, "quiet")})};
    auto const times = first_crack_times_of(pointers(packings));
    CHECK(times.elastic.size() == 1);
    CHECK(times.slow.size() == 4);
    // t = 50 / sqrt(P) in the first packing, 60 / sqrt(P) in the second.
    CHECK_THAT(times.slope.value(), WithinAbs(-0.5, 1e-12));
    CHECK_THAT(times.product, WithinAbs(55, 1e-9));
    CHECK_THAT(times.product_low, WithinAbs(50, 1e-9));
    CHECK_THAT(times.product_high, WithinAbs(60, 1e-9));
    CHECK_THAT(times.longest_run, WithinAbs(10, 1e-12));
}

TEST_CASE("the representative run is the one at capacity, else the one with most cracks") {
    load_run few = run_at(50, "capacity", 1e-9), many = run_at(80, "quiet", 1e-9), unsound = run_at(90, "quiet", 1e-9);
    few.cracks.resize(2);
    many.cracks.resize(5);
    unsound.cracks.resize(9);
    unsound.invalid = "energy";
    packing_result p = packing_of(1, {few, many, unsound});
    CHECK(representative_run(p)->load_MPa == 80);
    p.found.capacity_MPa = 50;
    CHECK(representative_run(p)->load_MPa == 50);
    CHECK(representative_run(packing_of(1, {run_at(5, "quiet")})) == nullptr);
}

TEST_CASE("layers in the order in which they lose half of their bonds") {
    auto const with = [](std::optional<double> a, std::optional<double> b) {
        load_run p = run_at(50, "complete", 1e-9);
        p.layers = {{"surface", 0, 10, 5, a}, {"surface", 1, 10, 5, b}};
        return p;
    };
    std::vector<packing_result> const packings{packing_of(1, {with(2e-9, {}), with(3e-9, 4e-9)}),
                                               packing_of(2, {with(6e-9, 5e-9)}), packing_of(3, {with({}, {})})};
    auto const order = layer_order_of(pointers(packings));
    CHECK(order.packings == 2);
    REQUIRE(order.layers.size() == 2);
    CHECK(order.layers[0].name == "surface 0");
    CHECK(order.layers[0].first == 1);
    CHECK(order.layers[1].first == 1);
    REQUIRE(order.layers[1].times.size() == 2);
    CHECK_THAT(order.layers[0].times[0], WithinAbs(3, 1e-9));
}

TEST_CASE("fronts arrive layer by layer, and the state at the first break is that at its position and time") {
    snapshot s;
    // Stress at 40 µm/ns and -100 MPa, pressure at 20 µm/ns and 2 MPa, in five layers of 20 µm.
    for (int k = 0; k <= 60; ++k) {
        front_profile f;
        f.time = 0.1e-9 * k;
        for (int layer = 0; layer < 5; ++layer) {
            double const depth = 20e-6 * (layer + 0.5);
            f.depth.push_back(depth);
            f.stress.push_back(depth <= 40e3 * f.time + 1e-9 ? -1e8 : -1e6);
            f.pore_pressure.push_back(depth <= 20e3 * f.time + 1e-9 ? 2e6 : 0.0);
        }
        s.fronts.push_back(f);
    }
    auto const fronts = arrivals_of(s);
    REQUIRE(fronts.stress.size() == 5);
    CHECK_THAT(fronts.stress[2][0], WithinAbs(1.3, 1e-6)); // 50 µm after 1.25 ns: in the profile of 1.3 ns
    CHECK_THAT(fronts.pressure[2][0], WithinAbs(2.5, 1e-6));
    CHECK_THAT(fronts.stress_speed.value(), WithinRel(40e3, 0.02));
    CHECK_THAT(fronts.pressure_speed.value(), WithinRel(20e3, 1e-6));

    CHECK_FALSE(first_break_of(s, 100));
    s.run.cracks.push_back({2.02e-9, 0, 65e-6, false, 0}); // 35 µm deep, where the pressure has come at 1.5 ns
    auto const broken = first_break_of(s, 100);
    REQUIRE(broken);
    CHECK_THAT(broken->depth, WithinAbs(35e-6, 1e-12));
    CHECK(broken->pressure == 2e6);
    CHECK(broken->stress == 1e8);
    CHECK(broken->strength == 2e8);
    s.run.cracks.front().y = 25e-6; // 75 µm: not yet
    CHECK(first_break_of(s, 100)->pressure == 0);
    s.zone = lacuna::cartilage_zone::deep;
    CHECK(first_break_of(s, 100)->strength == 1e9);
}
