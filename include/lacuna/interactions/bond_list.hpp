// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/interactions/break_event.hpp>
#include <lacuna/interactions/storage/pair_table.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Permanent record of a bond; it outlives the failure of the bond.
struct bond_record {
    std::array<std::int32_t, 2> particles; ///< stable ids
    bond_state state = bond_state::intact;
    std::int32_t slot = -1; ///< slot in the bond table while intact, else -1
};

/// Order of pairs in their tables: by i, then by j.
template <class Entry>
bool pair_before(Entry const& a, Entry const& b) noexcept {
    return a.i < b.i || (a.i == b.i && a.j < b.j);
}

/// Writes the slot of each intact bond into its record, and -1 into the records of the others.
template <class Law, class Real, int Dim>
void number_bonds(std::span<bond_record> records, pair_table<Law, Real, Dim> const& table, std::size_t particles) {
    for (auto& record : records) record.slot = -1;
    for (std::size_t s = 0; s < table.slots(); ++s) {
        if (table.is_padding(s, particles)) continue;
        auto& record = records[std::size_t(table.label(s))];
        if (record.state == bond_state::intact) record.slot = std::int32_t(s);
    }
}

/// Makes bonds between the given particles, without force at their present distances. Sorted as in the tables.
/// \param pairs stable ids of the two particles of each bond
/// \param row callable (i, j) -> row of the parameter table
/// \param longest raised to the length of the longest bond if that is larger, m
/// \throws std::invalid_argument for an unknown particle, a particle bonded to itself, two particles at the same
///         position, and a repeated pair
template <class Law, class Entry, class Real, int Dim, class Row>
std::vector<Entry> make_bonds(particle_store<Real, Dim> const& store,
                              std::span<std::array<std::int32_t, 2> const> pairs, Row const& row, Real& longest) {
    std::vector<Entry> bonds;
    bonds.reserve(pairs.size());
    for (std::size_t b = 0; b < pairs.size(); ++b) {
        std::string const name = "bond " + std::to_string(b);
        for (auto const id : pairs[b]) require_in(name + ".particle", id, 0, double(store.size()) - 1);
        if (pairs[b][0] == pairs[b][1]) refuse(name + ".particles", double(pairs[b][0]), "two different ones");
        auto i = store.internal(std::size_t(pairs[b][0])), j = store.internal(std::size_t(pairs[b][1]));
        if (i > j) std::swap(i, j);
        Real const touching = store.radius(std::size_t(i)) + store.radius(std::size_t(j));
        Real const distance = norm(store.nearest(store.position(std::size_t(j)) - store.position(std::size_t(i))));
        if (!(distance > 0))
            refuse(name + ".distance", double(distance),
                   "> 0: particles " + std::to_string(pairs[b][0]) + " and " + std::to_string(pairs[b][1]) +
                       " are at the same position " + to_text(store.position(std::size_t(i))) + " m");
        longest = std::max(longest, distance);
        bonds.push_back({i, j, row(i, j), std::int32_t(b), Law::template initial<Real, Dim>(distance, touching)});
    }
    std::sort(bonds.begin(), bonds.end(), pair_before<Entry>);
    for (std::size_t b = 1; b < bonds.size(); ++b)
        if (!pair_before(bonds[b - 1], bonds[b]))
            refuse("bond " + std::to_string(bonds[b].label), "a repeated pair", "given once");
    return bonds;
}

} // namespace lacuna
