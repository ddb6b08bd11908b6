// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <lacuna/core/prefetch.hpp>

namespace lacuna {

/// Prefetches memory, line by line, while the pair loop evaluates a chunk: the particles that the next chunk is the
/// first to read, and the data that the motion of the chunk's particles will read. The processor cannot predict where a
/// pair's second particle lies. Without prefetching it would wait for each particle outside the cache. Results do not
/// change.
class prefetcher {
public:
    /// Range of memory that is prefetched in equal shares, pack by pack.
    struct stream {
        char const* at = nullptr;
        std::size_t lines_per_pack = 0;

        stream() = default;
        stream(void const* from, std::size_t bytes, std::size_t packs) noexcept
            : at(static_cast<char const*>(from)),
              lines_per_pack(packs > 0 ? ((bytes + cache_line - 1) / cache_line + packs - 1) / packs : 0) {}
    };
    /// The streams of one chunk.
    struct plan {
        std::array<stream, 3> streams;
        bool any = false; ///< whether to prefetch at all

        /// Prefetches the share of one pack. Call it once per pack.
        void prefetch() noexcept {
            for (auto& s : streams)
                for (std::size_t l = 0; l < s.lines_per_pack; ++l, s.at += cache_line) __builtin_prefetch(s.at);
        }
    };

    /// Finds the particles that each chunk is the first to read. Call it when the tables have changed.
    /// \param tables the pair tables; only chunks(), first_slot(), j() and is_padding() are used
    template <class... Tables>
    void build(std::size_t particles, int chunks, Tables const&... tables) {
        first_use_.assign(particles >= few_particles ? std::size_t(chunks) + 2 : 0, particles);
        if (first_use_.empty()) return;
        distances_.assign(std::size_t(chunks) + 1, 0);
        find_first_uses(particles, chunks, std::size_t(chunks), true, tables...);
        // A few pairs may span many more chunks than the others, from one end of the packing to the other. Their
        // particles are not worth prefetching early.
        std::size_t pairs = 0, beyond = 0, usual = std::size_t(chunks);
        for (std::size_t const count : distances_) pairs += count;
        while (usual > 0 && 64 * (beyond + distances_[usual]) <= pairs) beyond += distances_[usual--];
        if (4 * (usual + 1) < std::size_t(chunks))
            find_first_uses(particles, chunks, 4 * (usual + 1), false, tables...);
    }
    /// Whether there are so many particles that prefetching pays.
    bool pays() const noexcept { return !first_use_.empty(); }
    /// Begin and end of the range of particles that the pairs of a chunk are the first to read.
    std::array<std::size_t, 2> newly_read(int chunk) const noexcept {
        auto const c = std::size_t(chunk);
        return {first_use_[std::min(c, first_use_.size() - 2)], first_use_[std::min(c + 1, first_use_.size() - 1)]};
    }

private:
    /// \param limit pairs that span more chunks are ignored
    /// \param count whether distances_ is filled
    template <class... Tables>
    void find_first_uses(std::size_t particles, int chunks, std::size_t limit, bool count, Tables const&... tables) {
        std::size_t reached = 0;
        for (int c = 0; c < chunks; ++c) {
            first_use_[std::size_t(c)] = reached;
            std::size_t const first = particles * std::size_t(c) / std::size_t(chunks);
            std::size_t const end = first + particles * (limit + 1) / std::size_t(chunks);
            auto const look = [&](auto const& table) {
                if (c >= table.chunks()) return;
                for (std::size_t s = table.first_slot(c), last = table.first_slot(c + 1); s < last; ++s) {
                    if (table.is_padding(s, particles)) continue;
                    auto const j = std::size_t(table.j(s));
                    if (j < end) reached = std::max(reached, j + 1);
                    if (count) ++distances_[j > first ? (j - first) * std::size_t(chunks) / particles : 0];
                }
            };
            (look(tables), ...);
        }
    }

    std::vector<std::size_t> distances_; // number of pairs by the number of chunks that they span
    std::vector<std::size_t> first_use_; // by chunk: first particle that no earlier chunk reads
};

} // namespace lacuna
