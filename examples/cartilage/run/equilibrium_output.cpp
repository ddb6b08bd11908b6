// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/equilibrium_output.hpp"

#include <algorithm>
#include <optional>

#include <lacuna/core/text.hpp>
#include <lacuna/draw/plot.hpp>

#include "cartilage/common/choices_json.hpp"
#include "cartilage/common/json_writer.hpp"

namespace cartilage {

namespace {

void add(json_writer& json, char const* key, std::optional<double> const& value) {
    if (value)
        json.value(key, *value);
    else
        json.null(key);
}

std::string load_text(std::optional<double> const& load_MPa) {
    return load_MPa ? lacuna::formatted("%.4g MPa", *load_MPa) : "none";
}

/// Layers that are cut, in the order of the loads.
std::vector<equilibrium_layer const*> sequence_of(equilibrium_run const& found) {
    std::vector<equilibrium_layer const*> order;
    for (equilibrium_layer const& layer : found.layers)
        if (layer.cut_MPa) order.push_back(&layer);
    std::stable_sort(order.begin(), order.end(),
                     [](auto const* a, auto const* b) { return *a->cut_MPa < *b->cut_MPa; });
    return order;
}

/// "no equilibrium at any load", "none above 61.2 MPa".
std::string ending_text(equilibrium_request const& r, equilibrium_run const& found) {
    if (!found.held) return "mechanism: no equilibrium at any load";
    if (found.ended == "mechanism") return "no equilibrium above " + load_text(found.load_MPa);
    if (found.ended == "complete") return "complete damage";
    if (found.ended == "limit") return "equilibrium at the highest load, " + load_text(r.model.load_MPa);
    return found.ended + " at " + load_text(found.load_MPa);
}

void add_request(json_writer& json, equilibrium_request const& r) {
    json.value("zone", lacuna::to_string(r.model.zone));
    json.value("preset", r.model.preset);
    add_choices(json, r.model.choices);
    json.value("seed", r.model.seed);
    json.value("length_um", r.model.length_um);
    json.value("height_um", r.model.height_um);
    json.value("highest_load_MPa", r.model.load_MPa);
    json.value("steps", r.steps);
    json.value("failures", r.failures == lacuna::failure_choice::first ? "first" : "worst_of_fibres");
    json.value("iterations", r.iterations);
    json.value("dry", r.model.dry);
    json.value("drained", r.drained);
}

void add_result(json_writer& json, equilibrium_run const& found) {
    json.value("result", found.result());
    json.value("ended", found.ended);
    json.value("load_MPa", found.load_MPa);
    add(json, "first_crack_MPa", found.first_crack_MPa);
    add(json, "capacity_MPa", found.capacity_MPa);
    add(json, "capacity_half_MPa", found.capacity_half_MPa);
    add(json, "complete_MPa", found.complete_MPa);
    add(json, "equilibrium_ends_MPa", found.ends_MPa());
    json.open('[', "layers");
    for (equilibrium_layer const& layer : found.layers) {
        json.open('{');
        json.value("zone", layer.zone).value("layer", layer.layer).value("fibres", layer.fibres);
        json.value("bonds", layer.bonds).value("broken", layer.broken);
        add(json, "cut_MPa", layer.cut_MPa);
        json.close('}');
    }
    json.close(']');
    json.value("broken", found.cracks.size());
    json.value("fibres_cut", found.fibres_cut);
    json.value("unbalanced_share", found.unbalanced);
    json.value("factorisations", found.factorisations);
    json.open('[', "trials");
    if (found.ended == "mechanism")
        for (auto const& t : found.trials)
            json.open('{').value("regularisation", t.regularisation).value("displacement_m", t.displacement).close('}');
    json.close(']');
    json.value("seconds", found.seconds);
}

void print_row(std::FILE* out, char const* name, std::string const& text) {
    std::fprintf(out, "  %-22s %s\n", name, text.c_str());
}

} // namespace

std::vector<std::string> equilibrium_results() { return {"layers.png", "layers.svg"}; }

std::string equilibrium_json(equilibrium_request const& r, equilibrium_run const& found, bool request) {
    json_writer json;
    json.open('{');
    if (request) {
        add_request(json, r);
    } else {
        json.value("zone", lacuna::to_string(r.model.zone));
        json.value("seed", r.model.seed);
    }
    add_result(json, found);
    json.close('}');
    return json.text();
}

std::string equilibrium_cracks(equilibrium_run const& found) {
    std::string text = "load_MPa,bond,first,second,fibre,mode,x_m,y_m,normal_force_N,shear_force_N,energy_J\n";
    for (std::size_t k = 0; k < found.cracks.size(); ++k) {
        crack_record const& c = found.cracks[k];
        text += lacuna::to_text(found.crack_MPa[k]);
        for (int number : {c.bond, c.first, c.second, c.fibre}) text.append(1, ',').append(std::to_string(number));
        text += c.shear ? ",shear" : ",tension";
        for (double v : {c.position[0], c.position[1], c.normal_force, c.shear_force, c.energy})
            text.append(1, ',').append(lacuna::to_text(v));
        text += "\n";
    }
    return text;
}

void print_equilibrium(std::FILE* out, equilibrium_request const& r, specimen const& s,
                       equilibrium_run const& found) {
    std::fprintf(out, "%s zone, seed %llu%s: %s\n", std::string(lacuna::to_string(r.model.zone)).c_str(),
                 static_cast<unsigned long long>(r.model.seed), r.model.dry ? ", dry" : (r.drained ? ", drained" : ""),
                 found.result());
    print_row(out, "ended", ending_text(r, found));
    if (found.ended == "mechanism" && found.trials.size() > 1) {
        auto const& first = found.trials.front();
        auto const& furthest =
            *std::max_element(found.trials.begin(), found.trials.end(),
                              [](auto const& a, auto const& b) { return a.displacement < b.displacement; });
        print_row(out, "displacement",
                  lacuna::formatted("%.2g m", first.displacement) +
                      lacuna::formatted(" at a regularisation of %.2g, ", first.regularisation) +
                      lacuna::formatted("%.2g m", furthest.displacement) +
                      lacuna::formatted(" at %.2g", furthest.regularisation));
    }
    print_row(out, "first crack", load_text(found.first_crack_MPa));
    std::string layers;
    for (equilibrium_layer const* layer : sequence_of(found))
        layers += (layers.empty() ? "" : ", ") + layer->zone + " " + std::to_string(layer->layer) +
                  lacuna::formatted(" at %.4g", *layer->cut_MPa);
    if (found.held) print_row(out, "layers cut", layers.empty() ? "none" : layers + " MPa");
    print_row(out, "capacity", load_text(found.capacity_MPa) + "; half of the first layer: " +
                                   load_text(found.capacity_half_MPa));
    print_row(out, "complete damage", load_text(found.complete_MPa));
    print_row(out, "broken bonds", std::to_string(found.cracks.size()));
    print_row(out, "fibres cut", std::to_string(found.fibres_cut) + " of " + std::to_string(s.fibres.size()));
    print_row(out, "wall time", lacuna::formatted("%.1f s, ", found.seconds) + std::to_string(found.factorisations) +
                                    " factorisations");
}

void draw_layers(std::string const& stem, equilibrium_request const& r, specimen const& s,
                 equilibrium_run const& found) {
    using lacuna::legend_mark;
    using lacuna::plot_mark;
    constexpr lacuna::color tension{0.80, 0.15, 0.12}, shear{0.50, 0.20, 0.65}, complete{0.10, 0.35, 0.75};
    lacuna::plot_style const style{17};
    lacuna::rectangle const frame{76, 64, 540, 360};
    lacuna::plot::points marks[2];
    double highest = found.ended == "limit" ? r.model.load_MPa : found.load_MPa;
    for (std::size_t k = 0; k < found.cracks.size(); ++k) {
        marks[found.cracks[k].shear].push_back({found.crack_MPa[k], 1e6 * found.cracks[k].position[1]});
        highest = std::max(highest, found.crack_MPa[k]);
    }
    lacuna::save_canvas_png_svg(stem, 560, 420, [&](lacuna::canvas& page) {
        page.clear({1, 1, 1});
        lacuna::plot plane(page, frame, {0, 1.05 * highest, "load (MPa)"}, {0, 1e6 * s.height, "height (µm)"}, style);
        plane.draw_axes();
        plane.markers(marks[0], plot_mark::disc, tension, 3.5);
        plane.markers(marks[1], plot_mark::ring, shear, 3.5);
        if (found.complete_MPa) plane.rule_x(*found.complete_MPa, complete, 1.6);
        lacuna::draw_legend_row(page, {frame.left, 20}, frame.width(),
                                 {{legend_mark::disc, tension, "tension"},
                                  {legend_mark::ring, shear, "shear"},
                                  {legend_mark::dashes, complete, "complete damage"}},
                                 0.9 * style.text_size, style.ink);
    });
}

} // namespace cartilage
