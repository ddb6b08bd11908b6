// SPDX-License-Identifier: BSD-3-Clause
#include "study.hpp"

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
#include <lacuna/core/whole_file.hpp>
#include <lacuna/observe/progress.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "cache.hpp"
#include "output.hpp"
#include "pool.hpp"
#include "simulate.hpp"
#include "snapshots.hpp"
#include "study_json.hpp"
#include "study_report.hpp"

namespace cartilage {

namespace {

constexpr char const* result_name = "study.json";

/// \throws usage_error
study_result read_study(std::string const& directory, char const* what) {
    std::string const path = directory + "/" + result_name;
    std::string text;
    try {
        text = lacuna::read_file(path, what);
    } catch (std::invalid_argument const&) {
        throw usage_error(std::string(what) + directory + ": has no " + result_name + " that can be read");
    }
    try {
        return study_from(text);
    } catch (std::runtime_error const& bad) {
        throw usage_error(path + ": is not a study: " + bad.what());
    }
}

/// What two studies have to have in common to be parts of one; none: they have.
std::optional<std::string> difference(study_result const& a, study_result const& b) {
    if (a.choices != b.choices) return "choices";
    if (a.lowest_MPa != b.lowest_MPa || a.highest_MPa != b.highest_MPa) return "range of loads";
    if (a.resolution != b.resolution) return "resolution";
    if (a.step_share != b.step_share) return "time step";
    if (a.dry != b.dry) return "fluid";
    if (a.length_um != b.length_um || a.height_um != b.height_um) return "size of the specimens";
    return std::nullopt;
}

/// Results of another study are not replaced by accident; of the same one they come out the same anyway.
/// \throws usage_error
void refuse_other_study(std::string const& directory, study_result const& wanted) {
    std::ifstream in(directory + "/" + result_name);
    if (!in) return;
    auto const other = difference(read_study(directory, "--out "), wanted);
    if (other) throw usage_error("--out " + directory + ": holds another study (its " + *other +
                                 (other->back() == 's' ? " differ" : " differs") + "); --force replaces it");
}

study_result frame_of(study_options const& o) {
    study_result s;
    s.lowest_MPa = o.loads.lowest_MPa;
    s.highest_MPa = o.loads.highest_MPa;
    s.resolution = o.loads.resolution;
    s.choices = text_of(o.model.open, true);
    s.code = code_version();
    s.step_share = o.model.step_share;
    s.dry = o.model.dry;
    s.length_um = o.model.length_um;
    s.height_um = o.model.height_um;
    return s;
}

/// Near the loads of most packings of the preset `literal`, MPa.
std::array<double, 3> first_guess(lacuna::cartilage_zone zone) {
    switch (zone) {
    case lacuna::cartilage_zone::surface: return {25, 110, 200};
    case lacuna::cartilage_zone::middle: return {170, 600, 1000};
    case lacuna::cartilage_zone::deep: return {170, 1500, 500};
    default: return {30, 110, 1000};
    }
}

/// Whether an independent piece of work belongs to the part of the study that is asked for.
bool is_own(study_options const& o, std::size_t piece) { return int(piece % std::size_t(o.shards)) == o.shard - 1; }

std::vector<paper_picture> pictures_of(study_options const& o) {
    std::vector<paper_picture> own;
    if (!o.pictures) return own;
    std::size_t piece = o.zones.size() * std::size_t(o.seeds);
    for (paper_picture const& p : paper_pictures())
        if (std::count(o.zones.begin(), o.zones.end(), p.zone) != 0 && is_own(o, piece++)) own.push_back(p);
    return own;
}

/// \return whether it was kept from before
bool find_snapshot(study_options const& o, result_cache const& cache, paper_picture const& picture, snapshot& shot) {
    options model = o.model;
    model.zone = picture.zone;
    model.seed = 1;
    std::string const name = "figure-" + picture.figure;
    std::string const key = key_of(model) + "picture " + lacuna::to_text(picture.load_MPa);
    try {
        if (auto const kept = cache.find(name, key)) {
            shot = snapshot_from(*kept);
            return true;
        }
    } catch (std::exception const&) {
        // Damaged: as if it were not there.
    }
    shot = take_snapshot(picture, model);
    cache.keep(name, key, json_of(shot));
    return false;
}

void print_study(std::FILE* out, study_result const& study) {
    std::fprintf(out, "  %-8s %9s %12s %9s %9s %8s\n", "zone", "packings", "first crack", "capacity", "complete",
                 "invalid");
    using lacuna::cartilage_zone;
    for (auto zone : {cartilage_zone::surface, cartilage_zone::middle, cartilage_zone::deep, cartilage_zone::whole}) {
        std::size_t packings = 0, runs = 0, invalid = 0;
        for (auto const& p : study.packings) {
            if (p.zone != zone) continue;
            ++packings;
            for (auto const& q : p.probes) ++runs, invalid += q.invalid.has_value();
        }
        if (packings == 0) continue;
        std::fprintf(out, "  %-8s %9zu %12s %9s %9s %zu of %zu runs\n", std::string(lacuna::to_string(zone)).c_str(),
                     packings, median_text(study.packings, zone, threshold::first_crack).c_str(),
                     median_text(study.packings, zone, threshold::capacity).c_str(),
                     median_text(study.packings, zone, threshold::complete).c_str(), invalid, runs);
    }
    std::fprintf(out, "  medians, MPa; -: above the highest load, <: below the lowest, ?: not to be had\n");
}

/// Writes the results of a study; the report only of a whole one.
void write_study(study_options const& o, lacuna::run_directory& out, study_result const& study, bool whole) {
    unfinished_mark const mark(out, "study");
    mark.begin_results();
    if (!o.quiet) print_study(stdout, study);
    if (whole) write_report(o.out, study);
    // Last, because its presence says that the study is finished.
    lacuna::whole_file file(out.file(result_name));
    file.write(text_of(study));
    file.commit();
    mark.end();
    if (o.quiet) return;
    if (whole) std::printf("%s\n", out.file("report.html").c_str());
    std::printf("%s\n", out.file(result_name).c_str());
}

int merge(study_options const& o) {
    std::vector<study_result> parts;
    for (std::string const& directory : o.merge) parts.push_back(read_study(directory, "merge "));
    study_result whole = parts.front();
    for (std::size_t p = 1; p < parts.size(); ++p) {
        auto other = difference(whole, parts[p]);
        if (!other && whole.code != parts[p].code) other = "code";
        if (other)
            throw usage_error("merge " + o.merge[p] + ": is no part of the study in " + o.merge[0] + ": its " + *other +
                              (other->back() == 's' ? " differ" : " differs"));
        for (auto& r : parts[p].packings) whole.packings.push_back(std::move(r));
        for (auto& s : parts[p].snapshots) whole.snapshots.push_back(std::move(s));
    }
    auto const place = [](packing_result const& r) { return std::pair(r.zone, r.seed); };
    std::stable_sort(whole.packings.begin(), whole.packings.end(),
                     [&](auto const& a, auto const& b) { return place(a) < place(b); });
    for (std::size_t k = 1; k < whole.packings.size(); ++k)
        if (place(whole.packings[k]) == place(whole.packings[k - 1]))
            throw usage_error("merge: zone " + std::string(lacuna::to_string(whole.packings[k].zone)) + ", seed " +
                              std::to_string(whole.packings[k].seed) + " is in two of the parts");
    std::stable_sort(whole.snapshots.begin(), whole.snapshots.end(),
                     [](auto const& a, auto const& b) { return a.figure < b.figure; });
    lacuna::run_directory out(o.out, "--out", study_results(), lacuna::earlier_results::replace);
    if (!o.force) refuse_other_study(o.out, whole);
    write_study(o, out, whole, true);
    return 0;
}

} // namespace

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

int study(study_options const& o) {
    if (!o.merge.empty()) return merge(o);
    study_result result = frame_of(o);
    // Results of the same study give way to the new ones once these are there.
    lacuna::run_directory out(o.out, "--out", study_results(), lacuna::earlier_results::replace);
    if (!o.force) refuse_other_study(o.out, result);
    unfinished_mark const mark(out, "study");
    pool_report report;
    pool_options how;
    how.jobs = o.jobs;
    how.cache = o.cache;
    how.progress = o.quiet ? nullptr : stderr;
    how.report = &report;
    auto const pictures = pictures_of(o);
    result_cache const cache(o.cache);
    result.snapshots.resize(pictures.size());
    std::atomic<std::size_t> kept{0};
    for (std::size_t k = 0; k < pictures.size(); ++k)
        how.further.emplace_back([&, k] { kept += find_snapshot(o, cache, pictures[k], result.snapshots[k]); });
    try {
        result.packings = run_packings(requests_of(o), how);
    } catch (interruption const&) {
        mark.stopped_by(lacuna::stop_signal());
        throw;
    }
    report.runs += pictures.size() - kept;
    report.probes_kept += kept;
    write_study(o, out, result, o.shards == 1);
    if (!o.quiet)
        std::printf("%zu runs; kept from before: %zu packings, %zu runs\n", report.runs, report.packings_kept,
                    report.probes_kept);
    return 0;
}

} // namespace cartilage
