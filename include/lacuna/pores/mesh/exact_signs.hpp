// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/pores/mesh/wide_number.hpp>

/// \file
/// Exact signs of the determinants on which a triangulation depends. Plain doubles are used where their error bound
/// guarantees the sign, otherwise sums of doubles that do not overlap (J. R. Shewchuk, Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates, Discrete Comput. Geom. 18 (1997) 305).

namespace lacuna::detail {

/// A number as the sum of doubles that do not overlap, the smallest first. Sums and products are exact.
class exact_number {
public:
    exact_number() = default;
    explicit exact_number(double a) {
        if (a != 0) part_.push_back(a);
    }
    static exact_number difference(double a, double b) { return exact_number(a) + exact_number(-b); }
    static exact_number square(double a) { return exact_number(a) * exact_number(a); }

    friend exact_number operator+(exact_number const& a, exact_number const& b) {
        if (a.part_.empty()) return b;
        if (b.part_.empty()) return a;
        std::vector<double> all(a.part_.size() + b.part_.size());
        std::merge(a.part_.begin(), a.part_.end(), b.part_.begin(), b.part_.end(), all.begin(),
                   [](double x, double y) { return std::fabs(x) < std::fabs(y); });
        exact_number sum;
        double carry = all[0];
        for (std::size_t k = 1; k < all.size(); ++k) {
            auto const [high, low] = two_sum(carry, all[k]);
            sum.add(low);
            carry = high;
        }
        sum.add(carry);
        return sum;
    }
    friend exact_number operator*(exact_number const& a, exact_number const& b) {
        exact_number product;
        for (double const factor : b.part_) {
            exact_number scaled;
            double carry = 0;
            for (double const part : a.part_) {
                double const high = part * factor, low = std::fma(part, factor, -high);
                auto const [sum, rest] = two_sum(carry, low);
                scaled.add(rest);
                auto const [next, rest_of_sum] = two_sum(high, sum);
                scaled.add(rest_of_sum);
                carry = next;
            }
            scaled.add(carry);
            product = product + scaled;
        }
        return product;
    }
    exact_number operator-() const {
        exact_number other(*this);
        for (double& part : other.part_) part = -part;
        return other;
    }
    friend exact_number operator-(exact_number const& a, exact_number const& b) { return a + -b; }

    /// The value, rounded to a relative error of a few units in the last coordinate; its sign is exact.
    double value() const noexcept {
        double sum = 0;
        for (double const part : part_) sum += part;
        return sum;
    }

private:
    static std::array<double, 2> two_sum(double a, double b) noexcept {
        double const sum = a + b, of_b = sum - a;
        return {sum, (a - (sum - of_b)) + (b - of_b)};
    }
    void add(double part) {
        if (part != 0) part_.push_back(part);
    }
    std::vector<double> part_;
};

/// Determinant of a small square matrix, expanded by its last column.
template <class T, std::size_t N>
T determinant(std::array<std::array<T, N>, N> const& m) {
    if constexpr (N == 1) {
        return m[0][0];
    } else if constexpr (N == 2) {
        return m[0][0] * m[1][1] - m[0][1] * m[1][0];
    } else {
        T sum{};
        for (std::size_t row = 0; row < N; ++row) {
            std::array<std::array<T, N - 1>, N - 1> minor;
            for (std::size_t r = 0; r + 1 < N; ++r)
                for (std::size_t c = 0; c + 1 < N; ++c) minor[r][c] = m[r < row ? r : r + 1][c];
            T const term = m[row][N - 1] * determinant(minor);
            sum = (row + N - 1) % 2 == 0 ? sum + term : sum - term;
        }
        return sum;
    }
}

/// Particles of a triangulation as exact_signs uses them: positions, and weights r^2 + shift. Lengths are scaled by a
/// power of two such that products of five do not overflow.
template <int Dim>
struct weighted_sites {
    static constexpr int most_exponent = 190; ///< lengths are under 2^190
    static constexpr double least = 0x1p-160; ///< products of five lengths above it are exact as sums of doubles

