// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <random>

#include <lacuna/interactions/kinematics.hpp>
#include <lacuna/neighbors/brute_force.hpp>
#include <lacuna/neighbors/kd_tree.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// 200 random scenarios on every path through the library: the engine's packs against a loop over all pairs in plain
/// numbers, double against float, and the three neighbour searches against each other.

using namespace setups;

namespace {

constexpr int scenarios = 200, steps = 60;

struct plane_by_brute_force : plane {
    template <class Real, int Dim>
    using search = lacuna::brute_force<Real, Dim>;
};
struct plane_by_tree : plane {
    template <class Real, int Dim>
    using search = lacuna::kd_tree<Real, Dim>;
};

struct scenario {
    lacuna::packing<double, 2> discs;
    std::vector<lacuna::vec<double, 2>> velocity, load;
    std::vector<double> spin;
    std::vector<bool> held;
    double contact_stiffness, bond_stiffness, friction, strength, density, skin;
};

/// 4 to 30 discs of mixed radii in a loose heap, some pairs bonded, thrown at each other.
scenario draw(int number) {
    std::mt19937_64 random(std::uint64_t(number) + 1);
    auto const next = [&](double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1p-53; };
    scenario s;
    int const columns = 2 + int(next(0, 4.99)), rows = 2 + int(next(0, 3.99));
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            auto const k = s.discs.add({x + next(-0.03, 0.03), y + next(-0.03, 0.03)}, next(0.42, 0.52));
            if (x > 0 && next(0, 1) < 0.5) s.discs.bonds.push_back({k - 1, k});
            if (y > 0 && next(0, 1) < 0.5) s.discs.bonds.push_back({k - columns, k});
            s.velocity.push_back({next(-0.5, 0.5), next(-0.5, 0.5)});
            s.load.push_back({next(-1, 1), next(-1, 1)});
            s.spin.push_back(next(-1, 1));
            s.held.push_back(next(0, 1) < 0.1);
        }
    s.contact_stiffness = next(20, 200);
    s.bond_stiffness = next(20, 200);
    s.friction = next(0, 1);
    s.strength = next(0.5, 5);
    s.density = unit_density(2) * next(0.5, 2);
    s.skin = next(0, 0.3);
    return s;
}

constexpr double time_step = 0.01;

struct state {
    std::vector<lacuna::vec<double, 2>> position;
    std::vector<double> spin;
    std::size_t broken = 0;
};

/// Simulates a scenario with the library.
template <class Model>
state play(scenario const& s, bool breaks) {
    auto p = springs<Model>(s.contact_stiffness, 0.7 * s.contact_stiffness, s.friction, s.density, 0, 0);
    p.materials[0].bond = {s.bond_stiffness, 0.7 * s.bond_stiffness, breaks ? s.strength : never,
                           breaks ? s.strength : never};
    p.interactions.skin = s.skin;
    p.time_step = time_step;
    lacuna::simulation<Model> run(lacuna::convert_packing<typename Model::real>(s.discs), p);
    for (std::size_t k = 0; k < run.size(); ++k) {
        run.set_velocity(k, s.velocity[k]);
        run.set_spin(k, {s.spin[k]});
        run.apply(k, s.load[k]);
        if (s.held[k]) run.fix(k);
    }
    state end;
    for (int n = 0; n < steps; ++n) {
        run.step();
        end.broken += run.events().size();
    }
    for (std::size_t k = 0; k < run.size(); ++k) {
        end.position.push_back(run.position(k));
        end.spin.push_back(run.spin(k)[0]);
    }
    return end;
}

