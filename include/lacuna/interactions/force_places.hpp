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
/// The first chunks of a span, its frontier, have partners in the span before: they move when all pairs are evaluated.
class chunk_spans {
public:
    chunk_spans() = default;
    /// \param reach largest distance, in chunks, from a pair's first particle to its second
    chunk_spans(int chunks, int threads, int reach) : chunks_(chunks), reach_(reach) {
        // Less than this, and a thread would do little but wait for its frontier.
        if (chunks >= 4 * (reach + 1) * threads) count_ = threads;
    }
    int count() const noexcept { return count_; }
    int begin(int span) const noexcept { return int((long long)(chunks_) * span / count_); }
    int frontier_end(int span) const noexcept { return span > 0 ? begin(span) + reach_ : 0; }

private:
    int chunks_ = 0, count_ = 1, reach_ = 0;
};

/// Where the forces of a pair table's packs are kept. Either each pack has a place of its own; or, when particles move
/// as soon as their chunk is evaluated, a force is only kept until the last chunk that needs it, and its place is used
/// again, which spares the memory the writing and fetching of forces that nobody reads.
class force_places {
public:
    /// \param streaming whether places are used again
    template <class Table>
    void build(Table const& table, std::size_t particles, chunk_spans const& spans, bool streaming) {
        at_.resize(std::size_t(table.chunks()));
        // Packs in use are counted on from chunk to chunk: those to spare between them need no place.
        std::size_t in_use = 0;
        for (int c = 0; c < table.chunks(); ++c) {
            at_[std::size_t(c)].origin = table.first_pack(c) - in_use;
            in_use = end_of(table, c);
        }
        count_ = 0;
        std::size_t const window = streaming ? longest_use(table, particles) : 0;
        for (int s = 0; s < spans.count(); ++s) {
            int const end = s + 1 < spans.count() ? spans.begin(s + 1) : table.chunks();
            int const kept_end = streaming ? std::min(spans.frontier_end(s), end) : end;
            for (int c = spans.begin(s); c < end; ++c) {
                auto& at = at_[std::size_t(c)];
                at.begin = count_;
                at.kept = window;
                if (c >= kept_end) continue;
                at.origin = table.first_pack(c);
                at.kept = std::numeric_limits<std::size_t>::max();
                count_ += table.end_pack(c) - table.first_pack(c);
            }
            if (kept_end < end) count_ += window;
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

    /// Number of packs in use up to the end of a chunk.
    template <class Table>
    std::size_t end_of(Table const& table, int chunk) const noexcept {
        return table.end_pack(chunk) - at_[std::size_t(chunk)].origin;
    }
    /// Packs from one whose force is still needed to the end of the chunk that needs it, at most.
    template <class Table>
    std::size_t longest_use(Table const& table, std::size_t particles) const noexcept {
        std::size_t most = 1;
        for (int c = 0; c < table.chunks(); ++c) {
            std::size_t const first = table.first_pack(c), end = table.end_pack(c);
            most = std::max(most, end - first);
            for (std::size_t s = first * table.width; s < end * table.width; ++s)
                if (!table.is_filler(s, particles))
                    most = std::max(most, end_of(table, int(table.j(s) / Table::chunk_particles)) -
                                              (s / table.width - at_[std::size_t(c)].origin));
        }
        return most;
    }

    std::vector<chunk_place> at_;
    std::size_t count_ = 1;
};

} // namespace lacuna
