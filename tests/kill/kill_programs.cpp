// SPDX-License-Identifier: BSD-3-Clause
//
// kill_programs run|study PROGRAM SCRATCH KILLS TERMS: sends SIGKILL and SIGTERM to lacuna-run, or to cartilage's
// study, at random instants. It resumes and stops them again until they complete. Then the directory must have the
// files of an undisturbed run, byte for byte. While a program runs, a second one must be refused its directory.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <utility>

#include "process.hpp"

namespace {

using process::fs::path;

/// Discs on a floor, with water between them, that are pressed until bonds break. The run writes every kind of file.
std::string deck() {
    std::string positions;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x)
            positions += (positions.empty() ? "[" : ", [") + std::to_string(x + 0.5 * (y % 2)) + ", " +
                         std::to_string(0.8660254 * y) + "]";
    return "[simulation]\nsteps = 3000\ntime_step = 5e-4\n"
           "[materials.disc]\ndensity = 1000.0\nnormal_stiffness = 1e6\nshear_stiffness = 5e5\nfriction = 0.2\n"
           "tensile_strength = 2e3\nshear_strength = 2e3\n[particles]\nposition = [" +
           positions +
           "]\nradius = 0.5\n"
           "material = \"disc\"\nfix = [{ particles = [0, 1, 2, 3, 4, 5], axes = \"xyr\" }]\n"
           "[bonds]\ntouching = true\ngap = 1e-5\n"
           "[[loads]]\npressure = 2e4\nmargin_diameters = 1\nramp_time = 0.2\n"
           "[fluid]\nbulk_modulus = 1e6\nconductivity = 1e-3\n"
           "aperture = { law = \"contact_force\", a0 = 1e-2, F0 = 1e4, gap_multiplier = 1.0 }\n"
           "[[probes]]\nquantity = \"position.y\"\nparticle = 20\n"
           "[[probes]]\nquantity = \"energy.friction\"\nevery = 7\n"
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

/// A program under test.
struct subject {
    words begin;                                ///< command of the first part
    std::function<words(path const& out)> next; ///< command of a part that continues a stopped one
    std::function<void(files const& left, files const& whole, int status)> look; ///< checks the files of a stopped part
    path before{}; ///< initial content of its directory; empty: none
    /// True for files to compare.
    std::function<bool(std::string const& name)> counts = [](std::string const&) { return true; };
};

files compared(subject const& s, path const& out) {
    auto all = process::files_of(out);
    for (auto at = all.begin(); at != all.end();) at = s.counts(at->first) ? std::next(at) : all.erase(at);
    return all;
}

/// True if a kill during a write may have left a part of it: the system writes page by page.
bool is_torn(std::string const& bytes, int status) {
    return status < 0 && bytes.size() % std::size_t(sysconf(_SC_PAGESIZE)) == 0;
}

/// Checks the files that lacuna-run leaves when it is stopped.
void look_at_run(files const& left, files const& whole, int status) {
    for (char const* log : {"probes.csv", "events.csv"}) {
        auto const at = left.find(log);
        if (at == left.end()) continue;
        require(at->second.empty() || at->second.back() == '\n' || is_torn(at->second, status),
                std::string(log) + " has an incomplete last line");
        require(whole.at(log).compare(0, at->second.size(), at->second) == 0,
                std::string(log) + " is not the beginning of the complete file");
    }
    for (auto const& [name, bytes] : left) {
        if (ends_with(name, ".pvd"))
            require(ends_with(bytes, "</VTKFile>\n") || is_torn(bytes, status), name + " is incomplete");
        if (ends_with(name, ".vtp") && whole.count(name))
            require(whole.at(name) == bytes, name + " is not that of the undisturbed run");
    }
    if (status < 0) {
        // It was killed after it had written everything, or before it continued a part that another signal had stopped.
        if (left.count("summary.json") == 1 && left.at("summary.json") != whole.at("summary.json"))
            require(left.at("summary.json").find("\"ended\": \"stopped by SIGTERM\"") != std::string::npos,
                    "a killed run has a summary");
        return;
    }
    require(status == 128 + SIGTERM, "exit status " + std::to_string(status) + " after SIGTERM");
    for (auto const& [name, bytes] : left)
        require(!ends_with(name, ".part") && name != "lacuna.lock", name + " is left after SIGTERM");
    require(left.at("summary.json").find("\"ended\": \"stopped by SIGTERM\"") != std::string::npos,
            "the summary is not marked");
    // No row is lost: the last one is that of the step in which it stopped.
    auto const& rows = left.at("probes.csv");
    auto const last = rows.rfind('\n', rows.size() - 2) + 1;
    std::string const step = rows.substr(last, rows.find(',', last) - last);
    require(left.at("summary.json").find("\"steps\": " + step + ",") != std::string::npos,
            "rows are missing up to the stop");
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

bool is_cached_run(std::string const& name) { return name.rfind("cache/", 0) == 0; }
bool has_cached_runs(files const& all) {
    return std::any_of(all.begin(), all.end(),
                       [](auto const& file) { return is_cached_run(file.first) && !ends_with(file.first, ".part"); });
}

/// Checks the files that a study leaves when it is stopped.
/// \param other files of the study that it replaces
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
        bool const is_new = now != whole.end() && now->second == bytes,
                   is_old = before != other.end() && before->second == bytes;
        require(is_new || is_old, name + " belongs neither to this study nor to the one before");
        results += !is_cached_run(name);
        any_new = any_new || (is_new && !is_old && !is_cached_run(name));
        any_old = any_old || (is_old && !is_new && !is_cached_run(name));
    }
    require(!any_new || !any_old, "results of two studies are mixed");
    for (auto const& [name, bytes] : whole) of_whole += !is_cached_run(name);
    for (auto const& [name, bytes] : other) of_other += !is_cached_run(name);
    auto const mark = left.find("unfinished-study.json");
    bool const marked = mark != left.end(), is_whole = results == (any_old ? of_other : of_whole);
    require(marked || is_whole || (results == 0 && !has_cached_runs(left)), "an incomplete study is not marked");
    if (status < 0) return;
    require(status == 128 + SIGTERM, "exit status " + std::to_string(status) + " after SIGTERM");
    // Old results stay, complete, until there are new ones.
    require(marked ? mark->second.find("stopped by SIGTERM") != std::string::npos : any_old, "the study is not marked");
}

