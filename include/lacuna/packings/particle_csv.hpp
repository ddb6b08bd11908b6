// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>
#include <lacuna/packings/csv_table.hpp>
#include <lacuna/packings/particle_list.hpp>

/// \file
/// Particles in CSV files. A heading names the columns, in any order. Required are position.x, position.y (position.z)
/// and radius; optional are material, density, velocity.x, velocity.y (velocity.z) and spin (in space spin.x, spin.y,
/// spin.z). Units are SI.
///
/// Files of other programs are read if they are unambiguous. Accepted are
///   - columns named x, y, z, r, vx, diameter, matId, and ParaView's Points:0 or Points_0, in small letters or
///     capitals;
///   - SI units in brackets, such as radius [m];
///   - cells separated by semicolons, tabs or blanks, and decimal commas;
///   - a heading in a comment, or as Yade writes it (a comment with the word format, and x_y_z_r);
///   - in the plane, columns of components out of the plane that contain only 0.
///
/// Empty lines and comments are skipped. Any other column is refused.

namespace lacuna {

namespace detail {

/// Names of all columns.
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
    known.emplace_back("density");
    return known;
}

/// Removes a unit in brackets from the end of a name such as "radius [m]".
/// \return the unit; "-" for empty brackets, an empty text without brackets
inline std::string csv_cut_unit(std::string& name) {
    char const last = name.empty() ? ' ' : name.back();
    auto const bracket = name.find_last_of(last == ']' ? '[' : '(');
    if ((last != ']' && last != ')') || bracket == name.npos || bracket == 0) return {};
    std::string const unit(trimmed(std::string_view(name).substr(bracket + 1, name.size() - bracket - 2)));
    name = trimmed(std::string_view(name).substr(0, bracket));
    return unit.empty() ? "-" : unit;
}

/// Our name of a column; empty for an unknown column.
/// \param name heading of the column in small letters, without its unit
inline std::string csv_plain_name(std::string const& name) {
    static std::vector<std::pair<std::string, std::string>> const scalars{
        {"radius", "radius"},   {"r", "radius"},          {"rad", "radius"},   {"diameter", "diameter"},
        {"d", "diameter"},      {"material", "material"}, {"mat", "material"}, {"matid", "material"},
        {"density", "density"}, {"rho", "density"},       {"spin", "spin"},    {"omega", "spin"},
        {"x", "position.x"},    {"y", "position.y"},      {"z", "position.z"}};
    for (auto const& [given, plain] : scalars)
        if (name == given) return plain;
    static std::vector<std::pair<std::string, std::string>> const vectors{
        {"position", "position"}, {"points", "position"}, {"coordinates", "position"}, {"pos", "position"},
        {"velocity", "velocity"}, {"vel", "velocity"},    {"v", "velocity"},           {"spin", "spin"},
        {"omega", "spin"},        {"w", "spin"}};
    for (auto const& [given, plain] : vectors) {
        if (!name.starts_with(given)) continue;
        std::string_view rest = std::string_view(name).substr(given.size());
        bool const separated = !rest.empty() && std::string_view(".:_ ").find(rest[0]) != std::string_view::npos;
        if (separated) rest.remove_prefix(1);
        auto const axis = rest.size() == 1 ? std::string_view("xyz012").find(rest[0]) : std::string_view::npos;
        if (axis != std::string_view::npos && (separated || axis < 3)) return plain + "." + "xyz"[axis % 3];
    }
    return {};
}

/// Reader of one CSV file.
template <int Dim>
class particle_csv_reader {
public:
    particle_csv_reader(std::string_view text, std::string const& name, std::vector<std::string> const& materials)
        : name_(name), materials_(materials),
          table_(csv_table::read(text, name, [](auto const& cells) { return all_known(cells); })) {}

