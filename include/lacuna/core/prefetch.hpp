// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/core/standard.hpp>

/// \file
/// Prefetches the data that a loop will read later. Nothing here changes a result, and an invalid address is harmless.

namespace lacuna {

/// With fewer particles than this, all data of a step stay in the cache, and prefetching would only cost time.
inline constexpr std::size_t few_particles = 8192;
/// Size of a cache line, bytes.
inline constexpr std::size_t cache_line = 64;

/// Prefetches `bytes` bytes that begin at `at`.
inline void prefetch(void const* at, std::size_t bytes) noexcept {
    for (std::size_t b = 0; b < bytes; b += cache_line) __builtin_prefetch(static_cast<char const*>(at) + b);
}

/// Prefetches the cache lines of base[stride * offset[k]] for k in [0, W).
template <int W, class T, class Offset>
void prefetch_records(T const* base, Offset const* offset, std::size_t stride = 1) noexcept {
    for (int k = 0; k < W; ++k) __builtin_prefetch(base + stride * std::size_t(offset[k]));
}

} // namespace lacuna
