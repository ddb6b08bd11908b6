// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <lacuna/core/error.hpp>

#include "cartilage/calibrate/calibrate_report.hpp"
#include "cartilage/common/print_paths.hpp"
#include "cartilage/common/unfinished_mark.hpp"
#include "cartilage/study/study.hpp"

namespace cartilage {

namespace {

/// These scale all strengths, set the duration, hold the free particles (two choices) and spread the load.
constexpr char const* free_by_default = "thickness,duration,matrix_links,wall_distance,load";

/// Names of the files that a calibration writes.
std::vector<std::string> calibration_results() {
    return {"calibration.html", "calibration.csv", "calibration.json", "best.choices"};
}

} // namespace

std::optional<calibrate_options> parse_calibrate_command_line(int argc, char const* const* argv) {
    calibrate_options o;
    o.study.out = "cartilage-calibration";
    model_arguments model;
    pool_arguments pool;
    std::string names = free_by_default, evaluations = "40", resolution, highest;
    CLI::App app("Searches for one set of open choices, for all zones, whose loads are nearest to the paper's eleven: "
                 "medians over the same packings for every set.\nResults go into a directory: calibration.html, "
                 "calibration.csv, calibration.json, best.choices. The same command continues where it was stopped.",
                 "cartilage calibrate");
    app.add_option("--free", names, std::string("choices to fit (") + free_by_default + ")")->type_name("LIST");
    app.add_option("--evaluations", evaluations, "largest number of sets to try (40)")->type_name("N");
    add_pool_options(app, pool);
    app.add_option("--resolution", resolution, "largest step between loads, relative (0.05)")->type_name("SHARE");
    app.add_option("--highest", highest, "highest load, MPa (300)")->type_name("MPA");
    add_model_options(app, model);
    add_run_options(app, model);
    add_output_options(app, o.study);
    if (!parse_arguments(app, argc, argv)) return std::nullopt;
    if (!can_calibrate()) throw usage_error("calibrate: needs NLopt, but the program was built without NLopt");
    read_arguments(model, pool, o.study, 6);
    if (!pool.quick) o.study.loads.resolution = 0.05;
    char const* const rule = "a number from 0.002 to 1";
    if (!resolution.empty()) o.study.loads.resolution = positive_number("--resolution", resolution, rule);
    if (!(o.study.loads.resolution >= 0.002 && o.study.loads.resolution <= 1)) refuse("--resolution", resolution, rule);
    o.study.loads.highest_MPa = 300;
    if (!highest.empty()) o.study.loads.highest_MPa = positive_number("--highest", highest, "a number of MPa");
    if (!(o.study.loads.highest_MPa >= 100 && o.study.loads.highest_MPa <= 1e4))
        refuse("--highest", highest, "a number of MPa from 100 to 10000");
    o.evaluations =
        whole_number<std::size_t>("--evaluations", evaluations, 1, 100000, "a whole number from 1 to 100000");
    for (std::string const& name : parts_of(names, ',')) {
        try {
            choice_field const& f = find_choice(name);
            if (f.stated) lacuna::refuse("choice", name, "one that the paper leaves open");
            if (std::count(o.free.begin(), o.free.end(), &f) != 0) lacuna::refuse("choice", name, "given once");
            if (o.study.model.dry && f.fluid) lacuna::refuse("choice", name, "one with an effect in a dry run");
            o.free.push_back(&f);
        } catch (std::invalid_argument const& bad) {
            throw usage_error(std::string("--free: ") + bad.what());
        }
    }
    validate_specimens(o.study);
    return o;
}

int calibrate(calibrate_options const& o) {
    lacuna::run_directory out(o.study.out, "--out", calibration_results(),
                              unfinished_mark::earlier(o.study.out, "calibrate", o.study.force));
    unfinished_mark const mark(out, "calibrate");
    auto base = requests_of(o.study);
    for (packing_request& r : base)
        // The loads of a good set are near those of the paper.
        for (threshold const what : all_thresholds)
            r.loads.first_guess[std::size_t(what)] =
                paper_load(r.model.zone, what).value_or(1.2 * *paper_load(r.model.zone, threshold::capacity));
    std::vector<calibrated_set> sets;
    auto const misfit = [&](choices const& c) {
        calibrated_set set;
        set.choices = c;
        auto requests = base;
        for (packing_request& r : requests) r.model = with_choices(r.model, c);
        try {
            validate(c);
            auto const packings = mark.stoppable([&] { return run_packings(requests, pool_options(o.study)); });
            set.targets = targets_of(packings);
            set.first_layers = first_layers_of(packings);
            set.misfit = misfit_of(set.targets);
        } catch (std::invalid_argument const& bad) {
            set.misfit = std::numeric_limits<double>::quiet_NaN();
            set.why = bad.what();
        }
        sets.push_back(set);
        if (!o.study.quiet) print_set(stderr, sets.size(), o.evaluations, set, o.free);
        return set.misfit;
    };
    calibration_request request;
    request.start = o.study.model.choices;
    request.free = o.free;
    request.evaluations = o.evaluations;
    auto const tried = calibrate(request, misfit);
    mark.begin_results();
    write_calibration(o.study.out, o, sets, best_of(tried));
    mark.end();
    if (!o.study.quiet) {
        print_best(stdout, sets[best_of(tried)]);
        print_paths(out, calibration_results());
    }
    return 0;
}

} // namespace cartilage
