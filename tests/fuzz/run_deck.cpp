// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <unistd.h>

#include <lacuna/core/error.hpp>

#include "fuzz/corpus.hpp"
#include "fuzz/deck_mutator.hpp"
#include "fuzz/run_deck/facts.hpp"
#include "runner.hpp"

/// \file
/// Reads decks of lacuna-run and runs them for a few steps, as the program does. LLVMFuzzerTestOneInput() lists the
/// promises that it checks.

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

namespace fs = std::filesystem;
using lacuna_run::scenario;

constexpr long long last_step = 24, checkpoint_step = 13;
std::string scratch;
std::vector<std::string> accepted; ///< decks that were run: most mutations of refused decks are refused again

/// True for small scenarios, which take milliseconds.
bool is_small(scenario const& s) {
    return s.particles.size() <= 64 && s.bonds.pairs.size() <= 240 && s.walls.size() <= 8 && s.loads.size() <= 16 &&
           s.materials.size() <= 8 && s.probes.size() <= 16 && (!s.fluid || s.fluid->pores.size() <= 64);
}

/// \param fine true: reduces the automatic step, so that the energy balance closes well
void shorten(scenario& s, bool fine) {
    if (fine) s.simulation.safety = std::min(s.simulation.safety, 0.005);
    s.simulation.end_time.reset();
    s.simulation.steps = std::min(s.simulation.steps.value_or(last_step), last_step);
    s.simulation.threads = 1;
    s.output.directory = scratch + "/out";
    s.output.checkpoint_every = checkpoint_step;
    if (s.output.vtk_every > 0) s.output.vtk_every = std::max(s.output.vtk_every, 9LL);
    if (s.output.picture_every > 0) s.output.picture_every = std::max(s.output.picture_every, 16LL);
}

/// The same scenario with the particles in reverse order.
scenario reversed(scenario s) {
    auto const last = std::int32_t(s.particles.size()) - 1;
    auto const reverse = [](auto& list) { std::reverse(list.begin(), list.end()); };
    reverse(s.particles.position);
    reverse(s.particles.velocity);
    reverse(s.particles.spin);
    reverse(s.particles.radius);
    reverse(s.particles.density);
    reverse(s.particles.material);
    for (auto& f : s.particles.fix)
        for (auto& id : f.particles) id = last - id;
    for (auto& l : s.loads)
        for (auto& id : l.particles) id = last - id;
    for (auto& p : s.bonds.pairs)
        for (auto& id : p) id = last - id;
    s.probes.clear();
    return s;
}

struct outcome {
    std::string message; ///< of an unstable run; empty: the run completed
    std::map<std::string, std::string> files;
    std::optional<fuzz::run_facts> last;  ///< final state, if the run has particles
    std::optional<fuzz::step_facts> seen; ///< summary of all steps, if they were observed
};

