// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>
#include <lacuna/core/vec.hpp>

/// \file
/// Header of a LAMMPS data file: units, counts, box. Used by lammps_data.hpp.

namespace lacuna::detail {

/// A unit style of LAMMPS. Lengths are divided by a whole number, so that 3.5 micrometres become the double nearest to
/// 3.5e-6 m.
struct lammps_units {
    char const* name = "si";
    double in_metre = 1;            ///< units of length per metre
    double density = 1;             ///< unit of density, kg/m^3
    double in_second = 1;           ///< units of time per second
    double in_metre_per_second = 1; ///< units of speed per m/s

    double length(double x) const noexcept { return x / in_metre; }
    double speed(double v) const noexcept { return v / in_metre_per_second; }
    double spin(double w) const noexcept { return w * in_second; }
};

inline constexpr std::array<lammps_units, 4> lammps_known_units{{{"si", 1, 1, 1, 1},
                                                                 {"cgs", 1e2, 1e3, 1, 1e2},
                                                                 {"micro", 1e6, 1e3, 1e6, 1},
                                                                 {"nano", 1e9, 1e6, 1e9, 1}}};

/// The units that a title or a comment names next to the word "units", such as "units = micro" by write_data. None if
/// that word does not occur.
/// \throws std::invalid_argument for units that cannot be converted to SI, or are unknown
inline std::optional<lammps_units> lammps_units_named(std::string const& line, std::string const& where) {
    std::vector<std::string> words(1);
    for (char const c : lower_case(line)) {
        if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_')
            words.back() += c;
        else if (!words.back().empty())
            words.emplace_back();
    }
    auto const mark = std::find(words.begin(), words.end(), "units");
    if (mark == words.end()) return std::nullopt;
    std::string const after = mark + 1 == words.end() ? "" : *(mark + 1),
                      before = mark == words.begin() ? "" : *(mark - 1);
    for (std::string const& word : {after, before})
        for (lammps_units const& known : lammps_known_units)
            if (word == known.name) return known;
    std::string const found = after.empty() ? before : after;
    refuse(where + ": units", in_quotes(found),
           "si, cgs, micro or nano" +
               std::string(found == "lj" ? ": lj units have no dimensions" : ""));
}

/// The header: the lines above the sections.
template <int Dim>
class lammps_header {
public:
    /// Reads a line. \param words words of the line, at least one
    void read(std::vector<std::string> const& words, std::string const& where) {
        std::size_t numbers = 0;
        while (numbers < words.size() && starts_number(words[numbers])) ++numbers;
        std::string what;
        for (std::size_t w = numbers; w < words.size(); ++w) what += (what.empty() ? "" : " ") + words[w];
        auto const needs = [&](std::size_t count) {
            if (numbers != count)
                refuse(where + ": " + what, std::to_string(numbers) + " numbers", std::to_string(count));
        };
        if (!seen_.emplace(what, 0).second) refuse(where, in_quotes(what), "given once");
        for (int axis = 0; axis < 3; ++axis)
            if (what == bounds_name(axis)) {
                needs(2);
                for (std::size_t end : {0u, 1u})
                    box_[std::size_t(axis)][end] = read_number(where + ": " + what, words[end]);
                if (!(box_[std::size_t(axis)][1] > box_[std::size_t(axis)][0]))
                    refuse(where + ": " + what, words[0] + " " + words[1], "a lower and a higher bound");
                return;
            }
        if (what == "xy xz yz") {
            needs(3);
            for (std::size_t w = 0; w < 3; ++w)
                if (read_number(where + ": " + what, words[w]) != 0)
                    refuse(where + ": " + what, words[w], "0: boxes here have right angles");
            return;
        }
        static std::vector<std::string> const counted{"atoms", "bonds", "atom types", "bond types"};
        static std::vector<std::string> const absent{"angles", "dihedrals", "impropers", "ellipsoids",
                                                     "lines",  "triangles", "bodies"};
        static std::vector<std::string> const without_meaning{
            "angle types", "dihedral types", "improper types", "extra bond per atom", "extra angle per atom",
            "extra dihedral per atom", "extra improper per atom", "extra special per atom"};
        auto const in = [&](auto const& list) { return std::find(list.begin(), list.end(), what) != list.end(); };
        if (!in(counted) && !in(absent) && !in(without_meaning)) refuse_unknown(what, where, counted);
        needs(1);
        auto const count = int(read_whole(where + ": " + what, words[0], 0, most_count));
        if (in(absent) && count > 0) refuse(where + ": " + what, words[0], "0: particles here are spheres with bonds");
        if (in(counted)) seen_[what] = count;
    }

    /// The header's number of "atoms", "bonds", "atom types" or "bond types"; -1 if it has no such line.
    int count(std::string const& what) const {
        auto const found = seen_.find(what);
        return found == seen_.end() ? -1 : found->second;
    }
    static std::string bounds_name(int axis) {
        std::string const name(1, "xyz"[axis]);
        return name + "lo " + name + "hi";
    }
    bool has_box(int axis) const noexcept { return box_[std::size_t(axis)][1] > box_[std::size_t(axis)][0]; }
    double low(int axis) const noexcept { return box_[std::size_t(axis)][0]; }
    double high(int axis) const noexcept { return box_[std::size_t(axis)][1]; }

    /// The number of an atom or bond type, given as a number or by its label.
    /// \param what "atom" or "bond"; \param word number or label
    int type(std::string const& what, std::string const& word, std::string const& where) const {
        if (auto const found = labels_.find({what, word}); found != labels_.end()) return found->second;
        int const known = count(what + " types");
        return int(read_whole(where + ": " + what + " type", word, 1, known < 0 ? most_count : known));
    }
    /// Gives a type a label.
    void label(std::string const& what, std::string const& word, int number, std::string const& where) {
        if (starts_number(word) || !labels_.emplace(std::pair(what, word), number).second)
            refuse(where + ": label", in_quotes(word), "a word that is no number, given once");
    }
    /// Vector from one particle to another, or to the image of the other in the next box if that is nearer. Along
    /// periodic axes it is unchanged.
    /// \param apart vector between the two, in the file's unit of length
    vec<double, Dim> nearest(vec<double, Dim> apart,
                             std::array<bool, std::size_t(Dim)> const& periodic) const noexcept {
        for (int axis = 0; axis < Dim; ++axis) {
            double const length = high(axis) - low(axis);
            if (has_box(axis) && !periodic[std::size_t(axis)] && 2 * std::fabs(apart[axis]) > length)
                apart[axis] -= std::copysign(length, apart[axis]);
        }
        return apart;
    }
    static bool starts_number(std::string const& word) {
        return std::string_view("+-.0123456789").find(word[0]) != std::string_view::npos;
    }

private:
    static constexpr int most_count = std::numeric_limits<int>::max();

    [[noreturn]] static void refuse_unknown(std::string const& what, std::string const& where,
                                            std::vector<std::string> const& counted) {
        if (what == "avec" || what == "bvec" || what == "cvec" || what == "abc origin")
            refuse(where, in_quotes(what), "xlo xhi and so on: boxes here have right angles");
        std::string const near = nearest_word(what, counted);
        refuse(where, in_quotes(what),
               "a line of a header, such as \"12 atoms\"" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"));
    }

    std::map<std::string, int> seen_; ///< names of all lines so far, with the count of those in `counted`
    std::map<std::pair<std::string, std::string>, int> labels_;
    std::array<std::array<double, 2>, 3> box_{};
};

} // namespace lacuna::detail
