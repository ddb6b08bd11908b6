// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "kill/process.hpp"
#include "scenario/program.hpp"

/// \file
/// Ownership of an output directory, results of earlier runs in it, and the size of a checkpoint.

using program::folder;
using program::table;

namespace {

/// Two bonded discs that swing; `more` goes below [output].
std::string pair_text(long long steps, std::string const& more = "") {
    return "[simulation]\nsteps = " + std::to_string(steps) +
           "\ntime_step = 1e-3\n[materials.m]\ndensity = 1000.0\nnormal_stiffness = 1e6\n"
           "shear_stiffness = 5e5\nfriction = 0.2\n"
           "[particles]\nposition = [[0.0, 0.0], [1.0, 0.0]]\nradius = 0.5\nmaterial = \"m\"\n"
           "velocity = [[-0.5, 0.0], [0.5, 0.0]]\n"
           "[bonds]\npairs = [[0, 1]]\n[[probes]]\nquantity = \"position.x\"\nparticle = 0\n[output]\n" +
           more;
}
constexpr long long for_ever = 1000000000;

/// Starts an endless run and waits until it has written some rows.
struct long_run : process::running {
    long_run(folder const& here, std::string const& file, std::vector<std::string> const& options = {})
        : process::running(words(file, options), empty(here)) {
        for (int k = 0;
             k < 600 && (!program::fs::exists(here / "out/probes.csv") || table(here / "out/probes.csv").rows.empty());
             ++k)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    static program::fs::path empty(folder const& here) {
        program::fs::remove_all(here / "out");
        return here / "";
    }
    static std::vector<std::string> words(std::string const& file, std::vector<std::string> const& options) {
        std::vector<std::string> all{LACUNA_RUN_PROGRAM};
        all.insert(all.end(), options.begin(), options.end());
        all.push_back(file);
        return all;
    }
};

bool holds(std::vector<std::string> const& names, std::string const& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

TEST_CASE("results of an earlier run are refused, or replaced with all their frames", "[program][directory]") {
    folder const here("earlier");
    here.write("first.toml", pair_text(40, "vtk_every = 10\n"));
    here.write("second.toml", pair_text(30, "vtk_every = 15\n"));
    REQUIRE(here.run("--quiet first.toml").status == 0);
    here.write("out/notes.txt", "of a person");
    here.write("out/particles-mine.vtp", "of a person");
    auto const before = process::files_of(here / "out");
    auto const refused = here.run("--quiet second.toml");
    REQUIRE(refused.status == 2);
    REQUIRE_THAT(refused.err, contains_text("output.directory = \"out\": must be") && contains_text("--force"));
    REQUIRE(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
    REQUIRE(process::files_of(here / "out") == before);
    // A refusal before the first step keeps the earlier results.
    here.write("wrong.toml", pair_text(30, "vtk_every = -1\n"));
    REQUIRE(here.run("--quiet --force wrong.toml").status == 2);
    REQUIRE(process::files_of(here / "out") == before);

    REQUIRE(here.run("--quiet --force second.toml").status == 0);
    auto names = here.files();
    REQUIRE_FALSE(holds(names, "out/particles-000000000010.vtp"));
    REQUIRE(holds(names, "out/notes.txt"));
    REQUIRE(holds(names, "out/particles-mine.vtp"));
    folder const alone("earlier_alone");
    alone.write("second.toml", pair_text(30, "vtk_every = 15\n"));
    REQUIRE(alone.run("--quiet second.toml").status == 0);
    auto left = process::files_of(here / "out");
    left.erase("notes.txt");
    left.erase("particles-mine.vtp");
    REQUIRE(left == process::files_of(alone / "out"));
}

TEST_CASE("two runs do not share a directory, and a killed run releases it", "[program][directory]") {
    folder const here("shared");
    here.write("long.toml", pair_text(for_ever));
    here.write("short.toml", pair_text(10));
    {
        long_run first(here, "long.toml");
        for (char const* options : {"", "--force "}) {
            auto const second = here.run(std::string("--quiet ") + options + "short.toml");
            REQUIRE(second.status == 2);
            REQUIRE_THAT(second.err, contains_text("in use by process " + std::to_string(first.id())));
        }
        REQUIRE(holds(here.files(), "out/lacuna.lock"));
        first.send(SIGKILL);
        REQUIRE(first.wait() == -SIGKILL);
    }
    // The directory has no owner, but it holds results.
    auto const refused = here.run("--quiet short.toml");
    REQUIRE(refused.status == 2);
    REQUIRE_THAT(refused.err, contains_text("--force"));
    REQUIRE(here.run("--quiet --force short.toml").status == 0);
    REQUIRE(table(here / "out/probes.csv").rows.size() == 11);
    REQUIRE(here.files() == std::vector<std::string>{"long.toml", "out/events.csv", "out/probes.csv",
                                                     "out/summary.json", "short.toml"});
    // Another process may have the number of the dead owner.
    here.write("out/lacuna.lock", std::to_string(getpid()) + " 1 elsewhere\n");
    REQUIRE(here.run("--quiet --force short.toml").status == 0);
    REQUIRE_FALSE(holds(here.files(), "out/lacuna.lock"));
}

TEST_CASE("after a signal files are complete, and the message says how to continue", "[program][directory]") {
    folder const here("signals");
    here.write("long.toml", pair_text(for_ever, "vtk_every = 1000\n"));
    for (int const signal : {SIGTERM, SIGINT, SIGHUP}) {
        long_run run(here, "long.toml", {"--quiet"});
        run.send(signal);
        run.send(signal); // as `timeout` does: to the program, and to its group
        REQUIRE(run.wait() == 128 + signal);
        std::string const name = signal == SIGTERM ? "SIGTERM" : signal == SIGINT ? "SIGINT" : "SIGHUP";
        REQUIRE_THAT(process::read_all((here / "../signals.said").string()),
                     contains_text("stopped by " + name) && contains_text("--restart"));
        auto const summary = nlohmann::json::parse(program::read_file(here / "out/summary.json"));
        REQUIRE(summary.at("ended") == "stopped by " + name);
        long long const steps = summary.at("steps");
        REQUIRE(table(here / "out/probes.csv").rows.size() == std::size_t(steps) + 1);
        REQUIRE(holds(here.files(), "out/checkpoint.bin"));
        // Resumed for some more steps, the run must equal one that was never stopped.
        here.write("on.toml", pair_text(steps + 10, "vtk_every = 1000\n"));
        REQUIRE(here.run("--quiet --restart out/checkpoint.bin on.toml").status == 0);
        if (signal != SIGTERM) continue;
        folder const whole("signals_whole");
        whole.write("on.toml", pair_text(steps + 10, "vtk_every = 1000\n"));
        REQUIRE(whole.run("--quiet on.toml").status == 0);
        auto const expected = process::files_of(whole / "out"), left = process::files_of(here / "out");
        INFO(process::difference(left, expected));
        REQUIRE((left == expected));
    }
}

TEST_CASE("a run is resumed in another directory, and from a checkpoint that was copied",
          "[program][directory][checkpoint]") {
    std::string const text = pair_text(100, "vtk_every = 10\ncheckpoint_every = 40\n");
    folder const whole("resumed_whole"), other("resumed_other");
    whole.write("case.toml", text);
    REQUIRE(whole.run("--quiet case.toml").status == 0);
    auto const expected = process::files_of(whole / "out");
    other.write("case.toml", text);
    auto const from = [](program::fs::path const& path) {
        return "--quiet --restart '" + path.string() + "' case.toml";
    };
    REQUIRE(other.run(from(whole / "out/checkpoint.bin")).status == 0);
    REQUIRE((process::files_of(other / "out") == expected));
    // The directory holds results of another run.
    other.write("short.toml", pair_text(5));
    REQUIRE(other.run("--quiet --force short.toml").status == 0);
    REQUIRE(other.run(from(whole / "out/checkpoint.bin")).status == 2);
    REQUIRE(other.run("--force " + from(whole / "out/checkpoint.bin")).status == 0);
    REQUIRE((process::files_of(other / "out") == expected));
    // A copied checkpoint finds the files of its run in the output directory.
    program::fs::copy_file(whole / "out/checkpoint.bin", other / "copy.bin");
    REQUIRE(other.run(from(other / "copy.bin")).status == 0);
    REQUIRE((process::files_of(other / "out") == expected));
    // Without these files, or with others, it is refused, and nothing changes.
    auto const refused = [&](std::string const& what) {
        auto const before = process::files_of(other / "");
        auto const ran = other.run(from(other / "copy.bin"));
        INFO(ran.err);
        REQUIRE(ran.status == 2);
        REQUIRE_THAT(ran.err, contains_text("--restart = ") && contains_text(what));
        REQUIRE(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
        REQUIRE((process::files_of(other / "") == before));
    };
    auto probes = program::read_file(other / "out/probes.csv");
    other.write("out/probes.csv", probes.substr(0, 100));
    refused("probes.csv does not begin with the");
    auto changed = probes;
    changed[60] = changed[60] == '1' ? '2' : '1';
    other.write("out/probes.csv", changed);
    refused("probes.csv does not begin with the");
    other.write("out/probes.csv", probes);
    program::fs::remove(other / "out/particles-000000000030.vtp");
    refused("particles-000000000030.vtp is missing; particles.pvd lists it");
}

TEST_CASE("a checkpoint holds the state but no history: its size does not grow", "[program][directory][checkpoint]") {
    std::vector<std::size_t> sizes;
    for (long long const steps : {100, 20000}) {
        folder const here("past");
        here.write("case.toml", pair_text(steps, "vtk_every = " + std::to_string(steps / 20) + "\ncheckpoint_every = " +
                                                     std::to_string(steps) + "\n"));
        REQUIRE(here.run("--quiet case.toml").status == 0);
        REQUIRE(table(here / "out/probes.csv").rows.size() == std::size_t(steps) + 1);
        sizes.push_back(program::fs::file_size(here / "out/checkpoint.bin"));
    }
    REQUIRE(sizes[0] == sizes[1]);
}

TEST_CASE("rows are in the file before the run ends", "[program][directory]") {
    folder const here("growing");
    here.write("long.toml", pair_text(for_ever, "checkpoint_every = 500\n"));
    long_run run(here, "long.toml");
    for (int k = 0; k < 600 && !holds(here.files(), "out/checkpoint.bin"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    run.send(SIGKILL);
    run.wait();
    auto const rows = table(here / "out/probes.csv").rows;
    REQUIRE(rows.size() >= 501);
    REQUIRE(rows.back().size() == 3);
    REQUIRE(program::read_file(here / "out/probes.csv").back() == '\n');
}

TEST_CASE("a file that cannot be written ends the run with status 1 and its name", "[program][directory]") {
    folder const here("full");
    here.write("case.toml", pair_text(20000));
    // ulimit -f counts blocks of 512 bytes or 1 KiB; without SIGXFSZ a write beyond it fails.
    std::string const command = "cd '" + (here / "").string() + "' && (trap '' XFSZ; ulimit -f 64; '" LACUNA_RUN_PROGRAM
                                "' case.toml) > said 2>&1";
    int const status = std::system(command.c_str());
    REQUIRE(WEXITSTATUS(status) == 1);
    REQUIRE_THAT(program::read_file(here / "said"), contains_text("out/probes.csv"));
    REQUIRE(program::read_file(here / "out/probes.csv").back() == '\n');
    REQUIRE(here.files() == std::vector<std::string>{"case.toml", "out/events.csv", "out/probes.csv", "said"});
}
