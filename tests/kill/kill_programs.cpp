// SPDX-License-Identifier: BSD-3-Clause
//
// kill_programs run|study PROGRAM SCRATCH KILLS TERMS: sends lacuna-run, or cartilage's study, SIGKILL and SIGTERM at random
// instants, of first parts and of resumed ones, and takes them up again until they are done. Then the directory must hold the
// files of the run that nobody stopped, byte for byte. While it runs, a second one is refused its directory.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <utility>

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

using files = std::map<std::string, std::string>;
using words = std::vector<std::string>;

/// What is tried.
struct subject {
    words begin;                                ///< of the first part
    std::function<words(path const& out)> next; ///< of the part after one that was stopped
    std::function<void(files const& left, files const& whole, int status)> look; ///< at what it left then
    path before{}; ///< a directory as which its own is there from the start; empty: none
    std::function<bool(std::string const& name)> counts = [](std::string const&) { return true; }; ///< whether a file is compared
};

files compared(subject const& s, path const& out) {
    auto all = process::files_of(out);
    for (auto at = all.begin(); at != all.end();) at = s.counts(at->first) ? std::next(at) : all.erase(at);
    return all;
}

/// Whether a kill within a write has left a part of it: the system writes page by page, and stops after one.
bool is_torn(std::string const& bytes, int status) { return status < 0 && bytes.size() % std::size_t(sysconf(_SC_PAGESIZE)) == 0; }