    std::vector<std::array<double, std::size_t(Dim)>> x;
    std::vector<double> radius, shift;
    double scale = 1; ///< 1 / m
    double reach = 0; ///< scaled_particles::reach, in the units of `x`
    /// Whether a length is under `least`, or a shift under its square. So it is if lengths differ by a factor of more
    /// than 2^349 (1e105), which those in single precision never do.
    bool wide = false;

    /// Length above which a simplex is never taken as degenerate: it has a particle far from the others, and may be
    /// thin without being flat.
    static double longest_degenerate(double reach) noexcept { return (Dim == 2 ? 100 : 10) * reach; }
    /// Power of two by which lengths are multiplied so that the reach becomes 1 to 2, and products of lengths that are
    /// not far above it do not underflow.
    static double unit(double reach) noexcept {
        return reach > 0 ? std::ldexp(1.0, std::min(-std::ilogb(reach), 1023)) : 1;
    }

    std::size_t size() const noexcept { return x.size(); }
    double weight(std::size_t k) const noexcept { return radius[k] * radius[k] + shift[k]; }
};

/// Position of a site relative to the orthogonal sphere of a simplex.
struct power_reading {
    double inside;  ///< > 0: the site is inside the sphere
    double share;   ///< inside / share is the change of weights that would put the site on the sphere
    double error;   ///< bound of the rounding error of `inside`
    double nearest; ///< smallest squared distance between any two of the corners and the site
};

/// Signs for simplices of sites; a simplex is an array of Dim + 1 site numbers.
template <int Dim>
class exact_signs {
public:
    static constexpr auto dim = std::size_t(Dim);
    using simplex = std::array<std::int32_t, dim + 1>;

    explicit exact_signs(weighted_sites<Dim> const& sites) : at_(sites) {}

    weighted_sites<Dim> const& sites() const noexcept { return at_; }

    /// Dim! times the size of a simplex, with exact sign; 0 when its corners lie on a line (in space: in a plane).
    double orientation(simplex const& s) const {
        std::array<std::array<double, dim>, dim> m, largest;
        for (std::size_t k = 0; k < dim; ++k)
            for (std::size_t a = 0; a < dim; ++a) {
                m[k][a] = coordinate(s[k + 1], a) - coordinate(s[0], a);
                largest[k][a] = std::fabs(m[k][a]);
            }
        double const size = determinant(m);
        if (std::fabs(size) > 1e-14 * permanent(largest) + underflow) return size;
        return at_.wide ? exact_orientation<wide_number>(s) : exact_orientation<exact_number>(s);
    }

    /// Whether the first `count` + 1 corners of s are not on one line; for count = 1, not at one point.
    bool independent(simplex const& s, std::size_t count) const {
        return at_.wide ? spans<wide_number>(s, count) : spans<exact_number>(s, count);
    }

    /// > 0 if site p is inside the orthogonal sphere of simplex s: below the plane through the simplex's corners in
    /// (x, |x|^2 - weight). < 0 above that plane, 0 on it; the sign is exact. s must have positive orientation.
    double inside(simplex const& s, std::int32_t p) const {
        auto const r = read(s, p);
        return std::fabs(r.inside) > r.error ? r.inside : exact_inside(s, p);
    }

