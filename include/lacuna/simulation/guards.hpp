// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/interactions/storage/contact_list.hpp>
#include <lacuna/motion/symplectic_euler.hpp>
#include <lacuna/observe/energy_ledger.hpp>
#include <lacuna/particles/store.hpp>
#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/simulation/growth_watch.hpp>

/// \file
/// Checks after each step that the state is still meaningful. See guard_parameters.

namespace lacuna {

/// Step number and time of a state.
struct moment {
    long long step;
    double time; ///< s
};

/// Throws unstable_run. The message has step, time, particle, position, the fault and its likely cause.
/// \param k internal index of the particle; -1: no particular one
/// \param what the fault
template <class Real, int Dim>
[[noreturn]] void throw_unstable(particle_store<Real, Dim> const& store, moment const& now, std::int32_t k,
                                 std::string const& what, std::string const& cause) {
    long long const id = k < 0 ? -1 : store.id(std::size_t(k));
    std::string text = "unstable run at step " + std::to_string(now.step) + ", time " + to_text(now.time) + " s: ";
    if (k >= 0) text += "particle " + std::to_string(id) + " at " + to_text(store.position(std::size_t(k))) + " m: ";
    throw unstable_run(text + what + "; likely cause: " + cause, now.step, id);
}

/// Checks the motion of a step.
/// \param reports one per chunk
/// \param smallest_radius of all particles, m
/// \param limit largest path of a particle in a step over its radius, 1; infinite: no limit
/// \param cause callable (k) -> text why particle k, or any particle for -1, moves so fast
/// \throws unstable_run for a velocity that is not a number, a particle that moved further than the limit, and a
///         particle that rotated by more than ten times the limit in rad
template <class Real, int Dim, class Cause>
largest_motion<Real> checked_motion(particle_store<Real, Dim> const& store,
                                    std::span<motion_report<Real> const> reports, Real time_step, Real smallest_radius,
                                    double limit, moment const& now, Cause const& cause) {
    record<Real> fastest(Real(0)), turning(Real(0)), poison(Real(0));
    for (auto const& r : reports) {
        fastest = max(r.fastest, fastest);
        turning = max(r.turning, turning);
        poison += r.poison;
    }
    if (!(poison[0] + poison[1] + poison[2] == Real(0))) {
        for (std::size_t k = 0; k < store.size(); ++k) {
            auto const v = store.velocity(k);
            for (int axis = 0; axis < Dim; ++axis)
                if (!std::isfinite(v[axis]))
                    throw_unstable(store, now, std::int32_t(k), "its velocity is not a number", cause(std::int32_t(k)));
        }
        throw_unstable(store, now, -1, "a velocity or spin is not a number", cause(-1));
    }
    Real squared = 0, turned = Dim == 2 ? fastest[2] * fastest[2] : Real(0);
    for (int axis = 0; axis < Dim; ++axis) squared += fastest[axis] * fastest[axis];
    for (int axis = 0; Dim == 3 && axis < 3; ++axis) turned += turning[axis] * turning[axis];
    largest_motion<Real> const moved{std::sqrt(squared) * time_step, std::sqrt(turned) * time_step};
    if (moved.path > smallest_radius * Real(limit))
        for (std::size_t k = 0; k < store.size(); ++k) {
            Real const own = norm(store.velocity(k)) * time_step / store.radius(k);
            if (own > Real(limit))
                throw_unstable(store, now, std::int32_t(k),
                               "it moved " + to_text(double(own)) + " of its radius in one step (limit " +
                                   to_text(limit) + ")",
                               cause(std::int32_t(k)));
        }
    Real const most = Real(10 * limit);
    if (moved.arc > smallest_radius * most)
        for (std::size_t k = 0; k < store.size(); ++k)
            if (Real const own = norm(store.spin(k)) * time_step; own > most)
                throw_unstable(store, now, std::int32_t(k),
                               "it rotated by " + to_text(double(own)) + " rad in one step (limit " +
                                   to_text(10 * limit) + ")",
                               cause(std::int32_t(k)));
    return moved;
}

/// Internal index of the fastest particle.
template <class Real, int Dim>
std::int32_t fastest_particle(particle_store<Real, Dim> const& store) noexcept {
    std::size_t fastest = 0;
    for (std::size_t k = 1; k < store.size(); ++k)
        if (squared_norm(store.velocity(k)) > squared_norm(store.velocity(fastest))) fastest = k;
    return std::int32_t(fastest);
}

/// Text about growing speeds for the messages of unstable_run.
inline std::string growth_text() {
    return "the speeds grow fourfold in every 16 steps and reverse in nearly every step";
}

/// \throws unstable_run if growth_watch finds that energy runs away
template <class Real, int Dim>
void check_growth(particle_store<Real, Dim> const& store, growth_watch<Real, Dim> const& watch,
                  largest_motion<Real> const& moved, Real smallest_radius, moment const& now) {
    if (watch.runs_away())
        throw_unstable(store, now, fastest_particle(store),
                       "it is the fastest, and " + growth_text() + ": " +
                           to_text(double(std::max(moved.path, moved.arc) / smallest_radius)) +
                           " of the smallest radius in one step",
                       "energy runs away: the time step is above the stable one");
}

/// \param rounding energy that rounding may have made, J
/// \throws unstable_run if more than half of the energy of a run has no source, and more than rounding can make
template <class Real, int Dim>
void check_energy(particle_store<Real, Dim> const& store, energy_ledger const& ledger, double rounding,
                  moment const& now) {
    if (double const residual = ledger.residual(); residual > 0.5 * ledger.largest() && residual > rounding)
        throw_unstable(store, now, fastest_particle(store),
                       "it is the fastest, and " + to_text(residual) + " J of at most " + to_text(ledger.largest()) +
                           " J have no source",
                       "energy runs away: the time step is above the stable one, or a law makes energy");
}

/// Finds a bond whose particles overlap by more than `limit` times the smaller radius, but did not nearly so at the
/// start.
/// \param deep_at_start labels of the bonds that overlapped so far at the start, sorted
/// \return slot of the bond, or -1
template <class Law, class Real, int Dim>
std::int64_t find_deep_bond(particle_store<Real, Dim> const& store, pair_table<Law, Real, Dim> const& bonds,
                            double limit, std::span<std::int32_t const> deep_at_start) noexcept {
    for (std::size_t s = 0; s < bonds.slots(); ++s) {
        if (bonds.is_padding(s, store.size())) continue;
        auto const i = std::size_t(bonds.i(s)), j = std::size_t(bonds.j(s));
        Real const far = store.radius(i) + store.radius(j) - Real(limit) * std::min(store.radius(i), store.radius(j));
        if (!(far > 0 && squared_norm(store.nearest(store.position(j) - store.position(i))) < far * far)) continue;
        if (!std::binary_search(deep_at_start.begin(), deep_at_start.end(), bonds.label(s))) return std::int64_t(s);
    }
    return -1;
}

/// Finds a bond that yields in compression without limit: "bond 3 between particles 5 and 7 ...". Returns "" if there
/// is none.
template <class Law, class Real, int Dim, class Interactions>
std::string crushed_bond([[maybe_unused]] particle_store<Real, Dim> const& store,
                         [[maybe_unused]] Interactions const& pairs) {
    using parameters = typename Law::template parameters<Real>;
    if constexpr (requires(parameters p, Real r) { Law::template compressive_limit<Dim>(p, r, r); }) {
        auto const& bonds = pairs.bonds();
        for (std::size_t s = 0; s < bonds.slots(); ++s) {
            if (bonds.is_padding(s, store.size())) continue;
            auto const i = std::size_t(bonds.i(s)), j = std::size_t(bonds.j(s));
            auto const& row = pairs.bond_parameters().row[std::size_t(bonds.parameter()[s])];
            Real const limit = Law::template compressive_limit<Dim>(row, store.radius(i), store.radius(j));
            Real const distance = norm(store.nearest(store.position(j) - store.position(i)));
            if (Law::stiffness(row) * (distance - bonds.get(s).state.rest_distance) > Real(-0.999) * limit) continue;
            auto const ids = std::minmax({store.id(i), store.id(j)}); // by value
            return "bond " + std::to_string(bonds.label(s)) + " between particles " + std::to_string(ids.first) +
                   " and " + std::to_string(ids.second) + " is crushed: at its limit, " + to_text(double(limit)) +
                   " N in compression, it yields without limit";
        }
    }
    return "";
}

/// Describes the bond of two particles that overlap too far; "" if they were never bonded.
/// \param i, j internal indices
template <class Law, class Real, int Dim, class Interactions>
std::string bond_between(particle_store<Real, Dim> const& store, Interactions const& pairs, std::int32_t i,
                         std::int32_t j) {
    auto const a = store.id(std::size_t(i)), b = store.id(std::size_t(j));
    auto const& records = pairs.bond_records();
    for (std::size_t n = 0; n < records.size(); ++n) {
        auto const& ids = records[n].particles;
        if (std::minmax(ids[0], ids[1]) != std::minmax(a, b)) continue;
        std::string text = "bond " + std::to_string(n) + " between them ";
        using parameters = typename Law::template parameters<Real>;
        if constexpr (requires(parameters p, Real r) { Law::template compressive_limit<Dim>(p, r, r); }) {
            auto const& row = pairs.bond_parameters().row[pairs.row_of_bond(store, std::int32_t(n))];
            Real const limit =
                Law::template compressive_limit<Dim>(row, store.radius(std::size_t(i)), store.radius(std::size_t(j)));
            if (double(limit) < 1e20)
                return text + "is crushed: at its limit, " + to_text(double(limit)) +
                       " N in compression, it yields without limit; a greater strength, a smaller load, or a law of "
                       "bonds that does not yield in compression";
        }
        return text + "is compressed by more than it can bear: the load is too high for its stiffness";
    }
    return "";
}

/// Checks that no pore is inverted. In 3D a regular triangulation has flat tetrahedra, which invert at any small
/// strain. At their minimum volume they exert no forces. Hence in 3D a pore may be inverted by up to a tenth of
/// pore_network::size.
/// \param crushed callable () -> crushed_bond()
/// \throws unstable_run for a pore whose corners have passed each other: it has no volume any more
template <class Real, int Dim, class Crushed>
void check_pores(particle_store<Real, Dim> const& store, pore_network<Real, Dim> const& net, moment const& now,
                 Crushed const& crushed) {
    if (net.bare()) return;
    for (std::size_t p = 0; p < net.pores(); ++p) {
        typename pore_mesh<Dim>::simplex corners;
        for (std::size_t c = 0; c < corners.size(); ++c) corners[c] = net.corner[c][p];
        Real const size = simplex_size(corners, store.positions());
        if (size > (Dim == 2 ? Real(0) : Real(-0.1) * net.size[p])) continue;
        std::string who;
        for (auto const k : corners) who += " " + std::to_string(store.id(std::size_t(k)));
        std::string cause =
            "particles have passed each other: the deformation is too large for the initial mesh of the "
            "pores; " +
            std::string(Dim == 2 ? "remeshing makes a new mesh" : "in 3D there is no remeshing");
        if (std::string const bond = crushed(); !bond.empty()) cause += "; " + bond;
        throw_unstable(store, now, corners[0],
                       "pore " + std::to_string(p) + " between particles" + who + " is inverted: its " +
                           (Dim == 2 ? "area" : "volume") + " is " + to_text(double(size)) +
                           (Dim == 2 ? " m^2" : " m^3"),
                       cause);
    }
}

} // namespace lacuna
