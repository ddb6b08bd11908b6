// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <lacuna/core/state.hpp>
#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/simulation/contact_forecast.hpp>

namespace lacuna {

/// Decides when the bound of the time step has to be computed again, which is called an update.
///
/// An update counts the contacts that touch or have at most a certain gap. For laws that stiffen it counts them with at
/// least a certain overlap. Its bound holds until two particles may have approached by more than the gap, a contact is
/// deeper than the overlap, or a bond has failed. Then the next update is due. If no contact that may form can make the
/// step unsafe (see contact_forecast), the update waits for so many steps that its cost stays small.
template <class Model>
class step_control {
public:
    static constexpr int dim = Model::dim;
    using store_type = typename simulation_state<Model>::store_type;
    using interactions_type = typename simulation_state<Model>::interactions_type;
    using walls_type = typename simulation_state<Model>::walls_type;
    static constexpr bool grows = contact_forecast<Model>::grows;
    /// A chosen step counts overlaps that are larger by this factor than those which stop the particles. At 0.2 of the
    /// bound a Hertzian collision then takes about 20 steps and restores the speeds within 1e-3.
    static constexpr double chosen_margin = 16;

    contact_assumption const& assumed() const noexcept { return assumed_; }
    contact_forecast<Model> const& forecast() const noexcept { return forecast_; }
    /// Discards the forecast and makes an update due, because supports have changed.
    void forget_forecast() noexcept {
        forecast_.forget();
        due_ = true;
    }
    /// Whether a contact that forms may make the step unsafe.
    bool cannot_wait() const noexcept { return !can_wait_; }
    /// Number of updates so far.
    long long updates() const noexcept { return updates_; }

    /// Assumptions about contacts for the next update.
    /// \param chosen whether the library chooses the step; false: the step is given and only checked
    /// \param wide whether the gap should be large enough for the usual time between two updates
    /// \param reach distance by which two particles may approach in the next step, m
    /// \param smallest_radius m
    /// \param wet whether there is fluid, which makes an update expensive
    contact_assumption next_assumption(store_type const& store, interactions_type const& pairs, walls_type const& walls,
                                       bool chosen, bool wide, double reach, double smallest_radius, bool wet) const {
        contact_assumption next{std::clamp(reach, least_gap * smallest_radius, most_gap * smallest_radius), 0};
        if (wide)
            next.gap = std::clamp(last_approach_ * double(lasting(wet)), next.gap, most_gap * smallest_radius);
        double listed = pairs.remaining();
        if (!walls.empty()) listed = std::min(listed, walls.remaining());
        next.gap = std::max(0.0, std::min(next.gap, listed));
        if constexpr (grows) {
            if constexpr (requires { Model::contact_law::expected_overlap; })
                if (chosen) next.overlap = Model::contact_law::expected_overlap;
            // Decreases slowly: particles that were fast, or deep in contact, at the last update may just be reversing.
            if (chosen) next.overlap = std::max(next.overlap, assumed_.overlap / 2);
            next.overlap = std::max(next.overlap, deeper * deepest_);
            double const margin = chosen ? chosen_margin : 1;
            auto const see = [&](contact_seen const& c, pair_stiffness const& k) {
                double const x = std::max({c.overlap, next.overlap * c.radius, 1e-6 * c.radius});
                double const stops = stopping_overlap(c.effective_mass, c.closing, k.normal, x);
                found_overlap_ = std::max({found_overlap_, deeper * c.overlap / c.radius, margin * stops / c.radius});
            };
            found_overlap_ = next.overlap;
            pairs.for_each_depth(store, next, see);
            walls.for_each_depth(store, next, see);
            next.overlap = std::min(found_overlap_, 1.0);
        }
        return next;
    }

    /// Updates the forecast of contacts.
    /// \param speed speed of the fastest particle or wall, m/s
    /// \param overlap least overlap of contacts, as a share of the smaller radius, 1
    /// \param chosen whether the library chooses the step
    void update_forecast(store_type const& store, interactions_type const& pairs, walls_type const& walls,
                         typename Model::damping::parameters const& damping, double speed, double overlap,
                         bool chosen) {
        forecast_.update(store, pairs, walls, damping, speed, overlap, chosen ? chosen_margin : 1);
    }

