// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// One contact in the primal-dual interior point. Its unknowns are the overlap o of its springs, the gap s, the shear
/// force t and the sliding p per shear force. Its equations, with the distance d, the distance L at which the force
/// begins, the law's normal force F(o) and shear stiffness k_s, and the friction f:
///
///   d - L + o - s = 0                              springs and gap fill the distance
///   F(o) s = m                                     force or gap
///   slip - (t - t_0) / k_s - p t = 0               slip is elastic or plastic
///   p ((f F)^2 - |t|^2) = 2 m                      stick, or slide against the shear force
///
/// The solver lowers the barrier m to practically nothing. Newton's step eliminates the four unknowns pair by pair, so
/// that the matrix of the particles keeps the pattern of their stiffness. In space this is Coulomb's cone, in the plane
/// an interval. See Nocedal and Wright 2006, Numerical Optimization, chapter 19, for the method.
template <int Dim>
class frictional_contact {
public:
    using shear = vec<double, shear_dim<Dim>>;

    /// Starts on the central path of the barrier, at the point nearest to a given state.
    /// \param formula contact_formula of the contact
    /// \param overlap of the state, negative for a gap, m
    /// \param shear_force of the state, N
    template <class Formula>
    void start(Formula const& formula, double overlap, shear const& shear_force, double barrier) {
        friction_ = formula.friction();
        overlap_ = find_overlap(formula, overlap, barrier);
        gap_ = overlap_ - overlap;
        update(formula);
        gap_ = std::max(gap_, barrier / force_);
        before_ = shear_force;
        if (!rough()) return;
        double const limit = friction_ * force_, size = norm(shear_force);
        shear_ = size > 0.95 * limit ? shear_force * (0.95 * limit / size) : shear_force;
        sliding_ = 2 * barrier / cone();
    }

    double force() const noexcept { return force_; }        ///< normal force, positive in compression, N
    shear const& shear_force() const noexcept { return shear_; } ///< N, on particle i
    double product() const noexcept { return force_ * gap_; } ///< J; the barrier on the central path
    bool rough() const noexcept { return friction_ > 0 && shear_stiffness_ > 0; }

    /// Linearises the contact at a distance and slip from the committed state.
    /// \param excess d - L, m
    /// \param shear_before shear force of the committed state in the present frame, N
    void linearise(double excess, shear const& slip, shear const& shear_before, shear const& normal) {
        before_ = shear_before;
        if constexpr (Dim == 3) shear_ = shear_ - normal * dot(normal, shear_);
        normal_residual_ = excess + overlap_ - gap_;
        weight_ = force_ / (gap_ + force_ / stiffness_);
        if (!rough()) return;
        flexibility_ = 1 / shear_stiffness_ + sliding_;
        bend_ = 2 * sliding_ / cone();
        shear_residual_ = slip - (shear_ - before_) / shear_stiffness_ - shear_ * sliding_;
    }
    /// Chooses the barrier at which the next step aims.
    /// \param follows whether the limit of friction follows the normal force within the step, or only after it
    void aim(double barrier, bool follows) noexcept {
        push_ = (barrier - force_ * gap_ - force_ * normal_residual_) / (gap_ + force_ / stiffness_);
        if (!rough()) return;
        double const c = cone();
        barrier_ = 2 * barrier;
        pull_ = soften(shear_residual_ - shear_ * ((barrier_ - sliding_ * c) / c));
        follow_ = follows ? soften(shear_) * (2 * sliding_ * friction_ * friction_ * force_ / c) : shear{};
    }
    /// Larger error of the equations of the distance and of the slip, as the force that it stands for, N.
    double residual() const noexcept {
        double const along = std::fabs(normal_residual_) * weight_;
        return rough() ? std::max(along, norm(soften(shear_residual_))) : along;
    }
    /// Change of the normal force per approach, N/m.
    double weight() const noexcept { return weight_; }
    /// Change of the normal force that the equations ask for at the present distance, N.
    double push() const noexcept { return push_; }
    /// Change of the shear force that they ask for at the present slip, N.
    shear pull() const noexcept { return rough() ? pull_ + follow_ * push_ : shear{}; }
    /// Change of the shear force per change of the normal force, as the limit of friction follows it, 1.
    shear follow() const noexcept { return rough() ? follow_ : shear{}; }
    /// Change of the shear force for a change of the slip, N, at constant normal force.
    shear soften(shear const& slip) const noexcept {
        return (slip - shear_ * (bend_ * dot(shear_, slip) / (flexibility_ + bend_ * squared_norm(shear_)))) /
               flexibility_;
    }