/// The same scenario in plain numbers: every pair in every step, one after the other.
state play_plainly(scenario const& s) {
    using contact = lacuna::frictional_spring;
    using bond = lacuna::brittle_spring_bond;
    auto const contact_law = contact::combine({s.contact_stiffness, 0.7 * s.contact_stiffness, s.friction},
                                              {s.contact_stiffness, 0.7 * s.contact_stiffness, s.friction}, 1);
    bond::material const glue{s.bond_stiffness, 0.7 * s.bond_stiffness, never, never};
    auto const bond_law = bond::combine(glue, glue, 1);
    std::size_t const n = s.discs.size();
    std::vector<lacuna::body<double, 2>> body;
    for (std::size_t k = 0; k < n; ++k) {
        double const r = s.discs.radius[k];
        body.push_back({s.discs.position[k], {}, {}, r, s.density * pi * r * r});
    }
    struct pair {
        std::size_t i, j;
        bool bonded;
        bond::history<double, 2> as_bond;
        contact::history<double, 2> as_contact;
    };
    std::vector<pair> pairs;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            double const touching = body[i].radius + body[j].radius, apart = norm(body[j].position - body[i].position);
            bool const bonded = std::any_of(s.discs.bonds.begin(), s.discs.bonds.end(), [&](auto const& b) {
                return std::size_t(b[0]) == i && std::size_t(b[1]) == j;
            });
            pairs.push_back({i, j, bonded, bond::initial<double, 2>(apart, touching),
                             contact::initial<double, 2>(touching, touching)});
        }
    for (int step = 0; step < steps; ++step) {
        std::vector<lacuna::vec<double, 2>> force = s.load;
        std::vector<double> torque(n, 0);
        for (auto& p : pairs) {
            auto const frame = lacuna::relative_motion(body[p.i], body[p.j], time_step);
            auto const act = [&](auto const& answer) {
                auto const f = frame.force(answer.normal_force, answer.shear_force);
                double const t = frame.torque_per_radius(answer.shear_force)[0];
                force[p.i] += f;
                force[p.j] -= f;
                torque[p.i] += t * body[p.i].radius;
                torque[p.j] += t * body[p.j].radius;
            };
            if (p.bonded) {
                auto const answer = bond::evaluate(bond_law, frame.motion, p.as_bond);
                p.as_bond = answer.history;
                act(answer);
            } else {
                auto const answer = contact::evaluate(contact_law, frame.motion, p.as_contact);
                p.as_contact = answer.history;
                act(answer);
            }
        }
        for (std::size_t k = 0; k < n; ++k) {
            auto& b = body[k];
            // Velocities given before the first step do not belong to an earlier motion.
            if (step == 0) {
                b.velocity = s.velocity[k];
                b.spin = {s.spin[k]};
            }
            if (!s.held[k]) {
                b.velocity += force[k] * (time_step / b.mass);
                b.spin[0] += torque[k] * time_step / (b.mass * b.radius * b.radius / 2);
            }
            b.position += b.velocity * time_step;
        }
    }
    state end;
    for (auto const& b : body) {
        end.position.push_back(b.position);
        end.spin.push_back(b.spin[0]);
    }
    return end;
}

/// Largest difference of positions, m (all of size 1), and spins, rad/s.
double difference(state const& a, state const& b) {
    double most = 0;
    for (std::size_t k = 0; k < a.position.size(); ++k)
        most = std::max({most, norm(a.position[k] - b.position[k]), std::fabs(a.spin[k] - b.spin[k])});
    return most;
}

} // namespace

TEST_CASE("200 random scenarios: packs against plain numbers, double against float, three searches", "[paths]") {
    std::vector<double> plain, single;
    std::size_t broken = 0;
    double moved = 0;
    for (int number = 0; number < scenarios; ++number) {
        INFO("scenario " << number);
        auto const s = draw(number);
        auto const packs = play<plane>(s, false);
        plain.push_back(difference(packs, play_plainly(s)));
        single.push_back(difference(packs, play<plane_in_single>(s, false)));
        for (std::size_t k = 0; k < packs.position.size(); ++k)
            moved = std::max(moved, norm(packs.position[k] - s.discs.position[k]));
        // The searches give the same pairs in the same order: not even rounding differs, also after failures of bonds.
        auto const grid = play<plane>(s, true), brute = play<plane_by_brute_force>(s, true),
                   tree = play<plane_by_tree>(s, true);
        REQUIRE(brute.position == grid.position);
        REQUIRE(brute.spin == grid.spin);
        REQUIRE(tree.position == grid.position);
        REQUIRE(tree.spin == grid.spin);
        REQUIRE(brute.broken == grid.broken);
        broken += grid.broken;
    }
    std::sort(plain.begin(), plain.end());
    std::sort(single.begin(), single.end());
    INFO("plain: median " << plain[scenarios / 2] << ", most " << plain.back() << "; single: median "
                          << single[scenarios / 2] << ", most " << single.back() << "; moved " << moved << ", broken "
                          << broken);
    REQUIRE(moved > 0.3);
    REQUIRE(broken > 200);
    // Sixty steps of some ten operations on numbers up to 6 and stiffnesses up to 200: thousands of roundings of 1e-16,
    // and of 6e-8. Median and worst case; a wrong term would be above 1e-3.
    REQUIRE(plain[scenarios / 2] < 1e-13);
    REQUIRE(plain.back() < 1e-11);
    REQUIRE(single[scenarios / 2] < 1e-4);
    REQUIRE(single.back() < 1e-3);
}
