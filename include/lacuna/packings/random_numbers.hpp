// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Random numbers of the packing generators. The same seed gives the same numbers with every compiler and standard
/// library; the distributions of `<random>` do not guarantee that.
class random_source {
public:
    explicit random_source(std::uint64_t seed) : engine_(seed) {}

    /// Uniform in [0, 1), a multiple of 2^-53.
    double uniform() { return double(engine_() >> 11) * 0x1p-53; }
    /// Uniform in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

private:
    std::mt19937_64 engine_;
};

} // namespace lacuna