    /// Finds the changes of the contact's unknowns from those of the distance and the slip.
    void find_step(double distance, shear const& slip) noexcept {
        force_step_ = push_ - weight_ * distance;
        overlap_step_ = force_step_ / stiffness_;
        gap_step_ = distance + overlap_step_ + normal_residual_;
        if (!rough()) return;
        shear_step_ = soften(slip) + pull_ + follow_ * force_step_;
        double const c = cone();
        sliding_step_ = (barrier_ - sliding_ * c -
                         2 * sliding_ * friction_ * friction_ * force_ * force_step_ +
                         2 * sliding_ * dot(shear_, shear_step_)) / c;
    }
    /// Largest share of the step, at most 1, that leaves spring and gap positive.
    double longest_step() const noexcept {
        return std::min({1.0, room(overlap_, overlap_step_), room(gap_, gap_step_)});
    }
    /// Makes a share of the step. Friction takes a smaller share where its limit is closer: a contact that is about to
    /// slide must not stop all others.
    template <class Formula>
    void advance(Formula const& formula, double share) {
        double const margin = rough() ? slide(std::min(share, 0.9 * longest_slide())) : 0;
        overlap_ += share * overlap_step_;
        gap_ += share * gap_step_;
        update(formula);
        if (!rough()) return;
        // The limit follows the normal force. Where it has come close, the shear force keeps its relative distance.
        double const limit = friction_ * force_, size = norm(shear_);
        if (limit - size < 0.1 * margin * limit) shear_ = shear_ * (limit * (1 - std::max(margin, 1e-12)) / size);
    }

private:
    /// Share of a step after which a positive value is zero.
    static double room(double value, double step) noexcept { return step < 0 ? -value / step : 1.0; }
    /// Largest share of the step that leaves the shear force below its limit, which moves too.
    double longest_slide() const noexcept {
        double const f2 = friction_ * friction_;
        double const a = f2 * force_step_ * force_step_ - squared_norm(shear_step_);
        double const b = f2 * force_ * force_step_ - dot(shear_, shear_step_), c = cone();
        double share = std::min(1.0, room(sliding_, sliding_step_));
        // The smallest positive root of a x^2 + 2 b x + c.
        double const root = b * b - a * c;
        if (root >= 0 && (b < 0 || a < 0))
            if (double const x = c / (std::sqrt(root) - b); x > 0) share = std::min(share, x);
        return share;
    }
    /// \return distance of the shear force from its old limit, as a share of it
    double slide(double share) noexcept {
        shear_ += shear_step_ * share;
        sliding_ += share * sliding_step_;
        double const limit = friction_ * force_;
        return std::clamp((limit - norm(shear_)) / limit, 0.0, 1.0);
    }
    double cone() const noexcept {
        double const limit = friction_ * force_;
        return (limit - norm(shear_)) * (limit + norm(shear_));
    }
    template <class Formula>
    void update(Formula const& formula) {
        auto const now = formula.at(overlap_);
        force_ = now.force;
        stiffness_ = now.stiffness;
        shear_stiffness_ = now.shear_stiffness;
    }
    /// The positive root o of F(o) (o - overlap) = barrier.
    template <class Formula>
    static double find_overlap(Formula const& formula, double overlap, double barrier) {
        double low = std::max(overlap, 0.0), high = std::max(low, std::numeric_limits<double>::min());
        auto const excess = [&](double o) { return formula.at(o).force * (o - overlap) - barrier; };
        double width = std::sqrt(
            barrier / std::max(formula.at(std::max(low, 1e-6 * formula.touching_distance())).stiffness, 1e-300));
        for (high = low + width; excess(high) < 0; width *= 2) high = low + width;
        double o = high;
        for (int n = 0; n < 60; ++n) {
            auto const now = formula.at(o);
            double const error = now.force * (o - overlap) - barrier;
            (error < 0 ? low : high) = o;
            double next = o - error / (now.stiffness * (o - overlap) + now.force);
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            if (std::fabs(next - o) <= 1e-12 * o) break;
            o = next;
        }
        return o;
    }

    double friction_ = 0;
    double overlap_ = 0, gap_ = 0, force_ = 0, stiffness_ = 0, shear_stiffness_ = 0, sliding_ = 0;
    shear shear_{}, before_{};
    double normal_residual_ = 0, weight_ = 0, push_ = 0, flexibility_ = 1, bend_ = 0, barrier_ = 0;
    shear shear_residual_{}, pull_{}, follow_{};
    double force_step_ = 0, overlap_step_ = 0, gap_step_ = 0, sliding_step_ = 0;
    shear shear_step_{};
};

} // namespace lacuna
