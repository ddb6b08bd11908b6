// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>
#include <lacuna/particles/particle_list.hpp>

/// \file
/// Packings in LAMMPS's data files (its command read_data), of the atom styles that have radii:
///
///   sphere       id type diameter density x y z
///   bpm/sphere   id molecule type diameter density x y z
///
/// with image flags of 0, sections Velocities (id vx vy vz wx wy wz) and Bonds (id type a b), in units si. Sections of
/// coefficients are passed over: parameters are the model's. A type is a material's number plus 1.

namespace lacuna {

namespace detail {

/// One reading of a data file.
template <int Dim>
class lammps_reader {
public:
    lammps_reader(std::string_view text, std::string const& name) : text_(text), name_(name) {}

    particle_list<Dim> read() {
        std::string line;
        next(line); // a title
        while (next(line)) {
            auto const words = words_of(line);
            if (words.empty()) continue;
            if (!is_number(words[0])) {
                section(words);
            } else if (section_.empty()) {
                header(words);
            } else {
                row(words);
            }
        }
        finish();
        return std::move(list_);
    }

private:
    struct atom {
        int type;
        double radius, density;
        vec<double, Dim> position, velocity{};
        vec<double, rotation_dim<Dim>> spin{};
    };

    /// The next line, without its comment, which is kept.
    bool next(std::string& line) {
        if (from_ >= text_.size()) return false;
        auto const end = std::min(text_.find('\n', from_), text_.size());
        line = text_.substr(from_, end - from_);
        from_ = end + 1;
        ++number_;
        comment_.clear();
        if (auto const mark = line.find('#'); mark != std::string::npos) {
            auto const words = words_of(std::string_view(line).substr(mark + 1));
            if (!words.empty()) comment_ = words[0];
            line.resize(mark);
        }
        return true;
    }
    static bool is_number(std::string const& word) { return word.find_first_not_of("+-.0123456789eE") == std::string::npos; }
    std::string where() const { return name_ + ":" + std::to_string(number_); }
    [[noreturn]] void refuse_here(std::string const& field, std::string const& value, std::string const& rule) const {
        refuse(where() + (field.empty() ? "" : ": " + field), value, rule);
    }
    double number(char const* field, std::string const& word) const { return read_number(where() + ": " + field, word); }
    int id(char const* field, std::string const& word) const { return read_integer(where() + ": " + field, word, 1); }
    /// A number that has to be 0 in the plane.
    void flat(char const* field, std::string const& word) const {
        if (Dim == 2 && number(field, word) != 0) refuse_here(field, word, "0 in the plane");
    }