    /// Records an update.
    /// \param assumed assumptions of the update
    /// \param time_step present length of the step, s
    /// \param rigorous bound for the particles from the update, s
    /// \param accurate longest step that resolves a single contact well enough, s
    /// \param chosen whether the library chooses the step
    /// \param wet whether there is fluid
    void record_update(contact_assumption const& assumed, double time_step, double rigorous, double accurate,
                       bool chosen, bool wet) noexcept {
        ++updates_;
        assumed_ = assumed;
        // If nothing was counted, the step is that of contacts that may form.
        if (grows && chosen && !std::isfinite(rigorous))
            assumed_.overlap = std::max(assumed_.overlap, std::min(1.0, chosen_margin * forecast_.overlap()));
        approach_ = deepest_ = 0;
        due_ = false;
        credit_ = std::max(0LL, credit_ - price(wet));
        can_wait_ = time_step <= 0.9 * forecast_.crowded(rigorous);
        price_ = !can_wait_ ? 0 : !chosen ? 4 * price(wet) : time_step <= accurate ? price(wet) : price(wet) / 4;
    }
    /// Records the motion of a step.
    /// \param path upper bound of the path of every particle and wall in the step, m
    /// \param deepest largest overlap above the assumed one, as a share of the smaller radius, 1; 0: none
    /// \param failed whether bonds have failed, or another reason makes an update due
    void moved(double path, double deepest, bool failed) noexcept {
        last_approach_ = 2 * path;
        approach_ += last_approach_;
        deepest_ = std::max(deepest_, deepest);
        // One step early: the next step may already exceed the gap.
        due_ =
            due_ || failed || !(approach_ + last_approach_ <= assumed_.gap) || (grows && deepest_ > assumed_.overlap);
        credit_ = std::min(credit_ + 1, 4 * price_of_wet_update);
    }
    /// Makes an update of the limits due before the next step, whatever it costs.
    void update_next() noexcept {
        due_ = true;
        credit_ = 4 * price_of_wet_update;
    }
    /// Whether the next step must begin with an update.
    bool needs_update() const noexcept {
        return due_ && (credit_ >= price_ || (grows && deepest_ > forecast_.overlap()));
    }

    /// Resets everything, before the first step.
    void reset(bool wet) noexcept {
        *this = {};
        credit_ = 2 * price(wet);
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(forecast_, assumed_.gap, assumed_.overlap, approach_, last_approach_, deepest_, credit_, price_, updates_,
           due_, can_wait_);
        for (double const number : {assumed_.gap, assumed_.overlap, approach_, last_approach_, deepest_})
            require_state(number >= 0 && std::isfinite(number), "what its time step assumes of contacts");
    }

private:
    static constexpr double least_gap = 0.01, most_gap = 0.1; ///< over the smallest radius
    static constexpr double deeper = 1.25;
    /// Number of steps between two updates that can wait if the step is chosen; four times that if it is given. An
    /// update of a bonded sheet takes as long as 22 steps.
    static constexpr long long price_of_dry_update = 1000, price_of_wet_update = 1600;
    static constexpr long long price(bool wet) noexcept { return wet ? price_of_wet_update : price_of_dry_update; }
    /// Number of steps for which a wide gap should suffice.
    static constexpr long long lasting(bool wet) noexcept { return wet ? 1600 : 400; }

    contact_forecast<Model> forecast_;
    contact_assumption assumed_{};
    double approach_ = 0, last_approach_ = 0; // of two particles, since the last update and in the last step, m
    double deepest_ = 0;                      // largest overlap since the last update, as a share of the smaller radius
    mutable double found_overlap_ = 0;
    long long credit_ = 0, price_ = 0, updates_ = 0;
    bool due_ = false, can_wait_ = true;
};

} // namespace lacuna
