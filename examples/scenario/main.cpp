// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "../command_line.hpp"
#include "checkpoints.hpp"
#include "key_table.hpp"
#include "runner.hpp"

namespace {

enum exit_status { done = 0, failed = 1, refused = 2, unstable = 3 };

struct request {
    std::string file, checkpoint;
    bool check = false, force = false, quiet = false;
};

/// Finishes the files of a run that a signal stopped, and prints how to continue it.
/// \return the exit status
int finish_stopped(request const& asked, lacuna_run::results& out, lacuna_run::runner const& run) {
    int const number = lacuna::stop_signal();
    std::string const signal = lacuna::signal_name(number);
    out.finish(run.summary("stopped by " + signal, "after step " + std::to_string(run.steps())), false);
#ifdef LACUNA_RUN_CHECKPOINTS
    std::string const how = "--restart " + out.file("checkpoint.bin") + " continues from there";
#else
    std::string const how = "this program was built without checkpoints: the run cannot be continued";
#endif
    std::fprintf(stderr, "lacuna-run: %s: stopped by %s after step %lld; %s\n", asked.file.c_str(), signal.c_str(),
                 run.steps(), how.c_str());
    return 128 + number;
}

int run(request const& asked) {
    auto const scenario = lacuna_run::read_scenario_file(asked.file);
    auto const run = lacuna_run::make_runner(scenario);
    lacuna_run::resumption start;
    if (!asked.checkpoint.empty()) {
        run->restore(asked.checkpoint);
        start = lacuna_run::find_earlier_part(scenario, asked.checkpoint, run->log(), run->steps());
    }
    if (asked.check) {
        if (!asked.quiet) std::printf("%s: fine\n", asked.file.c_str());
        programs::finish_output();
        return done;
    }
    lacuna::watch_stop_signals();
    lacuna_run::results out(scenario, asked.force, asked.quiet, start);
    out.begin();
    try {
        if (!run->run(out)) return finish_stopped(asked, out, *run);
    } catch (lacuna::unstable_run const& bad) {
        out.finish(run->summary("unstable", bad.what()), true);
        throw;
    } catch (std::invalid_argument const&) {
        if (asked.checkpoint.empty() && run->steps() == 0) out.discard();
        throw;
    }
    out.finish(run->summary(scenario.simulation.steps ? "steps" : "end_time", ""), true);
    if (!asked.quiet)
        for (char const* name : {"probes.csv", "events.csv", "summary.json"})
            std::printf("%s\n", out.file(name).c_str());
    programs::finish_output();
    return done;
}

/// \return the exit status if the command line alone decides it, otherwise -1
int parse(int argc, char** argv, request& asked) {
    CLI::App app("Simulates bonded particles and pore fluid as described by a TOML file.\n"
                 "Exit status: 0 done, 1 a file could not be written, 2 refused, 3 the run became unstable, 128 + "
                 "number of a signal.",
                 "lacuna-run");
    app.footer(lacuna_run::keys_help());
    app.add_option("FILE", asked.file, "the scenario")->required()->type_name("");
    app.add_flag("--check", asked.check, "only check the scenario");
    app.add_option("--restart", asked.checkpoint, "continue from a checkpoint of the same scenario")->type_name("FILE");
    app.add_flag("--force", asked.force, "replace the results in the output directory; other files stay");
    app.add_flag("--quiet", asked.quiet, "print nothing but errors");
    app.set_version_flag("--version", programs::version_text("lacuna-run"));
    try {
        return programs::parse(app, argc, argv) ? -1 : int(done);
    } catch (std::invalid_argument const& bad) {
        std::fprintf(stderr, "lacuna-run: %s\n", bad.what());
        return refused;
    } catch (std::runtime_error const& bad) {
        std::fprintf(stderr, "lacuna-run: %s\n", bad.what());
        return failed;
    }
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
