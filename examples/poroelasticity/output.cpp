// SPDX-License-Identifier: BSD-3-Clause
#include "output.hpp"

#include <cmath>

#include <lacuna/core/error.hpp>
#include <lacuna/core/whole_file.hpp>

#include "picture.hpp"

namespace poroelasticity {

namespace {

std::string number(double v) { return std::isfinite(v) ? lacuna::to_text(v) : "null"; }

std::string csv_of(outcome const& o) {
    std::string text = "curve,x,value,reference\n";
    for (auto const& curve : o.curves)
        for (auto const& p : curve.points)
            text += curve.name + "," + number(p.x) + "," + number(p.value) + "," + number(p.reference) + "\n";
    return text;
}

} // namespace

std::string to_json(outcome const& o) {
    std::string text = "{\n  \"case\": \"" + o.name + "\",\n";
    if (o.stopped) text += "  \"ended\": \"stopped by " + lacuna::signal_name(lacuna::stop_signal()) + "\",\n";
    text += "  \"particles\": " + std::to_string(o.particles) +
                       ",\n  \"pores\": " + std::to_string(o.pores) + ",\n  \"steps\": " + std::to_string(o.steps) +
                       ",\n  \"rows\": [";
    char const* separator = "\n";
    for (auto const& row : o.rows) {
        text += separator + ("    {\"quantity\": \"" + row.quantity) + "\", \"value\": " + number(row.value) +
                ", \"reference\": " + number(row.reference) + ", \"relative_error\": " + number(row.error()) + "}";
        separator = ",\n";
    }
    return text + "\n  ]\n}\n";
}

void print_rows(std::FILE* out, outcome const& o) {
    std::fprintf(out, "%s\n%zu particles, %zu pores, %lld steps\n", o.title.c_str(), o.particles, o.pores, o.steps);
    std::fprintf(out, "  %-32s %14s %14s %10s\n", "quantity", "value", "reference", "error");
    for (auto const& row : o.rows)
        std::fprintf(out, "  %-32s %14.8g %14.8g %10.2g\n", row.quantity.c_str(), row.value, row.reference,
                     row.error());
}

std::vector<std::string> result_names(std::string const& name) {
    return {name + ".csv", name + ".png", name + "-stopped.json"};
}

void write_files(lacuna::run_directory& directory, outcome const& o) {
    directory.keep();
    lacuna::whole_file csv(directory.file(o.name + ".csv"));
    csv.write(csv_of(o));
    if (o.stopped) {
        lacuna::whole_file mark(directory.file(o.name + "-stopped.json"));
        mark.write(to_json(o));
        mark.commit();
    } else {
        save_picture(directory.file(o.name + ".png"), o);
    }
    csv.commit();
}

} // namespace poroelasticity
