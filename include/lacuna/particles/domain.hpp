// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/scalar.hpp>
#include <lacuna/core/vec.hpp>

/// \file
/// Domain policies: the space that contains a model's particles.

namespace lacuna {

/// Unbounded space.
struct open_domain {
    static constexpr bool periodic = false;
    template <int Dim>
    struct parameters {
        void validate(std::string const&) const {}
    };
};

/// Space that repeats along some axes: each particle has images one period apart. Two particles interact along the
/// shortest vector between any of their images. Positions are not wrapped into one period, so they show how far a
/// particle has moved. Periods are constant.
struct periodic_domain {
    static constexpr bool periodic = true;
    template <int Dim>
    struct parameters {
        vec<double, Dim> period{}; ///< m; 0: open along this axis

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            double longest = 0;
            for (int axis = 0; axis < Dim; ++axis) {
                require_not_negative(name + ".period", period[axis]);
                longest = longest < period[axis] ? period[axis] : longest;
            }
            if (!(longest > 0)) refuse(name + ".period", longest, "> 0 along one axis at least");
        }
    };
};

namespace detail {
template <class D>
concept domain_flag = requires {
    { D::periodic } -> std::convertible_to<bool>;
};
template <class D, int Dim>
concept domain_parameters = std::default_initializable<typename D::template parameters<Dim>> &&
    requires(typename D::template parameters<Dim> const& p, std::string const& name) { p.validate(name); };
template <class D, int Dim>
concept domain_period = !requires { requires D::periodic; } || requires(typename D::template parameters<Dim> const& p) {
    { p.period } -> std::convertible_to<vec<double, Dim>>;
};
} // namespace detail

/// Requirements on a domain policy, such as open_domain and periodic_domain: the constant `periodic`, and
/// `parameters<Dim>` with `validate(std::string const& name)` and, if periodic, `period`, m.
template <class D, int Dim = 2>
concept domain_policy = detail::domain_flag<D> && detail::domain_parameters<D, Dim> && detail::domain_period<D, Dim>;

/// The periods of a domain, m, and their inverses, 1/m; 0 along open axes.
template <class Real, int Dim>
struct periods {
    vec<Real, Dim> length{}, inverse{};

    static periods of(vec<double, Dim> const& length) noexcept {
        periods p;
        for (int axis = 0; axis < Dim; ++axis) {
            p.length[axis] = Real(length[axis]);
            p.inverse[axis] = length[axis] > 0 ? Real(1 / length[axis]) : Real(0);
        }
        return p;
    }
    bool any() const noexcept { return squared_norm(inverse) > Real(0); }

    /// The shortest vector from a point to an image of another.
    /// \param between vector from the point to the other point, m
    template <class T>
    vec<T, Dim> shortest(vec<T, Dim> between) const noexcept {
        // A number this large has no fractional digits: adding and subtracting it rounds packs and plain numbers alike.
        constexpr auto large = value_t<T>(sizeof(value_t<T>) == 8 ? 6755399441055744.0 : 12582912.0);
        for (int axis = 0; axis < Dim; ++axis) {
            T whole = (between[axis] * T(inverse[axis]) + T(large)) - T(large);
            between[axis] = between[axis] - whole * T(length[axis]);
        }
        return between;
    }
};

} // namespace lacuna
