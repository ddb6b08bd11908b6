// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/records.hpp>

namespace lacuna {

/// Which pores act on each particle: the order of their summation. As force_rows has it for the pairs: per particle
/// a row of entries, all rows of a group of particles equally long (filled up with a zero force).
template <class Real, int Dim>
class corner_rows {
public:
    /// Records of a particle that write() fills: its force; in space also its torque, which is none.
    static constexpr std::size_t records = Dim == 2 ? 1 : 2;
    static constexpr std::size_t group_particles = 32;
    /// Groups that one thread handles at a time.
    static constexpr std::size_t chunk_groups = 16;

    /// \param for_each for_each(visit) calls visit(particle, offset of the force in reals) for every corner of every
    ///        pore, in the order of summation
    /// \param zero offset of a force that is none
    template <class ForEach>
    void build(std::size_t particles, ForEach const& for_each, std::uint32_t zero) {
        particles_ = particles;
        std::size_t const groups = (particles + group_particles - 1) / group_particles;
        std::vector<std::uint32_t> degree(groups * group_particles, 0);
        for_each([&](std::size_t particle, std::uint32_t) { ++degree[particle]; });
        row_.assign(groups, 0);
        begin_.assign(groups + 1, 0);
        for (std::size_t g = 0; g < groups; ++g) {
            auto const first = degree.begin() + std::ptrdiff_t(g * group_particles);
            row_[g] = *std::max_element(first, first + group_particles);
            begin_[g + 1] = begin_[g] + row_[g] * group_particles;
        }
        entry_.assign(begin_[groups], zero);
        std::fill(degree.begin(), degree.end(), 0);
        for_each([&](std::size_t particle, std::uint32_t offset) {
            std::size_t const g = particle / group_particles;
            entry_[begin_[g] + particle % group_particles * row_[g] + degree[particle]++] = offset;
        });
    }

    int chunks() const noexcept { return int((row_.size() + chunk_groups - 1) / chunk_groups); }

    /// Writes {F_x, F_y, 0, 0}, in space {F_x, F_y, F_z, 0} and four zeros, for every particle of a chunk, N.
    [[gnu::noinline, gnu::flatten]] void write(int chunk, Real const* forces, record_column<Real>& to) const noexcept {
        std::size_t const first = std::size_t(chunk) * chunk_groups, end = std::min(first + chunk_groups, row_.size());
        for (std::size_t g = first; g < end; ++g) {
            switch (row_[g]) {
            case 5: write_group<5>(g, forces, to); break;
            case 6: write_group<6>(g, forces, to); break;
            case 7: write_group<7>(g, forces, to); break;
            case 8: write_group<8>(g, forces, to); break;
            default: write_group<0>(g, forces, to);
            }
        }
    }

private:
    /// \tparam Length of the rows where it is known at compile time, else 0
    template <std::size_t Length>
    void write_group(std::size_t g, Real const* forces, record_column<Real>& to) const noexcept {
        using part = pack<Real, Dim == 2 ? 2 : 4>;
        std::size_t const length = Length > 0 ? Length : row_[g];
        std::uint32_t const* entry = entry_.data() + begin_[g];
        std::size_t const first = g * group_particles, end = std::min(first + group_particles, particles_);
        for (std::size_t k = first; k < end; ++k, entry += length) {
            part total(Real(0));
            if constexpr (Length > 0) {
#pragma GCC unroll 8
                for (std::size_t e = 0; e < Length; ++e) total += part::load(forces + entry[e]);
            } else {
                for (std::size_t e = 0; e < length; ++e) total += part::load(forces + entry[e]);
            }
            if constexpr (Dim == 2) {
                part none(Real(0));
                using native = typename record<Real>::native;
                to.set(k, record<Real>(native(__builtin_shufflevector(total.v, none.v, 0, 1, 2, 3))));
            } else {
                to.set(records * k, total);
                to.set(records * k + 1, record<Real>(Real(0)));
            }
        }
    }

    std::size_t particles_ = 0;
    std::vector<std::uint32_t> row_, entry_;
    std::vector<std::size_t> begin_;
};

} // namespace lacuna
