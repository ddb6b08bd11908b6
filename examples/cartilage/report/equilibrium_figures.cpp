// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/report/equilibrium_figures.hpp"

#include <optional>
#include <utility>

#include "cartilage/study/study_series.hpp"

namespace cartilage {

std::vector<std::string> equilibrium_report_files() {
    std::vector<std::string> names{"table3.csv"};
    auto const add = [&](std::string const& stem) {
        for (char const* ending : {".png", ".svg"}) names.push_back(stem + ending);
    };
    for (char const* stem : {"loads-first-crack", "loads-capacity", "loads-complete"}) add(stem);
    for (auto const zone : all_zones)
        for (char const* stem : {"cracks-", "layers-"}) add(stem + std::string(lacuna::to_string(zone)));
    return names;
}

std::vector<figure> draw_equilibrium_figures(std::string const& directory, study_result const& study,
                                             std::vector<table3_cell> const& cells,
                                             std::vector<equilibrium_packing> const& packings) {
    auto figures = draw_threshold_figures(directory, study, cells);
    for (figure& f : draw_crack_figures(directory, study)) figures.push_back(std::move(f));
    for (auto const zone : all_zones) {
        layer_order order;
        for (auto const& p : packings) {
            if (p.zone != zone) continue;
            std::vector<std::pair<std::string, std::optional<double>>> moments;
            for (auto const& layer : p.layers) moments.emplace_back(layer.name, layer.cut_MPa);
            order.add(moments);
        }
        if (order.packings > 0)
            figures.push_back(draw_layer_order(directory, zone, order, "load that cuts it (MPa)", "be cut"));
    }
    return figures;
}

} // namespace cartilage
