// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <lacuna/core/dual.hpp>
#include <lacuna/core/error.hpp>
#include <lacuna/core/fields.hpp>
#include <lacuna/interactions/storage/pair_table.hpp>
#include <lacuna/laws/pair_motion.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Stiffness of a pair that a bound of the stable time step has to assume, N/m.
struct pair_stiffness {
    double normal, shear;
};

/// Tangent stiffness of one pair: derivative of its forces by the relative motion of its particles.
template <int Dim>
struct pair_tangent {
    std::size_t i, j;        ///< internal indices
    bool bonded;             ///< a bond, else a contact
    vec<double, Dim> normal; ///< unit vector from i to j
    double normal_stiffness; ///< N/m
    double shear_stiffness;  ///< N/m
    double prestress;        ///< force of the pair over its distance, N/m
    double lever_i, lever_j; ///< from the centres to the point where the shear force acts, m
    moment_stiffness<double> moments; ///< N m/rad; zero for laws that carry no moments
};

/// Assumptions about contacts that hold until the bound of the stable time step is computed again.
struct contact_assumption {
    double gap = 0;     ///< pairs with a larger gap do not touch, m
    double overlap = 0; ///< laws that stiffen: least overlap of contacts, as a share of the smaller radius, 1
};

/// Tangent of a law from its derivatives by dual numbers, at the given distance and without slip.
///
/// A contact with a gap counts as if it just touched. If the law states a larger constant as its stiffness, that
/// constant counts: a yielded contact is stiffer in unloading than in loading. The coupling between normal and shear is
/// added to both, so that the diagonal pair is an upper bound of the full tangent.
/// \param distance m
/// \param bonded the pair is a bond, without force at this distance; else it touches at r_i + r_j
/// \param least_overlap a contact counts with at least this overlap, m
template <class Law, int Dim, class Real>
pair_stiffness law_stiffness(typename Law::template parameters<Real> const& parameters, double distance,
                             double radius_i, double radius_j, bool bonded, double least_overlap = 0) {
    using number = dual<double, 2>;
    double const touching = radius_i + radius_j;
    double const at = bonded ? distance : std::min(distance, touching - std::max(least_overlap, touching * 1e-6));
    pair_motion<number, Dim> motion{};
    motion.distance = number::variable(at, 0);
    motion.radius_i = number(radius_i);
    motion.radius_j = number(radius_j);
    motion.slip[0] = number::variable(0, 1);
    auto const p = convert_fields<number, Real, typename Law::template parameters<number>>(
        parameters, [](Real x) { return number(double(x)); });
    auto const state = Law::template initial<number, Dim>(number(bonded ? at : touching), number(touching));
    auto const answer = Law::evaluate(p, motion, state);
    double const coupling =
        std::max(std::fabs(answer.normal_force.derivative[1]), std::fabs(answer.shear_force[0].derivative[0]));
    double normal = std::fabs(answer.normal_force.derivative[0]);
    if constexpr (requires { Law::stiffness(parameters); })
        normal = std::max(normal, double(Law::stiffness(parameters)));
    return {normal + coupling, std::fabs(answer.shear_force[0].derivative[1]) + coupling};
}

/// \throws std::invalid_argument for a contact law whose tangent at an overlap of a tenth of the radius is above that
///         at first touch and above the constant that it states: no bound of the time step would follow it
/// \param radius of the two particles of the trial, m
template <class Law, int Dim, class Real>
void require_stated_stiffness(typename Law::template parameters<Real> const& parameters, double radius) {
    if constexpr (!stiffens<Law, Dim>) {
        double const touching = law_stiffness<Law, Dim>(parameters, 2 * radius, radius, radius, false).normal;
        double const pressed =
            law_stiffness<Law, Dim>(parameters, 2 * radius, radius, radius, false, 0.1 * radius).normal;
        if (pressed > 1.01 * touching)
            refuse("stiffness of the contact law", to_text(pressed) + " N/m at an overlap of a tenth of the radius",
                   "at most what stiffness(parameters) states, or what it is at first touch (" + to_text(touching) +
                       " N/m); a law that stiffens has stiffness(parameters, pair_motion, history)");
    }
}

/// Smaller radius of a pair, m. At a wall (radius_j = 0) it is the particle's radius.
inline double smaller_radius(double radius_i, double radius_j) noexcept {
    return radius_j > 0 ? std::min(radius_i, radius_j) : radius_i;
}

/// Tangent of a contact under an assumption.
/// \param overlap m; negative: a gap
template <class Law, int Dim, class Real>
pair_stiffness contact_stiffness(typename Law::template parameters<Real> const& parameters, double overlap,
                                 double radius_i, double radius_j, contact_assumption const& assumed) {
    double const least = stiffens<Law, Dim> ? assumed.overlap * smaller_radius(radius_i, radius_j) : 0;
    return law_stiffness<Law, Dim>(parameters, radius_i + radius_j - overlap, radius_i, radius_j, false, least);
}

/// One contact in the forecast of future overlaps.
struct contact_seen {
    double overlap;        ///< m; negative: a gap
    double radius;         ///< the smaller one, m
    double effective_mass; ///< kg
    double closing;        ///< speed at which the two approach, m/s; negative: they separate
};

