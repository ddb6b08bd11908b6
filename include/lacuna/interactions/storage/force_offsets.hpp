// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <lacuna/core/standard.hpp>
#include <lacuna/interactions/storage/pair_table.hpp>

namespace lacuna {

/// Cuts the chunks of particles into spans, one per thread. Each thread evaluates the pairs of its chunks in their
/// order. It moves the particles of a chunk right after that, while they are in the cache.
///
/// A chunk with partners in another span waits: its particles move once all pairs are evaluated. This concerns the
/// first chunks of a span, and single chunks with a long bond.
class chunk_spans {
public:
    /// Cuts the chunks anew. Call it when the tables have changed.
    /// \param tables the pair tables; read only for threads > 1
    template <class Real, int Dim, class... Laws>
    void build(int chunks, int threads, std::size_t particles, pair_table<Laws, Real, Dim> const&... tables) {
        chunks_ = chunks;
        count_ = threads;
        waits_.assign(threads > 1 ? std::size_t(chunks) : 0, 0);
        if (threads == 1) return;
        (mark(tables, particles), ...);
        std::ptrdiff_t most = 0;
        for (int s = 0; s < count_; ++s)
            most = std::max(most, std::count(waits_.begin() + begin(s), waits_.begin() + end(s), char(1)));
        // With fewer chunks the threads would spend most of the time waiting.
        if (chunks >= 4 * (most + 1) * threads) return;
        count_ = 1;
        waits_.clear();
    }
    int count() const noexcept { return count_; }
    int begin(int span) const noexcept { return int((long long)(chunks_) * span / count_); }
    int end(int span) const noexcept { return begin(span + 1); }
    /// Whether the particles of a chunk must not move before all pairs are evaluated.
    bool waits(int chunk) const noexcept { return !waits_.empty() && waits_[std::size_t(chunk)]; }

private:
    template <class Law, class Real, int Dim>
    void mark(pair_table<Law, Real, Dim> const& table, std::size_t particles) noexcept {
        for (int s = 0; s < count_; ++s)
            for (int c = begin(s); c < std::min(end(s), table.chunks()); ++c)
                for (std::size_t slot = table.first_slot(c), last = slot + table.chunk_size(c); slot < last; ++slot) {
                    if (table.is_padding(slot, particles)) continue;
                    int const second = int(table.j(slot) / table.chunk_particles);
                    if (second >= end(s)) waits_[std::size_t(second)] = 1;
                }
    }

    std::vector<char> waits_; // by chunk; empty if there is one span
    int chunks_ = 0, count_ = 1;
};

/// Memory offsets of the forces of a pair table, by pack. There are two modes.
///
/// Either each pack has memory of its own. Or particles move as soon as their chunk is evaluated: then a force is
/// stored only until the last chunk that needs it, and its memory is reused. This saves the memory traffic of forces
/// that are not read again. A chunk whose forces are needed much longer, because of a long bond or because a partner
/// waits, has memory of its own in both modes.
class force_offsets {
public:
    /// \param transient whether memory is reused
    template <class Law, class Real, int Dim>
    void build(pair_table<Law, Real, Dim> const& table, std::size_t particles, chunk_spans const& spans,
               bool transient) {
        at_.resize(std::size_t(table.chunks()));
        lifetimes_.assign(at_.size(), 0);
        packs_.resize(at_.size());
        // Packs in use are counted from chunk to chunk: the spare packs between them need no memory.
        std::size_t in_use = 0;
        for (int c = 0; c < table.chunks(); ++c) {
            at_[std::size_t(c)].origin = table.first_pack(c) - in_use;
            in_use = end_of(table, c);
            packs_[std::size_t(c)] = table.end_pack(c) - table.first_pack(c);
        }
        std::size_t window = 0;
        if (transient) {
            find_lifetimes(table, particles, spans);
            window = best_window(spans.count());
        }
        count_ = 0;
        for (int s = 0; s < spans.count(); ++s) {
            std::size_t const ring = count_;
            count_ += window;
            for (int c = spans.begin(s), end = std::min(spans.end(s), table.chunks()); c < end; ++c) {
                auto& at = at_[std::size_t(c)];
                if (transient && lifetimes_[std::size_t(c)] <= window) {
                    at.begin = ring;
                    at.window = window;
                } else {
                    at = {count_, table.first_pack(c), std::numeric_limits<std::size_t>::max()};
                    count_ += packs_[std::size_t(c)];
                }
            }
        }
        count_ = std::max<std::size_t>(count_, 1);
    }

