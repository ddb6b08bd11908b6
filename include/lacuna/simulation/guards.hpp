// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/motion/symplectic_euler.hpp>
#include <lacuna/particles/store.hpp>

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

} // namespace lacuna