/// Calls use(slot, i, j, arm, distance, overlap) for the contacts of a table that touch, or whose gap is at most that
/// of the assumption. The arm points from i to j; lengths are in m.
template <class Law, class Real, int Dim, class Use>
void visit_contacts(particle_store<Real, Dim> const& store, pair_table<Law, Real, Dim> const& table,
                    contact_assumption const& assumed, Use const& use) {
    for (int c = 0; c < table.chunks(); ++c)
        for (std::size_t s = table.first_slot(c), end = s + table.chunk_size(c); s < end; ++s) {
            auto const i = std::size_t(table.i(s)), j = std::size_t(table.j(s));
            vec<double, Dim> arm{};
            for (int axis = 0; axis < Dim; ++axis)
                arm[axis] = double(store.position(j)[axis]) - double(store.position(i)[axis]);
            arm = store.nearest(arm);
            pair_motion<Real, Dim> const still{Real(0), store.radius(i), store.radius(j), {}, Real(0)};
            double const touching = double(touching_distance_of(still, table.get(s).state)),
                         reach = touching + assumed.gap;
            double const squared = squared_norm(arm);
            if (!(squared <= reach * reach)) continue;
            double const distance = std::sqrt(squared);
            use(s, i, j, arm, distance, touching - distance);
        }
}

/// Calls visit(contact_seen, pair_stiffness) for the contacts of a table that touch or may touch under the assumption.
template <class Law, class Real, int Dim, class Parameters, class Visit>
void visit_depths(particle_store<Real, Dim> const& store, pair_table<Law, Real, Dim> const& table,
                  Parameters const& parameters, contact_assumption const& assumed, Visit const& visit) {
    visit_contacts(store, table, assumed, [&](std::size_t s, std::size_t i, std::size_t j, auto const& arm,
                                                   double distance, double overlap) {
        double const ri = double(store.radius(i)), rj = double(store.radius(j));
        double const mi = double(store.mass(i)), mj = double(store.mass(j));
        auto const approach = convert<double>(store.velocity(i)) - convert<double>(store.velocity(j));
        visit(contact_seen{overlap, smaller_radius(ri, rj), mi * mj / (mi + mj), dot(approach, arm) / distance},
              contact_stiffness<Law, Dim>(parameters.row[std::size_t(table.parameter()[s])], overlap, ri, rj, assumed));
    });
}

/// Tangent of one pair in its present state.
/// \param arm from i to j, m
/// \param distance length of the arm, m
/// \param k normal and shear stiffness of the pair, N/m
template <class Law, class Real, int Dim, class Parameters, class State>
pair_tangent<Dim> tangent_of(particle_store<Real, Dim> const& store, std::size_t i, std::size_t j, bool bonded,
                             vec<double, Dim> const& arm, double distance, pair_stiffness const& k,
                             Parameters const& row, State const& state) {
    double const ri = double(store.radius(i)), rj = double(store.radius(j));
    pair_motion<Real, Dim> const still{Real(distance), Real(ri), Real(rj), {}, Real(0)};
    auto const force = Law::evaluate(row, still, state);
    pair_tangent<Dim> t{
        i, j, bonded, arm / distance, k.normal, k.shear, 0, distance * ri / (ri + rj), distance * rj / (ri + rj), {}};
    t.prestress = std::hypot(double(force.normal_force), double(norm(force.shear_force))) / distance;
    if constexpr (requires { Law::shears_in_the_middle; }) t.lever_i = t.lever_j = distance / 2;
    if constexpr (carries_moment<Law>) {
        auto const moments =
            Law::template rotational_stiffness<Dim>(row, store.radius(i), store.radius(j), Real(distance));
        t.moments = {double(moments.bending), double(moments.twisting)};
    }
    return t;
}

/// Calls visit(pair_tangent) for every bond of a table.
template <class Law, class Real, int Dim, class Parameters, class Visit>
void visit_bond_tangents(particle_store<Real, Dim> const& store, pair_table<Law, Real, Dim> const& table,
                         Parameters const& parameters, Visit const& visit) {
    for (std::size_t s = 0; s < table.slots(); ++s) {
        if (table.is_padding(s, store.size())) continue;
        auto const i = std::size_t(table.i(s)), j = std::size_t(table.j(s));
        vec<double, Dim> arm{};
        for (int axis = 0; axis < Dim; ++axis)
            arm[axis] = double(store.position(j)[axis]) - double(store.position(i)[axis]);
        arm = store.nearest(arm);
        double const distance = norm(arm);
        auto const& row = parameters.row[std::size_t(table.parameter()[s])];
        auto const k = law_stiffness<Law, Dim>(row, distance, double(store.radius(i)), double(store.radius(j)), true);
        visit(tangent_of<Law>(store, i, j, true, arm, distance, k, row, table.get(s).state));
    }
}

/// Calls visit(pair_tangent) for the contacts of a table that touch or may touch under the assumption.
template <class Law, class Real, int Dim, class Parameters, class Visit>
void visit_contact_tangents(particle_store<Real, Dim> const& store, pair_table<Law, Real, Dim> const& table,
                            Parameters const& parameters, contact_assumption const& assumed, Visit const& visit) {
    visit_contacts(store, table, assumed, [&](std::size_t s, std::size_t i, std::size_t j, auto const& arm,
                                                   double distance, double overlap) {
        auto const& row = parameters.row[std::size_t(table.parameter()[s])];
        auto const k =
            contact_stiffness<Law, Dim>(row, overlap, double(store.radius(i)), double(store.radius(j)), assumed);
        visit(tangent_of<Law>(store, i, j, false, arm, distance, k, row, table.get(s).state));
    });
}

} // namespace lacuna
