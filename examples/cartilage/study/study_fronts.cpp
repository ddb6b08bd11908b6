// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/study_fronts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cartilage/specimen/collagen_strength.hpp"
#include "cartilage/specimen/specimen_types.hpp"

namespace cartilage {

namespace {

using profile_values = std::vector<double> front_profile::*;

series arrivals(std::vector<front_profile> const& profiles, profile_values what) {
    double largest = 0;
    for (front_profile const& p : profiles)
        for (double const v : p.*what) largest = std::max(largest, std::fabs(v));
    series found;
    if (!(largest > 0)) return found;
    for (std::size_t layer = 0; layer < profiles.front().depth.size(); ++layer)
        for (front_profile const& p : profiles)
            if (layer < (p.*what).size() && std::fabs((p.*what)[layer]) >= front_arrivals::share * largest) {
                found.push_back({1e9 * p.time, 1e6 * p.depth[layer]});
                break;
            }
    return found;
}

/// Slope of depth over time by least squares, m/s; none if depth and time do not correlate.
std::optional<double> speed_of(series const& front) {
    if (front.size() < 3) return std::nullopt;
    double t = 0, d = 0;
    for (auto const& p : front) {
        t += p[0] / double(front.size());
        d += p[1] / double(front.size());
    }
    double tt = 0, td = 0, dd = 0;
    for (auto const& p : front) {
        tt += (p[0] - t) * (p[0] - t);
        td += (p[0] - t) * (p[1] - d);
        dd += (p[1] - d) * (p[1] - d);
    }
    double const least_correlation = 0.9;
    if (!(td > least_correlation * std::sqrt(tt * dd))) return std::nullopt;
    // 1 µm/ns is 1000 m/s.
    return 1e3 * td / tt;
}

/// Strength of the fibres at a depth, Pa. In the whole specimen each zone is taken as a third of the height.
double strength_at(lacuna::cartilage_zone zone, double depth_share) {
    using lacuna::cartilage_zone;
    if (zone == cartilage_zone::whole)
        zone = depth_share < 1.0 / 3 ? cartilage_zone::surface
                                     : (depth_share < 2.0 / 3 ? cartilage_zone::middle : cartilage_zone::deep);
    switch (zone) {
    case cartilage_zone::surface: return collagen_strength[lacuna::surface_collagen];
    case cartilage_zone::middle: return collagen_strength[lacuna::middle_collagen];
    default: return collagen_strength[lacuna::deep_collagen];
    }
}

} // namespace

front_arrivals arrivals_of(snapshot const& s) {
    front_arrivals found;
    if (s.fronts.empty()) return found;
    found.stress = arrivals(s.fronts, &front_profile::stress);
    found.pressure = arrivals(s.fronts, &front_profile::pore_pressure);
    found.stress_speed = speed_of(found.stress);
    found.pressure_speed = speed_of(found.pressure);
    return found;
}

std::optional<first_break> first_break_of(snapshot const& s, double height_um) {
    if (s.run.cracks.empty() || s.fronts.empty()) return std::nullopt;
    load_run::crack const& crack = s.run.cracks.front();
    auto const nearest = std::min_element(s.fronts.begin(), s.fronts.end(), [&](auto const& a, auto const& b) {
        return std::fabs(a.time - crack.time) < std::fabs(b.time - crack.time);
    });
    if (nearest->pore_pressure.empty()) return std::nullopt;
    first_break b;
    b.time = crack.time;
    b.depth = 1e-6 * height_um - crack.y;
    auto const layer = std::min_element(nearest->depth.begin(), nearest->depth.end(), [&](double a, double c) {
        return std::fabs(a - b.depth) < std::fabs(c - b.depth);
    });
    auto const index = std::size_t(layer - nearest->depth.begin());
    b.pressure = std::fabs(nearest->pore_pressure.at(index));
    b.stress = std::fabs(nearest->stress.at(index));
    b.strength = strength_at(s.zone, 1e6 * b.depth / height_um);
    return b;
}

} // namespace cartilage
