// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <lacuna/core/fetch.hpp>

namespace lacuna {

/// What the loop over the pairs of a chunk asks the memory for, line by line while it computes: the bodies that the next
/// chunk is the first to read, and what will be read when its own particles move. Bodies that do not fit into the cache
/// would come one by one otherwise, each waited for: no processor foresees where a pair's second particle is. It changes
/// no result.
class read_ahead {
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
        void fetch() noexcept {
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
        std::size_t reached = 0;
        for (int c = 0; c < chunks; ++c) {
            first_use_[std::size_t(c)] = reached;
            auto const look = [&](auto const& table) {
                if (c >= table.chunks()) return;
                for (std::size_t s = table.first_slot(c), end = table.first_slot(c + 1); s < end; ++s)
                    if (!table.is_filler(s, particles)) reached = std::max(reached, std::size_t(table.j(s)) + 1);
            };
            (look(tables), ...);
        }
    }
    /// Whether there is so much that reading ahead pays.
    bool pays() const noexcept { return !first_use_.empty(); }
    /// First and end of the particles that the pairs of a chunk are the first to read.
    std::array<std::size_t, 2> fresh(int chunk) const noexcept {
        auto const c = std::size_t(chunk);
        return {first_use_[std::min(c, first_use_.size() - 2)], first_use_[std::min(c + 1, first_use_.size() - 1)]};
    }

private:
    std::vector<std::size_t> first_use_; // of each chunk, the first particle that no chunk before it reads
};

} // namespace lacuna
