// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "cartilage/study/study_fronts.hpp"
#include "cartilage/study/study_json.hpp"
#include "cartilage/study/study_table.hpp"
#include "synthetic_study.hpp"

using namespace cartilage;

namespace {

/// A study of one packing and one snapshot, with short lists and every kind of value in study.json.
json small_study() {
    study_result study = synthetic_study(1);
    study.packings.resize(1);
    study.packings[0].runs.resize(4);
    study.snapshots.resize(1);
    auto& shot = study.snapshots[0];
    shot.fronts.resize(3);
    shot.damage.particles.resize(3);
    shot.damage.pores.resize(2);
    shot.damage.cracks.resize(2);
    return json::parse(text_of(study));
}

/// The reader's error; empty if it accepts the study, which is then used as in the report.
std::string error_of(json const& j) {
    try {
        study_result const study = study_from(j.dump());
        for (snapshot const& s : study.snapshots) arrivals_of(s);
        table3_csv(table3(study), study);
        return "";
    } catch (std::runtime_error const& bad) {
        return bad.what();
    }
}

std::string error_with(std::string const& path, json const& value) {
    json j = small_study();
    j.at(json::json_pointer(path)) = value;
    return error_of(j);
}

void pointers_of(json const& j, std::string const& path, std::vector<std::string>& out) {
    out.push_back(path);
    if (j.is_object())
        for (auto const& [key, part] : j.items()) pointers_of(part, path + "/" + key, out);
    if (j.is_array())
        for (std::size_t k = 0; k < j.size() && k < 6; ++k) pointers_of(j[k], path + "/" + std::to_string(k), out);
}

} // namespace

TEST_CASE("a stored study is read back to the same text") {
    json const j = small_study();
    CHECK(error_of(j).empty());
    CHECK(json::parse(text_of(study_from(j.dump()))) == j);
}

TEST_CASE("a stored study with inconsistent lists, numbers out of range or unknown words is refused by path") {
    struct {
        char const* path;
        json value;
        char const* error;
    } const cases[] = {
        {"/snapshots/0/fronts/1/depth", json::array(),
         "snapshots[0].fronts[1].depth = (a list or an object): must be a list of 15 numbers, not 0"},
        {"/snapshots/0/fronts/2/stress",
         {1.0, 2.0},
         "snapshots[0].fronts[2].stress = (a list or an object): must be a list of 15 numbers, not 2"},
        {"/snapshots/0/fronts/0/pore_pressure", json::array(),
         "snapshots[0].fronts[1].pore_pressure = (a list or an object): must be empty"},
        {"/snapshots/0/fronts/1/time", 0.0, "snapshots[0].fronts[1].time = 0.0: must be not before"},
        {"/snapshots/0/fronts/1/broken", -1, "snapshots[0].fronts[1].broken = -1: must be a whole number from 0"},
        {"/snapshots/0/damage/particles/3", 3,
         "snapshots[0].damage.particles[3] = 3: must be a whole number from 0 to 1"},
        {"/snapshots/0/damage/cracks/9", -1, "snapshots[0].damage.cracks[9] = -1: must be a whole number from 0 to 1"},
        {"/snapshots/0/damage/frame", {0, 0, 0, 0}, "snapshots[0].damage.frame"},
        {"/packings/0/probes/3/cracks/0/4", 1e300,
         "packings[0].probes[3].cracks[0][4] = 1e+300: must be a whole number"},
        {"/packings/0/probes/3/cracks/0/3", 1, "packings[0].probes[3].cracks[0][3] = 1: must be true or false"},
        {"/packings/0/probes/3/layers/0/broken", 61,
         "packings[0].probes[3].layers[0].broken = 61: must be a whole number from 0 to 60"},
        {"/packings/0/probes/3/layers/0/bonds", 4294967297,
         "packings[0].probes[3].layers[0].bonds = 4294967297: must be a whole number"},
        {"/packings/0/probes/0/ended", "soon", "packings[0].probes[0].ended = \"soon\": must be one of duration"},
        {"/packings/0/probes/1/load_MPa", 1.0, "packings[0].probes[1].load_MPa = 1.0: must be not below"},
        {"/packings/0/zone", "knee", "packings[0].zone = \"knee\": must be one of surface"},
        {"/packings/0/seed", -1, "packings[0].seed = -1: must be a whole number"},
        {"/packings", 5, "packings = 5: must be a list"},
        {"/packings/0/first_crack_MPa", 3.0,
         "packings[0].first_crack_MPa = 3.0: must be within the range of loads, 5 to 1000"},
        {"/resolution", nullptr, "resolution = null: must be a number"},
        {"/highest_MPa", 1.0, "highest_MPa = 1.0: must be above lowest_MPa"},
    };
    for (auto const& c : cases) {
        INFO(c.path);
        CHECK_THAT(error_with(c.path, c.value), contains_text(c.error));
    }
    json without = small_study();
    without["packings"][0].erase("seed");
    CHECK_THAT(error_of(without), contains_text("packings[0].seed = (missing): must be given"));
    CHECK_THAT(error_of(json::array()), contains_text("the file = (a list or an object): must be an object"));
}

TEST_CASE("any value of a stored study may be replaced: the study is refused or can be reported") {
    json const whole = small_study();
    std::vector<std::string> paths;
    pointers_of(whole, "", paths);
    json const others[] = {nullptr, -1,   3,  1e300, -1e300,        18446744073709551615u,
                           0.5,     true, "", "x",   json::array(), json::object(),
                           {1, 2}};
    int refused = 0;
    for (std::string const& path : paths)
        for (json const& other : others) {
            json j = whole;
            j.at(json::json_pointer(path)) = other;
            std::string const error = error_of(j);
            refused += !error.empty();
            if (!error.empty()) REQUIRE_THAT(error, contains_text(": must be "));
        }
    // Most values are wrong at another position; texts may be any text.
    CHECK(refused > int(7 * paths.size()));
}
