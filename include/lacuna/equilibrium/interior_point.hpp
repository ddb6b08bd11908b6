// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/equilibrium/coupled_solve.hpp>
#include <lacuna/equilibrium/parameters.hpp>

namespace lacuna {

/// Scales of one solve.
struct equilibrium_scales {
    double stiffness;      ///< median normal stiffness of the pairs, N/m
    double force;          ///< expected force between two particles, N
    double regularisation; ///< stiffness added to each freedom, N/m
    double longest;        ///< largest displacement of a freedom in an iteration, m; four times as much in a solve
    double negligible;     ///< force that counts as none, N: of the rounding of positions, of the regularisation
    double barrier;        ///< barrier that counts as none, J
};

/// Solves the equations of an equilibrium_system by the primal-dual interior point method: Newton's method on the
/// equations with a barrier, which falls as the contacts approach their complementarity.
///
/// The limit of friction follows the normal force, which makes the tangent unsymmetric. The symmetric part is
/// factorised; the rest enters by a few iterations that use the factors (solve_coupled()).
template <class System>
class interior_point {
public:
    using vector = Eigen::VectorXd;

    interior_point(System& system, equilibrium_scales const& scales, equilibrium_parameters const& p)
        : system_(system), scales_(scales), parameters_(p) {}

    /// Solves for the increment from the committed state.
    /// \param u output, m
    /// \return whether it converged
    bool solve(vector& u) {
        u = vector::Zero(system_.count());
        goal_ = contacts() ? 10 * scales_.force * scales_.force / scales_.stiffness : 0.0;
        share_ = 0;
        double before = 0;
        system_.start_contacts(goal_);
        for (int n = 0; n < parameters_.iterations; ++n) {
            system_.linearise(u, forces_);
            forces_.head(system_.displacements()) -= scales_.regularisation * u.head(system_.displacements());
            error_ = std::max({largest(forces_), system_.flow_error(), system_.contact_residual()});
            if (n > 0 && converged()) return true;
            if (n > 0 && contacts()) lower_barrier();
            watch_friction();
            system_.matrix().add_diagonal(scales_.regularisation, system_.displacements());
            // Bonds and fluid alone are almost linear: the factors stay good.
            bool const keeps_factors = linear() && n > 0 && error_ < 0.1 * before;
            before = error_;
            if (!keeps_factors && !system_.matrix().factorise()) return false;
            vector const du = find_step();
            if (!du.allFinite()) return false;
            share_ = linear() ? 1.0 : std::min(1.0, 0.99 * system_.find_steps(du));
            if (double const far = share_ * largest(du); far > scales_.longest) share_ *= scales_.longest / far;
            u += share_ * du;
            system_.advance_contacts(share_);
            if (largest(u) > 4 * scales_.longest) return false;
        }
        return false;
    }

private:
    bool contacts() const noexcept { return system_.contacts() > 0; }
    /// Whether it is a step in slow time without contacts.
    bool linear() const noexcept { return system_.count() > system_.displacements() && !contacts(); }
    /// Largest displacement, or force on one.
    double largest(vector const& x) const {
        int const n = system_.displacements();
        return n > 0 ? x.head(n).template lpNorm<Eigen::Infinity>() : 0.0;
    }
    /// Tighter than what is asked for: the exact laws, which judge the result, differ a little.
    double tolerance() const {
        return std::max(0.1 * parameters_.tolerance * system_.largest_force(), scales_.negligible);
    }
    /// Barrier at which a contact that just touches has a force of the tolerance.
    double least_barrier() const { return std::max(tolerance() * tolerance() / scales_.stiffness, scales_.barrier); }
    bool converged() const {
        return error_ <= tolerance() && (!contacts() || system_.mean_product() <= 4 * least_barrier());
    }
    /// Lowers the barrier by as much as the last step succeeded. It waits for the forces to balance: contacts whose
    /// barrier has gone do not move any more.
    void lower_barrier() {
        double const product = system_.mean_product();
        double const factor = share_ > 0.9 ? 0.1 : share_ > 0.5 ? 0.3 : 0.7;
        double const wait = std::min(product, 0.3 * error_ * error_ / scales_.stiffness);
        goal_ = std::max({0.5 * least_barrier(), factor * product, wait});
    }
    /// With much friction Newton's steps may lead in a circle. Steps within which the limit of friction stays, as in
    /// the fixed point of Acary and others, lead out of it; they are slow elsewhere.
    void watch_friction() {
        if (error_ < least_error_) {
            least_error_ = error_;
            idle_ = 0;
        } else if ((idle_ += share_ > 0.5) > 12) {
            follows_ = !follows_;
            least_error_ = std::numeric_limits<double>::infinity();
            idle_ = 0;
        }
    }
    vector find_step() {
        system_.aim(goal_, follows_, forces_);
        auto const solve = [&](vector const& x) { return system_.matrix().solve(x); };
        if (!follows_ || !system_.rough()) return solve(forces_);
        auto const product = [&](vector const& x) {
            vector y = system_.matrix().product(x);
            system_.add_coupling(x, y);
            return y;
        };
        // A coarser tolerance leaves what the floppy particles hide: then Newton's method converges slowly.
        return solve_coupled(forces_, product, solve, 1e-3, 40);
    }

    System& system_;
    equilibrium_scales const& scales_;
    equilibrium_parameters const& parameters_;
    vector forces_;
    double goal_ = 0, share_ = 0, error_ = 0;
    double least_error_ = std::numeric_limits<double>::infinity();
    int idle_ = 0;        // long steps since the least error
    bool follows_ = true; // whether the limit of friction follows the normal force within a step
};

} // namespace lacuna
