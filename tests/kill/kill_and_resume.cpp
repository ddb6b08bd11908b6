// SPDX-License-Identifier: BSD-3-Clause

#include <chrono>
#include <csignal>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <lacuna/observe/crack_record.hpp>
#include <lacuna/simulation/checkpoint.hpp>

/// \file
/// Runs a child process that writes a checkpoint after each step. Kills it (SIGKILL) at 50 random instants, and each
/// time resumes from the file that it leaves. The final state must have the hash of an undisturbed run.

namespace {

using model = lacuna::default_model<2>;
using record = lacuna::crack_record<lacuna::break_event<2>>;
constexpr long long steps = 400;

/// A net of bonded discs that random velocities tear apart.
lacuna::simulation<model> make() {
    lacuna::packing<double, 2> discs;
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 20; ++x) {
            auto const k = discs.add({x + 0.01 * (y % 3), double(y)}, 0.49 + 0.001 * (x % 7));
            if (x > 0) discs.bonds.push_back({k - 1, k});
            if (y > 0 && x % 3 != 0) discs.bonds.push_back({k - 20, k});
        }
    lacuna::simulation_parameters<model> p;
    p.materials[0] = {1000, {1e5, 7e4, 0.4}, {1e5, 7e4, 3e3, 3e3}};
    p.interactions.skin = 0.05;
    p.interactions.initial_contact_tolerance = 0.05;
    p.time_step = 0.01;
    lacuna::simulation<model> run(discs, p);
    for (std::size_t k = 0; k < run.size(); ++k)
        run.set_velocity(k, {0.3 * double(k % 5) - 0.6, 0.2 * double(k % 4) - 0.3});
    return run;
}

/// Hash of the final state and the number of cracks.
std::uint64_t outcome(lacuna::simulation<model> const& run, record const& cracks) {
    return lacuna::state_hash(run) ^ (cracks.events().size() * 0x9e3779b97f4a7c15u);
}

[[noreturn]] void run_as_child(std::string const& path) {
    auto run = make();
    record cracks;
    run.run(steps, cracks, lacuna::checkpoint_every(1, path, cracks));
    _exit(0);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int check(std::string const& path) {
    auto whole = make();
    record all;
    whole.run(steps, all);
    std::uint64_t const expected = outcome(whole, all);
    if (all.events().size() < 10 || whole.pairs().neighbors().build_count() < 5)
        throw std::runtime_error("too few bonds break, or too few lists are built, to prove anything");

    std::mt19937_64 random(20240229);
    double length = 0; // of an undisturbed child, s
    int killed = 0, between = 0;
    long long first = steps, last = 0;
    for (int n = -1; killed < 50; ++n) {
        auto const start = std::chrono::steady_clock::now();
        pid_t const child = fork();
        if (child < 0) throw std::runtime_error("cannot fork");
        if (child == 0) run_as_child(path);
        if (n >= 0) {
            usleep(useconds_t(1e6 * length * double(random() >> 11) * 0x1p-53));
            kill(child, SIGKILL);
        }
        int status = 0;
        if (waitpid(child, &status, 0) != child) throw std::runtime_error("cannot wait");
        if (n < 0) {
            length = seconds_since(start);
            if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error("the undisturbed run failed");
        }
        killed += WIFSIGNALED(status) ? 1 : 0;
        // The child ended before the signal: shorten the delays.
        if (n >= 0 && !WIFSIGNALED(status)) length *= 0.9;

        auto run = make();
        record cracks;
        lacuna::load_checkpoint(path, run, cracks);
        first = std::min(first, run.steps());
        last = std::max(last, run.steps());
        between += run.steps() < steps ? 1 : 0;
        if (run.steps() < steps) run.run(steps - run.steps(), cracks);
        if (outcome(run, cracks) != expected) {
            std::printf("kill %d: the resumed run has another final state\n", n);
            return 1;
        }
    }
    std::printf("%d children were killed, %d left a checkpoint of a step before the end, from %lld to %lld; "
                "all resumed runs have the same final state with %zu cracks\n",
                killed, between, first, last, all.events().size());
    return between > 0 ? 0 : 1;
}

} // namespace

int main() {
    std::string const path = "kill_and_resume.bin";
    int result = 1;
    try {
        result = check(path);
    } catch (std::exception const& e) {
        std::printf("%s\n", e.what());
    }
    std::remove(path.c_str());
    std::remove((path + ".part").c_str());
    return result;
}
