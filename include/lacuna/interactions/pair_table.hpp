// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lacuna/core/fields.hpp>
#include <lacuna/core/records.hpp>

namespace lacuna {

/// The pairs to which one law applies, with what the law remembers, in the order in which the step visits them.
///
/// Pairs are sorted by (i, j), i < j, and cut into chunks: chunk c holds the pairs whose i lies in the c-th run of
/// `chunk_particles` particles. A chunk starts with a new pack; the last pack of a chunk is filled up with pairs
/// of the store's two ghosts.
template <class Law, class Real, int Dim>
class pair_table {
public:
    static constexpr int width = native_width<Real>;
    static constexpr int chunk_particles = 128;
    using lanes = pack<Real, width>;
    template <class T>
    using history_of = typename Law::template history<T, Dim>;
    using history = history_of<Real>;

    struct entry {
        std::int32_t i, j;      ///< internal indices, i < j
        std::int32_t parameter; ///< row of the parameter table
        std::int32_t label;     ///< number of the bond; not used for contacts
        history state;
    };

    /// Replaces all pairs. No allocation once the table was as large before.
    /// \param entries sorted by (i, j)
    /// \param apart distance of the ghosts, m
    void assign(std::span<entry const> entries, std::size_t particles, std::int32_t ghost0, std::int32_t ghost1, Real apart) {
        std::size_t const chunks = (particles + chunk_particles - 1) / chunk_particles;
        entry const filler{ghost0, ghost1, 0, -1, Law::template initial<Real, Dim>(apart, apart / 2)};
        chunk_begin_.assign(1, 0);
        i_.clear();
        j_.clear();
        parameter_.clear();
        label_.clear();
        uniform_.clear();
        state_.resize(entries.size() / width + chunks + 1);
        count_ = entries.size();
        std::size_t next = 0;
        auto const push = [&](entry const& e) {
            state_.set(i_.size(), e.state);
            i_.push_back(stride * std::uint32_t(e.i));
            j_.push_back(stride * std::uint32_t(e.j));
            parameter_.push_back(e.parameter);
            label_.push_back(e.label);
        };
        for (std::size_t c = 0; c < chunks; ++c) {
            auto const end = std::int64_t((c + 1) * chunk_particles);
            for (; next < entries.size() && entries[next].i < end; ++next) push(entries[next]);
            entry tail = filler;
            if (!i_.empty()) tail.parameter = parameter_.back();
            while (i_.size() % width != 0) push(tail);
            chunk_begin_.push_back(i_.size() / width);
        }
        for (std::size_t p = 0; p < packs(); ++p) {
            std::int32_t row = parameter_[p * width];
            for (int k = 1; k < width; ++k)
                if (parameter_[p * width + std::size_t(k)] != row) row = -1;
            uniform_.push_back(row);
        }
    }

    std::size_t packs() const noexcept { return i_.size() / width; }
    /// Number of slots, fillers included.
    std::size_t slots() const noexcept { return i_.size(); }
    /// Number of pairs, without fillers.
    std::size_t size() const noexcept { return count_; }
    int chunks() const noexcept { return int(chunk_begin_.size()) - 1; }
    std::size_t first_pack(int chunk) const noexcept { return chunk_begin_[std::size_t(chunk)]; }
    std::size_t end_pack(int chunk) const noexcept { return chunk_begin_[std::size_t(chunk) + 1]; }

    std::int32_t i(std::size_t slot) const noexcept { return std::int32_t(i_[slot] / stride); }
    std::int32_t j(std::size_t slot) const noexcept { return std::int32_t(j_[slot] / stride); }
    /// Where the particles begin in a body_column, in reals.
    std::uint32_t const* i_records() const noexcept { return i_.data(); }
    std::uint32_t const* j_records() const noexcept { return j_.data(); }
    std::int32_t const* parameter() const noexcept { return parameter_.data(); }
    std::int32_t label(std::size_t slot) const noexcept { return label_[slot]; }
    bool is_filler(std::size_t slot, std::size_t particles) const noexcept { return std::size_t(i_[slot]) >= stride * particles; }
    /// The parameter row that all pairs of a pack share, or -1.
    std::int32_t uniform_parameter(std::size_t p) const noexcept { return uniform_[p]; }
    field_packs<history_of, Real, width>& states() noexcept { return state_; }
    field_packs<history_of, Real, width> const& states() const noexcept { return state_; }
    /// Slot of the pair (i, j), i < j; -1 if there is none.
    std::int32_t find(std::int32_t i, std::int32_t j) const noexcept {
        int const chunk = int(i / chunk_particles);
        if (i < 0 || chunk >= chunks()) return -1;
        auto const before = [&](std::size_t s) { return this->i(s) < i || (this->i(s) == i && this->j(s) < j); };
        std::size_t low = first_pack(chunk) * width, high = end_pack(chunk) * width;
        while (low < high) {
            std::size_t const middle = (low + high) / 2;
            if (before(middle))
                low = middle + 1;
            else
                high = middle;
        }
        return low < i_.size() && this->i(low) == i && this->j(low) == j ? std::int32_t(low) : -1;
    }
    entry get(std::size_t slot) const noexcept {
        return {i(slot), j(slot), parameter_[slot], label_[slot], state_.get(slot)};
    }

private:
    static constexpr std::uint32_t stride = body_column<Real>::stride;
    std::vector<std::uint32_t> i_, j_;
    std::vector<std::int32_t> parameter_, label_, uniform_;
    std::vector<std::size_t> chunk_begin_{0};
    field_packs<history_of, Real, width> state_;
    std::size_t count_ = 0;
};

} // namespace lacuna
