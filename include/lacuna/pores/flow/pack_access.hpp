// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/records.hpp>

namespace lacuna::detail {

/// Pack of the numbers base[index[0]], base[index[1]], ... The lanes are written out: for a loop, g++ 12 builds the
/// pack in memory and stalls on the load.
template <class T, int W, class Index>
pack<T, W> gather(T const* base, Index const* index) noexcept {
    using native = typename pack<T, W>::native;
    auto at = [&](int k) { return base[index[k]]; };
    if constexpr (W == 2) {
        return pack<T, W>(native{at(0), at(1)});
    } else if constexpr (W == 4) {
        return pack<T, W>(native{at(0), at(1), at(2), at(3)});
    } else if constexpr (W == 8) {
        return pack<T, W>(native{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)});
    } else {
        static_assert(W == 16);
        return pack<T, W>(native{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8), at(9), at(10), at(11),
                                 at(12), at(13), at(14), at(15)});
    }
}

/// Position and radius of a particle, one record.
/// \param particles records of the particles, as in particle_store; here and below
template <class T>
record<T> load_particle(T const* particles, std::int32_t index) noexcept {
    return record<T>::load(particles + particle_column<T>::stride * std::size_t(std::uint32_t(index)));
}

/// Positions and radii of the particles index[0..W), transposed: result[l][k] is number l of particle index[k].
template <class T, int W>
std::array<pack<T, W>, 4> load_particles(T const* particles, std::int32_t const* index) noexcept {
    return transpose_load<T, W>([&](int k) { return load_particle(particles, index[k]); });
}

/// Loads W numbers that are stored in single precision.
template <class T, int W>
pack<T, W> load_single(float const* from) noexcept {
    auto const single = pack<float, W>::load(from);
    return pack<T, W>(__builtin_convertvector(single.v, typename pack<T, W>::native));
}

/// Stores x[0], y[0], x[1], y[1], ...
template <class T, int W>
void store_pairs(T* to, pack<T, W> const& x, pack<T, W> const& y) noexcept {
    using native = typename pack<T, W>::native;
    if constexpr (W == 8) {
        pack<T, W>(native(__builtin_shufflevector(x.v, y.v, 0, 8, 1, 9, 2, 10, 3, 11))).store(to);
        pack<T, W>(native(__builtin_shufflevector(x.v, y.v, 4, 12, 5, 13, 6, 14, 7, 15))).store(to + W);
    } else if constexpr (W == 4) {
        pack<T, W>(native(__builtin_shufflevector(x.v, y.v, 0, 4, 1, 5))).store(to);
        pack<T, W>(native(__builtin_shufflevector(x.v, y.v, 2, 6, 3, 7))).store(to + W);
    } else {
        for (int k = 0; k < W; ++k) {
            to[2 * k] = x[k];
            to[2 * k + 1] = y[k];
        }
    }
}

} // namespace lacuna::detail
