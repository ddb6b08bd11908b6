// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "cartilage/calibrate/calibration.hpp"
#include "cartilage/calibrate/comparison.hpp"
#include "cartilage/common/presets.hpp"

using namespace cartilage;

TEST_CASE("choices read back what they write") {
    choices c;
    CHECK(text_of(c).empty());
    // Every choice at another value than its default.
    for (choice_field const& f : choice_fields()) {
        CAPTURE(f.name);
        double const other = f.type == choice_field::kind::word ? f.most - f.get(c)
                             : f.type == choice_field::kind::count ? 7
                                                                   : 0.5 * (f.fit[0] + f.fit[1]) + 0.01 * f.fit[1];
        f.set(c, other);
        CHECK(f.get(c) == other);
        CHECK(f.get(c) != f.get(choices{}));
        CHECK_FALSE(f.reason.empty());
        CHECK_FALSE(f.rule.empty());
    }
    c.deep_fraction = 0.4;
    c.surface_fraction = 0.2;
    c.minimum_pressure = -std::numeric_limits<double>::infinity();
    choices read;
    set_choices(read, text_of(c), "text");
    CHECK(read == c);
    read = preset_choices("lattice");
    set_choices(read, text_of(c, true), "text");
    CHECK(read == c);
    CHECK(text_of(read) == text_of(c));

    read = {};
    set_choices(read, "\n  fill=0.8 # dense\r\n# load = platen\nload =  platen\n", "text");
    CHECK(text_of(read) == "fill = 0.8\nload = platen\n");
    CHECK(text_of(preset_choices("literal")).empty());
    CHECK(text_of(preset_choices("lattice")) == "packing = lattice\n");

    // The file written by the calibration, without its first line, the misfit.
    std::ifstream file(std::string(CARTILAGE_FOLDER) + "/data/calibrated/best.choices");
    std::string const best{std::istreambuf_iterator<char>(file), {}};
    REQUIRE(best.find('\n') != std::string::npos);
    CHECK(text_of(preset_choices("calibrated")) == best.substr(best.find('\n') + 1));
}

TEST_CASE("bad choices are refused by name, value and rule") {
    choices c;
    auto const refused = [&](char const* text, char const* words) {
        CAPTURE(text);
        CHECK_THROWS_AS(set_choices(c, text, "here"), std::invalid_argument);
        CHECK_THROWS_WITH(set_choices(c, text, "here"), contains_text(words));
        CHECK(c == choices{});
    };
    refused("fill = 2", "here:1: fill = 2: must be a number from 0.6 to 1");
    refused("\nfill = nan", "here:2: fill = nan: must be");
    refused("fill = 0.8x", "fill = 0.8x");
    refused("fill =", "fill = '': must be");
    refused("filling = 1", "name of a choice = filling: must be one of packing, radii");
    refused("load = plate", "load = plate: must be free or platen");
    refused("fibre_layers = 1e300", "fibre_layers = 1e+300");
    refused("fibre_layers = 1.5", "fibre_layers = 1.5: must be a whole number");
    refused("load", "choice = load: must be of the form name=value");
    refused("duration = -1", "duration = -1");
    refused("fill = 0.8\ndeep_fraction = 0.8", "deep_fraction + surface_fraction = 1.13333");
    refused("minimum_pressure = 0\nbond_moment = 1", "minimum_pressure = 0: must be -inf with a bond_moment");
    CHECK_THROWS_WITH(preset_choices("odd"), "preset = odd: must be one of literal, lattice, calibrated");
    // Values that mean "none" are allowed outside the range.
    set_choices(c, "duration = 0\nmerge_conductance = inf\nminimum_pressure = -inf", "here");
    CHECK(c == choices{});
}

