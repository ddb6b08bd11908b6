// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/records.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The forces of the pores on their corners, and their sums over the particles. Like force_gather for the pairs, it
/// stores a row of entries per particle, in the order of summation. All rows of a group of particles have the same
/// length; shorter ones are padded with a zero force.
///
/// Forces of all pores are stored, unless nothing changes them after the pass over the pores. In that case
/// (`transient`) each force is stored only until it has been summed. Pores are sorted by their lowest corners. So after
/// each block of pores more groups are complete: all their pores have been visited. The memory of older forces is then
/// reused.
template <class Real, int Dim>
class corner_forces {
public:
    static constexpr int width = native_width<Real>;
    static constexpr std::size_t corners = std::size_t(Dim) + 1;
    /// Numbers stored per force on a corner: F_x, F_y; in space F_x, F_y, F_z, 0.
    static constexpr std::size_t force_reals = Dim == 2 ? 2 : 4;
    /// Records written per particle: its force; in space also its torque, which is zero.
    static constexpr std::size_t records = Dim == 2 ? 1 : 2;
    static constexpr std::size_t group_particles = 32;
    /// Groups that one thread handles at a time.
    static constexpr std::size_t chunk_groups = 16;

    /// \param net pore_network, not bare
    /// \param block number of pores in a block: write_complete() is called after each block
    /// \param transient whether forces are stored only until they have been summed
    template <class Network>
    void build(Network const& net, std::size_t block, bool transient) {
        particles_ = net.particles;
        transient_ = transient;
        std::size_t const groups = (particles_ + group_particles - 1) / group_particles;
        std::vector<std::uint32_t> degree(groups * group_particles, 0);
        std::vector<std::size_t> oldest(groups, std::numeric_limits<std::size_t>::max()), last(groups, 0);
        for_each_corner(net, [&](std::size_t particle, std::size_t pore, std::size_t) {
            std::size_t const g = particle / group_particles;
            ++degree[particle];
            oldest[g] = std::min(oldest[g], pore);
            last[g] = std::max(last[g], pore);
        });
        find_complete(net.pores(), block, last);
        std::size_t const packs = (net.pores() + width - 1) / width;
        std::size_t const stored = transient ? std::bit_ceil(longest_use(net.pores(), block, oldest)) : packs;
        mask_ = transient ? stored - 1 : std::numeric_limits<std::size_t>::max();
        force_ = {};
        force_.resize(stored * pack_reals + force_reals, Real(0));

        auto const none = std::uint32_t(stored * pack_reals);
        row_.assign(groups, 0);
        begin_.assign(groups + 1, 0);
        for (std::size_t g = 0; g < groups; ++g) {
            auto const first = degree.begin() + std::ptrdiff_t(g * group_particles);
            row_[g] = *std::max_element(first, first + group_particles);
            begin_[g + 1] = begin_[g] + row_[g] * group_particles;
        }
        entry_.assign(begin_[groups], none);
        std::fill(degree.begin(), degree.end(), 0);
        for_each_corner(net, [&](std::size_t particle, std::size_t pore, std::size_t corner) {
            std::size_t const g = particle / group_particles;
            entry_[begin_[g] + particle % group_particles * row_[g] + degree[particle]++] =
                std::uint32_t(offset_of(pore, corner));
        });
    }

    /// Whether build() was called.
    bool built() const noexcept { return !begin_.empty(); }
    bool transient() const noexcept { return transient_; }

    /// Memory of the forces of a pack of pores: on all first corners, then on all second ones, and so on.
    Real* of_pack(std::size_t pack) noexcept { return force_.data() + (pack & mask_) * pack_reals; }
    /// Memory of the force on one corner.
    Real* of(std::size_t pore, std::size_t corner) noexcept { return force_.data() + offset_of(pore, corner); }