    particle_list<Dim> read() {
        find_columns();
        std::vector<std::size_t> numbers;
        for (std::size_t c = 0; c < plain_.size(); ++c)
            if (plain_[c] != "material" || materials_.empty()) numbers.push_back(c);
        commas_ = table_.has_decimal_commas(numbers, name_);
        std::vector<std::size_t> lines;
        for (csv_row const& row : table_.rows) {
            add(row);
            lines.push_back(row.line);
        }
        if (list_.size() == 0) refuse(name_ + ": particles", "0", "at least 1: there are no rows below the heading");
        list_.density = list_.packing.density;
        refuse_particles_given_twice(list_, lines, name_);
        return std::move(list_);
    }

private:
    /// Our name of the column with a given heading; empty for an unknown column. \param unit receives the unit in
    /// brackets
    static std::string plain_name(std::string const& cell, std::string& unit) {
        std::string name = lower_case(cell);
        unit = csv_cut_unit(name);
        std::string const plain = csv_plain_name(name);
        // In the plane spin and spin.z mean the same; in space spin needs the name of an axis.
        if (Dim == 2 && plain == "spin.z") return "spin";
        return Dim == 3 && plain == "spin" ? std::string() : plain;
    }
    static bool all_known(std::vector<std::string> const& cells) {
        std::string unit;
        auto const unknown = [&](std::string const& cell) { return plain_name(cell, unit).empty(); };
        return !cells.empty() && std::none_of(cells.begin(), cells.end(), unknown);
    }
    static void require_unit(std::string const& plain, std::string const& unit, std::string const& where,
                             std::string const& cell) {
        auto const is = [&](std::initializer_list<char const*> units) {
            return std::find(units.begin(), units.end(), unit) != units.end();
        };
        bool const length = plain == "radius" || plain == "diameter" || plain.starts_with("position");
        bool const speed = plain.starts_with("velocity"), spin = plain.starts_with("spin"), dense = plain == "density";
        bool const good = length  ? is({"m"})
                          : speed ? is({"m/s", "m s-1", "m s^-1"})
                          : spin  ? is({"rad/s", "1/s", "s-1", "s^-1"})
                          : dense ? is({"kg/m3", "kg/m^3", "kg/m\u00b3", "kg m-3", "kg m^-3"})
                                  : unit == "-";
        char const* const si = length ? "m" : speed ? "m/s" : spin ? "rad/s" : dense ? "kg/m^3" : "no unit";
        if (!good) refuse(where, in_quotes(cell), std::string("in ") + si);
    }
    void find_columns() {
        std::string const where = name_ + ":" + std::to_string(table_.heading.line);
        for (std::string const& cell : table_.heading.cells) {
            std::string unit;
            std::string const plain = plain_name(cell, unit);
            if (plain.empty()) refuse_column(cell, where);
            if (!unit.empty()) require_unit(plain, unit, where, cell);
            bool const size_twice = (plain == "radius" && has("diameter")) || (plain == "diameter" && has("radius"));
            if (has(plain) || size_twice) refuse(where, in_quotes(cell), "a column that is given once");
            plain_.push_back(plain);
        }
        for (std::string const& needed : csv_columns<Dim>()) {
            bool const size = needed == "radius" && !has("diameter");
            if ((size || needed.starts_with("position")) && !has(needed))
                refuse(where + ": " + needed, "(missing)", "given");
        }
        if (materials_.size() > 1 && !has("material"))
            refuse(where + ": material", "(missing)",
                   "given: there are " + std::to_string(materials_.size()) + " materials");
    }
    [[noreturn]] static void refuse_column(std::string const& cell, std::string const& where) {
        auto const known = csv_columns<Dim>();
        std::string rule = "a known column";
        if (std::string const odd = odd_character(cell); !odd.empty()) rule += "; it has " + odd;
        std::string const near = nearest_word(lower_case(cell), known);
        if (!near.empty()) refuse(where, in_quotes(cell), rule + " (did you mean \"" + near + "\"?)");
        std::string all;
        for (auto const& name : known) all += (all.empty() ? "" : ", ") + name;
        refuse(where, in_quotes(cell), rule + ": " + all + "; leave out all others, particles are numbered by rows");
    }
    bool has(std::string_view plain) const { return std::find(plain_.begin(), plain_.end(), plain) != plain_.end(); }