/// What is right in what lacuna-run leaves when it is stopped.
void look_at_run(files const& left, files const& whole, int status) {
    for (char const* log : {"probes.csv", "events.csv"}) {
        auto const at = left.find(log);
        if (at == left.end()) continue;
        require(at->second.empty() || at->second.back() == '\n' || is_torn(at->second, status), std::string(log) + " ends within a line");
        require(whole.at(log).compare(0, at->second.size(), at->second) == 0, std::string(log) + " is not the beginning of the whole");
    }
    for (auto const& [name, bytes] : left) {
        if (ends_with(name, ".pvd")) require(ends_with(bytes, "</VTKFile>\n") || is_torn(bytes, status), name + " is not whole");
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
    words const begin{program.string(), "--quiet", "--force", "deck.toml"};
    subject s;
    s.begin = begin;
    s.next = [begin](path const& out) {
        if (!process::fs::exists(out / "checkpoint.bin")) return begin;
        return words{begin[0], "--quiet", "--restart", "out/checkpoint.bin", "deck.toml"};
    };
    s.look = look_at_run;
    return s;
}

bool is_kept_run(std::string const& name) { return name.rfind("cache/", 0) == 0; }
bool has_kept_runs(files const& all) {
    return std::any_of(all.begin(), all.end(), [](auto const& file) { return is_kept_run(file.first) && !ends_with(file.first, ".part"); });
}

/// What is right in what a study leaves when it is stopped. \param other the study whose results it replaces
void look_at_study(files const& left, files const& whole, files const& other, int status) {
    bool any_new = false, any_old = false;
    std::size_t results = 0, of_whole = 0, of_other = 0;
    for (auto const& [name, bytes] : left) {
        if (ends_with(name, ".part") || name == "lacuna.lock") {
            require(status < 0, name + " is left after SIGTERM");
            continue;
        }
        if (name == "unfinished-study.json") continue;
        auto const now = whole.find(name), before = other.find(name);
        bool const is_new = now != whole.end() && now->second == bytes, is_old = before != other.end() && before->second == bytes;
        require(is_new || is_old, name + " is neither that of this study nor that of the one before");
        results += !is_kept_run(name);
        any_new = any_new || (is_new && !is_old && !is_kept_run(name));
        any_old = any_old || (is_old && !is_new && !is_kept_run(name));
    }
    require(!any_new || !any_old, "results of two studies are mixed");
    for (auto const& [name, bytes] : whole) of_whole += !is_kept_run(name);
    for (auto const& [name, bytes] : other) of_other += !is_kept_run(name);
    auto const mark = left.find("unfinished-study.json");
    bool const marked = mark != left.end(), is_whole = results == (any_old ? of_other : of_whole);
    require(marked || is_whole || (results == 0 && !has_kept_runs(left)), "what is not whole has no mark");
    if (status < 0) return;
    require(status == 128 + SIGTERM, "exit status " + std::to_string(status) + " after SIGTERM");
    // Results that are to be replaced stay until there are new ones, and are whole.
    require(marked ? mark->second.find("stopped by SIGTERM") != std::string::npos : any_old, "the study is not marked");
}

/// \param before the directory of another study, which is replaced; empty: none
subject of_study(path const& program, path const& before) {
    words begin{program.string(), "study",    "--quick", "--zones", "surface,deep", "--seeds", "1",     "--duration", "0.3", "--length", "84",
                "--height",       "42",       "--jobs",  "2",       "--quiet",      "--out",   "out"};
    if (!before.empty()) begin.push_back("--force");
    auto const other = process::files_of(before);
    subject s;
    s.begin = begin;
    s.next = [begin](path const&) { return begin; };
    s.look = [other](files const& left, files const& whole, int status) { look_at_study(left, whole, other, status); };
    s.before = before;
    s.counts = [other](std::string const& name) { return !is_kept_run(name) || other.count(name) == 0; };
    return s;
}

struct tally {
    int killed = 0, stopped = 0, resumed = 0;
};

void begin_directory(subject const& s, path const& folder) {
    process::fs::remove_all(folder / "out");
    if (!s.before.empty()) process::fs::copy(s.before, folder / "out", process::fs::copy_options::recursive);
}

/// One directory: begun, stopped by signals at random instants, at last left alone.
void try_one(subject const& s, path const& folder, files const& whole, double& length, std::mt19937_64& random,
             int& kills, int& terms, tally& count) {
    begin_directory(s, folder);
    auto command = s.begin;
    for (int part = 0;; ++part) {
        process::running program(command, folder);
        // Half of the directories are stopped more than once.
        bool const stop = kills + terms > 0 && (part == 0 || random() % 2 == 0);
        bool const hard = stop && int(random() % std::uint64_t(kills + terms)) < kills;
        if (stop) {
            double const longest = part == 0 ? length : 0.5 * length; // of a resumed part less is left
            usleep(useconds_t(1e6 * longest * double(random() >> 11) * 0x1p-53));
            program.send(hard ? SIGKILL : SIGTERM);
        }
        int const status = program.wait();
        if (status == 0) break;
        require(stop, "it ended with " + std::to_string(status) + ": " + process::read_all(folder.string() + ".said"));
        // Before it can catch it, a signal ends it as any other program: then nothing is begun.
        if (hard || status > 0) s.look(process::files_of(folder / "out"), whole, status);
        if (!hard && status < 0 && part == 0 && s.before.empty())
            require(process::files_of(folder / "out").size() <= 1, "stopped by SIGTERM without a word");
        --(hard ? kills : terms);
        ++(hard ? count.killed : count.stopped);
        count.resumed += part > 0;
        command = s.next(folder / "out");
    }
    auto const left = compared(s, folder / "out");
    require(left == whole, "other files than those of the whole run:" + process::difference(left, whole));
}

/// While a first one has the directory, a second one is refused it by the number of the first, which ends as if alone.
void check_owner(subject const& s, path const& folder, files const& whole) {
    begin_directory(s, folder);
    path const elsewhere = folder / "second";
    process::fs::remove_all(elsewhere);
    process::fs::create_directories(elsewhere);
    if (process::fs::exists(folder / "deck.toml")) process::fs::copy_file(folder / "deck.toml", elsewhere / "deck.toml");
    process::fs::create_directory_symlink(folder / "out", elsewhere / "out");
    process::running first(s.begin, folder);
    // Until the first one has written who it is.
    path const lock = folder / "out" / "lacuna.lock";
    for (std::error_code none; !process::fs::exists(lock) || process::fs::file_size(lock, none) == 0;) usleep(1000);
    process::running second(s.begin, elsewhere);
    int const refused = second.wait();
    std::string const said = process::read_all(elsewhere.string() + ".said");
    require(refused == 2 && said.find("in use by process " + std::to_string(first.id()) + " ") != std::string::npos &&
                std::count(said.begin(), said.end(), '\n') == 1,
            "the second was not refused: " + std::to_string(refused) + ", " + said);
    require(first.wait() == 0, "beside a second one it failed");
    auto const left = compared(s, folder / "out");
    require(left == whole, "beside a second one it left other files:" + process::difference(left, whole));
}

/// \return the files that a run leaves which nobody stops
files check(subject const& s, path const& folder, int kills, int terms) {
    begin_directory(s, folder);
    auto const start = std::chrono::steady_clock::now();
    {
        process::running program(s.begin, folder);
        int const status = program.wait();
        require(status == 0, "the undisturbed run failed: " + process::read_all(folder.string() + ".said"));
    }
    double length = process::seconds_since(start);
    auto const whole = compared(s, folder / "out");
    check_owner(s, folder, whole);
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
    return whole;
}

void check_run(path const& program, path const& folder, int kills, int terms) {
    std::ofstream(folder / "deck.toml") << deck();
    check(of_run(program), folder, kills, terms);
}

void check_study(path const& program, path const& folder, int kills, int terms) {
    auto const fresh = check(of_study(program, {}), folder, (kills + 1) / 2, terms / 2);
    auto other = of_study(program, {}).begin;
    other.push_back("--dry");
    path const before = folder / "before";
    process::fs::create_directories(before);
    process::running dry(other, before);
    require(dry.wait() == 0, "the other study failed: " + process::read_all(before.string() + ".said"));
    auto const replaced = check(of_study(program, before / "out"), folder, kills / 2, (terms + 1) / 2);
    require(replaced == fresh, "in place of another study it has other files:" + process::difference(replaced, fresh));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 6) return 2;
    std::string const what = argv[1];
    path const program = process::fs::absolute(argv[2]), folder = process::fs::absolute(argv[3]) / what;
    try {
        process::fs::remove_all(folder);
        process::fs::create_directories(folder);
        (what == "study" ? check_study : check_run)(program, folder, std::atoi(argv[4]), std::atoi(argv[5]));
        process::fs::remove_all(folder);
    } catch (std::exception const& bad) {
        std::printf("%s: %s\n", folder.c_str(), bad.what());
        return 1;
    }
}
