// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <lacuna/core/error.hpp>

#include "key_table.hpp"
#include "runner.hpp"

namespace {

enum exit_status { done = 0, failed = 1, refused = 2, unstable = 3 };

struct request {
    std::string file, checkpoint;
    bool check = false, quiet = false;
};

void write_results(lacuna_run::output_directory const& out, lacuna_run::scenario const& s, lacuna_run::runner const& run,
                   std::string const& ended, std::string const& message) {
    out.write("probes.csv", lacuna_run::probes_text(run.told()));
    out.write("events.csv", lacuna_run::events_text(s, run.told()));
    // Last, because its presence says that the run is finished.
    out.write("summary.json", run.summary(ended, message));
}

int run(request const& asked) {
    auto const scenario = lacuna_run::read_scenario_file(asked.file);
    auto const run = lacuna_run::make_runner(scenario);
    if (!asked.checkpoint.empty()) run->restore(asked.checkpoint);
    if (asked.check) {
        if (!asked.quiet) std::printf("%s: fine\n", asked.file.c_str());
        return done;
    }
    lacuna_run::output_directory const out(scenario.out.directory);
    try {
        run->run(out);
    } catch (lacuna::unstable_run const& bad) {
        write_results(out, scenario, *run, "unstable", bad.what());
        throw;
    }
    write_results(out, scenario, *run, scenario.simulation.steps ? "steps" : "end_time", "");
    if (!asked.quiet)
        for (char const* name : {"probes.csv", "events.csv", "summary.json"}) std::printf("%s\n", out.file(name).c_str());
    return done;
}

/// \return the exit status, where the command line alone decides it; else -1
int parse(int argc, char** argv, request& asked) {
    CLI::App app("Runs one TOML scenario of bonded particles and pore fluid and writes what it asks for.", "lacuna-run");
    app.footer(lacuna_run::keys_help());
    app.add_option("FILE", asked.file, "the scenario")->required();
    app.add_flag("--check", asked.check, "only check the scenario");
    app.add_option("--restart", asked.checkpoint, "go on from a checkpoint of the same scenario");
    app.add_flag("--quiet", asked.quiet, "say nothing but errors");
    try {
        app.parse(argc, argv);
    } catch (CLI::CallForHelp const& help) {
        return app.exit(help);
    } catch (CLI::ParseError const& bad) {
        std::fprintf(stderr, "lacuna-run: %s\n", bad.what());
        return refused;
    }
    return -1;
}

} // namespace

int main(int argc, char** argv) {
    request asked;
    if (int const status = parse(argc, argv, asked); status >= 0) return status;
    try {
        return run(asked);
    } catch (lacuna_run::refusal const& bad) {
        std::fprintf(stderr, "%s\n", bad.what());
        return refused;
    } catch (std::invalid_argument const& bad) {
        std::fprintf(stderr, "%s\n", bad.what());
        return refused;
    } catch (lacuna::unstable_run const& bad) {
        std::fprintf(stderr, "%s\n", bad.what());
        return unstable;
    } catch (std::exception const& bad) {
        std::fprintf(stderr, "lacuna-run: %s\n", bad.what());
        return failed;
    }
}
