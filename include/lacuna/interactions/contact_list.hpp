// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/neighbors/search.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// The candidates of a neighbour list without the bonded pairs, each with the history it had, or a new one.
/// \param candidates, bonds, old sorted by (i, j)
/// \param fresh replaced; sorted
/// \param make callable neighbor_pair -> entry, for pairs that were not in the list before
template <class Bond, class Contact, class Make>
void merge_contacts(std::vector<neighbor_pair> const& candidates, std::vector<Bond> const& bonds,
                    std::vector<Contact> const& old, std::vector<Contact>& fresh, Make const& make) {
    fresh.clear();
    auto bond = bonds.begin();
    auto known = old.begin();
    for (neighbor_pair const& pair : candidates) {
        auto const earlier = [&](auto const& e) { return e.i < pair.i || (e.i == pair.i && e.j < pair.j); };
        auto const same = [&](auto const& e) { return e.i == pair.i && e.j == pair.j; };
        while (bond != bonds.end() && earlier(*bond)) ++bond;
        if (bond != bonds.end() && same(*bond)) continue;
        while (known != old.end() && earlier(*known)) ++known;
        fresh.push_back(known != old.end() && same(*known) ? *known : make(pair));
    }
}

/// History of a pair that becomes a candidate: it touches at r_i + r_j, or, within `tolerance` times the smaller
/// radius of that, at the distance it has.
template <class Law, class Real, int Dim>
auto first_history(particle_store<Real, Dim> const& store, neighbor_pair const& pair, double tolerance) {
    auto const i = std::size_t(pair.i), j = std::size_t(pair.j);
    Real const touching = store.radius(i) + store.radius(j);
    Real start = touching;
    if (tolerance > 0) {
        Real const distance = norm(store.nearest(store.position(j) - store.position(i)));
        if (abs(distance - touching) <= Real(tolerance) * std::min(store.radius(i), store.radius(j))) start = distance;
    }
    return Law::template initial<Real, Dim>(start, touching);
}

/// Of the contacts of one pack, a particle that overlaps its partner by more than a radius, by internal index; else -1.
template <class Real, int Dim, class Table>
[[gnu::noinline]] std::int32_t find_deep_overlap(particle_store<Real, Dim> const& store, Table const& contacts,
                                                 std::size_t pack) {
    std::int32_t found = -1;
    for (std::size_t s = pack * Table::width; s < (pack + 1) * Table::width; ++s) {
        if (contacts.is_filler(s, store.size())) continue;
        auto const i = std::size_t(contacts.i(s)), j = std::size_t(contacts.j(s));
        Real const distance = norm(store.nearest(store.position(j) - store.position(i)));
        if (distance < std::max(store.radius(i), store.radius(j))) found = contacts.i(s);
    }
    return found;
}

} // namespace lacuna
