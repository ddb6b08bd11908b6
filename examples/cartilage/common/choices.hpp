// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// The open choices: values that the model needs and the paper does not state. One set holds for all zones. This file
/// has the table of the choices and their text form.
///
/// How the rest of the program uses them:
///   * model_options() fills options::choices from --preset, then --choices FILE, then --set name=value. --duration is
///     short for --set duration=NS. Packing, model and end of a run follow from the choices, the zone, the load and the
///     seed: build_specimen(), model_parameters(), set_up().
///   * text_of() gives equal text for equal sets and different text for different sets. It is part of cache keys and
///     reports.
///   * choice_fields() lists all choices; get() and set() treat them as numbers, a word as its index in
///     choice_field::words.
///   * Cross links are bonds between fibres, or between a fibre and a free particle. They come after the fibres' bonds
///     in the list of bonds, and their crack_record has fibre -1. Their breaks count neither as micro-cracks nor as
///     damage of a layer.

namespace cartilage {

enum class packing_rule : std::uint8_t { random, lattice };
enum class radius_rule : std::uint8_t { random, equal };
enum class domain_rule : std::uint8_t { tall, wide };
enum class area_rule : std::uint8_t { disc, strip };
enum class mass_rule : std::uint8_t { disc, sphere };
enum class load_rule : std::uint8_t { free, platen };
enum class drainage_rule : std::uint8_t { top_and_sides, top, sealed };

/// One set of all open choices. choice_fields() has their units, ranges and reasons. The defaults are the preset
/// `literal`.
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
    double least = 0, most = 0;          ///< range, both ends included
    double special = 0;                  ///< allowed outside the range, explained by `rule`; none: as `least`
    std::string_view rule;               ///< range in words
    scale steps = scale::linear;         ///< scale on which a calibration varies a number
    std::vector<std::string_view> words; ///< of a word: its possible values
    std::array<double, 2> fit{};         ///< of a number: range that a calibration searches
    std::vector<double> trials;          ///< values that a sensitivity study tries besides the default; words by index
    bool stated = false;                 ///< the paper states a value, so that the choice is never fitted
    bool fluid = false;                  ///< without effect in a dry run
    std::string_view reason;             ///< why the choice is open, one sentence
    double (*get)(choices const&) = nullptr;
    void (*set)(choices&, double) = nullptr; ///< does not check the value

    /// The value as text that set_choice() reads.
    std::string text(choices const& c) const;
    std::string text(double value) const;
    /// \throws std::invalid_argument naming the field, the value and the rule
    void validate(double value) const;
};

/// All choices, in the order that every table and text uses.
std::vector<choice_field> const& choice_fields();
/// The choice of that name. \throws std::invalid_argument if there is none
choice_field const& find_choice(std::string_view name);

/// Checks each choice and those that depend on each other.
/// \throws std::invalid_argument naming the field, the value and the rule
void validate(choices const& c);

/// Whether the conductivity is too high for the explicit flow scheme. The fluid is then solved implicitly.
inline bool flows_fast(choices const& c) { return c.conductivity > 1e-6; }

/// Lines "name = value\n" in the order of the table. If `all` is false, only choices that differ from the defaults.
std::string text_of(choices const& c, bool all = false);

/// Sets one choice from "name=value". Blanks around name and value are ignored.
/// \throws std::invalid_argument naming the field, the value and the rule
void set_choice(choices& c, std::string_view assignment);

/// Sets choices from the text that text_of() writes: one "name = value" a line. Empty lines and comments after # are
/// ignored. `c` changes only if the whole text is valid. \param origin of the text, for messages
/// \throws std::invalid_argument with origin and line number
void set_choices(choices& c, std::string_view text, std::string const& origin);

} // namespace cartilage
