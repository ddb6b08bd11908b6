// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/run_options.hpp"

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include "cartilage/common/option_parsing.hpp"
#include "cartilage/specimen/specimen.hpp"

namespace cartilage {

namespace {

/// The options as text from the command line.
struct run_arguments : model_arguments {
    std::string zone, load, seed = "1", threads = "1", out, picture_every, time_step;
    bool quiet = false, force = false, allow_unstable_step = false;
};

void add_specimen_options(CLI::App& app, run_arguments& args) {
    app.add_option("--zone", args.zone, "surface, middle, deep or whole")->required()->type_name("ZONE");
    app.add_option("--seed", args.seed, "seed of the packing (1)")->type_name("N");
    add_model_options(app, args);
    app.add_option("--out", args.out, "directory for the results (named after zone, load and seed)")->type_name("DIR");
    app.add_flag("--force", args.force, "replace the results in DIR");
    app.add_flag("--quiet", args.quiet, "no progress, no table");
}

options checked_options(run_arguments const& args, command what) {
    options o = model_options(args);
    o.what = what;
    o.zone = zone_of("--zone", args.zone);
    std::uint64_t const largest_seed = UINT64_MAX;
    o.seed = whole_number<std::uint64_t>("--seed", args.seed, 0, largest_seed, "a whole number >= 0");
    o.quiet = args.quiet;
    o.force = args.force;
    o.allow_unstable_step = args.allow_unstable_step;
    if (what == command::run) {
        o.load_MPa = positive_number("--load", args.load, "a number of MPa > 0");
        o.threads = whole_number<int>("--threads", args.threads, 1, 1024, "a whole number from 1 to 1024");
        if (!args.time_step.empty())
            o.time_step_ps = positive_number("--time-step", args.time_step, "a number of picoseconds > 0");
        if (!args.picture_every.empty())
            o.picture_every = whole_number<long long>("--picture-every", args.picture_every, 1, 1LL << 60,
                                                      "a whole number of steps > 0");
    }
    o.out = args.out;
    if (o.out.empty()) {
        o.out = "cartilage-" + args.zone;
        if (what == command::run) o.out += "-" + lacuna::to_text(o.load_MPa) + "MPa";
        o.out += "-seed" + std::to_string(o.seed);
    }
    validate_specimen(o);
    return o;
}

} // namespace

std::optional<options> parse_command_line(int argc, char const* const* argv, std::span<command_name const> others) {
    run_arguments args;
    CLI::App app("Articular cartilage under load: a bonded-particle model with pore fluid, after Hong, Evans and "
                 "Mente.\nResults go into a directory: summary.json, cracks.csv, pictures as PNG and SVG.\n"
                 "Exit status: 0 done, 1 a file could not be written, 2 bad request, 3 the run became unstable, "
                 "128 + number of the signal that stopped it.",
                 "cartilage");
    app.require_subcommand(1);

    CLI::App& run = *app.add_subcommand("run", "Load a specimen and see where it cracks");
    add_specimen_options(run, args);
    run.add_option("--load", args.load, "pressure on the top row, MPa")->required()->type_name("MPA");
    add_run_options(run, args);
    run.add_option("--time-step", args.time_step, "ps (0.4 of the rigorous bound)")->type_name("PS");
    run.add_flag("--allow-unstable-step", args.allow_unstable_step,
                 "run even with a time step above the rigorous bound");
    run.add_option("--threads", args.threads, "1 to 1024; the results do not depend on it (1)")->type_name("N");
    run.add_option("--picture-every", args.picture_every, "a damage picture every STEPS steps (none)")
        ->type_name("STEPS");

    CLI::App& pack = *app.add_subcommand("pack", "Build and draw a specimen, and print its statistics");
    add_specimen_options(pack, args);

    // These commands parse their own options. Here they only appear in the help.
    for (command_name const& other : others) app.add_subcommand(other.name, other.description);

    if (!parse_arguments(app, argc, argv)) return std::nullopt;
    return checked_options(args, run.parsed() ? command::run : command::pack);
}

} // namespace cartilage
