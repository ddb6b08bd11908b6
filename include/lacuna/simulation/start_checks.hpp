// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/interactions/storage/contact_list.hpp>
#include <lacuna/particles/store.hpp>

/// \file
/// Checks before the first step that a packing can be simulated.

namespace lacuna {

template <class Real>
std::string precision_text() {
    return sizeof(Real) < 8 ? "single precision" : "double precision";
}

/// Largest |coordinate| of all particles and smallest and largest radius, m. `furthest` and `smallest` are the internal
/// indices of the particles with the largest coordinate and with the smallest radius.
template <class Real>
struct body_extent {
    Real reach = 0, smallest_radius = 1, largest_radius = 0;
    std::int32_t furthest = -1, smallest = -1;

    /// Largest spacing of numbers at the particles, m.
    Real spacing() const noexcept { return std::numeric_limits<Real>::epsilon() * (reach + largest_radius); }
};
template <class Real, int Dim>
body_extent<Real> extent_of(particle_store<Real, Dim> const& store) noexcept {
    body_extent<Real> e;
    for (std::size_t k = 0; k < store.size(); ++k) {
        for (int axis = 0; axis < Dim; ++axis)
            if (Real const far = std::abs(store.position(k)[axis]); e.furthest < 0 || far > e.reach)
                e.reach = far, e.furthest = std::int32_t(k);
        Real const r = store.radius(k);
        if (e.smallest < 0 || r < e.smallest_radius) e.smallest_radius = r, e.smallest = std::int32_t(k);
        e.largest_radius = std::max(e.largest_radius, r);
    }
    return e;
}

/// \throws std::invalid_argument for particles so far from the origin that the smallest radius is less than a thousand
///         (1,024) spacings of the numbers there
template <class Real, int Dim>
void require_resolved(particle_store<Real, Dim> const& store, body_extent<Real> const& e) {
    double const epsilon = double(std::numeric_limits<Real>::epsilon()),
                 most = double(e.smallest_radius) / (1024 * epsilon);
    if (e.furthest < 0 || !(double(e.reach) > most)) return;
    refuse("particle " + std::to_string(store.id(std::size_t(e.furthest))) + ".position",
           to_text(store.position(std::size_t(e.furthest))) + " m",
           "within " + to_text(most) + " m of the origin: further away numbers of " + precision_text<Real>() + " are " +
               to_text(epsilon * double(e.reach)) + " m apart, too coarse for the radius of " +
               to_text(double(e.smallest_radius)) + " m of particle " +
               std::to_string(store.id(std::size_t(e.smallest))) + "; shift the body to the origin" +
               (sizeof(Real) < 8 ? ", use double precision" : "") + ", or switch guards.resolution off");
}

/// Overlaps in the initial packing.
struct start_pairs {
    double deepest = 0;                            ///< largest overlap of a contact over the smaller radius, 1
    std::array<std::int32_t, 2> particles{-1, -1}; ///< ids of its two particles
    /// Labels of bonds with an overlap above 0.9 of the limit, sorted: they belong to solids of overlapping particles.
    std::vector<std::int32_t> deep_bonds;
};

/// Checks the distances of all pairs in the initial packing.
/// \param limit largest overlap of two particles that are not bonded, over the smaller radius, 1
/// \throws std::invalid_argument for two particles at the same position, or so close that rounding determines their
///         direction, and for an overlap above the limit
template <class Real, int Dim, class Interactions>
start_pairs check_start(particle_store<Real, Dim> const& store, Interactions const& pairs, double limit) {
    start_pairs found;
    std::array<std::int32_t, 2> none{std::numeric_limits<std::int32_t>::max(), 0}, same = none, deep = none;
    Real const epsilon = std::numeric_limits<Real>::epsilon();
    auto const ids_of = [&](std::int32_t i, std::int32_t j) {
        std::array<std::int32_t, 2> ids{store.id(std::size_t(i)), store.id(std::size_t(j))};
        if (ids[0] > ids[1]) std::swap(ids[0], ids[1]);
        return ids;
    };
    auto const visit = [&](auto const& table, auto const& use) {
        for (std::size_t s = 0; s < table.slots(); ++s) {
            if (table.is_padding(s, store.size())) continue;
            auto const i = table.i(s), j = table.j(s);
            auto const x = store.position(std::size_t(i)), y = store.position(std::size_t(j));
            Real far = std::min(store.radius(std::size_t(i)), store.radius(std::size_t(j)));
            for (int axis = 0; axis < Dim; ++axis) far = std::max({far, std::abs(x[axis]), std::abs(y[axis])});
            if (!(norm(store.nearest(y - x)) > 16 * epsilon * far)) same = std::min(same, ids_of(i, j));
            use(s, ids_of(i, j), double(overlap_of(store, i, j)));
        }
    };
    visit(pairs.contacts(), [&](std::size_t, std::array<std::int32_t, 2> const& ids, double overlap) {
        if (overlap > found.deepest) found.deepest = overlap, found.particles = ids;
        if (overlap > limit) deep = std::min(deep, ids);
    });
    visit(pairs.bonds(), [&]([[maybe_unused]] std::size_t s, std::array<std::int32_t, 2> const&, double overlap) {
        if constexpr (requires { pairs.bonds().label(s); })
            if (overlap > 0.9 * limit) found.deep_bonds.push_back(pairs.bonds().label(s));
    });
    std::sort(found.deep_bonds.begin(), found.deep_bonds.end());
    auto const who = [](std::array<std::int32_t, 2> const& ids) {
        return "particles " + std::to_string(ids[0]) + " and " + std::to_string(ids[1]);
    };
    auto const position = [&](std::int32_t id) { return store.position(std::size_t(store.internal(std::size_t(id)))); };
    if (same != none)
        throw std::invalid_argument(who(same) + " are at the same position " + to_text(position(same[0])) +
                                    " m, or closer than rounding: must be apart, else their contact has no direction");
    if (deep != none) {
        double const overlap =
            double(overlap_of(store, store.internal(std::size_t(deep[0])), store.internal(std::size_t(deep[1]))));
        throw std::invalid_argument("initial overlap of " + who(deep) + " at " + to_text(position(deep[0])) + " and " +
                                    to_text(position(deep[1])) + " m = " + to_text(overlap) +
                                    " of the smaller radius: must be at most " + to_text(limit) +
                                    " (guards.overlap_limit)");
    }
    return found;
}

} // namespace lacuna
