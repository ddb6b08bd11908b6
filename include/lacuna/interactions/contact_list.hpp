// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <lacuna/core/parallel.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/neighbors/search.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Makes a table of the candidates of a neighbour list without the bonded pairs, each with the history it had, or a
/// new one.
/// \param candidates sorted by (i, j)
/// \param bonds the table of bonds
/// \param old the table until now
/// \param added pairs that were in no table of contacts, with a history; sorted by (i, j)
/// \param fresh replaced
/// \param store of the particles
/// \param threads how many may work on it
/// \param make callable neighbor_pair -> entry, for pairs that were not known before
template <class Bonds, class Contacts, class Real, int Dim, class Make>
void merge_contacts(std::vector<neighbor_pair> const& candidates, Bonds const& bonds, Contacts const& old,
                    std::vector<typename Contacts::entry> const& added, Contacts& fresh,
                    particle_store<Real, Dim> const& store, int threads, Make const& make) {
    auto const for_each_new = [&](int c, auto const& visit) {
        std::size_t bond = bonds.first_slot(c);
        std::size_t const bonds_end = bonds.first_slot(c + 1);
        auto const end = Contacts::first_of_chunk(candidates, c + 1);
        for (auto pair = Contacts::first_of_chunk(candidates, c); pair != end; ++pair) {
            while (bond < bonds_end && bonds.before(bond, *pair)) ++bond;
            if (bond == bonds_end || !bonds.is(bond, *pair)) visit(*pair);
        }
    };
    int const chunks = Contacts::chunks_of(store.size());
    fresh.lay_out(chunks, threads, [&](int c) {
        std::size_t count = 0;
        for_each_new(c, [&](neighbor_pair const&) { ++count; });
        return count;
    });
    for_each_chunk(chunks, threads, [&](int c) {
        std::size_t known = old.first_slot(c);
        std::size_t const known_end = old.first_slot(c + 1);
        auto other = Contacts::first_of_chunk(added, c);
        fresh.fill(c, store, [&](auto const& push) {
            for_each_new(c, [&](neighbor_pair const& pair) {
                while (known < known_end && old.before(known, pair)) ++known;
                if (known < known_end && old.is(known, pair)) return push(old.get(known));
                while (other != added.end() && (other->i < pair.i || (other->i == pair.i && other->j < pair.j))) ++other;
                bool const found = other != added.end() && other->i == pair.i && other->j == pair.j;
                push(found ? *other : make(pair));
            });
        });
    });
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
