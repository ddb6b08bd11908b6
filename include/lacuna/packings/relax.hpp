// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/particles/packing_grid.hpp>

namespace lacuna::detail {

/// Discs in a rectangle that repel each other. The unit of length is such that the mean radius is about 1. The first
/// `fixed` discs are obstacles: they neither move nor change their radius.
struct disc_bed {
    std::vector<vec<double, 2>> x;
    std::vector<double> r;
    std::size_t fixed = 0;
    vec<double, 2> low{};
    vec<double, 2> high{};
    bool hard[2] = {true, true}; ///< per axis: the whole disc stays inside (else only its centre)

    /// Overlap of disc i with the sides across an axis: positive at the lower side, negative at the upper one, or 0.
    double side_overlap(std::size_t i, int axis) const {
        double const reach = hard[axis] ? r[i] : 0.0;
        double const below = low[axis] + reach - x[i][axis];
        if (below > 0) return below;
        double const above = x[i][axis] + reach - high[axis];
        return above > 0 ? -above : 0.0;
    }
};

/// Minimises the elastic energy of the overlaps (unit stiffness per contact) by FIRE: Bitzek et al.,
/// Phys. Rev. Lett. 97, 170201 (2006).
class disc_relaxer {
public:
    explicit disc_relaxer(disc_bed& bed) : bed_(bed) {}

    /// Call it after adding or removing discs, and after changing radii by more than `skin`/4 in total.
    void reset() { listed_at_.clear(); }

    /// Takes at most `steps` steps. Stops early if no overlap exceeds `enough`, or if forces are balanced.
    void run(int steps, double enough) {
        std::size_t const n = bed_.x.size();
        velocity_.assign(n, vec<double, 2>{0, 0});
        double dt = 0.1, mixing = 0.1;
        int downhill = 0;
        for (int step = 0; step < steps; ++step) {
            forces();
            if (largest_overlap_ <= enough || largest_force_ < 1e-3 * mean_overlap_) return;
            double power = 0, v2 = 0, f2 = 0;
            for (std::size_t i = bed_.fixed; i < n; ++i) {
                power += dot(force_[i], velocity_[i]);
                v2 += squared_norm(velocity_[i]);
                f2 += squared_norm(force_[i]);
            }
            if (power > 0) {
                double const steering = f2 > 0 ? mixing * std::sqrt(v2 / f2) : 0.0;
                for (std::size_t i = bed_.fixed; i < n; ++i)
                    velocity_[i] = (1 - mixing) * velocity_[i] + steering * force_[i];
                if (++downhill > 5) {
                    dt = std::min(dt * 1.1, 0.45);
                    mixing *= 0.99;
                }
            } else {
                for (auto& v : velocity_) v = {0, 0};
                dt *= 0.5;
                mixing = 0.1;
                downhill = 0;
            }
            for (std::size_t i = bed_.fixed; i < n; ++i) {
                velocity_[i] += dt * force_[i];
                bed_.x[i] += clip_norm(dt * velocity_[i], 0.15);
            }
        }
        forces();
    }

    /// For each disc the sum of its overlaps with other discs and the sides, at the last call of forces().
    std::vector<double> const& pressure() const { return pressure_; }
    /// At the last call of forces().
    double largest_overlap() const { return largest_overlap_; }

    /// Computes forces and overlaps in the present positions.
    void forces() {
        if (stale()) list();
        std::size_t const n = bed_.x.size();
        force_.assign(n, vec<double, 2>{0, 0});
        pressure_.assign(n, 0.0);
        largest_overlap_ = largest_force_ = 0;
        double sum = 0;
        std::size_t contacts = 0;
        for (std::size_t i = bed_.fixed; i < n; ++i) {
            vec<double, 2> const xi = bed_.x[i];
            vec<double, 2> f = force_[i];
            double const ri = bed_.r[i];
            for (std::size_t k = start_[i - bed_.fixed]; k < start_[i - bed_.fixed + 1]; ++k) {
                std::size_t const j = other_[k];
                vec<double, 2> const d = bed_.x[j] - xi;
                double const reach = ri + bed_.r[j], d2 = squared_norm(d);
                if (d2 >= reach * reach) continue;
                double const distance = std::sqrt(d2), overlap = reach - distance;
                vec<double, 2> const push = distance > 0 ? d * (overlap / distance) : vec<double, 2>{overlap, 0};
                f = f - push;
                force_[j] += push;
                pressure_[i] += overlap;
                pressure_[j] += overlap;
                largest_overlap_ = std::max(largest_overlap_, overlap);
                sum += overlap;
                ++contacts;
            }
            for (int axis = 0; axis < 2; ++axis) {
                double const side = bed_.side_overlap(i, axis);
                f[axis] += side;
                pressure_[i] += std::fabs(side);
                largest_overlap_ = std::max(largest_overlap_, std::fabs(side));
            }
            force_[i] = f;
        }
        for (std::size_t i = bed_.fixed; i < n; ++i)
            largest_force_ = std::max(largest_force_, squared_norm(force_[i]));
        largest_force_ = std::sqrt(largest_force_);
        mean_overlap_ = contacts ? sum / double(contacts) : 0.0;
    }

    /// Calls visit(i, j) for every pair in the neighbour list: i is mobile; j is mobile with j > i, or an obstacle.
    template <class Visit>
    void for_each_pair(Visit&& visit) {
        if (stale()) list();
        for (std::size_t i = bed_.fixed; i < bed_.x.size(); ++i)
            for (std::size_t k = start_[i - bed_.fixed]; k < start_[i - bed_.fixed + 1]; ++k)
                visit(i, std::size_t(other_[k]));
    }

private:
    static constexpr double skin = 0.5;

    bool stale() const {
        if (listed_at_.size() != bed_.x.size()) return true;
        for (std::size_t i = bed_.fixed; i < bed_.x.size(); ++i)
            if (squared_norm(bed_.x[i] - listed_at_[i]) > (skin / 4) * (skin / 4)) return true;
        return false;
    }

    void list() {
        std::size_t const n = bed_.x.size();
        double largest = 0;
        for (double r : bed_.r) largest = std::max(largest, r);
        grid_.build(bed_.x, 2 * largest + skin);
        start_.assign(n - bed_.fixed + 1, 0);
        other_.clear();
        for (std::size_t i = bed_.fixed; i < n; ++i) {
            grid_.for_each_near(bed_.x[i], bed_.r[i] + largest + skin, [&](std::size_t j) {
                if (j <= i && j >= bed_.fixed) return;
                double const reach = bed_.r[i] + bed_.r[j] + skin;
                if (squared_norm(bed_.x[j] - bed_.x[i]) < reach * reach) other_.push_back(std::uint32_t(j));
            });
            start_[i - bed_.fixed + 1] = other_.size();
        }
        listed_at_ = bed_.x;
    }

    disc_bed& bed_;
    disc_grid grid_;
    std::vector<vec<double, 2>> listed_at_, force_, velocity_;
    std::vector<double> pressure_;
    std::vector<std::size_t> start_;
    std::vector<std::uint32_t> other_;
    double largest_overlap_ = 0, largest_force_ = 0, mean_overlap_ = 0;
};

} // namespace lacuna::detail