std::map<std::string, std::string> files_in(std::string const& directory) {
    std::map<std::string, std::string> files;
    for (auto const& entry : fs::directory_iterator(directory)) {
        std::ifstream file(entry.path(), std::ios::binary);
        files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return files;
}

enum class look { at_end, at_each_step };

/// Runs a scenario as the program does.
/// \param checkpoint file from which to resume; empty: from the start
outcome play(scenario const& s, look how, std::string const& checkpoint = "") {
    auto const run = lacuna_run::make_runner(s);
    lacuna_run::resumption start;
    if (!checkpoint.empty()) {
        run->restore(checkpoint);
        start = lacuna_run::find_earlier_part(s, checkpoint, run->log(), run->steps());
    }
    outcome done;
    auto const* watched = dynamic_cast<fuzz::watched const*>(run.get());
    long long const left = *s.simulation.steps - run->steps();
    if (watched && how == look::at_each_step && left > 0) done.seen = watched->rehearse(left);
    lacuna_run::results out(s, checkpoint.empty(), true, start);
    out.begin();
    try {
        fuzz::expect(run->run(out), "a run without signals completes");
        out.finish(run->summary("steps", ""), true);
    } catch (lacuna::unstable_run const& bad) {
        done.message = bad.what();
        out.finish(run->summary("unstable", bad.what()), true);
    }
    if (watched) done.last = watched->facts(done.message.empty());
    done.files = files_in(s.output.directory);
    return done;
}

/// True if only the particles and the fluid between them act on particles.
bool is_free(scenario const& s) {
    return s.walls.empty() && s.loads.empty() && s.particles.fix.empty() &&
           s.simulation.gravity == lacuna_run::point{} && s.simulation.local_damping == 0 &&
           s.simulation.mass_damping == 0;
}

void check_steps(scenario const& s, outcome const& done) {
    auto const& seen = *done.seen;
    fuzz::expect(seen.message == done.message && seen.hash == done.last->hash, "the same run twice has the same end");
    fuzz::expect(seen.finite, "a run that is not reported as unstable is finite");
    double const steps = double(*s.simulation.steps);
    if (is_free(s))
        fuzz::expect(seen.momentum_change <= 8 * steps * seen.momentum_rounding,
                     "the momentum of free particles is conserved");
    if (s.simulation.allow_unstable_step) return;
    // The error of the ledger is of second order in the step, except for slip, and for dashpots, whose forces start and
    // stop abruptly.
    double const part = seen.share * (8 * seen.share + 4 * s.simulation.viscous_damping);
    double const most =
        std::min(0.5, part) * seen.energy + 4 * seen.share * seen.spent + 64 * steps * seen.energy_rounding;
    fuzz::expect(seen.residual <= most, "the energy balance closes");
}

void check_restart(scenario const& s, outcome const& whole) {
    std::string const checkpoint = s.output.directory + "/checkpoint.bin";
    if (!fs::exists(checkpoint)) return;
    outcome const resumed = play(s, look::at_end, checkpoint);
    fuzz::expect(resumed.message == whole.message, "a resumed run ends as the whole one");
    fuzz::expect(resumed.files == whole.files, "a resumed run leaves the files of the whole one");
    if (whole.last) fuzz::expect(resumed.last->hash == whole.last->hash, "a resumed run has the bits of the whole one");
}

void check_order(scenario const& s, outcome const& whole) {
    outcome const other = play(reversed(s), look::at_end);
    fuzz::expect(other.message.empty() == whole.message.empty(), "a run ends alike with another order of particles");
    if (!whole.message.empty()) return; // an unstable run may have not-a-numbers
    auto const &a = whole.last->state, &b = other.last->state;
    fuzz::expect(std::equal(a.begin(), a.end(), b.rbegin(), b.rend()),
                 "the order of particles does not change the bits");
}

/// Stores the last 512 accepted decks.
void keep(std::string deck) {
    static std::size_t next = 0;
    if (accepted.size() < 512)
        accepted.push_back(std::move(deck));
    else
        accepted[next++ % accepted.size()] = std::move(deck);
}

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

void check_text(std::string_view text) {
    fuzz::expect(!text.empty() && text.find('\n') == text.npos, "a message has one line");
}
/// "field = value: must be rule", or the position of an error in TOML's syntax.
void check_refusal(std::string_view text) {
    check_text(text);
    bool const syntax = begins(text, "deck:") || begins(text, "not a TOML file: ");
    fuzz::expect(syntax || text.find(": must ") != text.npos, "a refusal states the rule");
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    std::error_code none;
    fs::path const memory = "/dev/shm";
    scratch = ((fs::is_directory(memory, none) ? memory : fs::temp_directory_path()) /
               ("lacuna_run_deck." + std::to_string(::getpid())))
                  .string();
    std::atexit([] {
        std::error_code ignored;
        fs::remove_all(scratch, ignored);
    });
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    if (seed % 16 == 0) return LLVMFuzzerMutate(data, size, most);
    std::string deck(reinterpret_cast<char const*>(data), size);
    if (seed % 4 != 0 && !accepted.empty()) deck = accepted[seed / 4 % accepted.size()];
    std::string const changed = fuzz::deck_mutator(seed)(deck);
    std::size_t const length = std::min(changed.size(), most);
    std::copy_n(changed.begin(), length, data);
    return length;
}

/// A refusal is one line that states the rule; no exception other than a refusal or an unstable run is thrown. A run
/// ends with finite numbers or is reported as unstable. The energy balance closes within the order of the scheme. The
/// momentum of free particles is conserved. A run has the same bits when it is repeated, resumed from a checkpoint, or
/// given its particles in another order; a resumed run also has the same files. Numbers of threads are not compared: so
/// few particles are not distributed over threads.
extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    try {
        scenario s = lacuna_run::read_scenario({reinterpret_cast<char const*>(data), size}, "deck", "");
        if (!is_small(s)) return 0;
        shorten(s, size % 2 == 0);
        outcome const whole = play(s, look::at_each_step);
        if (whole.message.empty() && whole.seen) keep({reinterpret_cast<char const*>(data), size});
        if (!whole.message.empty()) check_text(whole.message);
        if (whole.seen) check_steps(s, whole);
        check_restart(s, whole);
        if (whole.last) check_order(s, whole);
    } catch (fuzz::other_kind const&) {
    } catch (lacuna_run::refusal const& bad) {
        check_refusal(bad.what());
    } catch (std::invalid_argument const& bad) {
        check_refusal(bad.what());
    }
    return 0;
}
