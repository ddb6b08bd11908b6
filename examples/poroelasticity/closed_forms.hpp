// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

/// \file
/// Closed forms of Terzaghi, Mandel and Cryer (in the plane) as series. They use nothing of the library.

namespace poroelasticity {

/// A slab of unit half width or a disc of unit radius, drained at its rim, that starts at pressure 1. README.md derives
///
///   dp/dT + h d(mean p)/dT = laplacian(p),   p = 0 at the rim,   p = 1 at T = 0,
///
/// with h = 0 for Terzaghi's column and h = gamma G / K for Mandel's slab and Cryer's disc. The modes are f(a x) -
/// f(a). f is the cosine for the slab and Bessel's J_0 for the disc. Lengths, times and pressures are dimensionless.
class consolidation {
public:
    enum class shape { slab, disc };

    /// \param coupling h, >= 0
    /// \param ramp time T within which the load rises linearly from 0; 0: at once
    /// \param modes number of terms of the series
    explicit consolidation(shape of, double coupling, double ramp = 0, int modes = 200) : shape_(of), ramp_(ramp) {
        double const h = coupling;
        double low = 0;
        for (int k = 0; k < modes; ++k) {
            // The boundary condition changes sign between two extrema of f, so one root lies between them.
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
    /// Time and value of the highest pressure in the middle.
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

    double f(double a) const { return shape_ == shape::slab ? std::cos(a) : std::cyl_bessel_j(0, a); }
    /// Mean of f(a x) over the slab or disc.
    double mean_of_f(double a) const {
        return shape_ == shape::slab ? std::sin(a) / a : 2 * std::cyl_bessel_j(1, a) / a;
    }
    /// The condition at the rim, whose roots a are the modes.
    double condition(double h, double a) const { return (1 + h) * f(a) - h * mean_of_f(a); }
    /// The extremum of f after the extremum `from`: a zero of the sine or of J_1.
    double extremum(double from) const {
        if (shape_ == shape::slab) return from + std::numbers::pi;
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
        double const square = shape_ == shape::slab
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
    /// Mean of exp(-rate (T - s)) over the times s of the ramp, for a load that rises at a constant rate.
    double decay(double rate, double time) const {
        if (!(ramp_ > 0)) return std::exp(-rate * time);
        double const risen = time < ramp_ ? time : ramp_;
        return (std::exp(-rate * (time - risen)) - std::exp(-rate * time)) / (rate * ramp_);
    }

    shape shape_;
    double ramp_;
    std::vector<mode> modes_;
};

/// Stress of confined compression, divided by modulus times final strain. The strain rises linearly within `ramp` and
/// then stays (Mow, Kuei, Lai, Armstrong 1980, J. Biomech. Eng. 102, 73). Times are dimensionless as above.
inline double relaxing_stress(double time, double ramp, int modes = 2000) {
    double const risen = time < ramp ? time : ramp;
    double sum = 0;
    for (int n = 1; n <= modes; ++n) {
        double const rate = n * n * std::numbers::pi * std::numbers::pi;
        sum += 2 * (std::exp(-rate * (time - risen)) - std::exp(-rate * time)) / rate;
    }
    return (risen + sum) / ramp;
}

} // namespace poroelasticity
