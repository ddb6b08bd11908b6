// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <lacuna/core/state.hpp>
#include <lacuna/interactions/bond_list.hpp>
#include <lacuna/interactions/storage/contact_list.hpp>

namespace lacuna {

/// Writes bonds and contacts to a checkpoint and reads them back.
///
/// A checkpoint has the candidates, the intact bonds and the histories; the tables follow from them. It has no forces:
/// they are zero after reading, until the next step evaluates them.
struct interactions_archive {
    /// Writes the state that a run changes to an archive, or reads it from one.
    /// \throws std::runtime_error for a state that contradicts itself; `pairs` must not be used afterwards
    template <class Archive, class Interactions>
    static void apply(Archive& ar, Interactions& pairs, typename Interactions::store_type const& store) {
        std::vector<std::int32_t> bonds;
        std::vector<std::int8_t> states;
        for (std::size_t s = 0; s < pairs.bonds_.slots(); ++s)
            if (!pairs.bonds_.is_padding(s, store.size())) bonds.push_back(pairs.bonds_.label(s));
        for (auto const& record : pairs.bond_records_) states.push_back(std::int8_t(record.state));
        ar(pairs.neighbors_, bonds, fixed_length{states}, pairs.broken_);
        if constexpr (Archive::is_loading::value) rebuild(pairs, store, bonds, states);
        apply_states(ar, pairs.bonds_);
        apply_states(ar, pairs.contacts_);
    }

private:
    /// Histories of the packs in use. The number of spare packs is no part of the state.
    template <class Archive, class Law, class Real, int Dim>
    static void apply_states(Archive& ar, pair_table<Law, Real, Dim>& table) {
        auto const for_each = [&](auto const& visit) {
            std::size_t count = 0;
            for (int c = 0; c < table.chunks(); ++c)
                for (std::size_t p = table.first_pack(c); p < table.end_pack(c); ++p) visit(count++, p);
            return count;
        };
        auto states = table.states();
        states.resize(for_each([&](std::size_t k, std::size_t p) { states.store(k, states.load(p)); }));
        ar(states);
        if constexpr (Archive::is_loading::value)
            for_each([&](std::size_t k, std::size_t p) { table.states().store(p, states.load(k)); });
    }
    /// Builds the tables of the state that is being read. Their histories follow later.
    template <class Interactions>
    static void rebuild(Interactions& pairs, typename Interactions::store_type const& store,
                        std::vector<std::int32_t> const& bonds, std::vector<std::int8_t> const& states) {
        auto& records = pairs.bond_records_;
        for (std::size_t b = 0; b < states.size(); ++b) {
            require_state(states[b] >= 0 && states[b] <= std::int8_t(bond_state::broken_in_shear), "a bond's state");
            records[b].state = bond_state(states[b]);
        }
        std::vector<typename Interactions::bond_entry> left;
        for (auto const b : bonds) {
            require_state(b >= 0 && std::size_t(b) < records.size(), "a bond that does not exist");
            auto const& ids = records[std::size_t(b)].particles;
            auto i = store.internal(std::size_t(ids[0])), j = store.internal(std::size_t(ids[1]));
            if (i > j) std::swap(i, j);
            left.push_back({i, j, pairs.bond_row(store, b, i, j), b, {}});
            require_state(left.size() < 2 || pair_before(left[left.size() - 2], left.back()), "bonds out of order");
        }
        for (auto const& e : pairs.broken_)
            require_state(0 <= e.i && e.i < e.j && std::size_t(e.j) < store.size() &&
                              e.parameter == pairs.parameter_row(store, e.i, e.j),
                          "the contact of a broken bond");
        pairs.assign_bonds(store, left);
        using contacts = typename Interactions::contact_table;
        pairs.contacts_ = contacts();
        auto const make = [&](neighbor_pair const& pair) {
            return typename contacts::entry{pair.i, pair.j, pairs.parameter_row(store, pair.i, pair.j), -1, {}};
        };
        merge_contacts(pairs.neighbors_.pairs(), pairs.bonds_, {}, pairs.contacts_, store, 1, make);
        pairs.build_rows(store);
        pairs.forces_.forget();
    }
};

} // namespace lacuna
