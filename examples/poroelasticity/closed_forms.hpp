// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

/// \file
/// Closed forms of Terzaghi, Mandel and Cryer (disc), as series over time; nothing of the library is used.

namespace poroelasticity {

/// Drained bodies of unit half width or radius that start at pressure 1: README.md derives
///
///   dp/dT + h d(mean p)/dT = laplacian(p),   p = 0 at the rim,   p = 1 at T = 0,
///
/// with h = 0 for Terzaghi's column and h = gamma G / K for Mandel's slab and Cryer's disc. Its modes are
/// f(a x) - f(a), with f the cosine for the slab and Bessel's J_0 for the disc.
class consolidation {
public:
    enum class body { slab, disc };

    /// \param coupling h, >= 0
    /// \param ramp the load rises linearly within this time T, from pressure 0; 0: at once
    explicit consolidation(body shape, double coupling, double ramp = 0, int modes = 200)
        : shape_(shape), ramp_(ramp) {
        double const h = coupling;
        double low = 0;
        for (int k = 0; k < modes; ++k) {
            // One root lies between two extrema of f, where the boundary's condition changes sign.
            double const high = extremum(low);
            double a = k == 0 ? 1e-3 : low, b = high;
            bool const rising = condition(h, b) > 0;
            for (int i = 0; i < 100; ++i) {
                double const middle = (a + b) / 2;
                ((condition(h, middle) > 0) == rising ? b : a) = middle;
            }
            add_mode(h, (a + b) / 2);
            low = high;
        }
    }

    /// Pressure at x (0: middle, 1: rim) at time T.
    double pressure(double x, double time) const {
        return sum(time, [&](mode const& m) { return m.weight * (f(m.root * x) - f(m.root)); });
    }
    /// Mean pressure; 1 - mean is Terzaghi's degree of consolidation.
    double mean(double time) const {
        return sum(time, [](mode const& m) { return m.weight * m.mean; });
    }

    struct peak_point {
        double time, pressure;
    };
    /// The largest pressure in the middle.
    peak_point peak() const {
        double low = ramp_ + 1e-3, high = 0.5;
        for (int i = 0; i < 200; ++i) {
            double const a = low + (high - low) / 3, b = high - (high - low) / 3;
            (pressure(0, a) < pressure(0, b) ? low : high) = pressure(0, a) < pressure(0, b) ? a : b;
        }
        return {(low + high) / 2, pressure(0, (low + high) / 2)};
    }

private:
    struct mode {
        double root, weight, mean;
    };

    double f(double a) const { return shape_ == body::slab ? std::cos(a) : std::cyl_bessel_j(0, a); }
    /// Mean of f(a x) over the body.
    double mean_of_f(double a) const {
        return shape_ == body::slab ? std::sin(a) / a : 2 * std::cyl_bessel_j(1, a) / a;
    }
    double condition(double h, double a) const { return (1 + h) * f(a) - h * mean_of_f(a); }
    /// The next extremum of f beyond one: a zero of the sine or of J_1.
    double extremum(double from) const {
        if (shape_ == body::slab) return from + std::numbers::pi;
        double a = from + 2.5, b = from + 4;
        bool const rising = std::cyl_bessel_j(1, b) > 0;
        for (int i = 0; i < 100; ++i) {
            double const middle = (a + b) / 2;
            ((std::cyl_bessel_j(1, middle) > 0) == rising ? b : a) = middle;
        }
        return (a + b) / 2;
    }
    void add_mode(double h, double a) {
        double const mean = mean_of_f(a) - f(a);
        // Mean of mode times (mode + h mean(mode)); the latter is f(a x).
        double const square = shape_ == body::slab
                                  ? 0.5 + std::sin(2 * a) / (4 * a)
                                  : std::pow(std::cyl_bessel_j(0, a), 2) + std::pow(std::cyl_bessel_j(1, a), 2);
        modes_.push_back({a, (1 + h) * mean / (square - f(a) * mean_of_f(a)), mean});
    }
    template <class Term>
    double sum(double time, Term const& term) const {
        double total = 0;
        for (auto const& m : modes_) total += term(m) * decay(m.root * m.root, time);
        return total;
    }
    /// Mean of exp(-rate (T - s)) over the times s at which the load has risen.
    double decay(double rate, double time) const {
        if (!(ramp_ > 0)) return std::exp(-rate * time);
        double const risen = time < ramp_ ? time : ramp_;
        return (std::exp(-rate * (time - risen)) - std::exp(-rate * time)) / (rate * ramp_);
    }

    body shape_;
    double ramp_;
    std::vector<mode> modes_;
};

} // namespace poroelasticity
