// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study_command.hpp"

#include <cstdio>
#include <string>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

#include "cartilage/common/print_paths.hpp"
#include "cartilage/common/unfinished_mark.hpp"
#include "cartilage/common/write_whole.hpp"
#include "cartilage/report/study_report.hpp"
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
