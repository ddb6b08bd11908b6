// SPDX-License-Identifier: BSD-3-Clause
//
// kill_programs run PROGRAM SCRATCH KILLS TERMS: sends lacuna-run SIGKILL and SIGTERM at random instants, of first parts and of
// resumed ones, and takes them up again until they are done. Then the directory must hold the files of the run that nobody
// stopped, byte for byte.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>

#include "process.hpp"

namespace {

using process::fs::path;

/// Discs on a floor that are pressed until bonds break, with water between them: all files that a run has.
std::string deck() {
    std::string places;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x)
            places += (places.empty() ? "[" : ", [") + std::to_string(x + 0.5 * (y % 2)) + ", " + std::to_string(0.8660254 * y) + "]";
    return "[simulation]\nsteps = 3000\ntime_step = 5e-4\n"
           "[materials.disc]\ndensity = 1000.0\nnormal_stiffness = 1e6\nshear_stiffness = 5e5\nfriction = 0.2\n"
           "tensile_strength = 2e3\nshear_strength = 2e3\n[particles]\nposition = [" + places + "]\nradius = 0.5\n"
           "material = \"disc\"\nfix = [{ particles = [0, 1, 2, 3, 4, 5], axes = \"xyr\" }]\n[bonds]\ntouching = true\ngap = 1e-5\n"
           "[[loads]]\npressure = 2e4\nmargin_diameters = 1\nramp_time = 0.2\n"
           "[fluid]\nbulk_modulus = 1e6\nconductivity = 1e-3\n"
           "aperture = { law = \"contact_force\", a0 = 1e-2, F0 = 1e4, gap_multiplier = 1.0 }\n"
           "[[probes]]\nquantity = \"position.y\"\nparticle = 20\n[[probes]]\nquantity = \"energy.friction\"\nevery = 7\n"
           "[[probes]]\nquantity = \"count.broken_shear\"\n[output]\nvtk_every = 250\ncheckpoint_every = 400\n";
}