/// \param before the directory of another study, which this one replaces; empty: none
subject of_study(path const& program, path const& before) {
    words begin{
        program.string(), "study", "--quick",  "--zones", "surface,deep", "--seeds", "1",       "--duration", "0.3",
        "--length",       "84",    "--height", "42",      "--jobs",       "2",       "--quiet", "--out",      "out"};
    if (!before.empty()) begin.push_back("--force");
    auto const other = process::files_of(before);
    subject s;
    s.begin = begin;
    s.next = [begin](path const&) { return begin; };
    s.look = [other](files const& left, files const& whole, int status) { look_at_study(left, whole, other, status); };
    s.before = before;
    s.counts = [other](std::string const& name) { return !is_cached_run(name) || other.count(name) == 0; };
    return s;
}

struct tally {
    int killed = 0, stopped = 0, resumed = 0;
};

void begin_directory(subject const& s, path const& folder) {
    process::fs::remove_all(folder / "out");
    if (!s.before.empty()) process::fs::copy(s.before, folder / "out", process::fs::copy_options::recursive);
}

/// One directory: starts a run, stops it by signals at random instants, and finally lets it complete.
void try_one(subject const& s, path const& folder, files const& whole, double& length, std::mt19937_64& random,
             int& kills, int& terms, tally& count) {
    begin_directory(s, folder);
    auto command = s.begin;
    for (int part = 0;; ++part) {
        process::running program(command, folder);
        // Half of the resumed parts are stopped, too.
        bool const stop = kills + terms > 0 && (part == 0 || random() % 2 == 0);
        bool const hard = stop && int(random() % std::uint64_t(kills + terms)) < kills;
        if (stop) {
            double const longest = part == 0 ? length : 0.5 * length; // a resumed part is shorter
            usleep(useconds_t(1e6 * longest * double(random() >> 11) * 0x1p-53));
            program.send(hard ? SIGKILL : SIGTERM);
        }
        int const status = program.wait();
        if (status == 0) break;
        require(stop, "it ended with " + std::to_string(status) + ": " + process::read_all(folder.string() + ".said"));
        // Before it has installed its handler, SIGTERM ends it at once: then it has written nothing.
        if (hard || status > 0) s.look(process::files_of(folder / "out"), whole, status);
        if (!hard && status < 0 && part == 0 && s.before.empty())
            require(process::files_of(folder / "out").size() <= 1,
                    "SIGTERM ended it at once, but it has written files");
        --(hard ? kills : terms);
        ++(hard ? count.killed : count.stopped);
        count.resumed += part > 0;
        command = s.next(folder / "out");
    }
    auto const left = compared(s, folder / "out");
    require(left == whole, "files differ from those of the undisturbed run:" + process::difference(left, whole));
}