    void header(std::vector<std::string> const& words) {
        std::string what;
        for (std::string const& word : words)
            if (!is_number(word)) what += (what.empty() ? "" : " ") + word;
        if (what == "atoms") atoms_expected_ = read_integer(where() + ": atoms", words[0], 0);
        if (what == "bonds") bonds_expected_ = read_integer(where() + ": bonds", words[0], 0);
    }
    void section(std::vector<std::string> const& words) {
        section_ = words[0];
        for (std::size_t w = 1; w < words.size(); ++w) section_ += " " + words[w];
        static std::vector<std::string> const known{"Atoms", "Velocities", "Bonds", "Masses", "Pair Coeffs",
                                                    "PairIJ Coeffs", "Bond Coeffs"};
        if (std::find(known.begin(), known.end(), section_) == known.end()) {
            std::string const near = nearest_word(section_, known);
            refuse_here("", "\"" + section_ + "\"", "a section of spheres" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"));
        }
        if (section_ == "Atoms") {
            if (comment_ != "sphere" && comment_ != "bpm/sphere")
                refuse_here("Atoms", "\"" + comment_ + "\"", "followed by \"# sphere\" or \"# bpm/sphere\"");
            molecules_ = comment_ == "bpm/sphere";
        }
    }
    void row(std::vector<std::string> const& words) {
        auto const columns = [&](std::size_t count, std::size_t more = 0) {
            if (words.size() != count && words.size() != count + more)
                refuse_here(section_, std::to_string(words.size()) + " words", std::to_string(count) +
                                (more ? " or " + std::to_string(count + more) : std::string()));
        };
        if (section_ == "Atoms") {
            std::size_t const m = molecules_ ? 1 : 0;
            columns(7 + m, 3);
            atom a{id("type", words[1 + m]), 0.5 * number("diameter", words[2 + m]), number("density", words[3 + m]), {}};
            if (!(a.radius > 0)) refuse_here("diameter", words[2 + m], "> 0: points are no particles");
            if (!(a.density > 0)) refuse_here("density", words[3 + m], "> 0");
            flat("z", words[6 + m]);
            for (int axis = 0; axis < Dim; ++axis)
                a.position[axis] = number("position", words[4 + m + std::size_t(axis)]);
            for (std::size_t w = 7 + m; w < words.size(); ++w)
                if (number("image flag", words[w]) != 0) refuse_here("image flag", words[w], "0: give unwrapped positions");
            if (!atoms_.emplace(id("id", words[0]), a).second) refuse_here("id", words[0], "given once");
        } else if (section_ == "Velocities") {
            columns(7);
            atom& a = known_atom("id", words[0]);
            for (std::size_t w : {3u, 4u, 5u}) flat(w == 3 ? "vz" : w == 4 ? "wx" : "wy", words[w]);
            for (int axis = 0; axis < Dim; ++axis) a.velocity[axis] = number("velocity", words[1 + std::size_t(axis)]);
            for (int axis = 0; axis < rotation_dim<Dim>; ++axis)
                a.spin[axis] = number("spin", words[(Dim == 2 ? 6 : 4) + std::size_t(axis)]);
        } else if (section_ == "Bonds") {
            columns(4);
            known_atom("atom", words[2]);
            known_atom("atom", words[3]);
            bonds_.push_back({id("atom", words[2]), id("atom", words[3])});
            if (bonds_.back().first == bonds_.back().second) refuse_here("atom", words[3], "another than the first");
        }
    }
    atom& known_atom(char const* field, std::string const& word) {
        auto const found = atoms_.find(id(field, word));
        if (found == atoms_.end()) refuse_here(field, word, "an atom of the section Atoms above");
        return found->second;
    }
    void finish() {
        auto const count = [&](std::string const& what, std::size_t found, int expected) {
            if (expected < 0 || found != std::size_t(expected))
                refuse(name_ + ": " + what, std::to_string(found),
                       expected < 0 ? "announced in the header" : "as many as the header says, " + std::to_string(expected));
        };
        count("atoms", atoms_.size(), atoms_expected_);
        if (!bonds_.empty() || bonds_expected_ > 0) count("bonds", bonds_.size(), bonds_expected_);
        std::map<int, std::int32_t> rank;
        for (auto const& [id, a] : atoms_) {
            rank[id] = std::int32_t(list_.size());
            list_.add(a.position, a.radius, a.type - 1);
            list_.velocity.back() = a.velocity;
            list_.spin.back() = a.spin;
            list_.density.push_back(a.density);
        }
        for (auto const& [a, b] : bonds_) list_.packing.bonds.push_back({rank[a], rank[b]});
    }

    std::string_view text_;
    std::string name_;
    std::size_t from_ = 0, number_ = 0;
    std::string comment_, section_;
    bool molecules_ = false;
    int atoms_expected_ = -1, bonds_expected_ = -1;
    std::map<int, atom> atoms_; // by id: the order of lines is of no account
    std::vector<std::pair<int, int>> bonds_;
    particle_list<Dim> list_;
};

} // namespace detail

/// Reads the text of a data file. Particles are numbered in the order of their ids.
/// \param name of the file in messages
/// \throws std::invalid_argument "name:line: field = value: must be rule"
template <int Dim>
particle_list<Dim> parse_lammps_data(std::string_view text, std::string const& name) {
    return detail::lammps_reader<Dim>(text, name).read();
}

/// The same from a file. \throws std::invalid_argument, also for a file that cannot be read
template <int Dim>
particle_list<Dim> read_lammps_data(std::string const& path) {
    return parse_lammps_data<Dim>(read_file(path, "data file"), path);
}

} // namespace lacuna
