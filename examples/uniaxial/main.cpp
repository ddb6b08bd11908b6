// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <lacuna/observe/run_directory.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "../command_line.hpp"
#include "output.hpp"
#include "uniaxial.hpp"

namespace {

enum exit_status { done = 0, failed = 1, bad_request = 2 };

struct wish {
    uniaxial::request request;
    std::string specimen = "random", out = ".";
    bool json = false, force = false, help = false;
};

/// \throws std::invalid_argument with one line for a request that cannot be met
wish understand(int argc, char const* const* argv) {
    wish w;
    auto& q = w.request;
    CLI::App app("Uniaxial compression of a bonded specimen between two platens.\n"
                 "Writes uniaxial.csv, uniaxial.json, uniaxial.png, uniaxial.svg. SI units.\n"
                 "Exit status: 0 done, 1 failed, 2 bad request, 128 + number of a signal that stopped it.",
                 "uniaxial");
    app.failure_message(CLI::FailureMessage::simple);
    app.add_option("--specimen", w.specimen, "random or lattice (random)")->type_name("KIND");
    app.add_option("--width", q.width, "of the specimen, m")->capture_default_str();
    app.add_option("--height", q.height, "of the specimen, m")->capture_default_str();
    app.add_option("--radius", q.radius, "mean radius of the discs, m")->capture_default_str();
    app.add_option("--thickness", q.thickness, "of the specimen, m")->capture_default_str();
    app.add_option("--seed", q.seed, "of packing and strengths")->capture_default_str();
    app.add_option("--bond-modulus", q.bond_modulus, "k_n over the thickness, Pa")->capture_default_str();
    app.add_option("--shear-ratio", q.shear_ratio, "k_s over k_n")->capture_default_str();
    app.add_option("--tensile-strength", q.tensile_strength, "of bonds, Pa")->capture_default_str();
    app.add_option("--cohesion", q.cohesion, "of bonds, Pa")->capture_default_str();
    app.add_option("--internal-friction", q.internal_friction, "of bonds, tan phi")->capture_default_str();
    app.add_option("--friction", q.friction, "of contacts and platens")->capture_default_str();
    app.add_option("--weibull-modulus", q.weibull_modulus, "of the strengths' scatter; inf: none")->capture_default_str();
    app.add_option("--strain", q.strain, "at which the run ends at the latest")->capture_default_str();
    app.add_option("--steps", q.steps, "to get there")->capture_default_str();
    app.add_option("--out", w.out, "directory for the files (.)")->type_name("DIR");
    app.add_flag("--elastic", q.elastic, "bonds that never break: moduli alone");
    app.add_flag("--force", w.force, "replace the results that are in DIR");
    app.add_flag("--json", w.json, "the figures as JSON on stdout");
    app.set_version_flag("--version", programs::version_text("uniaxial"));
    if (!programs::parse(app, argc, argv)) {
        w.help = true;
        return w;
    }
    std::map<std::string, uniaxial::specimen_kind> const kinds{{"random", uniaxial::specimen_kind::random},
                                                               {"lattice", uniaxial::specimen_kind::lattice}};
    auto const kind = kinds.find(w.specimen);
    if (kind == kinds.end()) throw std::invalid_argument("--specimen " + w.specimen + ": must be random or lattice");
    q.specimen = kind->second;
    q.validate();
    return w;
}

} // namespace

int main(int argc, char** argv) {
    try {
        wish const w = understand(argc, argv);
        if (w.help) return done;
        lacuna::watch_stop_signals();
        lacuna::run_directory directory(w.out, "--out", {"uniaxial.csv", "uniaxial.json", "uniaxial.png", "uniaxial.svg"},
                                        w.force ? lacuna::earlier_results::replace : lacuna::earlier_results::refuse);
        lacuna::growing_file rows(directory.file("uniaxial.csv"), uniaxial::row_heading());
        directory.keep();
        auto const outcome = [&] {
            try {
                return uniaxial::run(w.request, &rows);
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
        if (outcome.ended.rfind("stopped", 0) != 0) return done;
        std::fprintf(stderr, "uniaxial: %s after step %lld; what there is is in %s\n", outcome.ended.c_str(), outcome.steps,
                     directory.file("uniaxial.csv").c_str());
        return 128 + lacuna::stop_signal();
    } catch (std::invalid_argument const& bad) {
        std::fprintf(stderr, "uniaxial: %s\n", bad.what());
        return bad_request;
    } catch (std::exception const& bad) {
        std::fprintf(stderr, "uniaxial: %s\n", bad.what());
        return failed;
    }
}
