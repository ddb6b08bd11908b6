// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/motion/symplectic_euler.hpp>
#include <lacuna/observe/energy_ledger.hpp>
#include <lacuna/particles/store.hpp>
#include <lacuna/pores/pore_network.hpp>

/// \file
/// What is looked at after each step: whether the state still means anything.

namespace lacuna {

/// When a state was found to be meaningless.
struct moment {
    long long step;
    double time; ///< s
};

/// Throws unstable_run with step, time, particle, place, what is wrong and the likely cause.
/// \param k internal index of the particle, -1 for none in particular
template <class Real, int Dim>
[[noreturn]] void throw_unstable(particle_store<Real, Dim> const& store, moment const& now, std::int32_t k,
                                 std::string const& what, std::string const& cause) {
    long long const id = k < 0 ? -1 : store.id(std::size_t(k));
    std::string text = "unstable run at step " + std::to_string(now.step) + ", time " + to_text(now.time) + " s: ";
    if (k >= 0) {
        text += "particle " + std::to_string(id) + " at (";
        for (int axis = 0; axis < Dim; ++axis)
            text += (axis ? ", " : "") + to_text(double(store.position(std::size_t(k))[axis]));
        text += ") m: ";
    }
    throw unstable_run(text + what + "; likely cause: " + cause, now.step, id);
}

/// Looks at the reports of a step.
/// \param smallest_radius of all particles, m
/// \return an upper bound of the path of every particle in the step, m
/// \throws unstable_run for a velocity that is no number and a particle that moved more than a tenth of its radius
template <class Real, int Dim>
Real checked_motion(particle_store<Real, Dim> const& store, std::span<motion_report<Real> const> reports, Real time_step,
                    Real smallest_radius, moment const& now) {
    record<Real> fastest(Real(0)), poison(Real(0));
    for (auto const& r : reports) {
        fastest = max(r.fastest, fastest);
        poison += r.poison;
    }
    if (!(poison[0] + poison[1] + poison[2] == Real(0))) {
        for (std::size_t k = 0; k < store.size(); ++k) {
            auto const v = store.velocity(k);
            for (int axis = 0; axis < Dim; ++axis)
                if (!std::isfinite(v[axis]))
                    throw_unstable(store, now, std::int32_t(k), "its velocity is not a number",
                                   "a load that is not a number, coinciding particles, or an unstable time step");
        }
        throw_unstable(store, now, -1, "a velocity or spin is not a number", "an unstable time step");
    }
    Real squared = 0;
    for (int axis = 0; axis < Dim; ++axis) squared += fastest[axis] * fastest[axis];
    Real const path = std::sqrt(squared) * time_step;
    if (path > smallest_radius / 10)
        for (std::size_t k = 0; k < store.size(); ++k) {
            Real const own = norm(store.velocity(k)) * time_step / store.radius(k);
            if (own > Real(0.1))
                throw_unstable(store, now, std::int32_t(k),
                               "it moved " + to_text(double(own)) + " of its radius in one step (limit 0.1)",
                               "the time step is above the stable one, or a load is very large");
        }
    return path;
}

/// Watches the largest speed of a run for growth that no load causes: by four times and more in each of four runs of
/// sixteen steps. Under a load a speed rises with the time, under one that rises itself with its square, and at an impact
/// once; only what feeds on itself goes on like that.
template <class Real>
class growth_watch {
public:
    /// \param path upper bound of the path of every particle in the step, m
    /// \param least below which motion is nothing but rounding, m
    /// \return whether energy runs away
    bool grows(long long step, Real path, Real least) noexcept {
        if (step % window != 0) return false;
        bool const again = path > least && path >= 4 * before_ && before_ > 0;
        growing_ = again ? growing_ + 1 : 0;
        before_ = path;
        return growing_ >= 4;
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(before_, growing_);
    }

private:
    static constexpr long long window = 16;
    Real before_ = 0;
    int growing_ = 0;
};

/// Internal index of the fastest particle.
template <class Real, int Dim>
std::int32_t fastest_particle(particle_store<Real, Dim> const& store) noexcept {
    std::size_t fastest = 0;
    for (std::size_t k = 1; k < store.size(); ++k)
        if (squared_norm(store.velocity(k)) > squared_norm(store.velocity(fastest))) fastest = k;
    return std::int32_t(fastest);
}

/// \throws unstable_run when the speeds of a run grow as growth_watch has it, or more than half of its energy has come
///         from nowhere (ledger: nullptr where none is kept)
template <class Real, int Dim>
void check_energy(particle_store<Real, Dim> const& store, growth_watch<Real>& watch, energy_ledger const* ledger,
                  Real path, Real smallest_radius, moment const& now) {
    Real const least = Real(1e-9) * smallest_radius;
    if (watch.grows(now.step, path, least))
        throw_unstable(store, now, fastest_particle(store),
                       "it is the fastest, and the speeds grow fourfold in every 16 steps: " +
                           to_text(double(path / smallest_radius)) + " of the smallest radius in one step",
                       "energy runs away: the time step is above the stable one");
    if (ledger && path > least && ledger->residual() > 0.5 * ledger->largest())
        throw_unstable(store, now, fastest_particle(store),
                       "it is the fastest, and " + to_text(ledger->residual()) + " J of at most " +
                           to_text(ledger->largest()) + " J have come from nowhere",
                       "energy runs away: the time step is above the stable one, or a law makes energy");
}

/// In space a regular triangulation has flat tetrahedra, which turn over at any small strain; at their least volume they
/// push nobody. There a pore may turn over by a tenth of pore_network::size.
/// \throws unstable_run for a pore whose corners have passed each other: it has no volume any more
template <class Real, int Dim>
void check_pores(particle_store<Real, Dim> const& store, pore_network<Real, Dim> const& net, moment const& now) {
    if (net.bare()) return;
    for (std::size_t p = 0; p < net.pores(); ++p) {
        typename pore_mesh<Dim>::simplex corners;
        for (std::size_t c = 0; c < corners.size(); ++c) corners[c] = net.corner[c][p];
        Real const size = simplex_size(corners, store.positions());
        if (size > (Dim == 2 ? Real(0) : Real(-0.1) * net.size[p])) continue;
        std::string who;
        for (auto const k : corners) who += " " + std::to_string(store.id(std::size_t(k)));
        throw_unstable(store, now, corners[0],
                       "pore " + std::to_string(p) + " between particles" + who + " is turned over, its " +
                           (Dim == 2 ? "area" : "volume") + " is " + to_text(double(size)) +
                           (Dim == 2 ? " m^2" : " m^3"),
                       "particles have passed each other: the deformation is too large for the pores of the start; " +
                           std::string(Dim == 2 ? "remeshing makes new ones" : "in space there is no remeshing"));
    }
}

} // namespace lacuna