TEST_CASE("the search of a calibration finds a known optimum", "[calibration]") {
    if (!can_calibrate()) return;
    // A valley about thickness 4 um (of 0.5 to 20, logarithmic), duration 10 ns and with a platen.
    auto const misfit = [](choices const& c) {
        double const a = std::log(c.thickness / 4), b = std::log((c.duration > 0 ? c.duration : 40) / 10);
        return 0.1 + a * a + 0.5 * b * b + 0.4 * a * b + (c.load == load_rule::platen ? 0 : 0.3);
    };
    calibration_request request;
    request.free = {&find_choice("thickness"), &find_choice("load"), &find_choice("duration")};
    request.start.duration = 2;
    request.evaluations = 60;
    auto const tried = calibrate(request, misfit);
    CHECK(tried.size() <= 60);
    CHECK(tried.front().choices == request.start);
    auto const& best = tried[best_of(tried)];
    CHECK(best.misfit < 0.11);
    CHECK(best.choices.load == load_rule::platen);
    CHECK(std::fabs(std::log(best.choices.thickness / 4)) < 0.12);
    CHECK(std::fabs(std::log(best.choices.duration / 10)) < 0.15);
    for (std::size_t k = 0; k < tried.size(); ++k) {
        choices rest = tried[k].choices;
        rest.thickness = request.start.thickness;
        rest.duration = request.start.duration;
        rest.load = request.start.load;
        CHECK(rest == request.start); // nothing else has changed
        for (std::size_t j = 0; j < k; ++j) CHECK_FALSE(tried[k].choices == tried[j].choices);
    }
    // A second search tries the same sets: nothing in it is random.
    auto const again = calibrate(request, misfit);
    REQUIRE(again.size() == tried.size());
    for (std::size_t k = 0; k < tried.size(); ++k) CHECK(again[k].choices == tried[k].choices);

    // Impossible sets are skipped, and the search may end early.
    request.misfit_enough = 0.15;
    auto const picky = calibrate(request, [&](choices const& c) {
        return c.thickness > 6 ? std::numeric_limits<double>::quiet_NaN() : misfit(c);
    });
    CHECK(picky.size() < tried.size());
    CHECK(picky.back().misfit <= 0.15);

    // With words alone all combinations are tried.
    request = {};
    request.free = {&find_choice("drainage"), &find_choice("load")};
    request.evaluations = 100;
    CHECK(calibrate(request, [](choices const& c) { return c.drainage == drainage_rule::sealed ? 1.0 : 2.0; }).size() ==
          6);

    struct stop {};
    CHECK_THROWS_AS(calibrate(request, [](choices const&) -> double { throw stop(); }), stop);
    request.free = {&find_choice("thickness")};
    int calls = 0;
    CHECK_THROWS_AS(calibrate(request, [&](choices const&) { return ++calls > 3 ? throw stop() : 1.0; }), stop);
    request.free = {&find_choice("friction")};
    CHECK_THROWS_WITH(calibrate(request, misfit), "free choice = friction: must be one that the paper leaves open");
    request.free = {&find_choice("fill"), &find_choice("fill")};
    CHECK_THROWS_WITH(calibrate(request, misfit), "free choice = fill: must be given once");
}

namespace {

packing_result packing(std::uint64_t seed, double first, double capacity, double complete) {
    packing_result r;
    r.seed = seed;
    if (first > 0) r.found.first_crack_MPa = first;
    if (capacity > 0) r.found.capacity_MPa = capacity;
    if (complete > 0) r.found.complete_MPa = complete;
    r.found.no_capacity = capacity > 0 ? "" : "above 300 MPa";
    r.found.no_complete = complete > 0 ? "" : "runs from 50 MPa to 80 MPa do not count";
    return r;
}

} // namespace

