// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/laws/no_contact.hpp>
#include <lacuna/motion/stable_step.hpp>
#include <lacuna/simulation/simulation_state.hpp>

namespace lacuna {

/// Overlap at which an elastic contact stops two bodies, m. It holds for a force that grows with the power 3/2 of the
/// overlap (Hertz); for a force that grows more slowly the overlap is smaller.
/// \param effective_mass kg
/// \param closing speed of approach, m/s
/// \param stiffness tangent of the force at `overlap`, N/m
/// \param overlap m
inline double stopping_overlap(double effective_mass, double closing, double stiffness, double overlap) {
    double const energy = stiffness * overlap * overlap / 2;
    return closing > 0 && energy > 0 ? overlap * std::pow(effective_mass * closing * closing / energy, 0.4) : 0;
}

/// Bounds of the time step for contacts that may form, wherever particles go. They come from the smallest and the
/// largest particle of each material and do not depend on the positions.
template <class Model>
class contact_forecast {
public:
    static constexpr int dim = Model::dim;
    using law = typename Model::contact_law;
    using damping_parameters = typename Model::damping::parameters;
    using store_type = typename simulation_state<Model>::store_type;
    using interactions_type = typename simulation_state<Model>::interactions_type;
    using walls_type = typename simulation_state<Model>::walls_type;
    static constexpr bool grows = stiffens<law, dim>;

    /// Computes the bounds, unless they are known for these speeds and overlaps.
    /// \param speed speed of the fastest particle or wall, m/s
    /// \param overlap least overlap of contacts, as a share of the smaller radius, 1
    /// \param margin ratio of the overlap that is counted to the overlap that stops two particles at that speed, 1
    void update(store_type const& store, interactions_type const& pairs, walls_type const& walls,
                damping_parameters const& damping, double speed, double overlap, double margin) {
        bool const known = known_ && (!grows || (overlap <= overlap_ && speed <= speed_ && 4 * speed >= speed_));
        if (known) return;
        known_ = true;
        overlap_ = 1.25 * overlap;
        speed_ = 1.25 * speed;
        stopping_share_ = stiff_ = viscous_ = crowd_stiff_ = crowd_viscous_ = 0;
        if constexpr (!is_absent<law>)
            if (pairs.has_contacts()) {
                find_kinds(store);
                search(store, pairs, walls, damping, margin);
            }
    }
    /// Discards the bounds, because particles were fixed or released.
    void forget() noexcept { known_ = false; }
    /// Largest overlap that the bounds include, as a share of the smaller radius, 1; without the margin.
    double overlap() const noexcept { return std::max(overlap_, stopping_share_); }
    /// Stable step of the single contact (of two particles, or particle and wall) with the highest frequency, s.
    double first_contact() const noexcept { return frequency_bound<dim>::step_of(stiff_, viscous_); }
    /// Stable step if contacts form on every side of a particle, s.
    /// \param without stable step without these contacts, s
    double crowded(double without) const noexcept {
        double const a = std::isfinite(without) ? 4 / (without * without) : 0;
        return frequency_bound<dim>::step_of(a + crowd_stiff_, crowd_viscous_);
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(known_, overlap_, speed_, stopping_share_, stiff_, viscous_, crowd_stiff_, crowd_viscous_);
    }

private:
    /// A particle that represents its material: the smallest or largest of those that move, or of those that are fixed.
    struct kind {
        std::size_t particle = 0;
        int material = 0;
        bool moves = false, smallest = false;
    };

    static bool moves(store_type const& store, std::size_t k) noexcept {
        for (int axis = 0; axis < frequency_bound<dim>::freedoms; ++axis)
            if (store.mobility(k, axis) > 0) return true;
        return false;
    }
    /// Finds the smallest and the largest particle of each material, among those that move and those that are fixed.
    void find_kinds(store_type const& store) {
        kinds_.clear();
        smallest_ = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < store.size(); ++k) {
            smallest_ = std::min(smallest_, double(store.radius(k)));
            kind const own{k, store.material(k), moves(store, k), false};
            bool small = false, large = false;
            for (auto& other : kinds_) {
                if (other.material != own.material || other.moves != own.moves) continue;
                (other.smallest ? small : large) = true;
                auto const r = store.radius(k), there = store.radius(other.particle);
                if (other.smallest ? r < there : r > there) other.particle = k;
            }
            if (!small) kinds_.push_back({k, own.material, own.moves, true});
            if (!large) kinds_.push_back({k, own.material, own.moves, false});
        }
    }
    /// Upper bound of the number of smallest particles that fit around a particle of the given radius, m.
    double most_neighbors(double radius) const noexcept {
        double const half = std::asin(smallest_ / (radius + smallest_));
        // In 3D no packing of large caps on a sphere is denser than 0.83, the density of 12 equal spheres.
        return dim == 2 ? std::numbers::pi / half * (1 + 1e-9) : 0.83 * 2 / (1 - std::cos(half));
    }

