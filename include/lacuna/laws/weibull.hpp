// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/bond_values.hpp>

namespace lacuna {

/// Strengths of single bonds, scattered by Weibull's distribution (1951, J. Appl. Mech. 18, 293). A bond's strength is
/// x times that of its materials. The share of bonds with a factor below x is
///
///   P(x) = 1 - exp(-(x Gamma(1 + 1/m))^m)
///
/// The mean of x is 1, its standard deviation is sqrt(Gamma(1 + 2/m) / Gamma(1 + 1/m)^2 - 1).
///
/// A bond's factor depends on the ids of its two particles and on the seed alone. It does not depend on other bonds, on
/// the order of bonds or of the two particles, or on threads. Limits: the tensile and the shear strength of a bond have
/// the same factor. There is no size effect (the distribution is the same for bonds of any area).
struct weibull_strengths {
    double modulus = 10;    ///< m, 1: a smaller modulus scatters more; at least 0.1
    std::uint64_t seed = 0; ///< each seed gives other strengths

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name) const {
        require_positive(name + ".modulus", modulus);
        if (!(modulus >= 0.1)) refuse(name + ".modulus", modulus, "at least 0.1");
    }

    /// The factor x of the bond between the particles with the ids a and b.
    double factor(std::int32_t a, std::int32_t b) const {
        return std::pow(-std::log1p(-uniform(a, b)), 1 / modulus) / std::tgamma(1 + 1 / modulus);
    }

    /// Returns the values for simulation_parameters::bonds.
    /// \param bonds as in packing::bonds
    /// \throws std::invalid_argument as validate()
    std::vector<bond_values> draw(std::span<std::array<std::int32_t, 2> const> bonds) const {
        validate("weibull_strengths");
        std::vector<bond_values> values(bonds.size());
        for (std::size_t b = 0; b < bonds.size(); ++b) values[b].strength_factor = factor(bonds[b][0], bonds[b][1]);
        return values;
    }

private:
    /// A uniform number in (0, 1): the finalizer of SplitMix64 (Steele, Lea and Flood 2014), applied once to the seed
    /// and once to the ids.
    double uniform(std::int32_t a, std::int32_t b) const noexcept {
        auto const mixed = [](std::uint64_t z) {
            z += 0x9e3779b97f4a7c15;
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
            z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
            return z ^ (z >> 31);
        };
        auto const low = std::uint64_t(std::uint32_t(std::min(a, b))),
                   high = std::uint64_t(std::uint32_t(std::max(a, b)));
        return (double(mixed(mixed(seed) ^ (high << 32 | low)) >> 11) + 0.5) * 0x1p-53;
    }
};

} // namespace lacuna
