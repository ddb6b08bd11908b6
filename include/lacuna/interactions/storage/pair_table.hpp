// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <lacuna/core/fields.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/laws/law_concepts.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The pairs to which one law applies, with the law's histories, in the order in which the step visits them.
///
/// Pairs are sorted by (i, j), i < j, and cut into chunks: chunk c holds the pairs whose i lies in the c-th block of
/// `chunk_particles` particles. Each chunk has a range of packs: first the packs in use, then spare packs. The rest of
/// the last pack in use is filled up with padding pairs of the store's two padding particles.
template <class Law, class Real, int Dim>
class pair_table {
public:
    static constexpr int width = native_width<Real>;
    static constexpr int chunk_particles = 128;
    using lanes = pack<Real, width>;
    template <class T>
    using history_of = typename Law::template history<T, Dim>;
    using history = history_of<Real>;
    static_assert(detail::consists_of<history_of<lanes>, lanes>(), "a law's history must consist of T and vec<T, N>");

    /// Whether pairs have labels: only bonds do.
    static constexpr bool labelled = bond_law<Law, Dim>;

    struct entry {
        std::int32_t i, j;      ///< internal indices, i < j
        std::int32_t parameter; ///< row of the parameter table
        std::int32_t label;     ///< number of the bond; contacts have none, -1
        history state;
    };

    /// Replaces all pairs. There are no spare packs afterwards.
    /// \param entries sorted by (i, j)
    /// \param store the particles, with the padding particles
    void assign(std::span<entry const> entries, particle_store<Real, Dim> const& store) {
        auto const first = [&](int c) { return first_of_chunk(entries, c); };
        lay_out(chunks_of(store.size()), [&](int c) { return packs_for(std::size_t(first(c + 1) - first(c))); });
        for (int c = 0; c < chunks(); ++c)
            fill(c, store, [&](auto const& push) {
                for (auto e = first(c); e != first(c + 1); ++e) push(*e);
            });
    }

    /// Makes a chunk hold exactly the pairs of `wanted`, in place. Pairs already there keep their histories. Chunks are
    /// independent of each other.
    /// \param wanted has forward(visit) and backward(visit), which call visit(pair) for each pair sorted by (i, j), in
    ///        this or in reverse order; backward() stops once visit() returns false
    /// \param make callable pair -> entry, for pairs that are not in the chunk
    /// \return whether the pairs fit. If not, unwanted pairs are removed and no pair is added; call make_room() then
    template <class Wanted, class Make>
    bool merge(int chunk, Wanted const& wanted, particle_store<Real, Dim> const& store, Make const& make) {
        if (chunk >= chunks()) return false;
        std::size_t const first = first_slot(chunk), old_end = first + chunk_pairs_[std::size_t(chunk)];
        std::size_t known = first, retained = first, end = first;
        wanted.forward([&](auto const& pair) {
            ++end;
            while (known < old_end && before(known, pair)) ++known;
            if (known == old_end || !is(known, pair)) return;
            if (known != retained) move(known, retained);
            ++known, ++retained;
        });
        bool const fits = end <= first_slot(chunk + 1), same = retained == old_end && retained == end;
        if (!fits) end = retained;
        // From the back, so that no pair is overwritten before it has moved. Once only retained pairs are left, they
        // are already in their slots.
        if (std::size_t slot = end; slot != retained)
            wanted.backward([&](auto const& pair) {
                --slot;
                if (retained > first && is(retained - 1, pair))
                    move(--retained, slot);
                else
                    put(slot, make(pair));
                return slot != retained;
            });
        chunk_pairs_[std::size_t(chunk)] = end - first;
        fill_up(chunk, std::max(packs_for(old_end - first), packs_for(end - first)), store);
        if (!same) find_uniform_parameters(chunk);
        return fits;
    }
    /// Lays the table out anew with the same pairs and with spare packs in every chunk.
    /// \param store the particles, with the padding particles
    /// \param count callable chunk -> number of pairs that must fit, not less than the chunk's present number
    template <class Count>
    void make_room(particle_store<Real, Dim> const& store, Count const& count) {
        pair_table larger;
        larger.lay_out(chunks_of(store.size()), [&](int c) {
            std::size_t const packs = packs_for(count(c));
            return packs + packs / 16 + 1;
        });
        for (int c = 0; c < larger.chunks(); ++c)
            larger.fill(c, store, [&](auto const& push) {
                if (c >= chunks()) return;
                for (std::size_t k = 0; k < chunk_pairs_[std::size_t(c)]; ++k) push(get(first_slot(c) + k));
            });
        *this = std::move(larger);
    }

