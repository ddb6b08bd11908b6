// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/scalar.hpp>
#include <lacuna/core/vec.hpp>

/// \file
/// Domain policies: the space in which a model's particles are.

namespace lacuna {

/// Without end.
struct open_domain {
    static constexpr bool periodic = false;
    template <int Dim>
    struct parameters {
        void validate(std::string const&) const {}
    };
};

/// Repeats itself along some axes: each particle stands for itself and for its images, a period apart. Two particles meet
/// by the shortest way between any of their images. Positions are not brought back into one period: they tell how far a
/// particle has come. Periods stay as they are.
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

/// A domain policy, the slot filled by open_domain and periodic_domain: the constant `periodic`, and `parameters<Dim>` with
/// `validate(std::string const& name)` and, where periodic, `period`, m.
template <class D, int Dim = 2>
concept domain_policy = detail::domain_flag<D> && detail::domain_parameters<D, Dim> && detail::domain_period<D, Dim>;

/// The periods of a domain, and their inverses; 0 along open axes.
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

    /// The shortest of the ways that lead from one point to the images of another.
    template <class T>
    vec<T, Dim> shortest(vec<T, Dim> way) const noexcept {
        // A number this large has no places after the point: adding it rounds, for packs as for plain numbers.
        constexpr auto large = value_t<T>(sizeof(value_t<T>) == 8 ? 6755399441055744.0 : 12582912.0);
        for (int axis = 0; axis < Dim; ++axis) {
            T whole = (way[axis] * T(inverse[axis]) + T(large)) - T(large);
            way[axis] = way[axis] - whole * T(length[axis]);
        }
        return way;
    }
};

} // namespace lacuna
