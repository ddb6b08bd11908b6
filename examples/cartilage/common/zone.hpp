// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// The zones of cartilage (Hong, Evans and Mente, Fig. 8 and 9).
enum class cartilage_zone { surface, middle, deep, whole };

constexpr std::string_view to_string(cartilage_zone zone) noexcept {
    switch (zone) {
    case cartilage_zone::surface: return "surface";
    case cartilage_zone::middle: return "middle";
    case cartilage_zone::deep: return "deep";
    default: return "whole";
    }
}

/// The zone of that name. \throws std::invalid_argument if there is none
inline cartilage_zone parse_cartilage_zone(std::string_view name) {
    for (auto zone : {cartilage_zone::surface, cartilage_zone::middle, cartilage_zone::deep, cartilage_zone::whole})
        if (name == to_string(zone)) return zone;
    refuse("zone", name, "surface, middle, deep or whole");
}

} // namespace lacuna

namespace cartilage {

inline constexpr std::array<lacuna::cartilage_zone, 4> all_zones{
    lacuna::cartilage_zone::surface, lacuna::cartilage_zone::middle, lacuna::cartilage_zone::deep,
    lacuna::cartilage_zone::whole};

} // namespace cartilage