    /// Removes the pairs for which keep(slot) is false, and all spare packs.
    template <class Keep>
    void filter(particle_store<Real, Dim> const& store, Keep const& keep) {
        // In place: a pair only moves towards the front, so it overwrites no pair that is still to move.
        std::size_t packs = 0;
        for (int c = 0; c < chunks(); ++c) {
            std::size_t const old_first = first_slot(c), old_end = old_first + chunk_pairs_[std::size_t(c)];
            std::size_t slot = packs * width;
            chunk_begin_[std::size_t(c)] = packs;
            for (std::size_t s = old_first; s < old_end; ++s)
                if (keep(s)) move(s, slot++);
            chunk_pairs_[std::size_t(c)] = slot - packs * width;
            packs = end_pack(c);
            fill_up(c, packs - first_pack(c), store);
            find_uniform_parameters(c);
        }
        chunk_begin_.back() = packs;
        resize();
    }

    static int chunks_of(std::size_t particles) noexcept {
        return int((particles + chunk_particles - 1) / chunk_particles);
    }
    /// Iterator to the first of the pairs, sorted by (i, j), that belongs to the chunk or to a later one.
    template <class Pairs>
    static auto first_of_chunk(Pairs const& pairs, int chunk) noexcept {
        auto const begin = std::int64_t(chunk) * chunk_particles;
        return std::partition_point(pairs.begin(), pairs.end(), [&](auto const& e) { return e.i < begin; });
    }

    std::size_t packs() const noexcept { return i_.size() / width; }
    /// Number of slots, padding included.
    std::size_t slots() const noexcept { return i_.size(); }
    /// Number of pairs, without padding.
    std::size_t size() const noexcept {
        return std::accumulate(chunk_pairs_.begin(), chunk_pairs_.end(), std::size_t(0));
    }
    int chunks() const noexcept { return int(chunk_pairs_.size()); }
    /// Number of pairs of a chunk, without padding; they begin at first_slot().
    std::size_t chunk_size(int chunk) const noexcept { return chunk_pairs_[std::size_t(chunk)]; }
    std::size_t first_pack(int chunk) const noexcept { return chunk_begin_[std::size_t(chunk)]; }
    /// End of the packs of a chunk that are in use.
    std::size_t end_pack(int chunk) const noexcept {
        return first_pack(chunk) + packs_for(chunk_pairs_[std::size_t(chunk)]);
    }

    /// First slot of a chunk; slots() for a chunk beyond the last.
    std::size_t first_slot(int chunk) const noexcept {
        return chunk_begin_[std::size_t(std::min(chunk, chunks()))] * width;
    }
    /// Whether a slot holds the given pair.
    template <class Pair>
    bool is(std::size_t slot, Pair const& pair) const noexcept {
        return i(slot) == pair.i && j(slot) == pair.j;
    }
    /// Whether a slot holds a pair that comes before the given pair.
    template <class Pair>
    bool before(std::size_t slot, Pair const& pair) const noexcept {
        return i(slot) < pair.i || (i(slot) == pair.i && j(slot) < pair.j);
    }

    /// Prefetches a pack; a pack beyond the end does no harm.
    void prefetch(std::size_t p) const noexcept {
        state_.prefetch(p);
        __builtin_prefetch(i_.data() + width * p);
        __builtin_prefetch(j_.data() + width * p);
    }

    std::int32_t i(std::size_t slot) const noexcept { return std::int32_t(i_[slot] / stride); }
    std::int32_t j(std::size_t slot) const noexcept { return std::int32_t(j_[slot] / stride); }
    /// Offsets of the pairs' particles in a particle_column, in reals.
    std::uint32_t const* i_records() const noexcept { return i_.data(); }
    std::uint32_t const* j_records() const noexcept { return j_.data(); }
    std::int32_t const* parameter() const noexcept { return parameter_.data(); }
    std::int32_t label(std::size_t slot) const noexcept
        requires labelled
    {
        return label_[slot];
    }
    bool is_padding(std::size_t slot, std::size_t particles) const noexcept {
        return std::size_t(i_[slot]) >= stride * particles;
    }
    /// Parameter row that all pairs of a pack share, or -1.
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
        entry e{i(slot), j(slot), parameter_[slot], -1, state_.get(slot)};
        if constexpr (labelled) e.label = label_[slot];
        return e;
    }

