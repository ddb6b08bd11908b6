// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study_command.hpp"

#include <cstdio>
#include <string>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

#include "cartilage/common/print_paths.hpp"
#include "cartilage/common/unfinished_mark.hpp"
#include "cartilage/common/write_whole.hpp"
#include "cartilage/report/equilibrium_figures.hpp"
#include "cartilage/report/study_report.hpp"
#include "cartilage/study/equilibrium_study.hpp"
#include "cartilage/study/study.hpp"
#include "cartilage/study/study_json.hpp"

namespace cartilage {

namespace {

/// Names of the files that a study writes.
std::vector<std::string> study_results() {
    auto names = report_files();
    names.push_back(study_file);
    return names;
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
            for (auto const& q : p.runs) ++runs, invalid += q.invalid.has_value();
        }
        if (packings == 0) continue;
        std::fprintf(out, "  %-8s %9zu %12s %9s %9s %zu of %zu runs\n", std::string(lacuna::to_string(zone)).c_str(),
                     packings, median_text(study.packings, zone, threshold::first_crack).c_str(),
                     median_text(study.packings, zone, threshold::capacity).c_str(),
                     median_text(study.packings, zone, threshold::complete).c_str(), invalid, runs);
    }
    std::fprintf(out, "  medians, MPa; -: above the highest load, <: below the lowest, ?: undecided\n");
}

/// Writes the results of a study, and the report if it is whole.
void write_study(study_options const& o, lacuna::run_directory& out, study_result const& study, bool whole) {
    unfinished_mark const mark(out, "study");
    mark.begin_results();
    if (!o.quiet) print_study(stdout, study);
    if (whole) write_report(o.out, study);
    // Last, because its presence means that the study is finished.
    write_whole(out.file(study_file), text_of(study));
    mark.end();
    if (o.quiet) return;
    if (whole) print_paths(out, {"report.html"});
    print_paths(out, {study_file});
}

/// Files of a study in equilibrium.
std::vector<std::string> equilibrium_study_results() {
    auto names = equilibrium_report_files();
    names.push_back(equilibrium_study_file);
    return names;
}

int study_in_equilibrium(study_options const& o) {
    lacuna::run_directory out(o.out, "--out", equilibrium_study_results(),
                              o.force ? lacuna::earlier_results::replace : lacuna::earlier_results::refuse);
    auto const beside = study_beside(o);
    std::size_t from_cache = 0;
    out.stay(); // for the cache
    auto const packings = run_equilibrium_study(o, from_cache);
    out.keep();
    study_result const study = as_study(o, packings);
    auto const cells = table3(packings, study.highest_MPa);
    write_whole(out.file("table3.csv"), equilibrium_csv(cells, study, beside ? &*beside : nullptr));
    draw_equilibrium_figures(o.out, study, cells, packings);
    // Last, because its presence means that the study is finished.
    write_whole(out.file(equilibrium_study_file), text_of(study, packings));
    if (o.quiet) return 0;
    std::fputs(equilibrium_table(cells, study, beside ? &*beside : nullptr).c_str(), stdout);
    for (auto const& p : packings)
        if (p.ended != "complete" && p.ended != "limit")
            std::printf("  %s %llu: %s at %.4g MPa\n", std::string(lacuna::to_string(p.zone)).c_str(),
                        static_cast<unsigned long long>(p.seed),
                        p.ended == "mechanism" ? "equilibrium ends" : "no convergence", p.load_MPa);
    print_paths(out, {"table3.csv", equilibrium_study_file});
    std::printf("%zu packings; from the cache: %zu\n", packings.size(), from_cache);
    return 0;
}

int merge(study_options const& o) {
    study_result const whole = merge_studies(o.merge);
    lacuna::run_directory out(o.out, "--out", study_results(), lacuna::earlier_results::replace);
    if (!o.force) refuse_other_study(o.out, whole);
    write_study(o, out, whole, true);
    return 0;
}

} // namespace

int study(study_options const& o) {
    if (!o.merge.empty()) return merge(o);
    if (o.equilibrium) return study_in_equilibrium(o);
    // Results of the same study stay until the new ones are ready.
    lacuna::run_directory out(o.out, "--out", study_results(), lacuna::earlier_results::replace);
    if (!o.force) refuse_other_study(o.out, study_frame(o));
    unfinished_mark const mark(out, "study");
    pool_report report;
    study_result const result = mark.stoppable([&] { return run_study(o, report); });
    write_study(o, out, result, o.shards == 1);
    if (!o.quiet)
        std::printf("%zu runs; from the cache: %zu packings, %zu runs\n", report.runs, report.packings_from_cache,
                    report.runs_from_cache);
    return 0;
}

} // namespace cartilage
