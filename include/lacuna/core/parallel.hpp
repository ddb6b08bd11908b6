// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace lacuna {

/// Calls body(c) for c in [0, count), on up to `threads` threads when the program is built with OpenMP. The chunks must
/// not depend on each other; any thread may run any chunk.
template <class Body>
void for_each_chunk(int count, [[maybe_unused]] int threads, Body const& body) {
#ifdef _OPENMP
    if (threads > 1 && count > 1) {
#pragma omp parallel for schedule(static) num_threads(threads)
        for (int c = 0; c < count; ++c) body(c);
        return;
    }
#endif
    for (int c = 0; c < count; ++c) body(c);
}

} // namespace lacuna
