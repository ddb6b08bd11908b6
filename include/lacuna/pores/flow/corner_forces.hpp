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
/// The forces of the pores on their corners, and their sums on the particles. As force_gather has it for the pairs: per
/// particle a row of entries, in the order of summation, all rows of a group of particles equally long (filled up with a
/// zero force).
///
/// Forces are kept of all pores; or, when nobody changes them after the pass over the pores, no longer than it takes to
/// sum them up: pores are in the order of their lowest corners, so after each run of pores some more groups have met all
/// of theirs, and the place of an older force is used again.
template <class Real, int Dim>
class corner_forces {
public:
    static constexpr int width = native_width<Real>;
    static constexpr std::size_t corners = std::size_t(Dim) + 1;
    /// Numbers of the force on a corner: a pair, in space a record with a 0 at its end.
    static constexpr std::size_t force_reals = Dim == 2 ? 2 : 4;
    /// Records of a particle that are written: its force; in space also its torque, which is none.
    static constexpr std::size_t records = Dim == 2 ? 1 : 2;
    static constexpr std::size_t group_particles = 32;
    /// Groups that one thread handles at a time.
    static constexpr std::size_t chunk_groups = 16;

    /// \param net pore_network, not bare
    /// \param run pores of a run: write_met() is called after each
    /// \param transient whether forces are kept no longer than it takes to sum them up
    template <class Network>
    void build(Network const& net, std::size_t run, bool transient) {
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
        find_met(net.pores(), run, last);
        std::size_t const packs = (net.pores() + width - 1) / width;
        std::size_t const kept = transient ? std::bit_ceil(longest_use(net.pores(), run, oldest)) : packs;
        mask_ = transient ? kept - 1 : std::numeric_limits<std::size_t>::max();
        force_ = {};
        force_.resize(kept * pack_reals + force_reals, Real(0));

        auto const none = std::uint32_t(kept * pack_reals);
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
            entry_[begin_[g] + particle % group_particles * row_[g] + degree[particle]++] = std::uint32_t(place_of(pore, corner));
        });
    }

    /// Whether build() was called.
    bool built() const noexcept { return !begin_.empty(); }
    bool transient() const noexcept { return transient_; }

    /// Where the forces of a pack of pores stand: on the first corners, the second, the third.
    Real* of_pack(std::size_t pack) noexcept { return force_.data() + (pack & mask_) * pack_reals; }
    /// Where the force on one corner stands.
    Real* of(std::size_t pore, std::size_t corner) noexcept { return force_.data() + place_of(pore, corner); }

    int chunks() const noexcept { return int((row_.size() + chunk_groups - 1) / chunk_groups); }
    /// Writes {F_x, F_y, 0, 0}, in space {F_x, F_y, F_z, 0} and four zeros, for every particle of a chunk, N.
    void write(int chunk, record_column<Real>& to) const noexcept {
        std::size_t const first = std::size_t(chunk) * chunk_groups;
        write_groups(first, std::min(first + chunk_groups, row_.size()), to);
    }
    /// The same for the particles that have met all their pores with run number `run`.
    void write_met(std::size_t run, record_column<Real>& to) const noexcept {
        write_groups(run > 0 ? met_[run - 1] : 0, met_[run], to);
    }

private:
    static constexpr std::size_t pack_reals = corners * force_reals * std::size_t(width);

    template <class Network, class Visit>
    static void for_each_corner(Network const& net, Visit const& visit) {
        for (std::size_t p = 0; p < net.pores(); ++p)
            for (std::size_t c = 0; c < corners; ++c) visit(std::size_t(net.corner[c][p]), p, c);
    }
    std::size_t place_of(std::size_t pore, std::size_t corner) const noexcept {
        return ((pore / width & mask_) * corners + corner) * force_reals * width + pore % width * force_reals;
    }

    /// How many of the first groups have met all their pores after each run. \param last pore of each group
    void find_met(std::size_t pores, std::size_t run, std::vector<std::size_t> const& last) {
        std::size_t const runs = std::max<std::size_t>((pores + run - 1) / run, 1);
        met_.assign(runs, 0);
        std::size_t group = 0;
        for (std::size_t r = 0; r < runs; ++r) {
            while (group < last.size() && last[group] < (r + 1) * run) ++group;
            met_[r] = group;
        }
    }
    /// Packs from one whose forces are still needed to the end of the run after which they are not, at most.
    /// \param oldest pore of each group, which becomes the oldest of it and all later ones
    std::size_t longest_use(std::size_t pores, std::size_t run, std::vector<std::size_t>& oldest) const {
        for (std::size_t g = oldest.size(); g-- > 1;) oldest[g - 1] = std::min(oldest[g - 1], oldest[g]);
        std::size_t most = 1;
        for (std::size_t r = 0; r < met_.size(); ++r) {
            std::size_t const group = r > 0 ? met_[r - 1] : 0;
            std::size_t const end = (std::min((r + 1) * run, pores) + width - 1) / width;
            if (group < oldest.size() && oldest[group] / width < end) most = std::max(most, end - oldest[group] / width);
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
    /// \tparam Length of the rows where it is known at compile time, else 0
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
    std::vector<std::size_t> begin_, met_;
    aligned_vector<Real> force_; // and a zero
};
LACUNA_END_PACKS

} // namespace lacuna
