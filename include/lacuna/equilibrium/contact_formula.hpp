// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <lacuna/core/dual.hpp>
#include <lacuna/core/error.hpp>
#include <lacuna/core/fields.hpp>
#include <lacuna/core/text.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/laws/law_concepts.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// What an equilibrium reads off a contact law's formula for one contact, with its history as it was at the last
/// committed state: the normal force F(overlap) and its derivative, the shear stiffness, and the friction. The law
/// states none of them: they are values and derivatives of its evaluate().
///
/// The overlap counts from the distance at which the force begins. This is the touching distance, less what remains of
/// an earlier dent.
template <class Law, int Dim>
class contact_formula {
public:
    using parameters = typename Law::template parameters<double>;
    using history = typename Law::template history<double, Dim>;

    contact_formula() = default;
    /// \param radius_j 0 for a wall
    /// \throws std::invalid_argument for a law whose force pulls, or does not grow with the overlap
    contact_formula(parameters const& p, history const& h, double radius_i, double radius_j)
        : parameters_(p), history_(h), radius_i_(radius_i), radius_j_(radius_j) {
        if constexpr (requires { history_.shear_force; }) history_.shear_force = {};
        double const radius = radius_j > 0 ? std::min(radius_i, radius_j) : radius_i;
        touching_ = touching_distance_of(motion<double>(0.0), h);
        require_no_pull(-1e-3 * radius);
        touching_ -= dent(radius);
        shallow_ = 1e-9 * radius;
        require_growth(radius);
        friction_ = find_friction(1e-3 * radius);
    }

    /// Distance at which the force begins, m.
    double touching_distance() const noexcept { return touching_; }
    /// Shear force that a sliding contact carries, over its normal force, 1; 0 for a smooth contact.
    double friction() const noexcept { return friction_; }

    struct response {
        double force;           ///< normal force, positive in compression, N
        double stiffness;       ///< its derivative by the overlap, N/m
        double shear_stiffness; ///< derivative of the shear force by the slip, N/m
    };
    /// \param overlap m, > 0
    response at(double overlap) const {
        if (overlap >= shallow_) return exactly_at(overlap);
        // The law subtracts distances: rounding would spoil a force at an overlap much smaller than they are.
        auto const shallow = exactly_at(shallow_);
        double const stiffness = shallow.force / shallow_;
        return {stiffness * overlap, stiffness, shallow.shear_stiffness};
    }

private:
    response exactly_at(double overlap) const {
        using number = dual<double, 2>;
        auto m = motion<number>(number::variable(touching_ - overlap, 0));
        m.slip[0] = number::variable(0, 1);
        auto const constant = [](double x) { return number(x); };
        auto const answer = Law::evaluate(
            convert_fields<number, double, typename Law::template parameters<number>>(parameters_, constant), m,
            convert_fields<number, double, typename Law::template history<number, Dim>>(history_, constant));
        return {-answer.normal_force.value, answer.normal_force.derivative[0],
                std::fabs(answer.shear_force[0].derivative[1])};
    }
    template <class T>
    pair_motion<T, Dim> motion(T const& distance) const {
        return {distance, T(radius_i_), T(radius_j_), {}, T(0)};
    }
    double force(double overlap) const {
        return -Law::evaluate(parameters_, motion(touching_ - overlap), history_).normal_force;
    }

    /// Overlap up to which the law answers no force, m: that of an earlier, deeper contact.
    double dent(double radius) const {
        double none = 0, some = 1e-9 * radius;
        while (!(force(some) > 0)) {
            require_no_pull(some);
            none = some;
            some *= 2;
            if (some > radius)
                refuse("contact law", "no force at an overlap of the whole radius",
                       "a force that grows with the overlap");
        }
        if (none == 0) return 0;
        for (int n = 0; n < 80; ++n) {
            double const middle = 0.5 * (none + some);
            (force(middle) > 0 ? some : none) = middle;
        }
        return none;
    }
    /// \throws std::invalid_argument for a force that pulls, or that acts across a gap
    void require_no_pull(double overlap) const {
        if (double const now = force(overlap); now < 0 || (now > 0 && overlap < 0))
            refuse("contact law", "a force of " + to_text(now) + " N at an overlap of " + to_text(overlap) + " m",
                   "a force that pushes and begins with the overlap, for an equilibrium");
    }
    /// \throws std::invalid_argument naming the overlaps between which the force falls
    void require_growth(double radius) const {
        double shallower = 0, before = 0;
        for (double const share : {1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1}) {
            double const overlap = share * radius, now = force(overlap);
            if (!(now > before))
                refuse("contact law",
                       "a force of " + to_text(before) + " N at an overlap of " + to_text(shallower) + " m and " +
                           to_text(now) + " N at " + to_text(overlap) + " m",
                       "a force that grows with the overlap, for an equilibrium");
            shallower = overlap;
            before = now;
        }
    }
    /// Ratio of the shear force to the normal force in a slip that no contact withstands; 0 without shear force, and
    /// for a shear force without limit a ratio that no load reaches.
    double find_friction(double overlap) const {
        auto const ratio = [&](double slip) {
            auto m = motion(touching_ - overlap);
            m.slip[0] = slip;
            auto const answer = Law::evaluate(parameters_, m, history_);
            return norm(answer.shear_force) / -answer.normal_force;
        };
        return std::min(ratio(1e6 * touching_), 1e3);
    }

    parameters parameters_{};
    history history_{};
    double radius_i_ = 0, radius_j_ = 0, touching_ = 0, friction_ = 0, shallow_ = 0;
};

} // namespace lacuna
