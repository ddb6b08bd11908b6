// SPDX-License-Identifier: BSD-3-Clause
//
// Limits of one core of this machine: bandwidth of a = b + s c for sizes that fit each cache in turn, and arithmetic of
// independent chains in registers, with and without fused multiply-add. Takes the best of several rounds, because a
// limit is no median.
//   bench_machine: prints one line of JSON

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "machine.hpp"

namespace {

using clock_type = std::chrono::steady_clock;

double since(clock_type::time_point start) {
    return std::chrono::duration<double>(clock_type::now() - start).count();
}

/// Bytes per second, counting two reads and one write. \param bytes total size of the three arrays
double triad(std::size_t bytes) {
    std::size_t const n = bytes / 24, repeats = std::max<std::size_t>(1, (std::size_t(1) << 28) / bytes);
    std::vector<double> a(n, 1.0), b(n, 2.0), c(n, 3.0);
    double best = 0;
    for (int round = 0; round < 8; ++round) {
        auto const start = clock_type::now();
        for (std::size_t r = 0; r < repeats; ++r) {
            double const s = 1e-3 * double(r);
            double *__restrict to = a.data(), *__restrict x = b.data(), *__restrict y = c.data();
#pragma omp simd
            for (std::size_t k = 0; k < n; ++k) to[k] = x[k] + s * y[k];
            // Hide from the compiler that all rounds but the last are overwritten.
            std::swap(a, b);
        }
        best = std::max(best, 24.0 * double(n) * double(repeats) / since(start));
    }
    return best;
}

/// Operations per second. A multiplication and an addition count as two, fused or not.
template <bool Fused>
double arithmetic(double seed) {
    constexpr int chains = 96;
    constexpr long steps = 2000000;
    double best = 0;
    for (int round = 0; round < 5; ++round) {
        double value[chains];
        for (int k = 0; k < chains; ++k) value[k] = seed + k;
        auto const start = clock_type::now();
        for (long s = 0; s < steps; ++s)
#pragma omp simd
            for (int k = 0; k < chains; ++k)
                value[k] = Fused ? std::fma(value[k], 0.999999, 1e-6) : value[k] * 0.999999 + 1e-6;
        double const seconds = since(start);
        double sum = 0;
        for (double const v : value) sum += v;
        // Always true, but the compiler cannot remove the chains.
        if (sum > 0) best = std::max(best, 2.0 * chains * double(steps) / seconds);
    }
    return best;
}

} // namespace

int main(int count, char**) {
    double const seed = count;
    std::printf("{\"cpu\": \"%s\", \"compiler\": \"%s\", \"flags\": \"%s\"", bench::cpu_name().c_str(),
                LACUNA_BENCH_COMPILER, LACUNA_BENCH_FLAGS);
    for (double const mb : {0.02, 0.5, 8.0, 256.0})
        std::printf(", \"triad_%gMB_GB/s\": %.1f", mb, triad(std::size_t(mb * 1e6)) / 1e9);
    std::printf(", \"fused_Gflop/s\": %.1f, \"unfused_Gflop/s\": %.1f}\n", arithmetic<true>(seed) / 1e9,
                arithmetic<false>(seed) / 1e9);
    return 0;
}
