// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <lacuna/core/state.hpp>
#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/simulation/contact_forecast.hpp>

namespace lacuna {

/// Decides when the bound of the time step has to be looked for again.
///
/// A look counts the contacts that touch or are no further apart than a gap; with laws that stiffen, at an overlap at
/// least. What it found holds until two bodies may have come together by more than the gap, a contact is deeper than
/// that, or a bond has failed. Then another look is due. Where no contact that may form makes the step unsafe
/// (contact_forecast), it waits until as many steps have passed as keep its cost small.
template <class Model>
class step_control {
public:
    static constexpr int dim = Model::dim;
    static constexpr bool grows = contact_forecast<Model>::grows;
    /// A step that is chosen is made for contacts that are deeper by this factor than those which stop the particles: at
    /// 0.2 of the bound a Hertzian collision takes some 20 steps, and gives the speeds back to 1e-3.
    static constexpr double chosen_margin = 16;

    contact_assumption const& assumed() const noexcept { return assumed_; }
    contact_forecast<Model> const& forecast() const noexcept { return forecast_; }
    /// Supports have changed: another look is due.
    void forget_forecast() noexcept {
        forecast_.forget();
        due_ = true;
    }
    /// Whether a contact that forms may make the step unsafe.
    bool cannot_wait() const noexcept { return !can_wait_; }
    /// How often a look was made.
    long long looks() const noexcept { return looks_; }

    /// What to assume next.
    /// \param chosen the step is one of our choice, not one to be judged
    /// \param wide a gap that lasts as long as a look should
    /// \param reach by how much two bodies may approach in a step that is thought of, m
    /// \param smallest_radius m
    /// \param wet there is fluid, which makes a look dear
    template <class Store, class Interactions, class Walls>
    contact_assumption next_assumption(Store const& store, Interactions const& pairs, Walls const& walls, bool chosen,
                                       bool wide, double reach, double smallest_radius, bool wet) const {
        contact_assumption next{std::clamp(reach, least_gap * smallest_radius, most_gap * smallest_radius), 0};
        if (wide)
            next.gap = std::clamp(last_approach_ * double(lasting(wet)), next.gap, most_gap * smallest_radius);
        double listed = pairs.remaining();
        if (!walls.empty()) listed = std::min(listed, walls.remaining());
        next.gap = std::max(0.0, std::min(next.gap, listed));
        if constexpr (grows) {
            if constexpr (requires { Model::contact_law::expected_overlap; })
                if (chosen) next.overlap = Model::contact_law::expected_overlap;
            // Slowly: the bodies that were fast, or deep, at the last look may only have turned round.
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

    /// What may come, for a speed of the fastest body, m/s.
    template <class Store, class Interactions, class Walls>
    void look_ahead(Store const& store, Interactions const& pairs, Walls const& walls,
                    typename Model::damping::parameters const& damping, double speed, double overlap, bool chosen) {
        forecast_.update(store, pairs, walls, damping, speed, overlap, chosen ? chosen_margin : 1);
    }

    /// A look has been made.
    /// \param rigorous bound that it found for the particles, s
    /// \param accurate the step above which a single contact would be followed too coarsely, s
    void looked(contact_assumption const& assumed, double time_step, double rigorous, double accurate, bool chosen,
                bool wet) noexcept {
        ++looks_;
        assumed_ = assumed;
        // Where nothing is counted the step is that of contacts to come.
        if (grows && chosen && !std::isfinite(rigorous))
            assumed_.overlap = std::max(assumed_.overlap, std::min(1.0, chosen_margin * forecast_.overlap()));
        approach_ = deepest_ = 0;
        due_ = false;
        credit_ = std::max(0LL, credit_ - price(wet));
        can_wait_ = time_step <= 0.9 * forecast_.crowded(rigorous);
        price_ = !can_wait_ ? 0 : !chosen ? 4 * price(wet) : time_step <= accurate ? price(wet) : price(wet) / 4;
    }
    /// After a step.
    /// \param path upper bound of the path of every particle and wall in it, m
    /// \param deepest overlap beyond the assumed one that contacts had, as a share of the smaller radius; 0: none
    /// \param failed whether bonds have failed
    void moved(double path, double deepest, bool failed) noexcept {
        last_approach_ = 2 * path;
        approach_ += last_approach_;
        deepest_ = std::max(deepest_, deepest);
        // Before the next step may be one too many.
        due_ = due_ || failed || !(approach_ + last_approach_ <= assumed_.gap) || (grows && deepest_ > assumed_.overlap);
        credit_ = std::min(credit_ + 1, 4 * price_of_wet_look);
    }
    /// Whether to look before the next step.
    bool looks_now() const noexcept { return due_ && (credit_ >= price_ || (grows && deepest_ > forecast_.overlap())); }

    /// Starts anew: before the first step.
    void reset(bool wet) noexcept {
        *this = {};
        credit_ = 2 * price(wet);
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(forecast_, assumed_.gap, assumed_.overlap, approach_, last_approach_, deepest_, credit_, price_, looks_, due_,
           can_wait_);
        for (double const number : {assumed_.gap, assumed_.overlap, approach_, last_approach_, deepest_})
            require_state(number >= 0 && std::isfinite(number), "what its time step assumes of contacts");
    }

private:
    static constexpr double least_gap = 0.01, most_gap = 0.1; ///< over the smallest radius
    static constexpr double deeper = 1.25;
    /// In steps: what lies between two looks that can wait, where the step is chosen; four times that where it is given. A
    /// look at a bonded sheet takes as long as 22 steps.
    static constexpr long long price_of_dry_look = 1000, price_of_wet_look = 1600;
    static constexpr long long price(bool wet) noexcept { return wet ? price_of_wet_look : price_of_dry_look; }
    /// For how many steps a wide gap should do.
    static constexpr long long lasting(bool wet) noexcept { return wet ? 1600 : 400; }

    contact_forecast<Model> forecast_;
    contact_assumption assumed_{};
    double approach_ = 0, last_approach_ = 0; ///< of two bodies, since the last look and in the last step, m
    double deepest_ = 0;                      ///< share of the smaller radius
    mutable double found_overlap_ = 0;
    long long credit_ = 0, price_ = 0, looks_ = 0;
    bool due_ = false, can_wait_ = true;
};

} // namespace lacuna