    void add(csv_row const& row) {
        std::string const where = name_ + ":" + std::to_string(row.line) + ": ";
        vec<double, 3> position{}, velocity{}, spin{};
        double radius = 0, density = 0;
        int material = 0;
        for (std::size_t c = 0; c < plain_.size(); ++c) {
            std::string const &plain = plain_[c], field = where + plain;
            if (plain == "material") {
                material = material_of(field, row.cells[c]);
                continue;
            }
            double const x = number(field, row.cells[c]);
            bool const size = plain == "radius" || plain == "diameter";
            if ((size || plain == "density") && !(x > 0)) refuse(field, x, "> 0");
            if (size) {
                radius = plain == "radius" ? x : 0.5 * x;
                if (!(radius > 0)) refuse(field, x, "of a radius > 0");
            } else if (plain == "density") {
                density = x;
            } else if (plain == "spin") {
                spin[2] = x;
            } else {
                int const axis = plain.back() - 'x';
                bool const out = Dim == 2 && (plain[0] == 's' || axis == 2);
                if (out && x != 0) refuse(field, x, "0 in the plane");
                (plain[0] == 'p' ? position : plain[0] == 'v' ? velocity : spin)[axis] = x;
            }
        }
        list_.add(first<Dim>(position), radius, material);
        list_.velocity.back() = first<Dim>(velocity);
        if constexpr (Dim == 2)
            list_.spin.back() = {spin[2]};
        else
            list_.spin.back() = spin;
        if (density > 0) list_.packing.density.push_back(density);
    }
    template <int N>
    static vec<double, N> first(vec<double, 3> const& v) {
        vec<double, N> some{};
        for (int axis = 0; axis < N; ++axis) some[axis] = v[axis];
        return some;
    }
    double number(std::string const& field, std::string const& cell) const {
        if (!commas_) return read_number(field, cell);
        std::string text = cell;
        std::replace(text.begin(), text.end(), ',', '.');
        if (number_of(text)) return read_number(field, text);
        return read_number(field, cell);
    }
    int material_of(std::string const& field, std::string const& cell) const {
        if (materials_.empty()) return read_integer(field, cell, 0);
        auto const found = std::find(materials_.begin(), materials_.end(), cell);
        if (found == materials_.end()) refuse(field, in_quotes(cell), "the name of a material");
        return int(found - materials_.begin());
    }

    std::string name_;
    std::vector<std::string> const& materials_;
    csv_table table_;
    std::vector<std::string> plain_; ///< our name of each column
    bool commas_ = false;
    particle_list<Dim> list_;
};

} // namespace detail

/// Reads the text of a CSV file.
/// \param name name of the file in messages
/// \param materials names that the column material contains. If there are none, it contains numbers from 0 on. If there
///        is no such column, all particles have material 0; it may be missing only if there is at most one name.
/// \throws std::invalid_argument "name:line: column = value: must be rule"
template <int Dim>
particle_list<Dim> parse_particle_csv(std::string_view text, std::string const& name,
                                      std::vector<std::string> const& materials = {}) {
    return detail::particle_csv_reader<Dim>(text, name, materials).read();
}

/// Reads a CSV file; see parse_particle_csv(). \throws std::invalid_argument, also for a file that cannot be read
template <int Dim>
particle_list<Dim> read_particle_csv(std::string const& path, std::vector<std::string> const& materials = {}) {
    return parse_particle_csv<Dim>(read_file(path, "particle file"), path, materials);
}

/// The text of a CSV file from which parse_particle_csv() reads the same numbers. Materials are written by number,
/// densities if there are any. Bonds are not written.
template <int Dim>
std::string particle_csv(particle_list<Dim> const& list) {
    auto const& packing = list.packing;
    bool const dense = !packing.density.empty();
    std::string text;
    for (auto const& name : detail::csv_columns<Dim>())
        if (dense || name != "density") text += (text.empty() ? "" : ",") + name;
    text += '\n';
    for (std::size_t k = 0; k < list.size(); ++k) {
        auto const put = [&](auto const& v, int count) {
            for (int axis = 0; axis < count; ++axis) text += "," + to_text(v[axis]);
        };
        text += to_text(packing.radius[k]) + "," + std::to_string(packing.material[k]);
        put(packing.position[k], Dim);
        put(list.velocity[k], Dim);
        put(list.spin[k], rotation_dim<Dim>);
        if (dense) text += "," + to_text(packing.density.at(k));
        text += '\n';
    }
    return text;
}

} // namespace lacuna
