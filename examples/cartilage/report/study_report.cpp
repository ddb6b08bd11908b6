// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/report/study_report.hpp"

#include <filesystem>
#include <vector>

#include <lacuna/core/error.hpp>

#include "cartilage/common/write_whole.hpp"
#include "cartilage/report/study_figures.hpp"
#include "cartilage/report/study_page.hpp"
#include "cartilage/study/study_table.hpp"

namespace cartilage {

namespace {

void check(study_result const& study) {
    lacuna::require_positive("study.lowest_MPa", study.lowest_MPa);
    lacuna::require_positive("study.highest_MPa - lowest_MPa", study.highest_MPa - study.lowest_MPa);
    lacuna::require_positive("study.resolution", study.resolution);
    lacuna::require_positive("study.length_um", study.length_um);
    lacuna::require_positive("study.height_um", study.height_um);
    if (study.packings.empty()) lacuna::refuse("study.packings", "none", "at least one");
    for (packing_result const& packing : study.packings)
        for (load_run const& p : packing.runs) {
            lacuna::require_positive("study.packings.probes.load_MPa", p.load_MPa);
            lacuna::require_in("study.packings.probes.broken_fraction", p.broken_fraction, 0, 1);
        }
}

/// Removes the files of an earlier report, because it may have had further figures.
void clear_report(std::string const& directory) {
    for (std::string const& name : report_files()) std::filesystem::remove(directory + "/" + name);
}

} // namespace

std::vector<std::string> report_files() {
    std::vector<std::string> names{"report.html", "table3.csv"};
    auto const add = [&](std::string const& stem) {
        for (char const* ending : {".png", ".svg"}) names.push_back(stem + ending);
    };
    for (char const* stem : {"loads-first-crack", "loads-capacity", "loads-complete"}) add(stem);
    for (auto const zone : all_zones)
        for (char const* stem : {"damage-", "first-crack-", "cracks-", "layers-"})
            add(stem + std::string(lacuna::to_string(zone)));
    for (char const* number : {"10", "11", "12"})
        for (char const* stem : {"figure-", "fronts-"}) add(std::string(stem) + number);
    return names;
}

void write_report(std::string const& directory, study_result const& study) {
    check(study);
    auto const cells = table3(study);
    clear_report(directory);
    write_whole(directory + "/table3.csv", table3_csv(cells, study));
    std::vector<figure_section> const sections{
        {"Scatter of the loads",
         "The load of every packing on a logarithmic scale, beside the paper's single number per zone.",
         draw_threshold_figures(directory, study, cells)},
        {"Damage against load",
         "Broken bonds at the end of the runs that did not stop at a criterion, and their median.",
         draw_damage_figures(directory, study)},
        {"Time of the first crack",
         "There are two mechanisms. Elastic waves break bonds within about 2 ns if the load is large enough. Free "
         "particles that flow out break bonds later; then t √P is constant, and any load cracks after some time.",
         draw_first_crack_figures(directory, study)},
        {"Positions of the breaks",
         "All breaks of each packing's representative run: the run at its capacity, else the run with most breaks.",
         draw_crack_figures(directory, study)},
        {"Order in which layers fail",
         "Times at which each layer lost half of its bonds. Each packing gives its run with most such layers. Layer 0 "
         "is the top fibre (surface), the top fifth (middle) or the centre fibre (deep). On the right: the number of "
         "packings in which the layer lost half of its bonds, and in which it was the first layer to do so.",
         draw_layer_figures(directory, study)},
        {"Damage at the loads of the paper's Figures 10 to 12",
         "Pore pressure as dots, broken bonds as dashes, at the end of a single run.",
         draw_snapshot_figures(directory, study)},
        {"Fronts of stress and pore pressure",
         "Upper plot: time at which the layer means of stress and pore pressure first reach a tenth of their largest "
         "value, and every break. Lower plot: the largest layer mean of each, by magnitude, and the first break. The "
         "paper says that bonds break while the pore pressure is still low.",
         draw_front_figures(directory, study)}};
    // Last, because its presence means that the report is finished.
    write_whole(directory + "/report.html", study_page(directory, study, cells, sections));
}

} // namespace cartilage
