// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string_view>

#include <lacuna/core/error.hpp>
#include <lacuna/draw/picture.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "cartilage/calibrate/calibrate.hpp"
#include "cartilage/calibrate/sensitivity.hpp"
#include "cartilage/common/interruption.hpp"
#include "cartilage/common/options.hpp"
#include "cartilage/common/print_paths.hpp"
#include "cartilage/equilibrium_command.hpp"
#include "cartilage/run/equilibrium_options.hpp"
#include "cartilage/run/run_options.hpp"
#include "cartilage/run/run_output.hpp"
#include "cartilage/run/simulate.hpp"
#include "cartilage/specimen/specimen.hpp"
#include "cartilage/study_command.hpp"
#include "command_line.hpp"

namespace {

enum exit_status { done = 0, failed = 1, bad_request = 2, unstable = 3 };

/// Exit status after a signal, as in a shell.
int interrupted() { return 128 + lacuna::stop_signal(); }

lacuna::run_directory directory_of(cartilage::options const& o) {
    return {o.out, "--out", cartilage::run_results(),
            o.force ? lacuna::earlier_results::replace : lacuna::earlier_results::refuse};
}

int pack(cartilage::options const& o) {
    lacuna::run_directory out = directory_of(o);
    cartilage::specimen const specimen = cartilage::build_specimen(o);
    cartilage::specimen_report const report = cartilage::report_of(specimen);
    out.keep();
    lacuna::save_packing(out.file("packing"), cartilage::scene_of(specimen, o));
    cartilage::write_statistics(out.file("statistics.json"), o, report);
    if (!o.quiet) cartilage::print_statistics(stdout, o, report);
    if (!o.quiet) cartilage::print_paths(out, {"packing.png", "packing.svg", "statistics.json"});
    return done;
}

int run(cartilage::options const& o) {
    lacuna::watch_stop_signals();
    lacuna::run_directory out = directory_of(o);
    cartilage::specimen const specimen = cartilage::build_specimen(o);
    lacuna::scene damage;
    cartilage::run_result const result = cartilage::simulate(specimen, o, out, o.quiet ? nullptr : stderr, damage);
    lacuna::save_packing(out.file("packing"), cartilage::scene_of(specimen, o));
    lacuna::save_damage(out.file("damage"), damage);
    // Last, because its presence means that the run is finished.
    cartilage::write_summary(out.file("summary.json"), o, result);
    if (!o.quiet) {
        cartilage::print_result(stdout, o, result);
        cartilage::print_paths(
            out, {"packing.png", "packing.svg", "damage.png", "damage.svg", "cracks.csv", "summary.json"});
    }
    return result.interrupted ? interrupted() : done;
}

/// Commands that read their own options.
constexpr cartilage::command_name further_commands[] = {
    {"equilibrium", "Load a specimen from equilibrium to equilibrium and see at which loads it cracks"},
    {"study", "Find the loads of Table 3 for many packings; 'study merge' joins parts"},
    {"sensitivity", "Show the effect of each open choice on these loads"},
    {"calibrate", "Fit open choices to the paper's eleven loads"}};

int equilibrium(int argc, char** argv) {
    auto const o = cartilage::parse_equilibrium_command_line(argc, argv);
    if (!o) return done;
    lacuna::watch_stop_signals();
    return cartilage::equilibrium(*o) ? done : interrupted();
}

int study(int argc, char** argv) {
    auto const o = cartilage::parse_study_command_line(argc, argv);
    if (!o) return done;
    lacuna::watch_stop_signals();
    return cartilage::study(*o);
}

int sensitivity(int argc, char** argv) {
    auto const o = cartilage::parse_sensitivity_command_line(argc, argv);
    if (!o) return done;
    lacuna::watch_stop_signals();
    return cartilage::sensitivity(*o);
}

int calibrate(int argc, char** argv) {
    auto const o = cartilage::parse_calibrate_command_line(argc, argv);
    if (!o) return done;
    lacuna::watch_stop_signals();
    return cartilage::calibrate(*o);
}

int run_command(int argc, char** argv) {
    std::string_view const command = argc > 1 ? argv[1] : "";
    if (command == "equilibrium") return equilibrium(argc - 1, argv + 1);
    if (command == "study") return study(argc - 1, argv + 1);
    if (command == "sensitivity") return sensitivity(argc - 1, argv + 1);
    if (command == "calibrate") return calibrate(argc - 1, argv + 1);
    auto const options = cartilage::parse_command_line(argc, argv, further_commands);
    if (!options) return done;
    return options->what == cartilage::command::run ? run(*options) : pack(*options);
}

} // namespace

int main(int argc, char** argv) {
    try {
        int const status = run_command(argc, argv);
        programs::finish_output();
        return status;
    } catch (cartilage::usage_error const& bad) {
        std::fprintf(stderr, "cartilage: %s\n", bad.what());
        return bad_request;
    } catch (std::invalid_argument const& bad) {
        std::fprintf(stderr, "cartilage: %s\n", bad.what());
        return bad_request;
    } catch (cartilage::interruption const&) {
        std::fprintf(stderr, "cartilage: stopped by %s; the same command continues from here\n",
                     lacuna::signal_name(lacuna::stop_signal()).c_str());
        return interrupted();
    } catch (lacuna::unstable_run const& bad) {
        std::fprintf(stderr, "cartilage: %s\n", bad.what());
        return unstable;
    } catch (cartilage::no_convergence const& bad) {
        std::fprintf(stderr, "cartilage: %s\n", bad.what());
        return unstable;
    } catch (std::exception const& bad) {
        std::fprintf(stderr, "cartilage: %s\n", bad.what());
        return failed;
    }
}
