// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <vector>

#include <lacuna/interactions/storage/force_offsets.hpp>
#include <lacuna/interactions/storage/pair_forces.hpp>

namespace lacuna {

/// Lists the pair forces that act on each particle, in the order of their summation.
///
/// Each particle has a row of entries. Its first half lists the pairs whose first particle it is: their forces act on
/// it as stored. Its second half lists the pairs whose second particle it is: their forces act on it reversed. All half
/// rows of a chunk of particles have the same length, filled up with a zero force, so that the loop over them has no
/// branch to mispredict. If one particle of a chunk has far more pairs than the others, the half rows of that chunk
/// have individual lengths instead. The order depends on the pairs alone: sums have the same bits for any number of
/// threads.
template <class Real, int Dim>
class force_gather {
public:
    static constexpr int chunk_particles = 128;
    static constexpr std::int32_t reals_per_pair = std::int32_t(4 * pair_forces<Real, Dim>::records_per_pair);
    /// Value of half_row() for a chunk whose half rows have individual lengths.
    static constexpr std::int32_t uneven = -1;

    /// \param offsets offsets of the forces of each table
    /// \param tables the pair tables; their forces follow each other in the force column, and one zero force ends it
    template <class... Laws>
    void build(std::size_t particles, std::array<force_offsets, sizeof...(Laws)> const& offsets,
               pair_table<Laws, Real, Dim> const&... tables) {
        std::size_t const chunks = (particles + chunk_particles - 1) / chunk_particles;
        degree_.assign(2 * chunks * chunk_particles, 0);
        auto const for_each = [&](auto const& visit) {
            std::size_t first = 0, t = 0;
            (void)std::initializer_list<int>{([&] {
                auto const& at = offsets[t++];
                for (int c = 0; c < tables.chunks(); ++c)
                    for (std::size_t p = tables.first_pack(c); p < tables.end_pack(c); ++p)
                        for (std::size_t k = 0, pack = first + at(c, p); k < tables.width; ++k)
                            if (std::size_t const s = p * tables.width + k; !tables.is_padding(s, particles))
                                visit(tables.i(s), tables.j(s), std::int32_t(pack * tables.width + k) * reals_per_pair);
                first += at.count();
            }(), 0)...};
            constexpr int width = native_width<Real>;
            return std::int32_t(first * width) * reals_per_pair;
        };
        // Two counters per particle: pairs whose first particle it is, and pairs whose second particle it is.
        std::int32_t const zero = for_each([&](std::int32_t i, std::int32_t j, std::int32_t) {
            ++degree_[2 * std::size_t(i)];
            ++degree_[2 * std::size_t(j) + 1];
        });
        lay_out(chunks);
        entry_.assign(begin_[chunks], zero);
        std::fill(degree_.begin(), degree_.end(), 0);
        auto const put = [&](std::int32_t k, std::size_t half, std::int32_t offset) {
            std::size_t const c = std::size_t(k) / chunk_particles, row = 2 * (std::size_t(k) % chunk_particles) + half;
            std::size_t const first =
                half_row_[c] == uneven ? std::size_t(starts(int(c))[row]) : row * std::size_t(half_row_[c]);
            entry_[begin_[c] + first + std::size_t(degree_[2 * std::size_t(k) + half]++)] = offset;
        };
        for_each([&](std::int32_t i, std::int32_t j, std::int32_t offset) {
            put(i, 0, offset);
            put(j, 1, offset);
        });
    }

    int chunks() const noexcept { return int(half_row_.size()); }
    /// Number of entries in half a row of a particle of the chunk, or `uneven`.
    int half_row(int chunk) const noexcept { return half_row_[std::size_t(chunk)]; }
    /// Row of the first particle of a chunk; the others follow. An entry is the offset of a force.
    std::int32_t const* rows(int chunk) const noexcept { return entry_.data() + begin_[std::size_t(chunk)]; }

