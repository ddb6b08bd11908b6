// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Chunks of particles, cut into runs that threads go through at the same time: each evaluates the pairs of its
/// chunks in their order and moves the particles of a chunk at once, while they are in the cache.
///
/// A chunk with partners in another span waits: it moves when all pairs are evaluated. Those are the first chunks of a
/// span, and single ones that a long bond concerns.
class chunk_spans {
public:
    /// To be called when tables have changed.
    /// \param tables the pair tables, which threads > 1 ask for
    template <class... Tables>
    void build(int chunks, int threads, std::size_t particles, Tables const&... tables) {
        chunks_ = chunks;
        count_ = threads;
        waits_.assign(threads > 1 ? std::size_t(chunks) : 0, 0);
        if (threads == 1) return;
        (mark(tables, particles), ...);
        std::ptrdiff_t most = 0;
        for (int s = 0; s < count_; ++s)
            most = std::max(most, std::count(waits_.begin() + begin(s), waits_.begin() + end(s), char(1)));
        // Less than this, and a thread would do little but wait.
        if (chunks >= 4 * (most + 1) * threads) return;
        count_ = 1;
        waits_.clear();
    }
    int count() const noexcept { return count_; }
    int begin(int span) const noexcept { return int((long long)(chunks_) * span / count_); }
    int end(int span) const noexcept { return begin(span + 1); }
    /// Whether the particles of a chunk are not to be moved before all pairs are evaluated.
    bool waits(int chunk) const noexcept { return !waits_.empty() && waits_[std::size_t(chunk)]; }

private:
    template <class Table>
    void mark(Table const& table, std::size_t particles) noexcept {
        for (int s = 0; s < count_; ++s)
            for (int c = begin(s); c < std::min(end(s), table.chunks()); ++c)
                for (std::size_t slot = table.first_slot(c), last = slot + table.chunk_size(c); slot < last; ++slot) {
                    if (table.is_padding(slot, particles)) continue;
                    int const second = int(table.j(slot) / Table::chunk_particles);
                    if (second >= end(s)) waits_[std::size_t(second)] = 1;
                }
    }

    std::vector<char> waits_; // of each chunk, where there are several spans
    int chunks_ = 0, count_ = 1;
};

/// Where the forces of a pair table's packs are kept. Either each pack has a place of its own; or, when particles move
/// as soon as their chunk is evaluated, a force is only kept until the last chunk that needs it, and its place is used
/// again, which spares the memory the writing and fetching of forces that nobody reads. Chunks whose forces are needed
/// much longer than others', because of a long bond or because a partner waits, have places of their own all the same.
class force_offsets {
public:
    /// \param transient whether places are used again
    template <class Table>
    void build(Table const& table, std::size_t particles, chunk_spans const& spans, bool transient) {
        at_.resize(std::size_t(table.chunks()));
        uses_.assign(at_.size(), 0);
        // Packs in use are counted on from chunk to chunk: those to spare between them need no place.
        std::size_t in_use = 0;
        for (int c = 0; c < table.chunks(); ++c) {
            at_[std::size_t(c)].origin = table.first_pack(c) - in_use;
            in_use = end_of(table, c);
        }
        std::size_t window = 0;
        if (transient) {
            find_uses(table, particles, spans);
            window = best_window(table, spans.count());
        }
        count_ = 0;
        for (int s = 0; s < spans.count(); ++s) {
            std::size_t const ring = count_;
            count_ += window;
            for (int c = spans.begin(s), end = std::min(spans.end(s), table.chunks()); c < end; ++c) {
                auto& at = at_[std::size_t(c)];
                if (transient && uses_[std::size_t(c)] <= window) {
                    at.begin = ring;
                    at.kept = window;
                } else {
                    at = {count_, table.first_pack(c), std::numeric_limits<std::size_t>::max()};
                    count_ += packs_of(table, c);
                }
            }
        }
        count_ = std::max<std::size_t>(count_, 1);
    }

    /// Places of the table, in packs.
    std::size_t count() const noexcept { return count_; }
    /// Where the places of a chunk begin, how many there are before the first is used again, and which of them the
    /// chunk's first pack has.
    struct row {
        std::size_t begin, kept, first;
    };
    template <class Table>
    row of_chunk(Table const& table, int chunk) const noexcept {
        auto const& at = at_[std::size_t(chunk)];
        return {at.begin, at.kept, (table.first_pack(chunk) - at.origin) % at.kept};
    }
    std::size_t operator()(int chunk, std::size_t pack) const noexcept {
        auto const& at = at_[std::size_t(chunk)];
        return at.begin + (pack - at.origin) % at.kept;
    }

private:
    struct chunk_place {
        std::size_t begin, origin, kept;
    };
    static constexpr std::size_t to_the_end = std::numeric_limits<std::size_t>::max();

    template <class Table>
    static std::size_t packs_of(Table const& table, int chunk) noexcept {
        return table.end_pack(chunk) - table.first_pack(chunk);
    }
    /// Number of packs in use up to the end of a chunk.
    template <class Table>
    std::size_t end_of(Table const& table, int chunk) const noexcept {
        return table.end_pack(chunk) - at_[std::size_t(chunk)].origin;
    }
    /// Of each chunk the packs from one whose force is still needed to the end of the chunk that needs it, at most.
    template <class Table>
    void find_uses(Table const& table, std::size_t particles, chunk_spans const& spans) noexcept {
        for (int c = 0; c < table.chunks(); ++c) {
            std::size_t const first = table.first_pack(c), end = table.end_pack(c);
            std::size_t most = std::max<std::size_t>(end - first, 1);
            if (spans.waits(c)) most = to_the_end;
            for (std::size_t s = first * table.width; s < end * table.width; ++s) {
                if (table.is_padding(s, particles)) continue;
                int const second = int(table.j(s) / Table::chunk_particles);
                most = spans.waits(second)
                           ? to_the_end
                           : std::max(most, end_of(table, second) - (s / table.width - at_[std::size_t(c)].origin));
            }
            uses_[std::size_t(c)] = most;
        }
    }
    /// How many places to use again in each span, so that places are fewest.
    template <class Table>
    std::size_t best_window(Table const& table, int spans) {
        order_.resize(uses_.size());
        for (std::size_t c = 0; c < order_.size(); ++c) order_[c] = int(c);
        std::sort(order_.begin(), order_.end(),
                  [&](int a, int b) { return uses_[std::size_t(a)] > uses_[std::size_t(b)]; });
        std::size_t own = 0, window = 0, fewest = to_the_end;
        for (int const c : order_) {
            std::size_t const use = uses_[std::size_t(c)];
            if (use != to_the_end && own + use * std::size_t(spans) < fewest) {
                fewest = own + use * std::size_t(spans);
                window = use;
            }
            own += packs_of(table, c);
        }
        return own < fewest ? 0 : window;
    }

    std::vector<chunk_place> at_;
    std::vector<std::size_t> uses_;
    std::vector<int> order_;
    std::size_t count_ = 1;
};

} // namespace lacuna
