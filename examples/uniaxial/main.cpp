// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <lacuna/core/text.hpp>
#include <lacuna/observe/run_directory.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "../command_line.hpp"
#include "../terminal_progress.hpp"
#include "output.hpp"
#include "uniaxial.hpp"

namespace {

enum exit_status { done = 0, failed = 1, bad_request = 2, not_converged = 3 };

/// The content of the command line.
struct command {
    uniaxial::request request;
    std::string specimen = "random", out = ".";
    bool json = false, force = false, help = false;
};

/// A number of the request with its option.
struct number_option {
    char const* option;
    double uniaxial::request::*member;
    char const* meaning;
};
using request = uniaxial::request;
constexpr number_option numbers[] = {
    {"--width", &request::width, "of the specimen, m"},
    {"--height", &request::height, "of the specimen, m"},
    {"--radius", &request::radius, "mean radius of the discs, m"},
    {"--thickness", &request::thickness, "of the specimen, m"},
    {"--bond-modulus", &request::bond_modulus, "k_n divided by the thickness, Pa"},
    {"--shear-ratio", &request::shear_ratio, "k_s divided by k_n"},
    {"--tensile-strength", &request::tensile_strength, "of bonds, Pa"},
    {"--cohesion", &request::cohesion, "of bonds, Pa"},
    {"--internal-friction", &request::internal_friction, "of bonds, tan phi"},
    {"--friction", &request::friction, "of contacts and platens"},
    {"--weibull-modulus", &request::weibull_modulus, "scatter of the strengths; inf: none"},
    {"--strain", &request::strain, "final strain; the run may end earlier"},
};

double read_number(std::string const& option, std::string const& word) {
    // The request decides which numbers may be infinite.
    auto const value = lacuna::number_of(word);
    return value && std::isinf(*value) && word.find_first_of("0123456789") == word.npos
               ? *value
               : lacuna::read_number(option, word);
}

/// \throws std::invalid_argument with a message of one line for an invalid command line
command parse_command_line(int argc, char const* const* argv) {
    command w;
    auto& q = w.request;
    std::string words[std::size(numbers)], seed, steps, load_steps;
    CLI::App app(
        "Uniaxial compression of a bonded specimen between two platens.\n"
        "Writes uniaxial.csv, uniaxial.json, uniaxial.png, uniaxial.svg. SI units.\n"
        "Exit status: 0 done, 1 a file could not be written, 2 bad request, 3 an equilibrium was not found,\n"
        "128 + number of a signal that stopped it.",
        "uniaxial");
    app.get_formatter()->column_width(28);
    app.add_option("--specimen", w.specimen, "random or lattice (random)")->type_name("KIND");
    for (std::size_t k = 0; k < std::size(numbers); ++k)
        app.add_option(numbers[k].option, words[k],
                       std::string(numbers[k].meaning) + " (" + lacuna::to_text(q.*numbers[k].member) + ")")
            ->type_name("NUMBER");
    app.add_option("--seed", seed, "of the packing and the strengths, a whole number (" + std::to_string(q.seed) + ")")
        ->type_name("N");
    app.add_option("--steps", steps, "number of steps to the final strain (" + std::to_string(q.steps) + ")")
        ->type_name("N");
    app.add_flag("--equilibrium", q.equilibrium, "static equilibria at growing strains instead of steps in time");
    app.add_option("--load-steps", load_steps,
                   "number of equilibria to the final strain (" + std::to_string(q.load_steps) + ")")
        ->type_name("N");
    app.add_option("--out", w.out, "directory for the files (.)")->type_name("DIR");
    app.add_flag("--elastic", q.elastic, "bonds never break; measures only the moduli");
    app.add_flag("--force", w.force, "replace the results in DIR");
    app.add_flag("--json", w.json, "print the results as JSON");
    app.set_version_flag("--version", programs::version_text("uniaxial"));
    if (!programs::parse(app, argc, argv)) {
        w.help = true;
        return w;
    }
    constexpr uniaxial::specimen_kind kinds[] = {uniaxial::specimen_kind::random, uniaxial::specimen_kind::lattice};
    q.specimen = kinds[programs::index_of("--specimen", w.specimen, {"random", "lattice"})];
    for (std::size_t k = 0; k < std::size(numbers); ++k)
        if (app.count(numbers[k].option) > 0) q.*numbers[k].member = read_number(numbers[k].option, words[k]);
    if (app.count("--seed") > 0)
        q.seed = std::uint64_t(lacuna::read_whole("--seed", seed, 0, std::numeric_limits<long long>::max()));
    if (app.count("--steps") > 0) q.steps = lacuna::read_whole("--steps", steps, 1000, 100000000);
    if (app.count("--load-steps") > 0) q.load_steps = int(lacuna::read_whole("--load-steps", load_steps, 1, 1000000));
    if (q.equilibrium && app.count("--steps") > 0) lacuna::refuse("--steps", steps, "left out with --equilibrium");
    if (!q.equilibrium && app.count("--load-steps") > 0)
        lacuna::refuse("--load-steps", load_steps, "left out without --equilibrium");
    q.validate();
    return w;
}

} // namespace

int main(int argc, char** argv) {
    try {
        command const w = parse_command_line(argc, argv);
        if (w.help) return done;
        lacuna::watch_stop_signals();
        lacuna::run_directory directory(w.out, "--out",
                                        {"uniaxial.csv", "uniaxial.json", "uniaxial.png", "uniaxial.svg"},
                                        w.force ? lacuna::earlier_results::replace : lacuna::earlier_results::refuse);
        lacuna::growing_file rows(directory.file("uniaxial.csv"), uniaxial::row_heading());
        directory.keep();
        auto const outcome = [&] {
            try {
                programs::terminal_progress progress;
                return uniaxial::run(w.request, &rows, &progress);
            } catch (std::invalid_argument const&) {
                directory.discard();
                throw;
            }
        }();
        uniaxial::write_files(directory, outcome);
        if (w.json)
            std::fputs(uniaxial::to_json(outcome).c_str(), stdout);
        else
            uniaxial::print(stdout, outcome);
        programs::finish_output();
        bool const stopped = outcome.ended.rfind("stopped", 0) == 0;
        if (!stopped && outcome.ended != "not converged") return done;
        std::fprintf(stderr, "uniaxial: %s after step %lld; results so far are in %s\n", outcome.ended.c_str(),
                     outcome.asked.equilibrium ? outcome.load_steps : outcome.steps,
                     directory.file("uniaxial.csv").c_str());
        return stopped ? 128 + lacuna::stop_signal() : not_converged;
    } catch (std::invalid_argument const& bad) {
        std::fprintf(stderr, "uniaxial: %s\n", bad.what());
        return bad_request;
    } catch (std::exception const& bad) {
        std::fprintf(stderr, "uniaxial: %s\n", bad.what());
        return failed;
    }
}