struct failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};
void require(bool holds, std::string const& what) {
    if (!holds) throw failure(what);
}
bool ends_with(std::string const& text, std::string const& ending) {
    return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// What is tried.
struct subject {
    std::vector<std::string> begin;            ///< words of the first part
    std::vector<std::string> (*next)(subject const&, path const&) = nullptr; ///< of the part after one that was stopped
    void (*look)(std::map<std::string, std::string> const& left, std::map<std::string, std::string> const& whole, int status) = nullptr;
    bool (*counts)(std::string const&) = nullptr; ///< whether a file is compared
};

std::map<std::string, std::string> compared(subject const& s, path const& out) {
    auto all = process::files_of(out);
    for (auto at = all.begin(); at != all.end();) at = s.counts(at->first) ? std::next(at) : all.erase(at);
    return all;
}

/// What is right in what lacuna-run leaves when it is stopped.
void look_at_run(std::map<std::string, std::string> const& left, std::map<std::string, std::string> const& whole, int status) {
    for (char const* log : {"probes.csv", "events.csv"}) {
        auto const at = left.find(log);
        if (at == left.end()) continue;
        require(at->second.empty() || at->second.back() == '\n', std::string(log) + " ends within a line");
        require(whole.at(log).compare(0, at->second.size(), at->second) == 0, std::string(log) + " is not the beginning of the whole");
    }
    for (auto const& [name, bytes] : left) {
        if (ends_with(name, ".pvd")) require(ends_with(bytes, "</VTKFile>\n"), name + " is not whole");
        if (ends_with(name, ".vtp") && whole.count(name)) require(whole.at(name) == bytes, name + " is not that of the whole run");
    }
    if (status < 0) {
        // Killed when all was written, or before it took up what another signal had stopped.
        if (left.count("summary.json") == 1 && left.at("summary.json") != whole.at("summary.json"))
            require(left.at("summary.json").find("\"ended\": \"stopped by SIGTERM\"") != std::string::npos, "a killed run has a summary");
        return;
    }
    require(status == 128 + SIGTERM, "exit status " + std::to_string(status) + " after SIGTERM");
    for (auto const& [name, bytes] : left) require(!ends_with(name, ".part") && name != "lacuna.lock", name + " is left after SIGTERM");
    require(left.at("summary.json").find("\"ended\": \"stopped by SIGTERM\"") != std::string::npos, "the summary is not marked");
    // Nothing is lost: the last row is that of the step in which it stopped.
    auto const& rows = left.at("probes.csv");
    auto const last = rows.rfind('\n', rows.size() - 2) + 1;
    std::string const step = rows.substr(last, rows.find(',', last) - last);
    require(left.at("summary.json").find("\"steps\": " + step + ",") != std::string::npos, "rows are missing up to the stop");
    require(left.count("checkpoint.bin") == 1, "no checkpoint after SIGTERM");
}

subject of_run(path const& program) {
    subject s;
    s.begin = {program.string(), "--quiet", "--force", "deck.toml"};
    s.next = [](subject const& me, path const& out) -> std::vector<std::string> {
        if (!process::fs::exists(out / "checkpoint.bin")) return me.begin;
        return {me.begin[0], "--quiet", "--restart", "out/checkpoint.bin", "deck.toml"};
    };
    s.look = look_at_run;
    s.counts = [](std::string const&) { return true; };
    return s;
}

struct tally {
    int killed = 0, stopped = 0, resumed = 0;
};

/// One directory: begun, stopped by signals at random instants, at last left alone.
void try_one(subject const& s, path const& folder, std::map<std::string, std::string> const& whole, double& length, std::mt19937_64& random,
             int& kills, int& terms, tally& count) {
    process::fs::remove_all(folder / "out");
    auto words = s.begin;
    for (int part = 0;; ++part) {
        process::running program(words, folder);
        // Half of the directories are stopped more than once.
        bool const stop = kills + terms > 0 && (part == 0 || random() % 2 == 0);
        bool const hard = stop && int(random() % std::uint64_t(kills + terms)) < kills;
        if (stop) {
            usleep(useconds_t(1e6 * length * double(random() >> 11) * 0x1p-53));
            program.send(hard ? SIGKILL : SIGTERM);
        }
        int const status = program.wait();
        if (status == 0) break;
        require(stop, "it ended with " + std::to_string(status) + ": " + process::read_all(folder.string() + ".said"));
        // Before it can catch it, a signal ends it as any other program: then nothing is begun.
        if (hard || status > 0) s.look(process::files_of(folder / "out"), whole, status);
        if (!hard && status < 0 && part == 0) require(process::files_of(folder / "out").size() <= 1, "stopped by SIGTERM without a word");
        --(hard ? kills : terms);
        ++(hard ? count.killed : count.stopped);
        count.resumed += part > 0;
        words = s.next(s, folder / "out");
    }
    auto const left = compared(s, folder / "out");
    require(left == whole, "other files than those of the whole run:" + process::difference(left, whole));
}

void check(subject const& s, path const& folder, int kills, int terms) {
    auto const start = std::chrono::steady_clock::now();
    {
        process::running program(s.begin, folder);
        int const status = program.wait();
        require(status == 0, "the undisturbed run failed: " + process::read_all(folder.string() + ".said"));
    }
    double length = process::seconds_since(start);
    auto const whole = compared(s, folder / "out");
    std::mt19937_64 random(20240229);
    tally count;
    for (int n = 0; kills + terms > 0; ++n) {
        int const before = kills + terms;
        try_one(s, folder, whole, length, random, kills, terms, count);
        if (kills + terms == before) length *= 0.9; // it was faster than the first one
        require(n < 10000, "no signal comes in time");
    }
    std::printf("%d killed, %d stopped, %d of them resumed ones; all ended with the same %zu files\n", count.killed, count.stopped,
                count.resumed, whole.size());
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 6) return 2;
    path const program = process::fs::absolute(argv[2]), folder = process::fs::absolute(argv[3]) / argv[1];
    try {
        process::fs::remove_all(folder);
        process::fs::create_directories(folder);
        std::ofstream(folder / "deck.toml") << deck();
        check(of_run(program), folder, std::atoi(argv[4]), std::atoi(argv[5]));
        process::fs::remove_all(folder);
    } catch (std::exception const& bad) {
        std::printf("%s: %s\n", folder.c_str(), bad.what());
        return 1;
    }
}
