// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/report/study_figures.hpp"

#include <algorithm>
#include <cmath>

#include <lacuna/core/text.hpp>

#include "cartilage/report/html.hpp"

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

void draw_legend(lacuna::canvas& page, double left, std::vector<lacuna::legend_entry> const& entries) {
    lacuna::draw_legend_row(page, {left, 20}, figure_width - left, entries, 0.9 * figure_style.text_size,
                            figure_style.ink);
}

std::string html_figure(std::string const& directory, figure const& f, std::string const& alt) {
    std::string const path = directory + "/" + f.stem;
    return "<figure><h3>" + html_text(f.title) + "</h3>\n" +
           (f.as_png ? html_picture(path + ".png", "image/png", alt)
                     : html_picture(path + ".svg", "image/svg+xml", alt)) +
           "\n<figcaption>" + html_text(f.caption) + "</figcaption></figure>\n";
}

} // namespace cartilage
