// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/interactions/storage/prefetcher.hpp>

#include "catch.hpp"

namespace {

/// Stands in for a pair table: it has the second particles of each chunk's pairs.
struct seconds {
    std::vector<std::vector<std::int32_t>> of_chunk;

    int chunks() const { return int(of_chunk.size()); }
    std::size_t first_slot(int chunk) const {
        std::size_t slot = 0;
        for (int c = 0; c < chunk; ++c) slot += of_chunk[std::size_t(c)].size();
        return slot;
    }
    std::int32_t j(std::size_t slot) const {
        for (auto const& list : of_chunk) {
            if (slot < list.size()) return list[slot];
            slot -= list.size();
        }
        return -1;
    }
    bool is_padding(std::size_t slot, std::size_t particles) const { return std::size_t(j(slot)) >= particles; }
};

} // namespace

TEST_CASE("prefetcher knows which particles a chunk is the first to read", "[interactions][prefetcher]") {
    std::size_t const many = 9000;
    // 9001 is a padding particle.
    seconds const bonds{{{3, 200}, {150, 9001}, {}, {700, 690}}};
    seconds const contacts{{{130}, {260, 90, 9001}, {10}, {8999}}};
    lacuna::prefetcher ahead;
    ahead.build(many, 4, bonds, contacts);
    REQUIRE(ahead.pays());
    // By hand: up to the largest second particle of the chunks so far, 200, 260, 260, 8999.
    std::size_t const expected[][2] = {{0, 201}, {201, 261}, {261, 261}, {261, 9000}, {9000, 9000}, {9000, 9000}};
    for (int c = 0; c < 6; ++c) {
        CAPTURE(c);
        auto const first_read = ahead.newly_read(c);
        CHECK(first_read[0] == expected[c][0]);
        CHECK(first_read[1] == expected[c][1]);
    }
}

TEST_CASE("prefetcher does nothing for few particles", "[interactions][prefetcher]") {
    lacuna::prefetcher ahead;
    ahead.build(1000, 1, seconds{{{1, 2, 999}}});
    CHECK_FALSE(ahead.pays());
}

TEST_CASE("prefetcher requests every line of a stream within a chunk's packs", "[interactions][prefetcher]") {
    // 1000 bytes are 16 lines: 4 packs take 4 each, 5 packs 4 (3.2), 100 packs 1, no pack none.
    char const data = 0;
    CHECK(lacuna::prefetcher::stream(&data, 1000, 4).lines_per_pack == 4);
    CHECK(lacuna::prefetcher::stream(&data, 1000, 5).lines_per_pack == 4);
    CHECK(lacuna::prefetcher::stream(&data, 1000, 100).lines_per_pack == 1);
    CHECK(lacuna::prefetcher::stream(&data, 0, 100).lines_per_pack == 0);
    CHECK(lacuna::prefetcher::stream(&data, 1000, 0).lines_per_pack == 0);
}
