// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/core/standard.hpp>

/// \file
/// Asking the memory for what a loop will read, while it computes. Nothing here changes a result, and addresses that
/// are nobody's do no harm.

namespace lacuna {

/// With fewer particles than this all that a step reads stays in the cache, and to ask for it ahead would only take time.
inline constexpr std::size_t few_particles = 8192;
/// Bytes that come from memory together.
inline constexpr std::size_t cache_line = 64;

/// Asks for `bytes` from `at` on.
inline void prefetch(void const* at, std::size_t bytes) noexcept {
    for (std::size_t b = 0; b < bytes; b += cache_line) __builtin_prefetch(static_cast<char const*>(at) + b);
}

/// Asks for what begins at base[stride * offset[0..W)].
template <int W, class T, class Offset>
void prefetch_records(T const* base, Offset const* offset, std::size_t stride = 1) noexcept {
    for (int k = 0; k < W; ++k) __builtin_prefetch(base + stride * std::size_t(offset[k]));
}

} // namespace lacuna