    int chunks() const noexcept { return int((row_.size() + chunk_groups - 1) / chunk_groups); }
    /// Sums the forces on every particle of a chunk and writes {F_x, F_y, 0, 0}, in space {F_x, F_y, F_z, 0} and four
    /// zeros, N.
    void write(int chunk, record_column<Real>& to) const noexcept {
        std::size_t const first = std::size_t(chunk) * chunk_groups;
        write_groups(first, std::min(first + chunk_groups, row_.size()), to);
    }
    /// The same for the groups of particles that become complete with block number `block`.
    void write_complete(std::size_t block, record_column<Real>& to) const noexcept {
        write_groups(block > 0 ? complete_[block - 1] : 0, complete_[block], to);
    }

private:
    static constexpr std::size_t pack_reals = corners * force_reals * std::size_t(width);

    template <class Network, class Visit>
    static void for_each_corner(Network const& net, Visit const& visit) {
        for (std::size_t p = 0; p < net.pores(); ++p)
            for (std::size_t c = 0; c < corners; ++c) visit(std::size_t(net.corner[c][p]), p, c);
    }
    std::size_t offset_of(std::size_t pore, std::size_t corner) const noexcept {
        return ((pore / width & mask_) * corners + corner) * force_reals * width + pore % width * force_reals;
    }

    /// Finds how many of the first groups are complete after each block. \param last last pore of each group
    void find_complete(std::size_t pores, std::size_t block, std::vector<std::size_t> const& last) {
        std::size_t const blocks = std::max<std::size_t>((pores + block - 1) / block, 1);
        complete_.assign(blocks, 0);
        std::size_t group = 0;
        for (std::size_t b = 0; b < blocks; ++b) {
            while (group < last.size() && last[group] < (b + 1) * block) ++group;
            complete_[b] = group;
        }
    }
    /// Largest number of packs whose forces are needed at the same time: from the oldest pack still needed to the end
    /// of the present block.
    /// \param oldest first pore of each group; becomes the first pore of this and all later groups
    std::size_t longest_use(std::size_t pores, std::size_t block, std::vector<std::size_t>& oldest) const {
        for (std::size_t g = oldest.size(); g-- > 1;) oldest[g - 1] = std::min(oldest[g - 1], oldest[g]);
        std::size_t most = 1;
        for (std::size_t b = 0; b < complete_.size(); ++b) {
            std::size_t const group = b > 0 ? complete_[b - 1] : 0;
            std::size_t const end = (std::min((b + 1) * block, pores) + width - 1) / width;
            if (group < oldest.size() && oldest[group] / width < end)
                most = std::max(most, end - oldest[group] / width);
        }
        return most;
    }

    [[gnu::noinline, gnu::flatten]] void write_groups(std::size_t first, std::size_t end,
                                                      record_column<Real>& to) const noexcept {
        for (std::size_t g = first; g < end; ++g) {
            switch (row_[g]) {
            case 5: write_group<5>(g, to); break;
            case 6: write_group<6>(g, to); break;
            case 7: write_group<7>(g, to); break;
            case 8: write_group<8>(g, to); break;
            default: write_group<0>(g, to);
            }
        }
    }
    /// \tparam Length of the rows if known at compile time, otherwise 0
    template <std::size_t Length>
    void write_group(std::size_t g, record_column<Real>& to) const noexcept {
        using part = pack<Real, Dim == 2 ? 2 : 4>;
        std::size_t const length = Length > 0 ? Length : row_[g];
        std::uint32_t const* entry = entry_.data() + begin_[g];
        Real const* forces = force_.data();
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

    std::size_t particles_ = 0, mask_ = 0;
    bool transient_ = false;
    std::vector<std::uint32_t> row_, entry_;
    std::vector<std::size_t> begin_;    // per group: index of its first entry
    std::vector<std::size_t> complete_; // per block: number of groups complete after it
    aligned_vector<Real> force_;        // ends with a zero force, to which padding entries point
};
LACUNA_END_PACKS

} // namespace lacuna
