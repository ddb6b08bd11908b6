// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>
#include <lacuna/packings/lammps_header.hpp>
#include <lacuna/packings/particle_list.hpp>

/// \file
/// Packings in LAMMPS data files (its command read_data), for the atom styles that have radii:
///
///   sphere       id type diameter density x y z
///   bpm/sphere   id molecule type diameter density x y z
///
/// Image flags may follow. Further sections are Velocities (id vx vy vz wx wy wz), Bonds (id type a b), Atom Type
/// Labels and Bond Type Labels.
///
/// Numbers are converted from the units that the title names, as write_data does: "units = micro"; si, cgs, micro or
/// nano. Without that, units are si. Material k is atom type k + 1, and entry k of packing.bond_type is bond type k +
/// 1. Densities go to packing.density. Coefficients and masses of types are ignored: the model has its own parameters,
/// and masses follow from densities.
///
/// A data file does not say along which axes its box is periodic: the caller does. Along non-periodic axes particles
/// must be in the box, with image flags of 0, and no bond may cross its sides. Along periodic axes positions are
/// unwrapped with their image flags, and packing.period is set; pass it on to the domain.

namespace lacuna {

namespace detail {

/// Reader of one data file.
template <int Dim>
class lammps_reader {
public:
    lammps_reader(std::string_view text, std::string const& name, std::array<bool, std::size_t(Dim)> const& periodic)
        : text_(plain_text(text, name)), name_(name), periodic_(periodic) {}

    particle_list<Dim> read() {
        title();
        std::string line;
        while (next(line)) {
            auto const words = words_of(line);
            if (words.empty()) {
                if (section_.empty()) take_units(comment_);
            } else if (char const first = lower_case(words[0])[0]; first >= 'a' && first <= 'z') {
                section(words);
            } else {
                section_.empty() ? header_.read(words, where()) : row(words);
            }
        }
        finish();
        return std::move(list_);
    }

private:
    struct atom {
        int type;
        double radius, density;
        vec<double, Dim> position;
        std::size_t line;
        bool moves = false;
        vec<double, Dim> velocity{};
        vec<double, rotation_dim<Dim>> spin{};
    };
    struct bond {
        long long a, b;
        int type;
        std::size_t line;
    };
    using word_list = std::vector<std::string>;

    /// Takes the next line, and stores its comment in comment_. \return false at the end of the text
    bool next(std::string& line) {
        std::string_view found;
        if (!take_line(text_, found)) return false;
        ++number_;
        auto const mark = std::min(found.find('#'), found.size());
        comment_ = trimmed(found.substr(std::min(mark + 1, found.size())));
        line = found.substr(0, mark);
        return true;
    }
    void title() {
        std::string line;
        next(line);
        auto const words = words_of(line);
        if (words.size() == 2 && words[1] == "atoms" && lammps_header<Dim>::starts_number(words[0]))
            refuse_here("title", in_quotes(trimmed(line)),
                        "a title: the first line of a data file is not part of its header");
        take_units(line + " " + comment_);
    }
    void take_units(std::string const& text) {
        auto const found = lammps_units_named(text, where());
        if (!found) return;
        if (units_named_ && std::string_view(units_.name) != found->name)
            refuse_here("units", found->name, std::string("those named above, ") + units_.name);
        units_ = *found;
        units_named_ = true;
    }
    std::string where(std::size_t line = 0) const { return name_ + ":" + std::to_string(line ? line : number_); }
    [[noreturn]] void refuse_here(std::string const& field, std::string const& value, std::string const& rule) const {
        refuse(where() + (field.empty() ? "" : ": " + field), value, rule);
    }
    double number(char const* field, std::string const& word) const {
        return read_number(where() + ": " + field, word);
    }
    long long id(char const* field, std::string const& word) const {
        return read_whole(where() + ": " + field, word, 1, std::numeric_limits<long long>::max());
    }
    /// Refuses a number other than 0 in the plane.
    void flat(char const* field, std::string const& word) const {
        if (Dim == 2 && number(field, word) != 0) refuse_here(field, word, "0 in the plane");
    }
    int type(char const* what, std::string const& word) const { return header_.type(what, word, where()); }

