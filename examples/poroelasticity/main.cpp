// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/run_directory.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "../command_line.hpp"
#include "../terminal_progress.hpp"
#include "cases.hpp"
#include "output.hpp"

namespace {

enum exit_status { done = 0, failed = 1, bad_request = 2 };

struct request {
    std::string name, out = ".";
    bool quick = false, json = false, force = false, slow = false;
    poroelasticity::outcome (*run)(bool quick, programs::terminal_progress& progress) = nullptr;
};

/// \return a request without `run` if only help or the version was requested
/// \throws std::invalid_argument with a message of one line
request parse_command_line(int argc, char const* const* argv) {
    request r;
    CLI::App app("Compares a bonded packing of discs with fluid in its pores with closed forms of poroelasticity.\n"
                 "Writes CASE.csv and CASE.png. Exit status: 0 done, 1 failed, 2 bad request, 128 + number of a signal "
                 "that stopped it.",
                 "poroelasticity");
    app.add_option("--case", r.name, "terzaghi, mandel, cryer, darcy, creep or relaxation")
        ->required()
        ->type_name("CASE");
    app.add_option("--out", r.out, "directory for the files (.)")->type_name("DIR");
    app.add_flag("--force", r.force, "replace earlier files of the case in DIR");
    app.add_flag("--json", r.json, "print quantity, value, reference and relative_error as JSON");
    app.add_flag("--quick", r.quick, "a coarse model and a short run");
    app.add_flag("--slow-time", r.slow, "terzaghi, mandel, cryer: from early to late times, particles always at rest");
    app.set_version_flag("--version", programs::version_text("poroelasticity"));
    if (!programs::parse(app, argc, argv)) return r;
    using namespace poroelasticity;
    constexpr decltype(r.run) runs[] = {run_terzaghi, run_mandel, run_cryer, run_darcy, run_creep, run_relaxation};
    constexpr decltype(r.run) slow[] = {run_slow_terzaghi, run_slow_mandel, run_slow_cryer};
    auto const which =
        programs::index_of("--case", r.name, {"terzaghi", "mandel", "cryer", "darcy", "creep", "relaxation"});
    if (r.slow && which == 3) lacuna::refuse("--slow-time", "--case darcy", "without it: its particles do not move");
    r.run = r.slow && which < 3 ? slow[which] : runs[which];
    return r;
}

} // namespace

int main(int argc, char** argv) {
    try {
        request const r = parse_command_line(argc, argv);
        if (!r.run) return done;
        lacuna::watch_stop_signals();
        // Cases have different files, so each has its own lock.
        lacuna::run_directory directory(r.out, "--out", poroelasticity::result_names(r.name),
                                        r.force ? lacuna::earlier_results::replace : lacuna::earlier_results::refuse,
                                        "lacuna-" + r.name + ".lock");
        programs::terminal_progress progress;
        auto const outcome = r.run(r.quick, progress);
        progress.finish();
        poroelasticity::write_files(directory, outcome);
        if (r.json)
            std::fputs(poroelasticity::to_json(outcome).c_str(), stdout);
        else
            poroelasticity::print_rows(stdout, outcome);
        programs::finish_output();
        if (!outcome.stopped) return done;
        std::fprintf(stderr, "poroelasticity: stopped by %s after step %lld; results so far are in %s\n",
                     lacuna::signal_name(lacuna::stop_signal()).c_str(), outcome.steps,
                     directory.file(r.name + ".csv").c_str());
        return 128 + lacuna::stop_signal();
    } catch (std::invalid_argument const& bad) {
        std::fprintf(stderr, "poroelasticity: %s\n", bad.what());
        return bad_request;
    } catch (std::exception const& bad) {
        std::fprintf(stderr, "poroelasticity: %s\n", bad.what());
        return failed;
    }
}
