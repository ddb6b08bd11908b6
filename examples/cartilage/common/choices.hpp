// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// What the paper leaves open, as one set of values for all zones: the table of choices and their text form.
///
/// How the rest of the program uses it:
///   * `options` has a member `choices open`, filled by understand_model() from --preset, --choices FILE and --set
///     name=value, in this order; --duration is short for --set duration=NS. Packing, model and end of a run follow
///     from it and from the zone, load and seed: build_specimen(), model_parameters(), set_up().
///   * text_of(open) is the same for equal sets and different for different ones: a key for caches, a line in reports.
///   * choice_fields() walks over all of them: get() and set() as numbers, words by their place.
///   * Bonds between fibres and from fibres to free particles (cross links) come after those of the fibres in the list
///     of bonds, and a crack_record of one has fibre -1: they count neither as micro-cracks nor for a layer's damage.

namespace cartilage {

enum class packing_rule : std::uint8_t { random, lattice };
enum class radius_rule : std::uint8_t { random, equal };
enum class domain_rule : std::uint8_t { tall, wide };
enum class area_rule : std::uint8_t { disc, strip };
enum class mass_rule : std::uint8_t { disc, sphere };
enum class load_rule : std::uint8_t { free, platen };
enum class drainage_rule : std::uint8_t { top_and_sides, top, sealed };

/// One set of all open choices. Units and reasons: choice_fields(). The defaults are the preset `literal`.
struct choices {
    packing_rule packing = packing_rule::random;
    radius_rule radii = radius_rule::random;
    domain_rule domain = domain_rule::tall;
    double fibre_spacing = 4;
    int fibre_layers = 0;
    double middle_fibre_length = 60;
    double deep_fraction = 1.0 / 3;
    double surface_fraction = 1.0 / 3;
    double fill = 0.9;
    double contact_tolerance = 0.01;
    double thickness = 3.5;
    mass_rule mass = mass_rule::disc;

    area_rule bond_area = area_rule::strip;
    double bond_moment = 0;
    double fibre_links = 0;
    double matrix_links = 0;
    double friction = 0.1;
    double local_damping = 0;

    area_rule load_area = area_rule::disc;
    load_rule load = load_rule::free;
    double ramp_time = 0;
    double wall_distance = 2;
    double duration = 0;
    double longest = 40;
    double quiet_fraction = 1e-3;
    double quiet_time = 20;

    double conductivity = 1e-9;
    double aperture = 10;
    double half_force = 1e-4;
    double gap_factor = 1;
    double merge_conductance = never;
    double minimum_pressure = -never;
    drainage_rule drainage = drainage_rule::top_and_sides;

    static constexpr double never = std::numeric_limits<double>::infinity();
    friend bool operator==(choices const&, choices const&) = default;
};

/// One row of the table of choices.
struct choice_field {
    enum class kind : std::uint8_t { number, count, word };
    enum class scale : std::uint8_t { linear, logarithmic };

    std::string_view name;
    kind type = kind::number;
    std::string_view unit;               ///< empty: none
    double least = 0, most = 0;          ///< range, both ends allowed
    double special = 0;                  ///< allowed besides the range, with the meaning that `rule` gives; else in it
    std::string_view rule;               ///< range in words
    scale steps = scale::linear;         ///< how it is varied
    std::vector<std::string_view> words; ///< of a word: what it can be
    std::array<double, 2> fit{};         ///< of a number: between which values a calibration looks
    std::vector<double> trials;          ///< what a sensitivity study tries instead of the default; words by place
    bool stated = false;                 ///< the paper gives a value after all: never fitted
    bool fluid = false;                  ///< without effect in a dry run
    std::string_view reason;             ///< why it is open, one sentence
    double (*get)(choices const&) = nullptr;
    void (*set)(choices&, double) = nullptr; ///< without a check

    /// Value as text, as set_choice() reads it.
    std::string text(choices const& c) const;
    std::string text(double value) const;
    /// \throws std::invalid_argument naming the field, the value and the rule
    void validate(double value) const;
};

/// All choices, in the order of every table and text.
std::vector<choice_field> const& choice_fields();
/// \throws std::invalid_argument when there is none of that name
choice_field const& find_choice(std::string_view name);

/// \throws std::invalid_argument naming the field, the value and the rule
void validate(choices const& c);

/// Whether the fluid may flow too fast for the explicit scheme's steps: it is solved implicitly then.
inline bool flows_fast(choices const& c) { return c.conductivity > 1e-6; }

/// Lines "name = value\n" in the order of the table; without `all` only those that differ from the defaults.
std::string text_of(choices const& c, bool all = false);

/// Sets one choice from "name=value", blanks around both allowed.
/// \throws std::invalid_argument naming the field, the value and the rule
void set_choice(choices& c, std::string_view assignment);

/// Sets choices from text as text_of() writes it: one "name = value" a line; empty lines and what follows # count
/// for nothing. \param origin of the text, for messages. \throws std::invalid_argument
void set_choices(choices& c, std::string_view text, std::string const& origin);

} // namespace cartilage
