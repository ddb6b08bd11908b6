// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// External forces: the weight of all particles, and a force and a torque on single particles. These change linearly
/// within a ramp time from the load that acted before (at first none), or at once.
template <class Real, int Dim>
class load_set {
public:
    using point = vec<double, Dim>;
    using rotation = vec<double, rotation_dim<Dim>>;

    load_set() = default;
    /// \param gravity m/s^2
    /// \param weight_share share of a particle's weight that remains, 1 without a fluid that it displaces. One entry
    ///        per material, or per internal index if `by_particle`.
    /// \param by_particle true if particles have their own densities
    load_set(point const& gravity, std::vector<double> weight_share, bool by_particle = false)
        : gravity_(gravity), weight_share_(std::move(weight_share)), by_particle_(by_particle) {}

    /// Replaces the load on one particle.
    /// \param k internal index
    /// \param force N
    /// \param torque N m
    /// \param ramp_time duration of the linear change from the current load to this one, s; 0: at once
    /// \param now current time, s
    /// \throws std::invalid_argument naming the particle
    void set(particle_store<Real, Dim>& store, std::size_t k, point const& force, rotation const& torque,
             double ramp_time, double now) {
        std::string const name = "load on particle " + std::to_string(store.id(k));
        for (int axis = 0; axis < Dim; ++axis) require_finite(name + ".force", force[axis]);
        for (int axis = 0; axis < rotation_dim<Dim>; ++axis) require_finite(name + ".torque", torque[axis]);
        require_not_negative(name + ".ramp_time", ramp_time);
        one_load& l = load_of(k, store.size());
        auto const [force_now, torque_now] = l.at(now);
        l = {force, torque, force_now, torque_now, now, ramp_time};
        bool const listed = std::find(rising_.begin(), rising_.end(), k) != rising_.end();
        if (ramp_time > 0 && !listed) rising_.push_back(k);
        put(store, k, now);
    }

    /// Sets the loads that still change to their value at `time`, s.
    void advance(particle_store<Real, Dim>& store, double time) {
        if (rising_.empty()) return;
        for (std::size_t const k : rising_) put(store, k, time);
        std::erase_if(rising_, [&](std::size_t k) {
            one_load const& l = *find(k);
            return time >= l.start + l.ramp_time;
        });
    }

    /// Writes the weight of all particles into the store.
    void apply_weight(particle_store<Real, Dim>& store) {
        // Without weight, particles that have no load need no memory for it and no time in the step.
        if (!(squared_norm(gravity_) > 0)) return;
        for (std::size_t k = 0; k < store.size(); ++k) put(store, k, 0);
    }
    /// Sum over all loads of hash(particle, force, torque, previous force, previous torque, ramp time).
    template <class Hash>
    std::uint64_t sum_of_loads(Hash const& hash) const {
        std::uint64_t sum = 0;
        for (std::size_t k = 0; k < index_.size(); ++k)
            if (one_load const* l = find(k))
                sum += hash(k, l->force, l->torque, l->from_force, l->from_torque, l->ramp_time);
        return sum;
    }

    /// Writes or reads the loads.
    /// \param particles number of particles
    /// \throws std::runtime_error for loads that contradict each other or this number
    template <class Archive>
    void archive(Archive& ar, std::size_t particles) {
        std::vector<std::size_t> loaded;
        std::vector<one_load> values;
        for (std::size_t k = 0; k < index_.size(); ++k)
            if (one_load const* l = find(k)) {
                loaded.push_back(k);
                values.push_back(*l);
            }
        ar(loaded, values, rising_);
        if constexpr (Archive::is_loading::value) {
            require_state(loaded.size() == values.size(), "the number of loads");
            load_.clear();
            index_.clear();
            for (std::size_t n = 0; n < loaded.size(); ++n) {
                require_state(loaded[n] < particles && (n == 0 || loaded[n - 1] < loaded[n]), "a load on no particle");
                load_of(loaded[n], particles) = values[n];
            }
            for (std::size_t const k : rising_) require_state(find(k) != nullptr, "a ramp without a load");
        }
    }

private:
    struct one_load {
        point force{};
        rotation torque{};
        point from_force{}; ///< at `start`
        rotation from_torque{};
        double start = 0, ramp_time = 0;

        std::pair<point, rotation> at(double time) const {
            double const passed = time - start;
            double const share = passed >= ramp_time ? 1.0 : passed > 0 ? passed / ramp_time : 0.0;
            return {from_force * (1 - share) + force * share, from_torque * (1 - share) + torque * share};
        }
    };

    /// The load on a particle; nullptr if it never had one.
    one_load const* find(std::size_t k) const noexcept {
        return k < index_.size() && index_[k] >= 0 ? &load_[std::size_t(index_[k])] : nullptr;
    }
    /// The load on a particle, which may be new.
    one_load& load_of(std::size_t k, std::size_t particles) {
        if (index_.empty()) index_.assign(particles, -1);
        if (index_[k] < 0) {
            index_[k] = std::int32_t(load_.size());
            load_.push_back({});
        }
        return load_[std::size_t(index_[k])];
    }

    void put(particle_store<Real, Dim>& store, std::size_t k, double time) const {
        auto const* found = find(k);
        one_load const l = found ? *found : one_load{};
        auto const [force, torque] = l.at(time);
        double const weight = double(store.mass(k)) * weight_share_[by_particle_ ? k : std::size_t(store.material(k))];
        vec<Real, Dim> total{};
        for (int axis = 0; axis < Dim; ++axis) total[axis] = Real(force[axis] + weight * gravity_[axis]);
        store.set_applied_force(k, total);
        if constexpr (Dim == 2)
            store.set_applied_torque(k, Real(torque[0]));
        else if (squared_norm(l.torque) > 0 || store.torques().size() > 0)
            store.set_applied_torque(k, convert<Real>(torque));
    }

    point gravity_{};
    std::vector<double> weight_share_;
    bool by_particle_ = false;
    std::vector<one_load> load_;      ///< of each particle that ever had a load
    std::vector<std::int32_t> index_; ///< by internal index: index in load_, -1 if none; empty before the first load
    std::vector<std::size_t> rising_;
};

} // namespace lacuna