    void section(word_list const& words) {
        section_ = words[0];
        for (std::size_t w = 1; w < words.size(); ++w) section_ += " " + words[w];
        static word_list const known{"Atoms",       "Velocities",       "Bonds",
                                     "Masses",      "Pair Coeffs",      "PairIJ Coeffs",
                                     "Bond Coeffs", "Atom Type Labels", "Bond Type Labels"};
        if (std::find(known.begin(), known.end(), section_) == known.end()) {
            std::string const near = nearest_word(section_, known);
            refuse_here("", in_quotes(section_),
                        "a section of spheres" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"));
        }
        if (!sections_.insert(section_).second) refuse_here("", in_quotes(section_), "a section that is given once");
        if (section_ == "Atoms") {
            if (comment_ != "sphere" && comment_ != "bpm/sphere")
                refuse_here("Atoms", in_quotes(comment_), "followed by \"# sphere\" or \"# bpm/sphere\"");
            molecules_ = comment_ == "bpm/sphere";
        }
    }
    void columns(word_list const& words, std::size_t count, std::size_t more = 0) const {
        if (words.size() == count || words.size() == count + more) return;
        refuse_here(section_, std::to_string(words.size()) + " words",
                    std::to_string(count) + (more ? " or " + std::to_string(count + more) : std::string()));
    }
    void row(word_list const& words) {
        if (section_ == "Atoms") return atom_row(words);
        if (section_ == "Velocities") return velocity_row(words);
        if (section_ == "Bonds") return bond_row(words);
        if (section_ == "Masses") {
            columns(words, 2);
            type("atom", words[0]);
            if (!(number("mass", words[1]) > 0)) refuse_here("mass", words[1], "> 0");
        } else if (section_.ends_with("Labels")) {
            columns(words, 2);
            char const* const what = section_[0] == 'A' ? "atom" : "bond";
            header_.label(what, words[1], type(what, words[0]), where());
        }
    }
    void atom_row(word_list const& words) {
        std::size_t const m = molecules_ ? 1 : 0;
        columns(words, 7 + m, 3);
        if (molecules_) read_whole(where() + ": molecule", words[1], 0, std::numeric_limits<long long>::max());
        atom a{type("atom", words[1 + m]), units_.length(0.5 * number("diameter", words[2 + m])),
               units_.density * number("density", words[3 + m]), {}, number_};
        if (!(a.radius > 0)) refuse_here("diameter", words[2 + m], "> 0: particles cannot be points");
        if (!(a.density > 0) || !std::isfinite(a.density)) refuse_here("density", words[3 + m], "> 0");
        flat("z", words[6 + m]);
        bool const images = words.size() > 7 + m;
        if (images) flat("image flag", words[9 + m]);
        for (int axis = 0; axis < Dim; ++axis) {
            auto const w = std::size_t(axis);
            a.position[axis] = coordinate(axis, words[4 + m + w], images ? words[7 + m + w] : "0");
        }
        if (!atoms_.emplace(id("id", words[0]), a).second) refuse_here("id", words[0], "given once");
    }
    /// A coordinate of a particle, unwrapped along periodic axes, m.
    double coordinate(int axis, std::string const& word, std::string const& flag) {
        double const x = number("position", word);
        auto const image = double(read_whole(where() + ": image flag", flag, -2147483648LL, 2147483647));
        bool const boxed = header_.has_box(axis);
        double const low = header_.low(axis), high = header_.high(axis);
        if (periodic_[std::size_t(axis)]) {
            if (!boxed)
                refuse_here(lammps_header<Dim>::bounds_name(axis), "(missing)",
                            "given in the header: along this axis the box is periodic");
            double const whole = units_.length(x + image * (high - low));
            if (!std::isfinite(whole)) refuse_here("image flag", flag, "of a finite position");
            return whole;
        }
        if (image != 0)
            refuse_here("image flag", flag,
                        std::string("0: the box is read as non-periodic along ") + "xyz"[axis] +
                            "; reading it as periodic unwraps positions");
        double const slack = 1e-5 * (high - low); // bounds may be written with fewer digits than positions
        if (boxed && !(x >= low - slack && x <= high + slack))
            refuse_here("position", word,
                        "within the box, from " + to_text(low) + " to " + to_text(high) + " along " + "xyz"[axis]);
        return units_.length(x);
    }
    void velocity_row(word_list const& words) {
        columns(words, 7);
        atom& a = known_atom("id", words[0]);
        if (std::exchange(a.moves, true)) refuse_here("id", words[0], "given once");
        for (std::size_t w : {3u, 4u, 5u}) flat(w == 3 ? "vz" : w == 4 ? "wx" : "wy", words[w]);
        for (int axis = 0; axis < Dim; ++axis)
            a.velocity[axis] = units_.speed(number("velocity", words[1 + std::size_t(axis)]));
        for (int axis = 0; axis < rotation_dim<Dim>; ++axis)
            a.spin[axis] = units_.spin(number("spin", words[(Dim == 2 ? 6 : 4) + std::size_t(axis)]));
    }
    void bond_row(word_list const& words) {
        columns(words, 4);
        atom const& first = known_atom("atom", words[2]);
        atom const& second = known_atom("atom", words[3]);
        bond const b{id("atom", words[2]), id("atom", words[3]), type("bond", words[1]), number_};
        if (b.a == b.b) refuse_here("atom", words[3], "another atom than the first");
        if (!bond_ids_.insert(id("id", words[0])).second) refuse_here("id", words[0], "given once");
        if (!bonded_.insert(std::minmax(b.a, b.b)).second)
            refuse_here("Bonds", words[2] + " " + words[3], "a pair that has no bond yet");
        refuse_bond_through_sides(first, second, words);
        bonds_.push_back(b);
    }
    /// Refuses a bond that crosses a side of the box along a non-periodic axis: it would become as long as the box.
    void refuse_bond_through_sides(atom const& a, atom const& b, word_list const& words) const {
        auto apart = (b.position - a.position) * units_.in_metre;
        for (int axis = 0; axis < Dim; ++axis)
            if (periodic_[std::size_t(axis)]) apart[axis] = 0; // the domain finds the nearest image
        double const within = units_.length(norm(apart));
        double const through = units_.length(norm(header_.nearest(apart, periodic_)));
        double const touching = a.radius + b.radius;
        // In a box that just holds two centres, they are as near through its sides: choose the length nearer to
        // contact.
        if (through < within && std::fabs(through - touching) < std::fabs(within - touching))
            refuse_here("Bonds", words[2] + " " + words[3],
                        "a pair that is nearest within the box: through its sides they are " + to_text(through) +
                            " m apart, within it " + to_text(within) +
                            " m; such a box is periodic, but is read as non-periodic");
    }
    atom& known_atom(char const* field, std::string const& word) {
        auto const found = atoms_.find(id(field, word));
        if (found == atoms_.end()) refuse_here(field, word, "an atom of the section Atoms above");
        return found->second;
    }
    void finish() {
        auto const count = [&](std::string const& what, std::size_t found) {
            int const expected = header_.count(what);
            if (expected < 0 || found != std::size_t(expected))
                refuse(name_ + ": " + what, std::to_string(found),
                       expected < 0 ? "announced in the header"
                                    : "as many as the header says, " + std::to_string(expected));
        };
        count("atoms", atoms_.size());
        if (atoms_.empty()) refuse(name_ + ": atoms", "0", "at least 1");
        if (!bonds_.empty() || header_.count("bonds") > 0) count("bonds", bonds_.size());
        std::map<long long, std::int32_t> rank;
        std::vector<std::size_t> lines;
        auto& packing = list_.packing;
        for (auto const& [id, a] : atoms_) {
            rank[id] = std::int32_t(list_.size());
            list_.add(a.position, a.radius, a.type - 1);
            list_.velocity.back() = a.velocity;
            list_.spin.back() = a.spin;
            packing.density.push_back(a.density);
            lines.push_back(a.line);
        }
        list_.density = packing.density;
        for (bond const& b : bonds_) {
            packing.bonds.push_back({rank[b.a], rank[b.b]});
            packing.bond_type.push_back(b.type - 1);
        }
        for (int axis = 0; axis < Dim; ++axis)
            if (periodic_[std::size_t(axis)])
                packing.period[axis] = units_.length(header_.high(axis) - header_.low(axis));
        refuse_particles_given_twice(list_, lines, name_);
    }

    std::string_view text_;
    std::string name_;
    std::array<bool, std::size_t(Dim)> periodic_;
    std::size_t number_ = 0;
    std::string comment_, section_;
    std::set<std::string> sections_;
    lammps_units units_;
    bool units_named_ = false, molecules_ = false;
    lammps_header<Dim> header_;
    std::map<long long, atom> atoms_; // by id: the order of lines does not matter
    std::vector<bond> bonds_;
    std::set<long long> bond_ids_;
    std::set<std::pair<long long, long long>> bonded_;
    particle_list<Dim> list_;
};

} // namespace detail

/// Reads the text of a data file. Particles are numbered in the order of their ids.
/// \param name name of the file in messages
/// \param periodic for each axis: whether the box is periodic along it
/// \throws std::invalid_argument "name:line: field = value: must be rule"
template <int Dim>
particle_list<Dim> parse_lammps_data(std::string_view text, std::string const& name,
                                     std::array<bool, std::size_t(Dim)> const& periodic = {}) {
    return detail::lammps_reader<Dim>(text, name, periodic).read();
}

/// Reads a data file; see parse_lammps_data(). \throws std::invalid_argument, also for a file that cannot be read
template <int Dim>
particle_list<Dim> read_lammps_data(std::string const& path, std::array<bool, std::size_t(Dim)> const& periodic = {}) {
    return parse_lammps_data<Dim>(read_file(path, "data file"), path, periodic);
}

} // namespace lacuna