TEST_CASE("packings are compared in pairs") {
    std::vector<packing_result> const before{packing(1, 40, 80, 100), packing(2, 20, 0, 100), packing(3, 10, 50, 0)};
    std::vector<packing_result> const after{packing(3, 20, 100, 30), packing(1, 60, 160, 50), packing(2, 10, 90, 200)};
    auto const changes = compare(before, after);
    REQUIRE(changes.size() == 3);
    // First crack: factors 1.5, 0.5 and 2, median 1.5.
    CHECK(changes[0].pairs == 3);
    CHECK_THAT(changes[0].change, WithinRel(50.0, 1e-12));
    CHECK_THAT(changes[0].before, WithinRel(20.0, 1e-12));
    CHECK_THAT(changes[0].after, WithinRel(20.0, 1e-12));
    CHECK_THAT(changes[0].of_change.low, WithinRel(-50.0, 1e-12));
    CHECK_THAT(changes[0].of_change.high, WithinRel(100.0, 1e-12));
    // Capacity: doubled twice; the third came into the range from above.
    CHECK(changes[1].pairs == 3);
    CHECK_THAT(changes[1].change, WithinRel(100.0, 1e-12));
    CHECK(changes[1].of_change.low == -100);
    // Complete: halved and doubled; the third is undecided before.
    CHECK(changes[2].pairs == 2);
    CHECK_THAT(changes[2].change, WithinAbs(0, 1e-9));
    // Above the range both times: the change is unknown.
    std::vector<packing_result> const high{packing(2, 20, 0, 100)};
    CHECK(compare(high, high).size() == 2);
}

TEST_CASE("the misfit of a set is its distance from the paper's loads") {
    std::vector<packing_result> all{packing(1, 45, 48, 53), packing(2, 45, 96, 53), packing(3, 45, 0, 53)};
    auto const targets = targets_of(all);
    REQUIRE(targets.size() == 3); // the surface zone alone
    CHECK(targets[0].misfit() == 0);
    CHECK_THAT(targets[1].misfit(), WithinRel(std::log(2.0), 1e-12)); // 48, 96, above
    CHECK(targets[2].misfit() == 0);
    CHECK_THAT(misfit_of(targets), WithinRel(std::log(2.0) / std::sqrt(3.0), 1e-12));
    all.pop_back();
    all.push_back(packing(4, 45, 0, 53));
    all.push_back(packing(5, 45, 0, 53));
    CHECK_THAT(targets_of(all)[1].misfit(), WithinRel(std::log(8.0), 1e-12)); // the median is above the range
    packing_result whole = packing(1, 46, 49, 400);
    whole.zone = lacuna::cartilage_zone::whole;
    REQUIRE(targets_of({whole}).size() == 2); // no complete damage in the paper
    CHECK(misfit_of(targets_of({whole})) == 0);
}

TEST_CASE("packings in which the first layer fails first are counted") {
    auto const run = [](double load, std::optional<double> first, std::optional<double> second) {
        load_run p;
        p.load_MPa = load;
        p.ended = "capacity";
        p.capacity_time = first;
        p.layers = {{"surface", 0, 10, 5, first}, {"surface", 1, 10, 5, second}};
        return p;
    };
    std::vector<packing_result> all{packing(1, 40, 60, 70), packing(2, 40, 60, 70), packing(3, 40, 60, 70),
                                    packing(4, 40, 0, 70)};
    all[0].runs = {run(60, 2e-9, 3e-9), run(70, 2e-9, 1e-9)}; // at its capacity load the first layer is first
    all[1].runs = {run(60, 2e-9, 1e-9)};
    all[2].runs = {run(60, 2e-9, std::nullopt)};
    auto const counts = first_layers_of(all);
    REQUIRE(counts.size() == 1);
    CHECK(counts[0].first == 2);
    CHECK(counts[0].packings == 3);
}

TEST_CASE("domain and duration follow the choices") {
    options o;
    choices wide;
    wide.domain = domain_rule::wide;
    wide.duration = 5;
    CHECK(with_choices(o, wide).length_um == 300);
    CHECK(with_choices(o, wide).height_um == 120);
    CHECK(with_choices(o, wide).duration_ns == 5);
    CHECK_FALSE(with_choices(with_choices(o, wide), choices{}).duration_ns);
    CHECK(with_choices(with_choices(o, wide), choices{}).length_um == 120);
    o.length_um = 84; // as if requested
    CHECK(with_choices(o, wide).length_um == 84);
}