    /// For an uneven chunk: offset of each half row from rows(), and the end of the last.
    std::int32_t const* starts(int chunk) const noexcept { return start_.data() + uneven_[std::size_t(chunk)]; }
    /// Size of the rows of a chunk, bytes.
    std::size_t bytes(int chunk) const noexcept {
        return (begin_[std::size_t(chunk) + 1] - begin_[std::size_t(chunk)]) * sizeof(std::int32_t);
    }

private:
    /// Chooses the lengths of all rows from degree_.
    void lay_out(std::size_t chunks) {
        constexpr std::size_t halves = 2 * chunk_particles;
        half_row_.resize(chunks);
        begin_.resize(chunks + 1);
        uneven_.resize(chunks);
        start_.clear();
        begin_[0] = 0;
        for (std::size_t c = 0; c < chunks; ++c) {
            auto const first = degree_.begin() + std::ptrdiff_t(c * halves);
            half_row_[c] = *std::max_element(first, first + halves);
            std::size_t const all = std::accumulate(first, first + halves, std::size_t(0));
            std::size_t length = halves * std::size_t(half_row_[c]);
            if (half_row_[c] > 16 && length > 4 * (all + halves)) {
                half_row_[c] = uneven;
                length = all;
                uneven_[c] = start_.size();
                start_.push_back(0);
                for (std::size_t row = 0; row < halves; ++row)
                    start_.push_back(start_.back() + first[std::ptrdiff_t(row)]);
            }
            begin_[c + 1] = begin_[c] + length;
        }
    }

    std::vector<std::int32_t> degree_, half_row_, entry_, start_;
    std::vector<std::size_t> begin_, uneven_;
};

/// Sums of the pair forces on the particles of one chunk.
/// \tparam Half number of entries in half a row if known at compile time, else 0; or force_gather::uneven
template <class Real, int Dim, int Half = 0>
class force_sum {
public:
    using rec = record<Real>;
    force_sum(force_gather<Real, Dim> const& rows, Real const* forces, int chunk) noexcept
        : forces_(forces), row_(rows.rows(chunk)), starts_(Half < 0 ? rows.starts(chunk) : nullptr),
          half_(Half > 0 ? Half : rows.half_row(chunk)) {}

    /// 2D: {F_x, F_y, torque over radius, not used} on particle number `k` of the chunk, N.
    rec operator()(int k) const noexcept
        requires(Dim == 2)
    {
        auto as_it_stands = [this](std::int32_t offset) { return rec::load(forces_ + offset); };
        // Forces on the two particles of a pair are opposite, torques per radius are equal.
        rec reversed(Real(-1));
        reversed.v[2] = 1;
        return add_half(2 * k, as_it_stands) + add_half(2 * k + 1, as_it_stands) * reversed;
    }
    /// 3D: force, and torque over radius, on particle number `k` of the chunk, N.
    std::array<rec, 2> operator()(int k) const noexcept
        requires(Dim == 3)
    {
        auto force = [this](std::int32_t offset) { return rec::load(forces_ + offset); };
        auto torque = [this](std::int32_t offset) { return rec::load(forces_ + offset + 4); };
        return {add_half(2 * k, force) - add_half(2 * k + 1, force),
                add_half(2 * k, torque) + add_half(2 * k + 1, torque)};
    }

private:
    template <class Part>
    rec add_half(int row, Part const& part) const noexcept {
        rec total(Real(0));
        if constexpr (Half < 0) {
            for (std::int32_t e = starts_[row]; e < starts_[row + 1]; ++e) total += part(row_[e]);
            return total;
        }
        std::int32_t const* entry = row_ + std::ptrdiff_t(row) * (Half > 0 ? Half : half_);
        if constexpr (Half > 0) {
            total = part(entry[0]);
#pragma GCC unroll 8
            for (int e = 1; e < Half; ++e) total += part(entry[e]);
        } else {
            for (int e = 0; e < half_; ++e) total += part(entry[e]);
        }
        return total;
    }

    Real const* forces_;
    std::int32_t const *row_, *starts_;
    int half_;
};

} // namespace lacuna
