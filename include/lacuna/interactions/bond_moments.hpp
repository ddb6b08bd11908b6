// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/interactions/pair_loop.hpp>
#include <lacuna/laws/bond_values.hpp>

namespace lacuna {

/// Adds the moments of a table's pairs to the torques in `out`, one pair after the other in their order.
/// \param moments moment on the first particle of each pair, N m; rotation_dim numbers per slot
/// \param out in 2D one record {F_x, F_y, torque over radius, 0} per particle; in 3D two records (force, torque over
///        radius); N
template <class Law, class Real, int Dim>
void add_moments(particle_store<Real, Dim> const& store, pair_table<Law, Real, Dim> const& pairs,
                 std::vector<Real> const& moments, record_column<Real>& out) noexcept {
    for (std::size_t s = 0; s < pairs.slots(); ++s) {
        if (pairs.is_padding(s, store.size())) continue;
        auto const i = std::size_t(pairs.i(s)), j = std::size_t(pairs.j(s));
        for (int axis = 0; axis < rotation_dim<Dim>; ++axis) {
            Real const moment = moments[s * rotation_dim<Dim> + std::size_t(axis)];
            out.at(Dim == 2 ? i : 2 * i + 1, Dim == 2 ? 2 : axis) += moment / store.radius(i);
            out.at(Dim == 2 ? j : 2 * j + 1, Dim == 2 ? 2 : axis) -= moment / store.radius(j);
        }
    }
}

/// Adds a row to the parameter table for each bond that has individual values.
/// \param own individual values, one entry per bond, indexed by the bonds' labels; an empty entry adds no row
/// \throws std::invalid_argument if the number of entries differs from that of the bonds, if a value is invalid, or if
///         the law takes no individual values
template <class Law, class Entry, class Real, int Dim>
void give_own_rows(particle_store<Real, Dim> const& store, std::vector<Entry>& bonds, std::span<bond_values const> own,
                   parameter_table<Law, Real>& parameters) {
    using row = typename Law::template parameters<double>;
    if (own.size() != bonds.size())
        refuse("bonds.size()", double(own.size()), "0 or the number of bonds, " + std::to_string(bonds.size()));
    for (Entry& e : bonds) {
        std::string const name = "bonds[" + std::to_string(e.label) + "]";
        auto const& values = own[std::size_t(e.label)];
        values.validate(name);
        if (values.empty()) continue;
        if constexpr (takes_bond_values<Law, Dim>) {
            auto const base = convert_fields<double, Real, row>(parameters.row[std::size_t(e.parameter)],
                                                                [](Real x) { return double(x); });
            e.parameter = std::int32_t(parameters.row.size());
            parameters.add(Law::template with_values<Dim>(base, values, double(store.radius(std::size_t(e.i))),
                                                          double(store.radius(std::size_t(e.j)))));
        } else {
            refuse(name, "values of its own", "left out: the bond law takes none");
        }
    }
}

} // namespace lacuna
