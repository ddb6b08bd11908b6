// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <lacuna/core/parallel.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/interactions/storage/pair_table.hpp>
#include <lacuna/laws/pair_motion.hpp>
#include <lacuna/neighbors/search.hpp>
#include <lacuna/particles/store.hpp>
#include <lacuna/particles/touching.hpp>

namespace lacuna {

/// The candidates of one chunk that are not bonded: the `wanted` pairs of pair_table::merge().
template <class BondLaw, class Real, int Dim>
class unbonded_candidates {
public:
    using bond_table = pair_table<BondLaw, Real, Dim>;
    /// \param candidates sorted by (i, j)
    unbonded_candidates(std::vector<neighbor_pair> const& candidates, bond_table const& bonds, int chunk) noexcept
        : bonds_(bonds), begin_(bond_table::first_of_chunk(candidates, chunk)),
          end_(bond_table::first_of_chunk(candidates, chunk + 1)), bonds_begin_(bonds.first_slot(chunk)),
          bonds_end_(bonds.first_slot(chunk + 1)) {}

    template <class Visit>
    void forward(Visit const& visit) const {
        std::size_t bond = bonds_begin_;
        for (auto pair = begin_; pair != end_; ++pair) {
            while (bond < bonds_end_ && bonds_.before(bond, *pair)) ++bond;
            if (bond == bonds_end_ || !bonds_.is(bond, *pair)) visit(*pair);
        }
    }
    /// From the last pair to the first, until visit() returns false.
    template <class Visit>
    void backward(Visit const& visit) const {
        std::size_t end = bonds_end_;
        for (auto pair = end_; pair != begin_;) {
            --pair;
            while (end > bonds_begin_ && !bonds_.before(end - 1, *pair) && !bonds_.is(end - 1, *pair)) --end;
            if (end > bonds_begin_ && bonds_.is(end - 1, *pair)) continue;
            if (!visit(*pair)) return;
        }
    }

private:
    bond_table const& bonds_;
    std::vector<neighbor_pair>::const_iterator begin_, end_;
    std::size_t bonds_begin_, bonds_end_;
};

/// Makes the contact table hold exactly the candidates of a neighbour list that are not bonded. A pair that is already
/// in the table keeps its history. Allocates nothing while the pairs fit into the table's chunks.
/// \param candidates sorted by (i, j)
/// \param bonds table of bonds
/// \param added entries with a history for pairs that are not in the table yet; sorted by (i, j)
/// \param contacts table to change
/// \param threads number of threads to use
/// \param make callable neighbor_pair -> entry, for pairs that are neither in the table nor in `added`
template <class BondLaw, class ContactLaw, class Real, int Dim, class Make>
void merge_contacts(std::vector<neighbor_pair> const& candidates, pair_table<BondLaw, Real, Dim> const& bonds,
                    std::vector<typename pair_table<ContactLaw, Real, Dim>::entry> const& added,
                    pair_table<ContactLaw, Real, Dim>& contacts,
                    particle_store<Real, Dim> const& store, int threads, Make const& make) {
    auto const find_or_make = [&](neighbor_pair const& pair) {
        auto const found = std::partition_point(added.begin(), added.end(), [&](auto const& e) {
            return e.i < pair.i || (e.i == pair.i && e.j < pair.j);
        });
        return found != added.end() && found->i == pair.i && found->j == pair.j ? *found : make(pair);
    };
    auto const merge = [&] {
        std::atomic<bool> fits = true;
        for_each_chunk(contacts.chunks_of(store.size()), threads, [&](int c) {
            if (!contacts.merge(c, unbonded_candidates(candidates, bonds, c), store, find_or_make)) fits = false;
        });
        return bool(fits);
    };
    if (merge()) return;
    contacts.make_room(store, [&](int c) {
        std::size_t count = 0;
        unbonded_candidates(candidates, bonds, c).forward([&](neighbor_pair const&) { ++count; });
        return count;
    });
    merge();
}

/// Overlap of two particles over the smaller radius, 1; negative: a gap. The indices are internal.
template <class Real, int Dim>
Real overlap_of(particle_store<Real, Dim> const& store, std::int32_t first, std::int32_t second) noexcept {
    auto const i = std::size_t(first), j = std::size_t(second);
    Real const distance = norm(store.nearest(store.position(j) - store.position(i)));
    return (store.radius(i) + store.radius(j) - distance) / std::min(store.radius(i), store.radius(j));
}

/// Whether a pair of the initial packing touches with zero force at its present distance. This holds if its gap or
/// overlap is at most `tolerance` times the smaller radius, up to rounding.
/// \param distance present distance of the centres, m
template <class Real, int Dim>
bool starts_touching(particle_store<Real, Dim> const& store, neighbor_pair const& pair, double tolerance,
                     Real distance) {
    Real const ri = store.radius(std::size_t(pair.i)), rj = store.radius(std::size_t(pair.j));
    return abs(distance - (ri + rj)) <= Real(tolerance) * std::min(ri, rj) + touching_slack<Real> * (ri + rj);
}

/// History of a pair that becomes a candidate. It touches at r_i + r_j or, if starts_touching(), at its present
/// distance.
template <class Law, class Real, int Dim>
auto first_history(particle_store<Real, Dim> const& store, neighbor_pair const& pair, double tolerance) {
    auto const i = std::size_t(pair.i), j = std::size_t(pair.j);
    Real const touching = store.radius(i) + store.radius(j);
    Real start = touching;
    if (tolerance > 0) {
        Real const distance = norm(store.nearest(store.position(j) - store.position(i)));
        if (starts_touching(store, pair, tolerance, distance)) start = distance;
    }
    return Law::template initial<Real, Dim>(start, touching);
}

/// The pairs with a gap that start as touching. The search uses the radii of each pair, so that one large particle does
/// not widen the search for the others.
/// \param search made for the domain of the particles
/// \param tolerance as for starts_touching()
/// \return sorted by (i, j)
template <class Search, class Real, int Dim>
std::vector<neighbor_pair> pairs_touching_apart(particle_store<Real, Dim> const& store, Search& search,
                                                double tolerance) {
    std::vector<neighbor_pair> pairs;
    if (!(tolerance > 0)) return pairs;
    Real first = 0, second = 0;
    for (Real const r : store.radii()) {
        second = std::max(second, std::min(first, r));
        first = std::max(first, r);
    }
    // Each particle gets half the tolerance. The largest gets no more than it needs with the second largest.
    std::vector<Real> reach;
    for (Real const r : store.radii())
        reach.push_back((r + Real(tolerance / 2) * std::min(r, second)) * (1 + 2 * touching_slack<Real>));
    search.touching_pairs(store.positions(), reach, Real(0), pairs);
    std::erase_if(pairs, [&](neighbor_pair const& pair) {
        auto const i = std::size_t(pair.i), j = std::size_t(pair.j);
        Real const distance = norm(store.nearest(store.position(j) - store.position(i)));
        return !(distance > store.radius(i) + store.radius(j) && starts_touching(store, pair, tolerance, distance));
    });
    return pairs;
}

/// Whether a contact may have a force beyond r_i + r_j, the range of the search. Such contacts come from the initial
/// packing or from a bond. If the law's history has a `touching_distance`, the force begins there; the law resets it to
/// r_i + r_j once the pair separates. Other laws are evaluated at a slightly smaller distance.
template <class Law, class Real, int Dim, class Parameters, class Entry>
bool acts_apart(particle_store<Real, Dim> const& store, Parameters const& parameters, Entry const& contact) {
    Real const ri = store.radius(std::size_t(contact.i)), rj = store.radius(std::size_t(contact.j));
    if constexpr (requires { contact.state.touching_distance; }) {
        return contact.state.touching_distance > ri + rj;
    } else {
        auto const arm = store.position(std::size_t(contact.j)) - store.position(std::size_t(contact.i));
        Real const distance = norm(store.nearest(arm));
        pair_motion<Real, Dim> const closer{
            distance * (1 - 64 * std::numeric_limits<Real>::epsilon()), ri, rj, {}, Real(0)};
        return distance > ri + rj && Law::evaluate(parameters, closer, contact.state).normal_force != Real(0);
    }
}

/// Looks in one pack of contacts for an overlap above `limit` times the smaller radius.
/// \return internal indices of the two particles, or {-1, -1}
template <class Law, class Real, int Dim>
[[gnu::noinline]] std::array<std::int32_t, 2> find_deep_overlap(particle_store<Real, Dim> const& store,
                                                                pair_table<Law, Real, Dim> const& contacts,
                                                                std::size_t pack, Real limit) {
    std::array<std::int32_t, 2> found{-1, -1};
    for (std::size_t s = pack * contacts.width; s < (pack + 1) * contacts.width; ++s)
        if (!contacts.is_padding(s, store.size()) && overlap_of(store, contacts.i(s), contacts.j(s)) > limit)
            found = {contacts.i(s), contacts.j(s)};
    return found;
}

/// Largest overlap in one pack of contacts as a share of the smaller radius, 1. Only for laws that stiffen.
template <class Law, class Real, int Dim>
[[gnu::noinline]] Real deepest_of_pack(particle_store<Real, Dim> const& store,
                                       pair_table<Law, Real, Dim> const& contacts, std::size_t pack) {
    Real deepest = 0;
    for (std::size_t s = pack * contacts.width; s < (pack + 1) * contacts.width; ++s) {
        if (contacts.is_padding(s, store.size())) continue;
        auto const i = std::size_t(contacts.i(s)), j = std::size_t(contacts.j(s));
        pair_motion<Real, Dim> const still{Real(0), store.radius(i), store.radius(j), {}, Real(0)};
        Real const distance = norm(store.nearest(store.position(j) - store.position(i)));
        Real const overlap = touching_distance_of(still, contacts.get(s).state) - distance;
        deepest = std::max(deepest, overlap / std::min(still.radius_i, still.radius_j));
    }
    return deepest;
}

} // namespace lacuna
