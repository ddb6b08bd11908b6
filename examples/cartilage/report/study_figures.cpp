// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/report/study_figures.hpp"

#include <algorithm>
#include <cmath>

#include <lacuna/core/text.hpp>

namespace cartilage {

std::string zone_title(lacuna::cartilage_zone zone) {
    if (zone == lacuna::cartilage_zone::whole) return "Whole specimen";
    std::string name(lacuna::to_string(zone));
    name[0] = char(name[0] - 'a' + 'A');
    return name + " zone";
}

std::string number_text(char const* format, double value) { return lacuna::formatted(format, value); }

lacuna::plot_axis load_axis(double lowest, double highest) {
    lowest *= 0.93;
    highest *= 1.07;
    return {lowest, highest, "load (MPa)", lacuna::axis_scale::logarithmic, 8};
}

std::string count_text(std::size_t count, char const* noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

} // namespace cartilage
