// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/run_output.hpp"

#include <cmath>
#include <cstdio>

#include <lacuna/core/text.hpp>
#include <lacuna/observe/progress.hpp>

#include "cartilage/common/choices_json.hpp"
#include "cartilage/common/json_writer.hpp"
#include "cartilage/common/write_whole.hpp"

namespace cartilage {

namespace {

void add_request(json_writer& json, options const& o) {
    json.value("zone", lacuna::to_string(o.zone));
    json.value("preset", o.preset);
    add_choices(json, o.choices);
    json.value("seed", o.seed);
    json.value("length_um", o.length_um);
    json.value("height_um", o.height_um);
}

void print_row(std::FILE* out, char const* name, std::string const& text) {
    std::fprintf(out, "  %-22s %s\n", name, text.c_str());
}

std::string number(char const* format, double v) { return lacuna::formatted(format, v); }

} // namespace

std::vector<std::string> run_results() {
    return {"summary.json", "statistics.json", "cracks.csv",   "packing.png", "packing.svg",
            "damage.png",   "damage.svg",      "damage-#.png", "damage-#.svg"};
}

void write_summary(std::string const& path, options const& o, run_result const& r) {
    json_writer json;
    json.open('{');
    add_request(json, o);
    json.value("load_MPa", o.load_MPa);
    json.value("dry", o.dry);
    json.value("threads", o.threads);
    json.value("interrupted", r.interrupted);
    json.value("ended", r.ended);
    json.value("particles", r.specimen.particles);
    json.value("bonds", r.specimen.bonds);
    json.value("fibres", r.specimen.fibres);
    json.value("steps", r.steps);
    json.value("time_step", r.time_step);
    json.value("time_step_limit", r.time_step_limit);
    json.value("end_time", r.end_time);
    json.value("wall_seconds", r.wall_seconds);
    json.value("particle_steps_per_second", r.particle_steps_per_second());
    json.value("broken_tension", r.broken(false));
    json.value("broken_shear", r.broken(true));
    json.value("broken_fraction", r.broken_fraction());
    json.value("fibres_cut", r.fibres_cut);
    if (r.cracks.empty()) {
        json.null("first_crack_time").null("first_crack_time_sqrt_load").null("first_crack_position");
    } else {
        crack_record const& first = r.cracks.front();
        json.value("first_crack_time", first.time);
        json.value("first_crack_time_sqrt_load", first.time * std::sqrt(o.load_MPa));
        json.open('[', "first_crack_position").value("", first.position[0]).value("", first.position[1]).close(']');
    }
    json.open('[', "layers");
    for (layer_result const& layer : r.layers) {
        json.open('{');
        json.value("zone", layer.zone).value("layer", layer.layer).value("fibres", layer.fibres);
        json.value("bonds", layer.bonds).value("broken", layer.broken);
        json.value("broken_fraction", layer.broken_fraction());
        json.close('}');
    }
    json.close(']');
    if (r.peak_pore_pressure)
        json.value("peak_pore_pressure", *r.peak_pore_pressure);
    else
        json.null("peak_pore_pressure");
    json.open('{', "energy");
    for (auto const& [name, joules] : r.energy) json.value(name, joules);
    json.value("residual", r.energy_residual);
    json.close('}');
    json.close('}');
    write_whole(path, json.text());
}

std::string crack_heading() {
    return "step,time_s,bond,first,second,fibre,mode,x_m,y_m,normal_force_N,shear_force_N,energy_J\n";
}

std::string crack_line(crack_record const& c) {
    std::string text = std::to_string(c.step) + "," + lacuna::to_text(c.time);
    for (int number : {c.bond, c.first, c.second, c.fibre}) text.append(1, ',').append(std::to_string(number));
    text += c.shear ? ",shear" : ",tension";
    for (double v : {c.position[0], c.position[1], c.normal_force, c.shear_force, c.energy})
        text.append(1, ',').append(lacuna::to_text(v));
    return text + "\n";
}

void write_statistics(std::string const& path, options const& o, specimen_report const& s) {
    json_writer json;
    json.open('{');
    add_request(json, o);
    json.value("particles", s.particles);
    json.value("bonded_particles", s.bonded_particles);
    json.value("fibres", s.fibres);
    json.value("bonds", s.bonds);
    json.value("fixed_particles", s.fixed);
    json.value("loaded_particles", s.loaded);
    json.value("area_fraction", s.area_fraction);
    json.value("mean_radius", s.mean_radius);
    json.value("max_overlap", s.max_overlap);
    json.value("mean_coordination", s.mean_coordination);
    json.value("loose_particles", s.loose);
    json.close('}');
    write_whole(path, json.text());
}

void print_result(std::FILE* out, options const& o, run_result const& r) {
    std::fprintf(out, "%s zone, %s MPa, seed %llu%s%s\n", std::string(lacuna::to_string(o.zone)).c_str(),
                 lacuna::to_text(o.load_MPa).c_str(), static_cast<unsigned long long>(o.seed), o.dry ? ", dry" : "",
                 r.interrupted ? ", INTERRUPTED" : "");
    print_row(out, "particles", std::to_string(r.specimen.particles) + ", " + std::to_string(r.specimen.fibres) +
                                    " fibres, " + std::to_string(r.specimen.bonds) + " bonds");
    print_row(out, "simulated", number("%.3g ns", 1e9 * r.end_time) + " in " + std::to_string(r.steps) + " steps of " +
                                    number("%.3g ps", 1e12 * r.time_step) + " (" + r.ended + ")");
    print_row(out, "wall time", number("%.1f s, ", r.wall_seconds) + lacuna::rate_text(r.particle_steps_per_second()) +
                                    " particle-steps/s");
    print_row(out, "broken bonds", std::to_string(r.cracks.size()) + number(" (%.2f %%): ", 100 * r.broken_fraction()) +
                                       std::to_string(r.broken(false)) + " tension, " + std::to_string(r.broken(true)) +
                                       " shear");
    print_row(out, "fibres cut", std::to_string(r.fibres_cut) + " of " + std::to_string(r.specimen.fibres));
    if (!r.cracks.empty()) {
        crack_record const& first = r.cracks.front();
        print_row(out, "first crack", number("%.3g ns at ", 1e9 * first.time) +
                                          number("(%.1f, ", 1e6 * first.position[0]) +
                                          number("%.1f) µm, t sqrt(P) = ", 1e6 * first.position[1]) +
                                          number("%.3g ns sqrt(MPa)", 1e9 * first.time * std::sqrt(o.load_MPa)));
    }
    if (r.peak_pore_pressure) print_row(out, "peak pore pressure", number("%.3g MPa", 1e-6 * *r.peak_pore_pressure));
    print_row(out, "energy residual", number("%.2e J", r.energy_residual));
}

void print_statistics(std::FILE* out, options const& o, specimen_report const& s) {
    std::fprintf(out, "%s zone, seed %llu\n", std::string(lacuna::to_string(o.zone)).c_str(),
                 static_cast<unsigned long long>(o.seed));
    print_row(out, "particles", std::to_string(s.particles) + ", " + std::to_string(s.bonded_particles) + " bonded");
    print_row(out, "fibres, bonds", std::to_string(s.fibres) + ", " + std::to_string(s.bonds));
    print_row(out, "fixed, loaded", std::to_string(s.fixed) + ", " + std::to_string(s.loaded));
    print_row(out, "area fraction", number("%.3f", s.area_fraction));
    print_row(out, "mean radius", number("%.3f µm", 1e6 * s.mean_radius));
    print_row(out, "largest overlap", number("%.2e of a radius", s.max_overlap));
    print_row(out, "mean coordination", number("%.2f", s.mean_coordination));
    print_row(out, "loose particles", std::to_string(s.loose));
}

} // namespace cartilage