    /// Bounds for a single contact: mass-scaled stiffness, 1/s^2, and damping, 1/s.
    struct terms {
        double stiff = 0, viscous = 0;
        void raise(terms const& other) noexcept {
            stiff = std::max(stiff, other.stiff);
            viscous = std::max(viscous, other.viscous);
        }
    };

    void search(store_type const& store, interactions_type const& pairs, walls_type const& walls,
                damping_parameters const& damping, double margin) {
        auto const& rows = pairs.contact_parameters().row;
        auto const materials = std::size_t(std::lround(std::sqrt(double(rows.size()))));
        terms alone, crowd;
        for (kind const& a : kinds_) {
            if (!a.moves) continue;
            terms pair, wall;
            for (kind const& b : kinds_)
                pair.raise(meet(store, damping, margin, a, &b,
                                rows[std::size_t(a.material) * materials + std::size_t(b.material)]));
            for (std::size_t w = 0; w < walls.size(); ++w)
                wall.raise(meet(store, damping, margin, a, nullptr, walls.parameters(w, std::size_t(a.material))));
            double const count = most_neighbors(double(store.radius(a.particle)));
            alone.raise(pair);
            alone.raise(wall);
            crowd.raise({count * pair.stiff + wall.stiff, count * pair.viscous + wall.viscous});
        }
        double const slowed = 1 + std::fabs(Model::damping::particle_force(damping, 1.0, -1.0));
        double drag = 0;
        if constexpr (requires { Model::damping::drag_rate(damping); }) drag = Model::damping::drag_rate(damping);
        stiff_ = slowed * alone.stiff;
        viscous_ = slowed * (alone.viscous + drag);
        crowd_stiff_ = slowed * crowd.stiff;
        crowd_viscous_ = slowed * (crowd.viscous + drag);
    }
    /// Bounds for the contact of a moving particle with another particle, or with a wall (b = nullptr).
    template <class Row>
    terms meet(store_type const& store, damping_parameters const& damping, double margin, kind const& a, kind const* b,
               Row const& row) {
        using real = typename Model::real;
        double const ri = double(store.radius(a.particle)), rj = b ? double(store.radius(b->particle)) : 0;
        double const mi = double(store.mass(a.particle)), mj = b ? double(store.mass(b->particle)) : mi;
        auto k = contact_stiffness<law, dim>(row, 0.0, ri, rj, contact_assumption{0, overlap_});
        if constexpr (grows) {
            double const r = smaller_radius(ri, rj), x = std::max(overlap_ * r, (ri + rj) * 1e-6);
            double const share = stopping_overlap(b ? mi * mj / (mi + mj) : mi, 2 * speed_, k.normal, x) / r;
            stopping_share_ = std::max(stopping_share_, share);
            if (margin * share > overlap_)
                k = contact_stiffness<law, dim>(row, 0.0, ri, rj, contact_assumption{0, margin * share});
        }
        stiff_bound_.reset(2);
        viscous_bound_.reset(2);
        for (int axis = 0; axis < frequency_bound<dim>::freedoms; ++axis)
            for (auto* bound : {&stiff_bound_, &viscous_bound_}) {
                bound->set_mobility(0, axis, double(store.mobility(a.particle, axis)));
                bound->set_mobility(1, axis, b ? double(store.mobility(b->particle, axis)) : 0.0);
            }
        vec<double, dim> normal{};
        normal[0] = 1;
        stiff_bound_.add_pair(0, 1, normal, k.normal, k.shear, 0, ri, rj);
        if constexpr (carries_moment<law>) {
            auto const turning = law::template rotational_stiffness<dim>(row, real(ri), real(rj), real(ri + rj));
            stiff_bound_.add_rotational(0, 1, normal, double(turning.bending), double(turning.twisting));
        }
        if constexpr (Model::damping::acts_on_pairs)
            viscous_bound_.add_pair(
                0, 1, normal, Model::damping::pair_force(damping, k.normal, b ? mi : 2 * mi, b ? mj : 2 * mi, 1.0), 0,
                0, ri, rj);
        double const w = stiff_bound_.frequency(), c = viscous_bound_.frequency();
        return {w * w, c * c};
    }

    std::vector<kind> kinds_;
    frequency_bound<dim> stiff_bound_, viscous_bound_;
    double smallest_ = 0;
    bool known_ = false;
    double overlap_ = 0, speed_ = 0, stopping_share_ = 0, stiff_ = 0, viscous_ = 0, crowd_stiff_ = 0,
           crowd_viscous_ = 0;
};

} // namespace lacuna