/// While a first program owns the directory, a second one is refused, with the first one's number. The first completes.
void check_owner(subject const& s, path const& folder, files const& whole) {
    begin_directory(s, folder);
    path const elsewhere = folder / "second";
    process::fs::remove_all(elsewhere);
    process::fs::create_directories(elsewhere);
    if (process::fs::exists(folder / "deck.toml"))
        process::fs::copy_file(folder / "deck.toml", elsewhere / "deck.toml");
    process::fs::create_directory_symlink(folder / "out", elsewhere / "out");
    process::running first(s.begin, folder);
    // Wait until the first one has written its number.
    path const lock = folder / "out" / "lacuna.lock";
    for (std::error_code none; !process::fs::exists(lock) || process::fs::file_size(lock, none) == 0;) usleep(1000);
    process::running second(s.begin, elsewhere);
    int const refused = second.wait();
    std::string const said = process::read_all(elsewhere.string() + ".said");
    require(refused == 2 && said.find("in use by process " + std::to_string(first.id()) + " ") != std::string::npos &&
                std::count(said.begin(), said.end(), '\n') == 1,
            "the second program was not refused: " + std::to_string(refused) + ", " + said);
    require(first.wait() == 0, "the first program failed while a second one was refused");
    auto const left = compared(s, folder / "out");
    require(left == whole, "beside a refused program the files differ:" + process::difference(left, whole));
}

/// \return the files of an undisturbed run
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
        if (kills + terms == before) length *= 0.9; // it ended before the signal
        require(n < 10000, "no signal arrives in time");
    }
    std::printf("%d killed, %d stopped, %d of them resumed; all ended with the same %zu files\n", count.killed,
                count.stopped, count.resumed, whole.size());
    return whole;
}

void check_run(path const& program, path const& folder, int kills, int terms) {
    std::ofstream(folder / "deck.toml") << deck();
    check(of_run(program), folder, kills, terms);
}

void check_study(path const& program, path const& folder, int kills, int terms) {
    auto const first = check(of_study(program, {}), folder, (kills + 1) / 2, terms / 2);
    auto other = of_study(program, {}).begin;
    other.push_back("--dry");
    path const before = folder / "before";
    process::fs::create_directories(before);
    process::running dry(other, before);
    require(dry.wait() == 0, "the other study failed: " + process::read_all(before.string() + ".said"));
    auto const replaced = check(of_study(program, before / "out"), folder, kills / 2, (terms + 1) / 2);
    require(replaced == first,
            "a study that replaces another one has other files:" + process::difference(replaced, first));
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
