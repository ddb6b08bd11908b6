// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>

#include <lacuna/core/error.hpp>
#include <lacuna/core/parallel.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// A particle as a body force sees it, in double precision whatever the model's.
template <int Dim>
struct acted_particle {
    vec<double, Dim> position; ///< m
    vec<double, Dim> velocity; ///< m/s, half a step before the position
    double radius;             ///< m
    double mass;               ///< kg
    int material;              ///< number of its material
    std::size_t id;            ///< number in the packing
    double time;               ///< s
};

/// A model without forces of its own: the default of the slot `forces`.
struct no_forces {
    struct parameters {
        void validate(std::string const&) const {}
    };
    template <class Real, int Dim>
    class term {
    public:
        term() = default;
        explicit term(parameters const&) {}
        static constexpr bool active() noexcept { return false; }
    };
};

/// The model's own force on each particle, for the slot `forces`: attraction of a centre, drag of a gas, a field.
///
/// Force is a struct or a lambda, called as `force(acted_particle<Dim> const&) -> vec<double, Dim>`, N. It sees one
/// particle and may run on several threads at once; results do not depend on their number. A member
/// `validate(std::string const& name) const` checks its parameters. Its work is part of the ledger's external work. Its
/// derivatives by position and velocity, from central differences, enter the bound of the time step.
/// \code
/// inline constexpr auto pull = [](lacuna::acted_particle<2> const& p) { return p.position * (-9.0 * p.mass); };
/// struct model : lacuna::default_model<2> {
///     using forces = lacuna::body_force<decltype(pull)>;
/// };
/// \endcode
template <class Force>
struct body_force {
    struct parameters {
        std::remove_cv_t<Force> force{}; ///< what is called
        void validate([[maybe_unused]] std::string const& name) const {
            if constexpr (requires { force.validate(name); }) force.validate(name + ".force");
        }
    };

    /// The force in one simulation.
    template <class Real, int Dim>
    class term {
    public:
        using store_type = particle_store<Real, Dim>;

        term() = default;
        explicit term(parameters const& p) : force_(p.force) {}
        static constexpr bool active() noexcept { return true; }

        /// Adds the force on each particle to `out`: one record {force, torque over radius} per particle in 2D, two in
        /// 3D.
        /// \param time of the positions, s
        void add_forces(store_type const& store, double time, int threads, record_column<Real>& out) {
            forces_.resize(store.size());
            constexpr std::size_t block = 512;
            int const blocks = int((store.size() + block - 1) / block);
            for_each_chunk(blocks, threads, [&](int b) {
                std::size_t const end = std::min(store.size(), (std::size_t(b) + 1) * block);
                for (std::size_t k = std::size_t(b) * block; k < end; ++k) {
                    auto const f = force_on(seen(store, k, time));
                    for (int axis = 0; axis < Dim; ++axis) {
                        forces_.at(k, axis) = Real(f[axis]);
                        out.at(Dim == 2 ? k : 2 * k, axis) += Real(f[axis]);
                    }
                }
            });
        }
        /// Force on particle k at the last evaluation, N.
        vec<Real, Dim> force(std::size_t k) const noexcept {
            vec<Real, Dim> f{};
            for (int axis = 0; axis < Dim; ++axis) f[axis] = forces_.at(k, axis);
            return f;
        }
        /// Power of the forces of the last evaluation at the present velocities, W.
        double power(store_type const& store) const noexcept {
            double sum = 0;
            for (std::size_t k = 0; k < store.size(); ++k) sum += double(dot(force(k), store.velocity(k)));
            return sum;
        }

        /// Adds the derivatives of the force by position and by velocity to bounds of the time step.
        template <class Bound>
        void add_stiffness(store_type const& store, double time, Bound& stiff, Bound& viscous) const {
            for (std::size_t k = 0; k < store.size(); ++k) {
                auto const at = seen(store, k, time);
                double const length = 1e-5 * at.radius, speed = 1e-5 * std::max(norm(at.velocity), at.radius);
                stiff.add_matrix(k, slope(at, &acted_particle<Dim>::position, length));
                viscous.add_matrix(k, slope(at, &acted_particle<Dim>::velocity, speed));
            }
        }

    private:
        using point = vec<double, Dim>;
        using matrix = std::array<point, std::size_t(Dim)>; ///< by rows

        static acted_particle<Dim> seen(store_type const& store, std::size_t k, double time) {
            return {convert<double>(store.position(k)), convert<double>(store.velocity(k)), double(store.radius(k)),
                    double(store.mass(k)), store.material(k), std::size_t(store.id(k)), time};
        }
        point force_on(acted_particle<Dim> const& p) const {
            static_assert(std::is_invocable_r_v<point, Force const&, acted_particle<Dim> const&>,
                          "a body force must be callable as: vec<double, dim> force(acted_particle<dim> const&) const");
            return force_(p);
        }
        /// Minus the derivative of the force by one of the particle's vectors.
        matrix slope(acted_particle<Dim> at, point acted_particle<Dim>::*variable, double step) const {
            matrix result{};
            for (int axis = 0; axis < Dim; ++axis) {
                double const middle = (at.*variable)[axis];
                (at.*variable)[axis] = middle + step;
                double const above = (at.*variable)[axis];
                point const high = force_on(at);
                (at.*variable)[axis] = middle - step;
                double const below = (at.*variable)[axis];
                point const low = force_on(at);
                (at.*variable)[axis] = middle;
                for (int row = 0; row < Dim; ++row)
                    result[std::size_t(row)][axis] = (low[row] - high[row]) / (above - below);
            }
            return result;
        }

        std::remove_cv_t<Force> force_{};
        record_column<Real> forces_;
    };
};

namespace detail {
template <class F>
concept forces_parameters = std::default_initializable<typename F::parameters> &&
    requires(typename F::parameters const& p, std::string const& name) { p.validate(name); };
template <class F, class Real, int Dim>
concept forces_term = std::copyable<typename F::template term<Real, Dim>> &&
    std::constructible_from<typename F::template term<Real, Dim>, typename F::parameters const&> &&
    requires(typename F::template term<Real, Dim> const& term) {
        { term.active() } -> std::convertible_to<bool>;
    };
/// What a step asks of a term that is not no_forces.
template <class F, class Real, int Dim>
concept forces_members = std::is_same_v<F, no_forces> ||
    requires(typename F::template term<Real, Dim>& term, particle_store<Real, Dim> const& store,
             record_column<Real>& out) {
        term.add_forces(store, 1.0, 1, out);
        { term.force(std::size_t(0)) } -> std::convertible_to<vec<Real, Dim>>;
        { term.power(store) } -> std::convertible_to<double>;
    };
template <class F, int Dim>
inline constexpr bool is_callable_force = true;
template <class Force, int Dim>
inline constexpr bool is_callable_force<body_force<Force>, Dim> =
    std::is_invocable_r_v<vec<double, Dim>, Force const&, acted_particle<Dim> const&>;
} // namespace detail

/// Forces of a model's own, the slot filled by no_forces and body_force.
template <class F, int Dim, class Real = double>
concept forces_policy = detail::forces_parameters<F> && detail::is_callable_force<F, Dim> &&
    detail::forces_term<F, Real, Dim> && detail::forces_members<F, Real, Dim>;

} // namespace lacuna
