// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/equilibrium_options.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <lacuna/core/text.hpp>

#include "cartilage/common/option_parsing.hpp"
#include "cartilage/specimen/specimen.hpp"
#include "command_line.hpp"

namespace cartilage {

namespace {

/// The options as text from the command line.
struct equilibrium_arguments : model_arguments {
    std::string zone, seed = "1", load = "400", steps = "40", iterations = "200", failures = "first";
    std::string out, picture_every;
    std::vector<std::string> refused; ///< values of options without meaning
    bool drained = false, quiet = false, force = false, json = false;
};

/// Options of `run` that equilibrium has no use for: refused by name.
constexpr char const* without_meaning[][2] = {{"--duration", "equilibrium knows no time"},
                                              {"--time-step", "equilibrium knows no time"},
                                              {"--allow-unstable-step", "equilibrium knows no time"},
                                              {"--threads", "an equilibrium is sought by one thread"}};

void add_options(CLI::App& app, equilibrium_arguments& args) {
    app.add_option("--zone", args.zone, "surface, middle, deep or whole")->required()->type_name("ZONE");
    app.add_option("--seed", args.seed, "seed of the packing (1)")->type_name("N");
    app.add_option("--load", args.load, "highest pressure on the top row, MPa (400)")->type_name("MPA");
    app.add_option("--steps", args.steps, "equal steps to that load; bonds break at their own loads (40)")
        ->type_name("N");
    app.add_option("--failures", args.failures,
                   "bonds that break at once where several are overloaded; first: one; worst_of_fibres: one of each "
                   "fibre (first)")
        ->type_name("WHICH");
    app.add_option("--iterations", args.iterations, "largest number of iterations of one solve (200)")->type_name("N");
    app.add_flag("--drained", args.drained, "pore pressures stay zero: the fluid flows out freely");
    app.add_flag("--dry", args.dry, "without pore fluid");
    add_model_options(app, args);
    app.add_option("--picture-every", args.picture_every, "a damage picture every STEPS load steps (none)")
        ->type_name("STEPS");
    app.add_option("--out", args.out, "directory for the results (named after zone and seed)")->type_name("DIR");
    app.add_flag("--force", args.force, "replace the results in DIR");
    app.add_flag("--json", args.json, "the result as one JSON object on stdout, no table");
    app.add_flag("--quiet", args.quiet, "no progress, no table");
    for (auto const& [name, why] : without_meaning) app.add_option(name, args.refused)->expected(0, 1)->group("");
}

} // namespace

std::optional<equilibrium_options> parse_equilibrium_command_line(int argc, char const* const* argv) {
    equilibrium_arguments args;
    CLI::App app("Loads a specimen from equilibrium to equilibrium, whatever the time that it takes, and finds first "
                 "crack, the order in which layers are cut, and complete damage, or shows that the specimen is a "
                 "mechanism.\nResults go into a directory: summary.json, cracks.csv, pictures as PNG and SVG.\n"
                 "Exit status: 0 done, also for a mechanism, 1 a file could not be written, 2 bad request, 3 no "
                 "convergence, 128 + number of the signal that stopped it.",
                 "cartilage equilibrium");
    add_options(app, args);
    if (!parse_arguments(app, argc, argv)) return std::nullopt;
    for (auto const& [name, why] : without_meaning)
        if (app.count(name) > 0) throw usage_error(std::string(name) + ": must not be given: " + why);
    equilibrium_options o;
    o.model = model_options(args);
    o.model.zone = zone_of("--zone", args.zone);
    o.model.seed = whole_number<std::uint64_t>("--seed", args.seed, 0, UINT64_MAX, "a whole number >= 0");
    o.model.load_MPa = positive_number("--load", args.load, "a number of MPa > 0");
    o.steps = whole_number<int>("--steps", args.steps, 1, 100000, "a whole number from 1 to 100000");
    o.iterations =
        whole_number<int>("--iterations", args.iterations, 1, 1000000, "a whole number from 1 to 1000000");
    bool const worst = programs::index_of("--failures", args.failures, {"first", "worst_of_fibres"}) == 1;
    o.failures = worst ? lacuna::failure_choice::worst_of_groups : lacuna::failure_choice::first;
    if (!args.picture_every.empty())
        o.model.picture_every = whole_number<long long>("--picture-every", args.picture_every, 1, 1LL << 60,
                                                        "a whole number of steps > 0");
    o.drained = args.drained;
    o.json = args.json;
    o.model.quiet = args.quiet;
    o.model.force = args.force;
    o.model.out = args.out.empty() ? "cartilage-equilibrium-" + args.zone + "-seed" + std::to_string(o.model.seed)
                                   : args.out;
    validate(o);
    validate_specimen(o.model);
    return o;
}

} // namespace cartilage
