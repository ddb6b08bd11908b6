// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <lacuna/core/dual.hpp>
#include <lacuna/core/fields.hpp>
#include <lacuna/laws/pair_motion.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Stiffness of a pair as a bound of the stable time step has to count with it, N/m.
struct pair_stiffness {
    double normal, shear;
};

/// Tangent of a law by its own dual-number derivatives, at the given distance and without slip.
///
/// A contact that is open is read as if it just touched, or overlapped as much as its law expects, because it may
/// close before the next look. Coupling
/// between normal and shear enters both, which makes the diagonal pair an upper bound of the full tangent.
/// \param bonded the pair was made at this distance, without force (a bond); else it touches at r_i + r_j
template <class Law, int Dim, class Real>
pair_stiffness law_stiffness(typename Law::template parameters<Real> const& parameters, double distance,
                             double radius_i, double radius_j, bool bonded) {
    using number = dual<double, 2>;
    double const touching = radius_i + radius_j;
    double const smaller = radius_j > 0 ? std::min(radius_i, radius_j) : radius_i;
    double overlap = touching * 1e-6;
    if constexpr (requires { Law::expected_overlap; }) overlap = std::max(overlap, smaller * Law::expected_overlap);
    double const at = bonded ? distance : std::min(distance, touching - overlap);
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
    return {std::fabs(answer.normal_force.derivative[0]) + coupling,
            std::fabs(answer.shear_force[0].derivative[1]) + coupling};
}

/// Calls visit(i, j, normal, normal_stiffness, shear_stiffness, prestress, lever_i, lever_j) for every pair of a
/// table; the prestress is the pair's force over its distance. N/m, m.
/// \param bonded see law_stiffness()
template <class Law, class Real, int Dim, class Table, class Parameters, class Visit>
void visit_stiffness(particle_store<Real, Dim> const& store, Table const& table, Parameters const& parameters,
                     bool bonded, Visit const& visit) {
    for (std::size_t s = 0; s < table.slots(); ++s) {
        if (table.is_filler(s, store.size())) continue;
        auto const i = std::size_t(table.i(s)), j = std::size_t(table.j(s));
        vec<double, Dim> arm{};
        for (int axis = 0; axis < Dim; ++axis)
            arm[axis] = double(store.position(j)[axis]) - double(store.position(i)[axis]);
        arm = store.nearest(arm);
        double const distance = norm(arm), ri = double(store.radius(i)), rj = double(store.radius(j));
        auto const k = law_stiffness<Law, Dim>(parameters.row[std::size_t(table.parameter()[s])], distance, ri, rj, bonded);
        pair_motion<Real, Dim> const still{Real(distance), Real(ri), Real(rj), {}, Real(0)};
        auto const force = Law::evaluate(parameters.row[std::size_t(table.parameter()[s])], still, table.get(s).state);
        double const prestress = std::hypot(double(force.normal_force), double(norm(force.shear_force))) / distance;
        double lever_i = distance * ri / (ri + rj), lever_j = distance * rj / (ri + rj);
        if constexpr (requires { Law::shears_in_the_middle; }) lever_i = lever_j = distance / 2;
        visit(i, j, arm / distance, k.normal, k.shear, prestress, lever_i, lever_j);
    }
}

} // namespace lacuna
