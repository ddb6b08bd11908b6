// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/study.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <lacuna/core/text.hpp>

#include "cartilage/study/cache.hpp"
#include "cartilage/study/snapshots.hpp"
#include "cartilage/study/study_json.hpp"

namespace cartilage {

namespace {

/// Reads the study in a directory. \param what the option, for messages \throws usage_error
study_result read_study(std::string const& directory, char const* what) {
    std::string const path = directory + "/" + study_file;
    std::string text;
    try {
        text = lacuna::read_file(path, what);
    } catch (std::invalid_argument const&) {
        throw usage_error(std::string(what) + directory + ": has no " + study_file + " that can be read");
    }
    try {
        return study_from(text);
    } catch (std::runtime_error const& bad) {
        throw usage_error(path + ": is not a study: " + bad.what());
    }
}

/// The setting in which two studies differ, so that they are not parts of one study; none: they agree.
std::optional<std::string> difference(study_result const& a, study_result const& b) {
    if (a.choices != b.choices) return "choices";
    if (a.lowest_MPa != b.lowest_MPa || a.highest_MPa != b.highest_MPa) return "range of loads";
    if (a.resolution != b.resolution) return "resolution";
    if (a.step_share != b.step_share) return "time step";
    if (a.dry != b.dry) return "fluid";
    if (a.length_um != b.length_um || a.height_um != b.height_um) return "size of the specimens";
    return std::nullopt;
}

/// Guesses near the loads of most packings of the preset `literal`, MPa.
std::array<double, 3> first_guess(lacuna::cartilage_zone zone) {
    switch (zone) {
    case lacuna::cartilage_zone::surface: return {25, 110, 200};
    case lacuna::cartilage_zone::middle: return {170, 600, 1000};
    case lacuna::cartilage_zone::deep: return {170, 1500, 500};
    default: return {30, 110, 1000};
    }
}

/// Whether a packing or picture belongs to the requested shard.
bool is_own(study_options const& o, std::size_t piece) { return int(piece % std::size_t(o.shards)) == o.shard - 1; }

std::vector<paper_picture> pictures_of(study_options const& o) {
    std::vector<paper_picture> own;
    if (!o.pictures) return own;
    std::size_t piece = o.zones.size() * std::size_t(o.seeds);
    for (paper_picture const& p : paper_pictures())
        if (std::count(o.zones.begin(), o.zones.end(), p.zone) != 0 && is_own(o, piece++)) own.push_back(p);
    return own;
}

/// Takes a snapshot from the cache, or runs it. \return whether it was in the cache
bool find_snapshot(study_options const& o, result_cache const& cache, paper_picture const& picture, snapshot& shot) {
    options model = o.model;
    model.zone = picture.zone;
    model.seed = 1;
    std::string const name = "figure-" + picture.figure;
    std::string const key = key_of(model) + "picture " + lacuna::to_text(picture.load_MPa);
    try {
        if (auto const stored = cache.find(name, key)) {
            shot = snapshot_from(*stored);
            return true;
        }
    } catch (std::exception const&) {
        // A damaged entry counts as missing.
    }
    shot = take_snapshot(picture, model);
    cache.store(name, key, json_of(shot));
    return false;
}

} // namespace

study_result study_frame(study_options const& o) {
    study_result s;
    s.lowest_MPa = o.loads.lowest_MPa;
    s.highest_MPa = o.loads.highest_MPa;
    s.resolution = o.loads.resolution;
    s.choices = text_of(o.model.choices, true);
    s.code = code_version();
    s.step_share = o.model.step_share;
    s.dry = o.model.dry;
    s.length_um = o.model.length_um;
    s.height_um = o.model.height_um;
    return s;
}

void refuse_other_study(std::string const& directory, study_result const& wanted) {
    std::ifstream in(directory + "/" + study_file);
    if (!in) return;
    auto const other = difference(read_study(directory, "--out "), wanted);
    if (other) throw usage_error("--out " + directory + ": holds another study (its " + *other +
                                 (other->back() == 's' ? " differ" : " differs") + "); --force replaces it");
}

std::optional<study_result> study_beside(study_options const& o) {
    bool const asked = !o.beside.empty();
    std::string const directory = asked ? o.beside : "cartilage-study";
    if (!asked && !std::ifstream(directory + "/" + study_file)) return std::nullopt;
    study_result found = read_study(directory, "--beside ");
    study_result wanted = study_frame(o);
    wanted.lowest_MPa = found.lowest_MPa;
    wanted.highest_MPa = found.highest_MPa;
    wanted.resolution = found.resolution;
    if (auto const other = difference(found, wanted)) {
        if (!asked) return std::nullopt;
        throw usage_error("--beside " + directory + ": must be a study of the same model: its " + *other +
                          (other->back() == 's' ? " differ" : " differs"));
    }
    return found;
}

std::vector<packing_request> requests_of(study_options const& o) {
    std::vector<packing_request> requests;
    std::size_t piece = 0;
    for (auto zone : o.zones)
        for (std::uint64_t seed = 1; seed <= o.seeds; ++seed)
            if (is_own(o, piece++)) {
                packing_request r{o.model, o.loads};
                r.model.zone = zone;
                r.model.seed = seed;
                r.loads.first_guess = first_guess(zone);
                requests.push_back(std::move(r));
            }
    return requests;
}

study_result run_study(study_options const& o, pool_report& report) {
    study_result result = study_frame(o);
    pool_options how(o);
    how.report = &report;
    auto const pictures = pictures_of(o);
    result_cache const cache(o.cache);
    result.snapshots.resize(pictures.size());
    std::atomic<std::size_t> from_cache{0};
    for (std::size_t k = 0; k < pictures.size(); ++k)
        how.other_tasks.emplace_back(
            [&, k] { from_cache += find_snapshot(o, cache, pictures[k], result.snapshots[k]); });
    result.packings = run_packings(requests_of(o), how);
    report.runs += pictures.size() - from_cache;
    report.runs_from_cache += from_cache;
    return result;
}

study_result merge_studies(std::vector<std::string> const& directories) {
    std::vector<study_result> parts;
    for (std::string const& directory : directories) parts.push_back(read_study(directory, "merge "));
    study_result whole = parts.front();
    for (std::size_t p = 1; p < parts.size(); ++p) {
        auto other = difference(whole, parts[p]);
        if (!other && whole.code != parts[p].code) other = "code";
        if (other)
            throw usage_error("merge " + directories[p] + ": is no part of the study in " + directories[0] + ": its " +
                              *other + (other->back() == 's' ? " differ" : " differs"));
        for (auto& r : parts[p].packings) whole.packings.push_back(std::move(r));
        for (auto& s : parts[p].snapshots) whole.snapshots.push_back(std::move(s));
    }
    auto const order_of = [](packing_result const& r) { return std::pair(r.zone, r.seed); };
    std::stable_sort(whole.packings.begin(), whole.packings.end(),
                     [&](auto const& a, auto const& b) { return order_of(a) < order_of(b); });
    for (std::size_t k = 1; k < whole.packings.size(); ++k)
        if (order_of(whole.packings[k]) == order_of(whole.packings[k - 1]))
            throw usage_error("merge: zone " + std::string(lacuna::to_string(whole.packings[k].zone)) + ", seed " +
                              std::to_string(whole.packings[k].seed) + " is in two of the parts");
    std::stable_sort(whole.snapshots.begin(), whole.snapshots.end(),
                     [](auto const& a, auto const& b) { return a.figure < b.figure; });
    return whole;
}

} // namespace cartilage
