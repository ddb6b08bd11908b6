// SPDX-License-Identifier: BSD-3-Clause
#include "output.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include <lacuna/core/error.hpp>
#include <lacuna/core/whole_file.hpp>

namespace uniaxial {

namespace {

/// Relative error; for a reference of zero the value itself.
double error_of(figure const& f) { return std::fabs(*f.reference != 0 ? f.value / *f.reference - 1 : f.value); }

} // namespace

std::string to_json(outcome const& o) {
    nlohmann::ordered_json all;
    auto const& q = o.asked;
    all["specimen"] = q.specimen == specimen_kind::lattice ? "lattice" : "random";
    all["particles"] = o.particles;
    all["bonds"] = o.bonds;
    all["ended"] = o.ended;
    if (q.equilibrium) {
        all["load_steps"] = o.load_steps;
        all["factorisations"] = o.factorisations;
    } else {
        all["steps"] = o.steps;
        all["time_step"] = o.time_step;
    }
    all["settings"] = {{"width", q.width}, {"height", q.height}, {"radius", q.radius}, {"thickness", q.thickness},
                       {"seed", q.seed}, {"bond_modulus", q.bond_modulus}, {"shear_ratio", q.shear_ratio},
                       {"tensile_strength", q.tensile_strength}, {"cohesion", q.cohesion},
                       {"internal_friction", q.internal_friction}, {"friction", q.friction},
                       // null: no scatter; JSON has no infinity
                       {"weibull_modulus", q.weibull_modulus}, {"elastic", q.elastic}, {"strain", q.strain},
                       {"equilibrium", q.equilibrium}};
    if (q.equilibrium)
        all["settings"]["load_steps"] = q.load_steps;
    else
        all["settings"]["steps"] = q.steps;
    all["figures"] = nlohmann::ordered_json::array();
    for (auto const& f : o.figures()) {
        nlohmann::ordered_json row{{"quantity", f.quantity}, {"unit", f.unit}, {"value", f.value}};
        if (f.reference) {
            row["reference"] = *f.reference;
            row["relative_error"] = error_of(f);
        }
        all["figures"].push_back(row);
    }
    return all.dump(2) + "\n";
}

void print(std::FILE* out, outcome const& o) {
    std::fprintf(out, "%zu particles, %zu bonds, ", o.particles, o.bonds);
    if (o.asked.equilibrium)
        std::fprintf(out, "%lld load steps, %d factorisations, ended by: %s\n", o.load_steps, o.factorisations,
                     o.ended.c_str());
    else
        std::fprintf(out, "%lld steps of %.3g s\n", o.steps, o.time_step);
    for (auto const& f : o.figures()) {
        std::fprintf(out, "  %-32s %14.6g %-3s", f.quantity.c_str(), f.value, f.unit.c_str());
        if (f.reference) std::fprintf(out, " closed form %.6g, error %.2g", *f.reference, error_of(f));
        std::fputc('\n', out);
    }
}

void write_files(lacuna::run_directory const& directory, outcome const& o) {
    save_picture(directory.file("uniaxial"), o);
    // Last, because its presence means that the run has ended.
    lacuna::whole_file json(directory.file("uniaxial.json"));
    json.write(to_json(o));
    json.commit();
}

} // namespace uniaxial
