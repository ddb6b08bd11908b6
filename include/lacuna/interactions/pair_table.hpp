// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lacuna/core/fields.hpp>
#include <lacuna/core/parallel.hpp>
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
    /// \param store particle_store of the particles, with the ghosts
    template <class Store>
    void assign(std::span<entry const> entries, Store const& store) {
        int const chunks = chunks_of(store.size());
        auto const first = [&](int c) { return first_of_chunk(entries, c); };
        lay_out(chunks, 1, [&](int c) { return std::size_t(first(c + 1) - first(c)); });
        for (int c = 0; c < chunks; ++c)
            fill(c, store, [&](auto const& push) {
                for (auto e = first(c); e != first(c + 1); ++e) push(*e);
            });
    }

    /// Makes room for `count(c)` pairs in each chunk c; their values are any until fill() has written them.
    /// \param chunks of the particles
    /// \param threads how many may call count
    /// \param count callable chunk -> number of pairs
    template <class Count>
    void lay_out(int chunks, int threads, Count const& count) {
        chunk_begin_.assign(std::size_t(chunks) + 1, 0);
        for_each_chunk(chunks, threads, [&](int c) { chunk_begin_[std::size_t(c) + 1] = count(c); });
        count_ = 0;
        for (std::size_t c = 0; c < std::size_t(chunks); ++c) {
            count_ += chunk_begin_[c + 1];
            chunk_begin_[c + 1] = chunk_begin_[c] + (chunk_begin_[c + 1] + width - 1) / width;
        }
        resize();
    }
    /// Writes the pairs of a chunk, as many as lay_out() was told. Chunks are independent of each other.
    /// \param chunk which
    /// \param store of the particles, with the ghosts
    /// \param write callable that calls push(entry) for each, sorted by (i, j)
    template <class Store, class Write>
    void fill(int chunk, Store const& store, Write const& write) {
        std::size_t slot = first_pack(chunk) * width;
        write([&](entry const& e) { put(slot++, e); });
        close(chunk, slot, store);
    }

    /// Leaves out the pairs for which keep(slot) is false.
    template <class Store, class Keep>
    void filter(Store const& store, Keep const& keep) {
        // Towards the front, within the table itself: a pair never moves beyond where it was.
        std::size_t slot = 0, old_first = 0;
        count_ = 0;
        for (int c = 0; c < chunks(); ++c) {
            std::size_t const old_end = end_pack(c) * width;
            chunk_begin_[std::size_t(c)] = slot / width;
            for (std::size_t s = old_first; s < old_end; ++s) {
                if (is_filler(s, store.size()) || !keep(s)) continue;
                put(slot++, get(s));
                ++count_;
            }
            slot = close(c, slot, store);
            old_first = old_end;
        }
        chunk_begin_.back() = slot / width;
        resize();
    }

    static int chunks_of(std::size_t particles) noexcept { return int((particles + chunk_particles - 1) / chunk_particles); }
    /// The first of the pairs, sorted by (i, j), that belong to a chunk or a later one.
    template <class Pairs>
    static auto first_of_chunk(Pairs const& pairs, int chunk) noexcept {
        auto const begin = std::int64_t(chunk) * chunk_particles;
        return std::partition_point(pairs.begin(), pairs.end(), [&](auto const& e) { return e.i < begin; });
    }

    std::size_t packs() const noexcept { return i_.size() / width; }
    /// Number of slots, fillers included.
    std::size_t slots() const noexcept { return i_.size(); }
    /// Number of pairs, without fillers.
    std::size_t size() const noexcept { return count_; }
    int chunks() const noexcept { return int(chunk_begin_.size()) - 1; }
    std::size_t first_pack(int chunk) const noexcept { return chunk_begin_[std::size_t(chunk)]; }
    std::size_t end_pack(int chunk) const noexcept { return chunk_begin_[std::size_t(chunk) + 1]; }

    /// First slot of a chunk; of one beyond the last, slots().
    std::size_t first_slot(int chunk) const noexcept { return chunk_begin_[std::size_t(std::min(chunk, chunks()))] * width; }
    /// Whether a slot holds the given pair, or one before it.
    template <class Pair>
    bool is(std::size_t slot, Pair const& pair) const noexcept {
        return i(slot) == pair.i && j(slot) == pair.j;
    }
    template <class Pair>
    bool before(std::size_t slot, Pair const& pair) const noexcept {
        return i(slot) < pair.i || (i(slot) == pair.i && j(slot) < pair.j);
    }

    /// Asks the memory for a pack; one beyond the end does no harm.
    void fetch(std::size_t p) const noexcept {
        state_.fetch(p);
        __builtin_prefetch(i_.data() + width * p);
        __builtin_prefetch(j_.data() + width * p);
    }

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
        struct {
            std::int32_t i, j;
        } const wanted{i, j};
        std::size_t low = first_pack(chunk) * width, high = end_pack(chunk) * width;
        while (low < high) {
            std::size_t const middle = (low + high) / 2;
            if (before(middle, wanted))
                low = middle + 1;
            else
                high = middle;
        }
        return low < i_.size() && is(low, wanted) ? std::int32_t(low) : -1;
    }
    entry get(std::size_t slot) const noexcept {
        return {i(slot), j(slot), parameter_[slot], label_[slot], state_.get(slot)};
    }

private:
    void resize() {
        std::size_t const packs = chunk_begin_.back(), slots = packs * width;
        for (auto* indices : {&i_, &j_}) resize_with_room(*indices, slots);
        for (auto* numbers : {&parameter_, &label_}) resize_with_room(*numbers, slots);
        resize_with_room(uniform_, packs);
        state_.resize(packs);
    }
    void put(std::size_t slot, entry const& e) noexcept {
        i_[slot] = stride * std::uint32_t(e.i);
        j_[slot] = stride * std::uint32_t(e.j);
        parameter_[slot] = e.parameter;
        label_[slot] = e.label;
        state_.set(slot, e.state);
    }
    /// Fills up the last pack of a chunk, and looks which rows its packs have.
    /// \return the first slot after the chunk
    template <class Store>
    std::size_t close(int chunk, std::size_t slot, Store const& store) noexcept {
        Real const apart = store.ghost_distance();
        std::size_t const first = first_pack(chunk) * width;
        // In their pack's row, so that it has one.
        std::int32_t const row = slot > first ? parameter_[slot - 1] : 0;
        for (; slot % width != 0; ++slot)
            put(slot, {store.ghost(0), store.ghost(1), row, -1, Law::template initial<Real, Dim>(apart, apart / 2)});
        for (std::size_t s = first; s < slot; s += width) {
            bool const same = std::all_of(parameter_.begin() + std::ptrdiff_t(s), parameter_.begin() + std::ptrdiff_t(s + width),
                                          [&](std::int32_t r) { return r == parameter_[s]; });
            uniform_[s / width] = same ? parameter_[s] : -1;
        }
        return slot;
    }

    static constexpr std::uint32_t stride = body_column<Real>::stride;
    std::vector<std::uint32_t> i_, j_;
    std::vector<std::int32_t> parameter_, label_, uniform_;
    std::vector<std::size_t> chunk_begin_{0};
    field_packs<history_of, Real, width> state_;
    std::size_t count_ = 0;
};

} // namespace lacuna
