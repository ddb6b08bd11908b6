// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <type_traits>

#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/damping.hpp>
#include <lacuna/laws/frictional_spring.hpp>
#include <lacuna/laws/law_concepts.hpp>
#include <lacuna/laws/no_contact.hpp>
#include <lacuna/loads/body_force.hpp>
#include <lacuna/motion/symplectic_euler.hpp>
#include <lacuna/neighbors/cell_grid.hpp>
#include <lacuna/particles/domain.hpp>
#include <lacuna/pores/flow/flow.hpp>

namespace lacuna {

/// The parts of a simulator that a model does not name itself. A model starts from it and overrides by name:
/// \code
/// struct my_model : lacuna::default_model<2> {
///     using damping = lacuna::local_damping;
/// };
/// \endcode
/// Its slots are the members below. A misspelt one would leave the default in place: names that are nearly a slot's are
/// refused (simulation/slot_names.hpp); any other member is taken for the model's own.
template <int Dim, class Real = double>
struct default_model {
    static constexpr int dim = Dim;
    using real = Real;
    using contact_law = frictional_spring;
    using bond_law = brittle_spring_bond;
    using damping = no_damping;
    using flow = no_flow;
    using forces = no_forces;
    using integrator = symplectic_euler;
    using domain = open_domain;
    template <class R, int D>
    using search = cell_grid<R, D>;
};

/// Whether a model has a fluid.
template <class M>
inline constexpr bool has_fluid = !std::is_same_v<typename M::flow, no_flow>;

/// Whether models can have this dimension.
template <int Dim>
inline constexpr bool plane_or_space = Dim == 2 || Dim == 3;

/// A complete set of parts, each of the kind its slot asks for.
template <class M>
concept model = plane_or_space<M::dim> && std::floating_point<typename M::real> &&
    contact_law<typename M::contact_law, M::dim> && bond_law<typename M::bond_law, M::dim> &&
    damping_policy<typename M::damping> && flow_policy<typename M::flow, M::dim, typename M::real> &&
    forces_policy<typename M::forces, M::dim, typename M::real> && integrator<typename M::integrator, M::dim> &&
    domain_policy<typename M::domain, M::dim> &&
    neighbor_search<typename M::template search<typename M::real, M::dim>>;

} // namespace lacuna
