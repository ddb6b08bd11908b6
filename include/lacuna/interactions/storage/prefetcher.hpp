// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <lacuna/core/prefetch.hpp>

namespace lacuna {

/// What the loop over the pairs of a chunk asks the memory for, line by line while it computes: the bodies that the next
/// chunk is the first to read, and what will be read when its own particles move. Bodies that do not fit into the cache
/// would come one by one otherwise, each waited for: no processor foresees where a pair's second particle is. It changes
/// no result.
class prefetcher {
public:
    /// Lines that are asked for in equal shares, pack by pack.
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
        bool any = false; ///< whether to ask for anything

        /// To be called once a pack.
        void prefetch() noexcept {
            for (auto& s : streams)
                for (std::size_t l = 0; l < s.lines_per_pack; ++l, s.at += cache_line) __builtin_prefetch(s.at);
        }
    };

    /// To be called when tables have changed.
    /// \param tables the pair tables
    template <class... Tables>
    void build(std::size_t particles, int chunks, Tables const&... tables) {
        first_use_.assign(particles >= few_particles ? std::size_t(chunks) + 2 : 0, particles);
        if (first_use_.empty()) return;
        distances_.assign(std::size_t(chunks) + 1, 0);
        look_at(particles, chunks, std::size_t(chunks), true, tables...);
        // A few pairs may reach much further than the others, from one end of the body to the other: what they need is not
        // worth to be asked for at once.
        std::size_t pairs = 0, beyond = 0, usual = std::size_t(chunks);
        for (std::size_t const count : distances_) pairs += count;
        while (usual > 0 && 64 * (beyond + distances_[usual]) <= pairs) beyond += distances_[usual--];
        if (4 * (usual + 1) < std::size_t(chunks)) look_at(particles, chunks, 4 * (usual + 1), false, tables...);
    }
    /// Whether there is so much that reading ahead pays.
    bool pays() const noexcept { return !first_use_.empty(); }
    /// First and end of the particles that the pairs of a chunk are the first to read.
    std::array<std::size_t, 2> fresh(int chunk) const noexcept {
        auto const c = std::size_t(chunk);
        return {first_use_[std::min(c, first_use_.size() - 2)], first_use_[std::min(c + 1, first_use_.size() - 1)]};
    }

private:
    /// \param limit largest distance of pairs that count, in chunks
    template <class... Tables>
    void look_at(std::size_t particles, int chunks, std::size_t limit, bool count, Tables const&... tables) {
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

    std::vector<std::size_t> distances_; // pairs by how many chunks they span
    std::vector<std::size_t> first_use_; // of each chunk, the first particle that no chunk before it reads
};

} // namespace lacuna