    /// The same in plain doubles, with error bound and scales.
    power_reading read(simplex const& s, std::int32_t p) const noexcept {
        std::array<std::array<double, dim>, dim + 1> u;
        std::array<double, dim + 1> lift, bound;
        power_reading r{0, 0, underflow, 1e300};
        double const own = at_.weight(std::size_t(p));
        for (std::size_t k = 0; k <= dim; ++k) {
            double squared = 0;
            for (std::size_t a = 0; a < dim; ++a) {
                u[k][a] = coordinate(s[k], a) - coordinate(p, a);
                squared += u[k][a] * u[k][a];
            }
            double const weight = at_.weight(std::size_t(s[k]));
            lift[k] = squared - weight + own;
            bound[k] = squared + std::fabs(weight) + std::fabs(own);
            r.nearest = std::min(r.nearest, squared);
            for (std::size_t j = 0; j < k; ++j) {
                double apart = 0;
                for (std::size_t a = 0; a < dim; ++a) apart += (u[k][a] - u[j][a]) * (u[k][a] - u[j][a]);
                r.nearest = std::min(r.nearest, apart);
            }
        }
        double whole = 0;
        for (std::size_t k = 0; k <= dim; ++k) {
            std::array<std::array<double, dim>, dim> m, largest;
            for (std::size_t j = 0; j < dim; ++j)
                for (std::size_t a = 0; a < dim; ++a) {
                    m[j][a] = u[j < k ? j : j + 1][a];
                    largest[j][a] = std::fabs(m[j][a]);
                }
            double const size = determinant(m), signed_size = k % 2 == 0 ? size : -size;
            r.inside += signed_size * lift[k];
            r.error += 4e-14 * bound[k] * permanent(largest);
            r.share += std::fabs(size);
            whole += signed_size;
        }
        r.share += std::fabs(whole);
        return r;
    }

    double exact_inside(simplex const& s, std::int32_t p) const {
        return at_.wide ? exact_inside<wide_number>(s, p) : exact_inside<exact_number>(s, p);
    }

private:
    /// Bound of the error by underflow: each product errs by at most 2^-1075, times three other lengths under 2^191.
    static constexpr double underflow = 0x1p-490;

    template <class Number>
    double exact_orientation(simplex const& s) const {
        std::array<std::array<Number, dim>, dim> m;
        for (std::size_t k = 0; k < dim; ++k)
            for (std::size_t a = 0; a < dim; ++a)
                m[k][a] = Number::difference(coordinate(s[k + 1], a), coordinate(s[0], a));
        return determinant(m).value();
    }
    template <class Number>
    bool spans(simplex const& s, std::size_t count) const {
        auto const apart = [&](std::size_t k, std::size_t a) {
            return Number::difference(coordinate(s[k], a), coordinate(s[0], a));
        };
        for (std::size_t a = 0; a < dim; ++a) {
            std::size_t const b = (a + 1) % dim;
            auto const size = count == 1 ? apart(1, a) : apart(1, a) * apart(2, b) - apart(1, b) * apart(2, a);
            if (size.value() != 0) return true;
        }
        return false;
    }
    template <class Number>
    double exact_inside(simplex const& s, std::int32_t p) const {
        std::array<std::array<Number, dim + 1>, dim + 1> m;
        auto const weight = [&](std::int32_t k) {
            return Number::square(at_.radius[std::size_t(k)]) + Number(at_.shift[std::size_t(k)]);
        };
        auto const own = weight(p);
        for (std::size_t k = 0; k <= dim; ++k) {
            m[k][dim] = own - weight(s[k]);
            for (std::size_t a = 0; a < dim; ++a) {
                m[k][a] = Number::difference(coordinate(s[k], a), coordinate(p, a));
                m[k][dim] = m[k][dim] + m[k][a] * m[k][a];
            }
        }
        // The first term of the expansion by the last column, as in read(), has the sign (-1)^Dim.
        double const value = determinant(m).value();
        return Dim % 2 == 0 ? value : -value;
    }
    double coordinate(std::int32_t k, std::size_t axis) const noexcept { return at_.x[std::size_t(k)][axis]; }
    static double permanent(std::array<std::array<double, dim>, dim> const& m) noexcept {
        if constexpr (Dim == 2)
            return m[0][0] * m[1][1] + m[0][1] * m[1][0];
        else
            return m[0][0] * (m[1][1] * m[2][2] + m[1][2] * m[2][1]) +
                   m[0][1] * (m[1][0] * m[2][2] + m[1][2] * m[2][0]) +
                   m[0][2] * (m[1][0] * m[2][1] + m[1][1] * m[2][0]);
    }
    weighted_sites<Dim> const& at_;
};

} // namespace lacuna::detail
