// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include <lacuna/interactions/pair_loop.hpp>

namespace lacuna {

/// Which pair forces act on each particle: the order of their summation.
///
/// Per particle a row of entries, all rows of a chunk of particles equally long (filled up with a zero force), so
/// that the loop over them has no branch to guess. The order follows the pairs alone: sums have the same bits for
/// any number of threads.
template <class Real, int Dim>
class force_rows {
public:
    static constexpr int chunk_particles = 128;
    /// Added to the offset of a force in the entry of the particle that it acts on as it stands (the first of the
    /// pair); the other one gets the opposite.
    static constexpr std::int32_t own = Dim == 2 ? 2 : 3;
    static constexpr std::int32_t reals_per_pair = std::int32_t(4 * pair_forces<Real, Dim>::records_per_pair);

    /// \param streaming the particles of a chunk move as soon as its pairs are evaluated: a force is then only kept
    ///        until the last chunk that needs it, and its place is used again, which spares the memory the writing
    ///        and fetching of forces that nobody reads
    /// \param tables the pair tables whose forces lie one after the other in the force column, then one zero
    /// \return for each table, how many packs of forces are kept: pack p lies at p modulo that number
    template <class... Tables>
    std::array<std::size_t, sizeof...(Tables)> build(std::size_t particles, bool streaming, Tables const&... tables) {
        std::array<std::size_t, sizeof...(Tables)> const kept{(streaming ? window(particles, tables) : all(tables))...};
        std::size_t const chunks = (particles + chunk_particles - 1) / chunk_particles;
        degree_.assign(chunks * chunk_particles, 0);
        auto const for_each = [&](auto const& visit) {
            std::size_t first = 0, t = 0;
            (void)std::initializer_list<int>{([&] {
                std::size_t const places = kept[t++] * tables.width;
                for (std::size_t s = 0; s < tables.slots(); ++s)
                    if (!tables.is_filler(s, particles))
                        visit(tables.i(s), tables.j(s), std::int32_t(first + s % places) * reals_per_pair);
                first += places;
            }(), 0)...};
            return std::int32_t(first) * reals_per_pair;
        };
        std::int32_t const zero = for_each([&](std::int32_t i, std::int32_t j, std::int32_t) {
            ++degree_[std::size_t(i)];
            ++degree_[std::size_t(j)];
        });
        row_.resize(chunks);
        begin_.resize(chunks + 1);
        begin_[0] = 0;
        for (std::size_t c = 0; c < chunks; ++c) {
            auto const first = degree_.begin() + std::ptrdiff_t(c * chunk_particles);
            row_[c] = *std::max_element(first, first + chunk_particles);
            begin_[c + 1] = begin_[c] + std::size_t(row_[c]) * chunk_particles;
        }
        entry_.assign(begin_[chunks], zero);
        std::fill(degree_.begin(), degree_.end(), 0);
        auto const put = [&](std::int32_t k, std::int32_t value) {
            std::size_t const c = std::size_t(k) / chunk_particles;
            entry_[begin_[c] + (std::size_t(k) % chunk_particles) * std::size_t(row_[c]) +
                   std::size_t(degree_[std::size_t(k)]++)] = value;
        };
        for_each([&](std::int32_t i, std::int32_t j, std::int32_t offset) {
            put(i, offset + own);
            put(j, offset);
        });
        return kept;
    }

    int chunks() const noexcept { return int(row_.size()); }
    /// Entries per particle in a chunk.
    int row_length(int chunk) const noexcept { return row_[std::size_t(chunk)]; }
    /// Entries of the first particle of a chunk; the others follow. Entry = offset of the force, a multiple of four,
    /// plus `own` for the first of the pair.
    std::int32_t const* rows(int chunk) const noexcept { return entry_.data() + begin_[std::size_t(chunk)]; }

private:
    template <class Table>
    static std::size_t all(Table const& table) noexcept {
        return std::max<std::size_t>(table.packs(), 1);
    }
    /// Packs from one whose force is still needed to the end of the chunk that needs it, at most.
    template <class Table>
    static std::size_t window(std::size_t particles, Table const& table) noexcept {
        std::size_t most = 1;
        for (int c = 0; c < table.chunks(); ++c) most = std::max(most, table.end_pack(c) - table.first_pack(c));
        for (std::size_t s = 0; s < table.slots(); ++s)
            if (!table.is_filler(s, particles))
                most = std::max(most, table.end_pack(int(table.j(s) / chunk_particles)) - s / table.width);
        return most;
    }

    std::vector<std::int32_t> degree_, row_, entry_;
    std::vector<std::size_t> begin_;
};

/// Sum of the pair forces on the particles of one chunk.
/// \tparam Length entries per particle where it is known at compile time, else 0
template <class Real, int Dim, int Length = 0>
class force_sum {
public:
    using rec = record<Real>;
    force_sum(force_rows<Real, Dim> const& rows, Real const* forces, int chunk) noexcept
        : forces_(forces), row_(rows.rows(chunk)), length_(Length > 0 ? Length : rows.row_length(chunk)) {}

    /// 2D: {F_x, F_y, torque over radius, 0} on particle number `k` of the chunk.
    rec operator()(int k) const noexcept
        requires(Dim == 2)
    {
        rec total(Real(0));
        for_each(k, [&](std::int32_t offset, rec const& sign) { total = rec::load(forces_ + offset) * sign + total; });
        return total;
    }
    /// 3D: force, and torque over radius, on particle number `k` of the chunk.
    std::array<rec, 2> operator()(int k) const noexcept
        requires(Dim == 3)
    {
        rec force(Real(0)), torque(Real(0));
        for_each(k, [&](std::int32_t offset, rec const& sign) {
            force = rec::load(forces_ + offset) * sign + force;
            torque += rec::load(forces_ + offset + 4);
        });
        return {force, torque};
    }

private:
    template <class Add>
    void for_each(int k, Add const& add) const noexcept {
        std::int32_t const* entry = row_ + std::ptrdiff_t(k) * length_;
        auto one = [&](int e) { add(entry[e] & ~3, rec::load(&signs[entry[e] & 3])); };
        if constexpr (Length > 0) {
#pragma GCC unroll 8
            for (int e = 0; e < Length; ++e) one(e);
        } else {
            for (int e = 0; e < length_; ++e) one(e);
        }
    }

    // Forces are opposite on the two sides of a pair, torques per radius are equal. Read from 0 on, the signs are
    // those of the second of a pair; from `own` on, those of the first.
    static constexpr Real minus = Dim == 2 ? Real(1) : Real(-1);
    static constexpr Real signs[7] = {-1, -1, minus, 1, 1, 1, 1};
    Real const* forces_;
    std::int32_t const* row_;
    int length_;
};

} // namespace lacuna
