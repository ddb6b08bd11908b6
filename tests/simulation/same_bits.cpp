// SPDX-License-Identifier: BSD-3-Clause

#include <numeric>
#include <string>

#include <lacuna/observe/crack_record.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"
#include "simulation/specimens.hpp"

/// \file
/// The full coupled cartilage run has the same bits on any number of threads and for particles in any order: by the
/// hash of the complete state, and of what an observer writes as a file.

namespace {

/// Output of a typical program: a line per hundred steps and per crack, with all digits.
struct journal {
    static constexpr lacuna::stage stages = lacuna::stage::step | lacuna::stage::breakage;
    static constexpr bool needs_energy = true;
    std::string text{};
    void add(double value) { text += lacuna::to_text(value) + ","; }
    void on_step(specimens::wet_run const& run) {
        if (run.steps() % 100 != 0) return;
        auto const& e = run.energy();
        for (double const value : {run.time(), e.kinetic, e.strain, e.friction, e.fracture, e.fluid_storage,
                                   e.fluid_viscous, e.fluid_outflow, e.external, e.residual()})
            add(value);
        for (double const p : run.flow().network().pressure) add(p);
        text += "\n";
    }
    void on_break(lacuna::break_event<2> const& e, specimens::wet_run const&) {
        for (double const value : {e.time, e.position[0], e.position[1], e.normal_force, e.shear_force, e.energy})
            add(value);
        text += e.mode == lacuna::bond_state::broken_in_tension ? "tension\n" : "shear\n";
    }
};

struct end_state {
    std::uint64_t state;
    std::string written;
    std::vector<lacuna::vec<double, 2>> position, velocity;
};

end_state play(lacuna::cartilage_specimen<double> const& s, int threads, bool keep_pair_forces = true) {
    auto run = specimens::make(s, threads, 1000, keep_pair_forces);
    journal text;
    run.run(1000, text);
    end_state o{lacuna::state_hash(run), text.text, {}, {}};
    for (std::size_t k = 0; k < run.size(); ++k) {
        o.position.push_back(run.position(k));
        o.velocity.push_back(run.velocity(k));
    }
    return o;
}

} // namespace

TEST_CASE("the coupled cartilage run: the same state and the same file with 1, 2 and 4 threads", "[determinism]") {
    auto const s = specimens::small();
    auto const one = play(s, 1);
    REQUIRE_THAT(one.written, contains_text("tension"));
    for (int const threads : {2, 4}) {
        auto const more = play(s, threads);
        REQUIRE(more.state == one.state);
        REQUIRE(more.written == one.written);
    }
}

TEST_CASE("the coupled cartilage run: the same whether pair forces are stored or not", "[determinism]") {
    auto const s = specimens::small();
    auto const stored = play(s, 1), discarded = play(s, 1, false);
    REQUIRE_THAT(stored.written, contains_text("tension"));
    REQUIRE(discarded.state == stored.state);
    REQUIRE(discarded.written == stored.written);
}

TEST_CASE("the coupled cartilage run: the same for particles and bonds in any order", "[determinism]") {
    auto const s = specimens::small();
    std::size_t const n = s.discs.size();
    auto const one = play(s, 1);
    // new number = step * old modulo n, step without a common factor with n.
    std::size_t step = n / 2 + 1;
    while (std::gcd(step, n) != 1) ++step;
    auto const number = [&](std::int32_t old) { return std::int32_t(std::size_t(old) * step % n); };
    auto other = s;
    for (std::size_t k = 0; k < n; ++k) {
        auto const to = std::size_t(number(std::int32_t(k)));
        other.discs.position[to] = s.discs.position[k];
        other.discs.radius[to] = s.discs.radius[k];
        other.discs.material[to] = s.discs.material[k];
    }
    other.discs.bonds.clear();
    for (auto b = s.discs.bonds.rbegin(); b != s.discs.bonds.rend(); ++b)
        other.discs.bonds.push_back({number((*b)[1]), number((*b)[0])});
    for (auto& id : other.fixed) id = number(id);
    for (auto& id : other.loaded) id = number(id);
    auto const again = play(other, 1);
    // The output names no particle: it is the same to the byte. Particles are the same up to their numbers.
    REQUIRE(again.written == one.written);
    for (std::size_t k = 0; k < n; ++k) {
        auto const to = std::size_t(number(std::int32_t(k)));
        REQUIRE(again.position[to] == one.position[k]);
        REQUIRE(again.velocity[to] == one.velocity[k]);
    }
}
