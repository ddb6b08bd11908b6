// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>
#include <lacuna/particles/particle_list.hpp>

/// \file
/// Particles in CSV files. The first line names the columns, in any order: position.x, position.y (position.z), radius,
/// material, and if wanted velocity.x, velocity.y (velocity.z), spin (in space spin.x, spin.y, spin.z). Empty lines are
/// passed over. SI units.

namespace lacuna {

namespace detail {

inline std::vector<std::string> csv_cells(std::string_view line) {
    std::vector<std::string> found;
    for (std::size_t from = 0;;) {
        auto const comma = line.find(',', from);
        std::string_view cell = line.substr(from, comma == std::string_view::npos ? comma : comma - from);
        auto const first = cell.find_first_not_of(" \t\r\"");
        cell = first == std::string_view::npos ? "" : cell.substr(first, cell.find_last_not_of(" \t\r\"") - first + 1);
        found.emplace_back(cell);
        if (comma == std::string_view::npos) return found;
        from = comma + 1;
    }
}

/// Names of the columns; the first 2 + Dim of them must be there.
template <int Dim>
std::vector<std::string> csv_columns() {
    std::vector<std::string> known{"radius", "material"};
    auto const add = [&](std::string const& name, int count) {
        for (int axis = 0; axis < count; ++axis) known.push_back(name + "." + "xyz"[axis]);
    };
    add("position", Dim);
    add("velocity", Dim);
    if constexpr (Dim == 2)
        known.emplace_back("spin");
    else
        add("spin", 3);
    return known;
}

} // namespace detail

/// Reads the text of a CSV file.
/// \param name of the file in messages
/// \param materials names that the column material may have; none: it has numbers from 0 on
/// \throws std::invalid_argument "name:line: column = value: must be rule"
template <int Dim>
particle_list<Dim> parse_particle_csv(std::string_view text, std::string const& name,
                                      std::vector<std::string> const& materials = {}) {
    auto const known = detail::csv_columns<Dim>();
    std::vector<std::string> heading;
    std::vector<int> column(known.size(), -1);
    particle_list<Dim> list;
    std::size_t number = 0;
    for (std::size_t from = 0; from < text.size() || number == 0;) {
        auto const end = std::min(text.find('\n', from), text.size());
        std::string_view const line = text.substr(from, end - from);
        from = end + 1;
        auto const row = detail::csv_cells(line);
        std::string const where = name + ":" + std::to_string(++number);
        if (number == 1) {
            heading = row;
            for (std::size_t c = 0; c < heading.size(); ++c) {
                std::size_t k = 0;
                while (k < known.size() && known[k] != heading[c]) ++k;
                if (k == known.size()) {
                    std::string const near = nearest_word(heading[c], known);
                    refuse(where, "\"" + heading[c] + "\"",
                           "a known column" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"));
                }
                if (column[k] >= 0) refuse(where, "\"" + heading[c] + "\"", "a column that is not there yet");
                column[k] = int(c);
            }
            for (std::size_t k = 0; k < 2 + Dim; ++k)
                if (column[k] < 0) refuse(where + ": " + known[k], "(missing)", "given");
            continue;
        }
        if (line.find_first_not_of(" \t\r\"") == std::string_view::npos) continue;
        if (row.size() != heading.size())
            refuse(where, std::to_string(row.size()) + " cells", "as many as the heading has, " + std::to_string(heading.size()));
        std::size_t next = 0;
        auto const cell = [&](std::size_t k) -> std::string const& { return row[std::size_t(column[k])]; };
        auto const read = [&] {
            std::size_t const k = next++;
            return column[k] < 0 ? 0.0 : read_number(where + ": " + known[k], cell(k));
        };
        double const radius = read();
        if (!(radius > 0)) refuse(where + ": radius", radius, "> 0");
        std::size_t m = 0;
        std::string const& material = cell(next++);
        if (materials.empty())
            m = std::size_t(read_integer(where + ": material", material, 0));
        else
            while (m < materials.size() && materials[m] != material) ++m;
        if (!materials.empty() && m == materials.size())
            refuse(where + ": material", "\"" + material + "\"", "the name of a material");
        vec<double, Dim> position{};
        for (int axis = 0; axis < Dim; ++axis) position[axis] = read();
        list.add(position, radius, int(m));
        for (int axis = 0; axis < Dim; ++axis) list.velocity.back()[axis] = read();
        for (int axis = 0; axis < rotation_dim<Dim>; ++axis) list.spin.back()[axis] = read();
    }
    return list;
}

/// The same from a file. \throws std::invalid_argument, also for a file that cannot be read
template <int Dim>
particle_list<Dim> read_particle_csv(std::string const& path, std::vector<std::string> const& materials = {}) {
    return parse_particle_csv<Dim>(read_file(path, "particle file"), path, materials);
}

/// The text of a CSV file that parse_particle_csv() reads back to the same numbers; materials by number. Bonds and
/// densities are not in it.
template <int Dim>
std::string particle_csv(particle_list<Dim> const& list) {
    std::string text;
    for (auto const& name : detail::csv_columns<Dim>()) text += (text.empty() ? "" : ",") + name;
    text += '\n';
    for (std::size_t k = 0; k < list.size(); ++k) {
        text += to_text(list.packing.radius[k]) + "," + std::to_string(list.packing.material[k]);
        auto const put = [&](auto const& v, int count) {
            for (int axis = 0; axis < count; ++axis) text += "," + to_text(v[axis]);
        };
        put(list.packing.position[k], Dim);
        put(list.velocity[k], Dim);
        put(list.spin[k], rotation_dim<Dim>);
        text += '\n';
    }
    return text;
}

} // namespace lacuna
