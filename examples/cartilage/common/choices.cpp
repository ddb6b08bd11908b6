// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/common/choices.hpp"

#include <cmath>
#include <limits>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

namespace cartilage {

namespace {

using kind = choice_field::kind;
using scale = choice_field::scale;
constexpr double infinity = std::numeric_limits<double>::infinity();

template <auto Member>
choice_field field(std::string_view name, kind type, std::string_view unit) {
    choice_field f;
    f.name = name;
    f.type = type;
    f.unit = unit;
    f.get = [](choices const& c) { return static_cast<double>(c.*Member); };
    f.set = [](choices& c, double value) {
        c.*Member = static_cast<std::remove_reference_t<decltype(c.*Member)>>(value);
    };
    return f;
}

/// Range of a number, and how it is varied.
struct number_range {
    double least, most;
    std::string_view rule;
    scale steps;
    std::vector<double> trials;
    std::array<double, 2> fit;
    double special = std::numeric_limits<double>::quiet_NaN();
};

template <auto Member>
choice_field number(std::string_view name, std::string_view unit, number_range s, std::string_view reason) {
    choice_field f = field<Member>(name, kind::number, unit);
    f.least = s.least;
    f.most = s.most;
    f.special = std::isnan(s.special) ? s.least : s.special;
    f.rule = s.rule;
    f.steps = s.steps;
    f.trials = std::move(s.trials);
    f.fit = s.fit;
    f.reason = reason;
    return f;
}

template <auto Member>
choice_field word(std::string_view name, std::vector<std::string_view> words, std::string_view rule,
                  std::string_view reason) {
    choice_field f = field<Member>(name, kind::word, "");
    f.most = double(words.size() - 1);
    f.words = std::move(words);
    f.rule = rule;
    f.reason = reason;
    for (std::size_t k = 0; k < f.words.size(); ++k)
        if (double(k) != f.get(choices{})) f.trials.push_back(double(k));
    return f;
}

choice_field of_fluid(choice_field f) {
    f.fluid = true;
    return f;
}
choice_field stated(choice_field f) {
    f.stated = true;
    return f;
}

void add_specimen_fields(std::vector<choice_field>& f) {
    using c = choices;
    f.push_back(word<&c::packing>("packing", {"random", "lattice"}, "random or lattice",
                                  "The paper states neither how the particles were packed nor how densely."));
    f.push_back(word<&c::radii>("radii", {"random", "equal"}, "random or equal",
                                "Table 2 says random from 1.5 to 2 um; equal radii show the effect of the scatter."));
    f.push_back(word<&c::domain>("domain", {"120x300", "300x120"}, "120x300 or 300x120",
                                 "Table 2 gives length x height, but the specimens are 120 um thick (Fig. 7)."));
    f.push_back(number<&c::fibre_spacing>("fibre_spacing", "diameters",
                                          {2, 12, "a number from 2 to 12", scale::logarithmic, {3, 6}, {2.5, 8}},
                                          "Only Fig. 9 shows the distance between fibres."));
    choice_field layers = field<&c::fibre_layers>("fibre_layers", kind::count, "");
    layers.most = 100;
    layers.rule = "a whole number from 0 (as many as fit) to 100";
    layers.trials = {4, 8};
    layers.reason = "Only Fig. 9 shows the number of fibres.";
    f.push_back(std::move(layers));
    f.push_back(number<&c::middle_fibre_length>(
        "middle_fibre_length", "um", {15, 300, "a number from 15 to 300", scale::logarithmic, {30, 120}, {20, 150}},
        "The paper only says that the network of the middle zone is random."));
    f.push_back(
        number<&c::deep_fraction>("deep_fraction", "of the height",
                                  {0.1, 0.8, "a number from 0.1 to 0.8", scale::linear, {0.25, 0.45}, {0.2, 0.5}},
                                  "The thickness of the zones of the whole specimen is not given."));
    f.push_back(
        number<&c::surface_fraction>("surface_fraction", "of the height",
                                     {0.1, 0.8, "a number from 0.1 to 0.8", scale::linear, {0.15, 0.45}, {0.15, 0.5}},
                                     "The thickness of the zones of the whole specimen is not given."));
    f.push_back(number<&c::fill>("fill", "area fraction",
                                 {0.6, 1, "a number from 0.6 to 1", scale::linear, {0.78}, {0.75, 0.9}},
                                 "The density of the free particles is not given."));
    f.push_back(number<&c::contact_tolerance>(
        "contact_tolerance", "of the smaller radius",
        {1e-3, 0.05, "a number from 0.001 to 0.05", scale::logarithmic, {5e-3, 0.02}, {2e-3, 0.03}},
        "The largest gap between particles in contact is not given."));
    f.push_back(number<&c::thickness>("thickness", "um",
                                      {0.1, 1e6, "a number from 0.1 to 1e6", scale::logarithmic, {1.75, 7}, {0.5, 20}},
                                      "The model is plane; its thickness out of the plane is not given."));
    f.push_back(word<&c::mass>("mass", {"disc", "sphere"}, "disc or sphere",
                               "Table 1 gives densities, but not the volume of a particle of given radius."));
}

void add_interaction_fields(std::vector<choice_field>& f) {
    using c = choices;
    f.push_back(word<&c::bond_area>("bond_area", {"disc", "strip"}, "disc (pi r^2) or strip (2 r t)",
                                    "The area A_c of the failure criterion is not given."));
    f.push_back(number<&c::bond_moment>(
        "bond_moment", "of a parallel bond's",
        {0, 10, "a number from 0 (none) to 10", scale::linear, {0.25, 1}, {0, 10}},
        "The paper's bonds carry no moment, but a fibre without bending stiffness is a chain of hinges."));
    f.push_back(number<&c::fibre_links>("fibre_links", "of the fibres' strength",
                                        {0, 10, "a number from 0 (none) to 10", scale::linear, {0.5, 1}, {0, 3}},
                                        "The paper does not say whether fibres are bonded where they touch."));
    f.push_back(number<&c::matrix_links>("matrix_links", "of the fibres' strength",
                                         {0, 10, "a number from 0 (none) to 10", scale::linear, {0.5, 1}, {0, 3}},
                                         "The paper does not say whether fibres are bonded to free particles."));
    f.push_back(
        stated(number<&c::friction>("friction", "", {0, 2, "a number from 0 to 2", scale::linear, {0, 0.5}, {0, 1}},
                                    "Table 1 gives 0.1; varied to show its effect.")));
    f.push_back(number<&c::local_damping>(
        "local_damping", "of the force", {0, 0.9, "a number from 0 (none) to 0.9", scale::linear, {0.2, 0.7}, {0, 0.8}},
        "The paper mentions no damping, but without damping nothing comes to rest."));
}

void add_load_fields(std::vector<choice_field>& f) {
    using c = choices;
    f.push_back(word<&c::load_area>("load_area", {"disc", "strip"}, "disc (pi r^2) or strip (2 r t)",
                                    "The area that turns the load in MPa into a force on a particle is not given."));
    f.push_back(word<&c::load>("load", {"free", "platen"}, "free or platen",
                               "The paper's load is uniform; the experiment loads with a plate (Fig. 7)."));
    f.push_back(number<&c::ramp_time>("ramp_time", "ns",
                                      {0, 1e3, "a number from 0 to 1000", scale::linear, {2, 8}, {0, 20}},
                                      "The paper does not say whether the load is sudden or ramped."));
    f.push_back(number<&c::wall_distance>("wall_distance", "diameters",
                                          {0, 100, "a number from 0 (confined) to 100", scale::linear, {0, 8}, {0, 10}},
                                          "The paper's walls at 2 diameters only stop particles that splash."));
    f.push_back(number<&c::duration>("duration", "ns",
                                     {1e-3, 1e9, "a number from 0.001 to 1e9, or 0 (until quiet)", scale::logarithmic,
                                      {5, 20}, {1, 20}, 0},
                                     "The duration of the load is not given."));
    f.push_back(number<&c::longest>("longest", "ns",
                                    {0.1, 1e4, "a number from 0.1 to 10000", scale::logarithmic, {20, 80}, {5, 80}},
                                    "Time limit for specimens that do not become quiet."));
    f.push_back(
        number<&c::quiet_fraction>("quiet_fraction", "of the largest kinetic energy",
                                   {1e-8, 1, "a number from 1e-8 to 1", scale::logarithmic, {1e-4, 0.01}, {1e-5, 0.1}},
                                   "The criterion of equilibrium is not given."));
    f.push_back(number<&c::quiet_time>("quiet_time", "ns",
                                       {0, 1e4, "a number from 0 to 10000", scale::linear, {5, 40}, {0, 40}},
                                       "The time without breaks that counts as equilibrium is not given."));
}

void add_fluid_fields(std::vector<choice_field>& f) {
    using c = choices;
    f.push_back(of_fluid(number<&c::conductivity>(
        "conductivity", "m/(s Pa)",
        {1e-15, 1e3, "a number from 1e-15 to 1000", scale::logarithmic, {1e-3, 83}, {1e-12, 100}},
        "Table 2's conductivity factor 1e-9 has no unit; water has 1/(12 mu) = 83 m/(s Pa).")));
    f.push_back(of_fluid(number<&c::aperture>(
        "aperture", "nm", {0.1, 1e4, "a number from 0.1 to 10000", scale::logarithmic, {1, 100}, {1, 1000}},
        "The aperture a of eq. 14 at zero force is not given.")));
    f.push_back(of_fluid(number<&c::half_force>(
        "half_force", "N", {1e-9, 1, "a number from 1e-9 to 1", scale::logarithmic, {1e-5, 1e-3}, {1e-6, 1e-2}},
        "The effect of a force on the aperture is not given.")));
    f.push_back(
        of_fluid(number<&c::gap_factor>("gap_factor", "", {0, 1, "a number from 0 to 1", scale::linear, {0}, {0, 1}},
                                        "The effect of a gap on the aperture is not given.")));
    f.push_back(of_fluid(number<&c::merge_conductance>(
        "merge_conductance", "m^3/(s Pa)",
        {1e-40, 1, "a number from 1e-40 to 1, or inf (none)", scale::logarithmic, {1e-27}, {1e-32, 1e-20}, infinity},
        "The conductance above which pores merge (Fig. 5b) is not given.")));
    f.push_back(of_fluid(number<&c::minimum_pressure>(
        "minimum_pressure", "Pa",
        {-1e12, 0, "a number from -1e12 to 0, or -inf (the fluid never tears)", scale::linear, {0}, {-1e7, 0},
         -infinity},
        "The paper does not say whether the water can be in tension.")));
    f.push_back(of_fluid(word<&c::drainage>("drainage", {"top_and_sides", "top", "sealed"},
                                            "top_and_sides, top or sealed",
                                            "The drained boundaries are not given.")));
}

std::vector<choice_field> make_fields() {
    std::vector<choice_field> fields;
    add_specimen_fields(fields);
    add_interaction_fields(fields);
    add_load_fields(fields);
    add_fluid_fields(fields);
    return fields;
}

/// " (did you mean fill?)", or nothing.
std::string suggestion(std::string_view word, std::vector<std::string> const& known) {
    std::string const near = lacuna::nearest_word(word, known);
    return near.empty() ? "" : " (did you mean " + near + "?)";
}

double value_of(choice_field const& f, std::string_view text) {
    std::string const word(text);
    if (f.type == kind::word) {
        for (std::size_t k = 0; k < f.words.size(); ++k)
            if (f.words[k] == text) return double(k);
        lacuna::refuse(f.name, word.empty() ? "''" : word,
                       std::string(f.rule) + suggestion(word, {f.words.begin(), f.words.end()}));
    }
    auto const value = lacuna::number_of(word);
    bool const whole = f.type != kind::count || (value && *value == std::floor(*value));
    if (!value || !whole) lacuna::refuse(f.name, word.empty() ? "''" : word, f.rule);
    return *value;
}

} // namespace

std::string choice_field::text(double value) const {
    if (type == kind::word) return std::string(words.at(static_cast<std::size_t>(value)));
    return lacuna::to_text(value);
}

std::string choice_field::text(choices const& c) const { return text(get(c)); }

void choice_field::validate(double value) const {
    if (!(value >= least && value <= most) && value != special) lacuna::refuse(name, value, rule);
}

std::vector<choice_field> const& choice_fields() {
    static std::vector<choice_field> const fields = make_fields();
    return fields;
}

choice_field const& find_choice(std::string_view name) {
    for (choice_field const& f : choice_fields())
        if (f.name == name) return f;
    std::string rule = "one of";
    std::vector<std::string> names;
    for (choice_field const& f : choice_fields()) {
        rule += (names.empty() ? " " : ", ") + std::string(f.name);
        names.emplace_back(f.name);
    }
    lacuna::refuse("name of a choice", name.empty() ? "''" : name, rule + suggestion(name, names));
}

void validate(choices const& c) {
    for (choice_field const& f : choice_fields()) f.validate(f.get(c));
    double const ends = c.deep_fraction + c.surface_fraction;
    if (!(ends <= 0.9)) lacuna::refuse("deep_fraction + surface_fraction", ends, "at most 0.9");
    if (c.minimum_pressure > -infinity && (c.bond_moment > 0 || flows_fast(c)))
        lacuna::refuse("minimum_pressure", c.minimum_pressure,
                       "-inf with a bond_moment or a conductivity above 1e-6, where the fluid is solved implicitly");
}

std::string text_of(choices const& c, bool all) {
    choices const plain;
    std::string lines;
    for (choice_field const& f : choice_fields()) {
        if (!all && f.get(c) == f.get(plain)) continue;
        lines.append(f.name).append(" = ").append(f.text(c)).append("\n");
    }
    return lines;
}

void set_choice(choices& c, std::string_view assignment) {
    auto const sign = assignment.find('=');
    if (sign == std::string_view::npos)
        lacuna::refuse("choice", assignment.empty() ? "''" : assignment, "of the form name=value");
    choice_field const& f = find_choice(lacuna::trimmed(assignment.substr(0, sign)));
    double const value = value_of(f, lacuna::trimmed(assignment.substr(sign + 1)));
    f.validate(value);
    f.set(c, value);
}

void set_choices(choices& c, std::string_view text, std::string const& origin) {
    choices changed = c;
    for (int line = 1; !text.empty(); ++line) {
        auto const end = text.find('\n');
        std::string_view one = text.substr(0, end);
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
        one = lacuna::trimmed(one.substr(0, one.find('#')));
        if (one.empty()) continue;
        try {
            set_choice(changed, one);
        } catch (std::invalid_argument const& bad) {
            throw std::invalid_argument(origin + ":" + std::to_string(line) + ": " + bad.what());
        }
    }
    validate(changed);
    c = changed;
}

} // namespace cartilage