    /// Memory that the forces of the table need, in packs.
    std::size_t count() const noexcept { return count_; }
    /// Offsets of one chunk, in packs.
    struct row {
        std::size_t begin;  ///< where the memory of the chunk begins
        std::size_t window; ///< number of packs after which the memory is reused from `begin` on
        std::size_t first;  ///< offset of the chunk's first pack from `begin`
    };
    template <class Law, class Real, int Dim>
    row of_chunk(pair_table<Law, Real, Dim> const& table, int chunk) const noexcept {
        auto const& at = at_[std::size_t(chunk)];
        return {at.begin, at.window, (table.first_pack(chunk) - at.origin) % at.window};
    }
    /// Offset of a pack of a chunk, in packs.
    std::size_t operator()(int chunk, std::size_t pack) const noexcept {
        auto const& at = at_[std::size_t(chunk)];
        return at.begin + (pack - at.origin) % at.window;
    }

private:
    struct chunk_offsets {
        std::size_t begin, origin, window;
    };
    static constexpr std::size_t to_the_end = std::numeric_limits<std::size_t>::max();

    /// Number of packs in use up to the end of a chunk.
    template <class Law, class Real, int Dim>
    std::size_t end_of(pair_table<Law, Real, Dim> const& table, int chunk) const noexcept {
        return table.end_pack(chunk) - at_[std::size_t(chunk)].origin;
    }
    /// Finds the lifetime of each chunk's forces: the largest number of packs from a force of the chunk to the end of
    /// the last chunk that needs it.
    template <class Law, class Real, int Dim>
    void find_lifetimes(pair_table<Law, Real, Dim> const& table, std::size_t particles,
                        chunk_spans const& spans) noexcept {
        for (int c = 0; c < table.chunks(); ++c) {
            std::size_t const first = table.first_pack(c), end = table.end_pack(c);
            std::size_t most = std::max<std::size_t>(end - first, 1);
            if (spans.waits(c)) most = to_the_end;
            for (std::size_t s = first * table.width; s < end * table.width; ++s) {
                if (table.is_padding(s, particles)) continue;
                int const second = int(table.j(s) / table.chunk_particles);
                most = spans.waits(second)
                           ? to_the_end
                           : std::max(most, end_of(table, second) - (s / table.width - at_[std::size_t(c)].origin));
            }
            lifetimes_[std::size_t(c)] = most;
        }
    }
    /// Number of packs to reuse in each span that makes the memory smallest.
    std::size_t best_window(int spans) {
        order_.resize(lifetimes_.size());
        for (std::size_t c = 0; c < order_.size(); ++c) order_[c] = int(c);
        std::sort(order_.begin(), order_.end(),
                  [&](int a, int b) { return lifetimes_[std::size_t(a)] > lifetimes_[std::size_t(b)]; });
        std::size_t own = 0, window = 0, fewest = to_the_end;
        for (int const c : order_) {
            std::size_t const lifetime = lifetimes_[std::size_t(c)];
            if (lifetime != to_the_end && own + lifetime * std::size_t(spans) < fewest) {
                fewest = own + lifetime * std::size_t(spans);
                window = lifetime;
            }
            own += packs_[std::size_t(c)];
        }
        return own < fewest ? 0 : window;
    }

    std::vector<chunk_offsets> at_;
    std::vector<std::size_t> lifetimes_, packs_; // by chunk; packs_: number of packs in use
    std::vector<int> order_;
    std::size_t count_ = 1;
};

} // namespace lacuna
