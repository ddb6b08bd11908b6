// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/study_options.hpp"

#include <algorithm>
#include <string>

#include <CLI/CLI.hpp>

#include "cartilage/specimen/specimen.hpp"

namespace cartilage {

namespace {

std::vector<lacuna::cartilage_zone> zones_of(std::string const& list) {
    std::vector<lacuna::cartilage_zone> zones;
    for (std::string const& name : parts_of(list, ',')) {
        zones.push_back(zone_of("--zones", name));
    }
    std::sort(zones.begin(), zones.end());
    if (std::adjacent_find(zones.begin(), zones.end()) != zones.end())
        refuse("--zones", list, "a list without a zone twice");
    return zones;
}

void read_shard(std::string const& word, study_options& o) {
    char const* const rule = "K/N with whole numbers 1 <= K <= N, at most 10000";
    auto const parts = parts_of(word, '/');
    if (parts.size() != 2) refuse("--shard", word, rule);
    o.shards = whole_number<int>("--shard", parts[1], 1, 10000, rule);
    o.shard = whole_number<int>("--shard", parts[0], 1, o.shards, rule);
}

/// Options of a study in equilibrium, as text from the command line.
struct equilibrium_arguments {
    std::string load = "400", steps = "40";
    bool drained = false;
};

void add_equilibrium_options(CLI::App& app, study_options& o, equilibrium_arguments& args) {
    app.add_flag("--equilibrium", o.equilibrium,
                 "from equilibrium to equilibrium in place of runs in time; writes equilibrium.json and table3.csv");
    app.add_option("--load", args.load, "with --equilibrium: highest load, MPa (400)")->type_name("MPA");
    app.add_option("--steps", args.steps, "with --equilibrium: equal steps to that load (40)")->type_name("N");
    app.add_flag("--drained", args.drained, "with --equilibrium: pore pressures stay zero");
    app.add_option("--beside", o.beside,
                   "with --equilibrium: an explicit study of the same choices, for its columns (cartilage-study)")
        ->type_name("DIR");
}

/// \throws usage_error for options that only one kind of study has
void read_equilibrium(CLI::App const& app, equilibrium_arguments const& args, study_options& o) {
    if (!o.equilibrium) {
        for (char const* name : {"--load", "--steps", "--drained", "--beside"})
            if (app.count(name) > 0) throw usage_error(std::string(name) + ": must be given with --equilibrium only");
        return;
    }
    if (app.count("--no-snapshots") > 0)
        throw usage_error("--no-snapshots: must not be given with --equilibrium, which has none");
    equilibrium_request& r = o.in_equilibrium;
    r.model = o.model;
    r.model.load_MPa = positive_number("--load", args.load, "a number of MPa > 0");
    r.steps = whole_number<int>("--steps", args.steps, 1, 100000, "a whole number from 1 to 100000");
    r.drained = args.drained;
    r.failures = lacuna::failure_choice::worst_of_groups;
    validate(r);
}

} // namespace

void add_pool_options(CLI::App& app, pool_arguments& args) {
    app.add_option("--zones", args.zones, "some of surface,middle,deep,whole (all)")->type_name("LIST");
    app.add_option("--seeds", args.seeds, "packings of each zone, seeds 1 to N (20; with --quick 3)")->type_name("N");
    app.add_flag("--quick", args.quick, "few packings, and loads only to 25 %");
    app.add_option("--jobs", args.jobs, "runs at the same time; the results do not depend on it (all processors)")
        ->type_name("N");
    app.add_option("--cache", args.cache, "directory of stored runs; studies may share it (DIR/cache)")
        ->type_name("DIR");
}

void add_output_options(CLI::App& app, study_options& o, std::string const& replaced) {
    app.add_option("--out", o.out, "directory for the results (" + o.out + ")")->type_name("DIR");
    app.add_flag("--force", o.force, "replace " + replaced + " in DIR");
    app.add_flag("--quiet", o.quiet, "no progress, no table");
}

void read_arguments(model_arguments const& model, pool_arguments const& args, study_options& o, std::uint64_t seeds) {
    o.model = model_options(model);
    o.model.what = command::run;
    o.zones = zones_of(args.zones);
    o.seeds = args.quick ? 3 : seeds;
    if (!args.seeds.empty())
        o.seeds = whole_number<std::uint64_t>("--seeds", args.seeds, 1, 100000, "a whole number from 1 to 100000");
    if (args.quick) o.loads.resolution = 0.25;
    o.model.step_share = 0.8;
    if (!args.jobs.empty()) o.jobs = whole_number<int>("--jobs", args.jobs, 1, 4096, "a whole number from 1 to 4096");
    o.cache = args.cache.empty() ? o.out + "/cache" : args.cache;
}

void validate_specimens(study_options const& o) {
    for (auto const zone : o.zones) {
        options one = o.model;
        one.zone = zone;
        validate_specimen(one);
    }
}

std::optional<study_options> parse_study_command_line(int argc, char const* const* argv) {
    study_options o;
    o.out = "cartilage-study";
    model_arguments model;
    pool_arguments pool;
    std::string shard;
    CLI::App app("Finds the loads of first crack, capacity and complete damage for many packings of each zone.\n"
                 "Results go into a directory: study.json, table3.csv, report.html and its plots. A study that was "
                 "stopped continues where it was; a repeated study takes its results from the cache.",
                 "cartilage study");
    add_pool_options(app, pool);
    app.add_option("--shard", shard, "only every N-th packing, from the K-th on; see merge")->type_name("K/N");
    add_model_options(app, model);
    add_run_options(app, model);
    app.add_flag("--no-snapshots", [&](std::int64_t) { o.pictures = false; }, "leave out the runs of Figures 10 to 12");
    add_output_options(app, o, "another study");
    equilibrium_arguments in_equilibrium;
    add_equilibrium_options(app, o, in_equilibrium);
    CLI::App& merge = *app.add_subcommand("merge", "Join the parts of a study and write the report");
    merge.add_option("DIR", o.merge, "results of the parts")->required()->type_name("");
    add_output_options(merge, o, "another study");
    if (!parse_arguments(app, argc, argv)) return std::nullopt;
    if (merge.parsed()) return o;
    if (o.equilibrium && app.count("--out") == 0) o.out = "cartilage-equilibrium-study";
    read_arguments(model, pool, o);
    read_equilibrium(app, in_equilibrium, o);
    if (!shard.empty()) read_shard(shard, o);
    validate_specimens(o);
    return o;
}

} // namespace cartilage
