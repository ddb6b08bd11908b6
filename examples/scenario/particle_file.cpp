// SPDX-License-Identifier: BSD-3-Clause
#include "particle_file.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "toml_table.hpp"

namespace lacuna_run {

namespace {

std::string trimmed(std::string_view text) {
    auto const first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) return "";
    return std::string(text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1));
}

std::vector<std::string> cells(std::string const& line) {
    std::vector<std::string> found;
    for (std::size_t from = 0;;) {
        auto const comma = line.find(',', from);
        found.push_back(trimmed(std::string_view(line).substr(from, comma == std::string::npos ? comma : comma - from)));
        if (comma == std::string::npos) return found;
        from = comma + 1;
    }
}

} // namespace

void read_particle_file(std::string const& path, std::string const& key, int dimension,
                        std::vector<material> const& materials, particles& to) {
    std::ifstream file(path);
    std::error_code ignored;
    if (!file || std::filesystem::is_directory(path, ignored)) refuse(key, "\"" + path + "\"", "a file that can be read");

    std::vector<std::string> known{"radius", "material"};
    auto const add = [&](std::string const& name, int count) {
        for (int axis = 0; axis < count; ++axis) known.push_back(name + "." + "xyz"[axis]);
    };
    add("position", dimension);
    std::size_t const required = known.size();
    add("velocity", dimension);
    if (dimension == 2)
        known.emplace_back("spin");
    else
        add("spin", 3);

    std::string line;
    std::getline(file, line);
    auto const heading = cells(line);
    std::vector<int> column(known.size(), -1);
    for (std::size_t c = 0; c < heading.size(); ++c) {
        std::size_t k = 0;
        while (k < known.size() && known[k] != heading[c]) ++k;
        std::string const name = key + ":1";
        if (k == known.size()) {
            std::string const near = nearest_word(heading[c], known);
            refuse(name, "\"" + heading[c] + "\"", "a known column" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"));
        }
        if (column[k] >= 0) refuse(name, "\"" + heading[c] + "\"", "a column that is not there yet");
        column[k] = int(c);
    }
    for (std::size_t k = 0; k < required; ++k)
        if (column[k] < 0) refuse(key + ":1: " + known[k], "(missing)", "given");

    for (std::size_t number = 2; std::getline(file, line); ++number) {
        if (trimmed(line).empty()) continue;
        auto const row = cells(line);
        std::string const where = key + ":" + std::to_string(number);
        if (row.size() != heading.size())
            refuse(where, std::to_string(row.size()) + " cells", "as many as the heading has, " + std::to_string(heading.size()));
        auto const cell = [&](std::string const& name) -> std::string const* {
            for (std::size_t k = 0; k < known.size(); ++k)
                if (known[k] == name) return column[k] < 0 ? nullptr : &row[std::size_t(column[k])];
            return nullptr;
        };
        auto const read = [&](std::string const& name) {
            std::string const* const text = cell(name);
            if (!text) return 0.0;
            char* end = nullptr;
            double const x = std::strtod(text->c_str(), &end);
            if (text->empty() || *end != '\0') refuse(where + ": " + name, "\"" + *text + "\"", "a number");
            if (!std::isfinite(x)) refuse(where + ": " + name, *text, "finite");
            return x;
        };
        point position{}, velocity{}, spin{};
        for (int axis = 0; axis < dimension; ++axis) {
            std::string const suffix = std::string(".") + "xyz"[axis];
            position[std::size_t(axis)] = read("position" + suffix);
            velocity[std::size_t(axis)] = read("velocity" + suffix);
            if (dimension == 3) spin[std::size_t(axis)] = read("spin" + suffix);
        }
        if (dimension == 2) spin[0] = read("spin");
        double const radius = read("radius");
        if (!(radius > 0)) refuse(where + ": radius", lacuna::to_text(radius), "> 0");
        std::string const& name = *cell("material");
        std::size_t m = 0;
        while (m < materials.size() && materials[m].name != name) ++m;
        if (m == materials.size()) refuse(where + ": material", "\"" + name + "\"", "the name of a material");
        to.position.push_back(position);
        to.velocity.push_back(velocity);
        to.spin.push_back(spin);
        to.radius.push_back(radius);
        to.material.push_back(int(m));
    }
    if (to.position.empty()) refuse(key, "\"" + path + "\"", "a file with at least one particle");
}

} // namespace lacuna_run