private:
    static std::size_t packs_for(std::size_t pairs) noexcept { return (pairs + width - 1) / width; }
    /// Lays out the ranges of the chunks, all empty.
    /// \param packs callable chunk -> length of its range in packs
    template <class Packs>
    void lay_out(int chunks, Packs const& packs) {
        chunk_pairs_.assign(std::size_t(chunks), 0);
        chunk_begin_.assign(std::size_t(chunks) + 1, 0);
        for (int c = 0; c < chunks; ++c) chunk_begin_[std::size_t(c) + 1] = chunk_begin_[std::size_t(c)] + packs(c);
        resize();
    }
    void resize() {
        std::size_t const packs = chunk_begin_.back(), slots = packs * width;
        for (auto* indices : {&i_, &j_}) resize_with_room(*indices, slots);
        resize_with_room(parameter_, slots);
        if constexpr (labelled) resize_with_room(label_, slots);
        resize_with_room(uniform_, packs);
        state_.resize(packs);
    }
    /// Writes the pairs of an empty chunk.
    /// \param write callable that calls push(entry) for each pair, sorted by (i, j)
    template <class Write>
    void fill(int chunk, particle_store<Real, Dim> const& store, Write const& write) {
        std::size_t const first = first_slot(chunk);
        auto& pairs = chunk_pairs_[std::size_t(chunk)];
        write([&](entry const& e) { put(first + pairs++, e); });
        fill_up(chunk, first_pack(chunk + 1) - first_pack(chunk), store);
        find_uniform_parameters(chunk);
    }
    void put(std::size_t slot, entry const& e) noexcept {
        i_[slot] = stride * std::uint32_t(e.i);
        j_[slot] = stride * std::uint32_t(e.j);
        parameter_[slot] = e.parameter;
        if constexpr (labelled) label_[slot] = e.label;
        state_.set(slot, e.state);
    }
    void move(std::size_t from, std::size_t to) noexcept {
        i_[to] = i_[from];
        j_[to] = j_[from];
        parameter_[to] = parameter_[from];
        if constexpr (labelled) label_[to] = label_[from];
        state_.set(to, state_.get(from));
    }
    /// Fills the slots after a chunk's pairs with padding pairs, within the first `packs` packs of its range.
    void fill_up(int chunk, std::size_t packs, particle_store<Real, Dim> const& store) noexcept {
        Real const apart = store.padding_distance();
        std::size_t const first = first_slot(chunk);
        std::size_t slot = first + chunk_pairs_[std::size_t(chunk)];
        // Padding takes the row of the last pair, so that the pack can have a uniform row.
        entry const padding_pair{store.padding_particle(0), store.padding_particle(1),
                                 slot > first ? parameter_[slot - 1] : 0, -1,
                                 Law::template initial<Real, Dim>(apart, apart / 2)};
        for (; slot < first + packs * width; ++slot) put(slot, padding_pair);
    }
    /// Finds the parameter row that all pairs of a pack share, for each pack of a chunk.
    void find_uniform_parameters(int chunk) noexcept {
        for (std::size_t p = first_pack(chunk); p < end_pack(chunk); ++p) {
            auto const row = parameter_.begin() + std::ptrdiff_t(p * width);
            uniform_[p] = std::all_of(row, row + width, [&](std::int32_t r) { return r == *row; }) ? *row : -1;
        }
    }

    static constexpr std::uint32_t stride = particle_column<Real>::stride;
    std::vector<std::uint32_t> i_, j_;
    std::vector<std::int32_t> parameter_, label_, uniform_;
    std::vector<std::size_t> chunk_begin_{0}, chunk_pairs_; // by chunk: first pack (and the end), number of pairs
    field_packs<history_of, Real, width> state_;
};
LACUNA_END_PACKS

} // namespace lacuna
