// SPDX-License-Identifier: BSD-3-Clause
#include "words.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

#include "../command_line.hpp"
#include "presets.hpp"
#include "study_table.hpp"

namespace cartilage {

namespace {

/// \throws usage_error, std::invalid_argument
std::string contents_of(std::string const& path) {
    std::string text;
    try {
        text = lacuna::read_file(path, "--choices");
    } catch (std::invalid_argument const&) {
        refuse("--choices", path, "a file that can be read");
    }
    if (text.empty()) refuse("--choices", path, "a file with lines \"name = value\": it is empty");
    return std::string(lacuna::plain_text(text, path));
}

/// The open choices, for --help.
std::string choices_help() {
    std::string text = "Choices for --set and --choices, with defaults:\n";
    choices const plain;
    for (choice_field const& f : choice_fields()) {
        std::string line = "  " + std::string(f.name) + "=" + f.text(plain);
        if (!f.unit.empty()) line.append(" ").append(f.unit);
        if (line.size() < 40) line.resize(40, ' ');
        text.append(line).append("  ").append(f.rule).append("\n");
    }
    return text;
}

/// The choices of preset, file and single settings, in this order.
choices understand_choices(model_words const& w) {
    choices c;
    std::vector<std::string> presets;
    for (auto name : preset_names()) presets.emplace_back(name);
    c = preset_choices(presets[programs::place_of("--preset", w.preset, presets)]);
    if (!w.file.empty()) set_choices(c, contents_of(w.file), w.file);
    for (std::string const& one : w.set) {
        try {
            set_choice(c, one);
        } catch (std::invalid_argument const& bad) {
            throw usage_error(std::string("--set: ") + bad.what());
        }
    }
    if (!w.duration.empty()) c.duration = positive_number("--duration", w.duration, "a number of nanoseconds > 0");
    validate(c);
    return c;
}

} // namespace

void refuse(char const* option, std::string const& word, char const* rule) {
    throw usage_error(std::string(option) + " " + (word.empty() ? "''" : word) + ": must be " + rule);
}

double positive_number(char const* option, std::string const& word, char const* rule) {
    double const value = lacuna::number_of(word).value_or(0);
    if (!(value > 0) || !std::isfinite(value)) refuse(option, word, rule);
    return value;
}

bool parse_words(CLI::App& app, int argc, char const* const* argv) {
    auto const version = programs::version_text("cartilage");
    app.set_version_flag("--version", version);
    for (auto* command : app.get_subcommands([](CLI::App const*) { return true; })) command->set_version_flag("--version", version);
    try {
        return programs::parse(app, argc, argv);
    } catch (std::invalid_argument const& bad) {
        throw usage_error(bad.what());
    }
}

std::vector<std::string> parts_of(std::string const& list, char separator) {
    std::vector<std::string> parts(1);
    for (char const c : list)
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

lacuna::cartilage_zone zone_of(std::string const& option, std::string const& word) {
    std::vector<std::string> names;
    for (auto const zone : all_zones) names.emplace_back(lacuna::to_string(zone));
    return all_zones[programs::place_of(option, word, names)];
}

void add_model_options(CLI::App& app, model_words& w) {
    app.footer(choices_help());
    app.add_option("--length", w.length, "of the specimen, horizontal, um (as the choice domain says: 120)")
        ->type_name("UM");
    app.add_option("--height", w.height, "of the specimen, um (as the choice domain says: 300)")->type_name("UM");
    app.add_option("--preset", w.preset, "literal: as the paper says; lattice: equal radii, no chance; calibrated: nearest to the paper, if --dry (literal)")
        ->type_name("NAME");
    app.add_option("--choices", w.file, "file of choices that differ from the preset, a line 'name = value' each")
        ->type_name("FILE");
    app.add_option("--set", w.set, "one choice that differs; may be repeated")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->allow_extra_args(false);
}

void add_run_options(CLI::App& app, model_words& w) {
    app.add_option("--duration", w.duration, "simulated time, ns (until quiet, 40 at most)")->type_name("NS");
    app.add_flag("--dry", w.dry, "without pore fluid");
}

options understand_model(model_words const& w) {
    options o;
    o.preset = w.preset;
    o.open = understand_choices(w);
    if (o.open.duration > 0) o.duration_ns = o.open.duration;
    bool const tall = o.open.domain == domain_rule::tall;
    auto const extent = [](char const* option, std::string const& word, double plain) {
        return word.empty() ? plain : positive_number(option, word, "a number of micrometres > 0");
    };
    o.length_um = extent("--length", w.length, tall ? 120 : 300);
    o.height_um = extent("--height", w.height, tall ? 300 : 120);
    o.dry = w.dry;
    return o;
}

void validate_specimen(options const& o) {
    try {
        o.specimen().validate();
    } catch (std::invalid_argument const& bad) {
        std::string const what_m = std::string(bad.what()) + " m";
        if (what_m.rfind("specimen.height", 0) == 0)
            throw usage_error("--height " + lacuna::to_text(o.height_um) + ": " + what_m);
        if (what_m.rfind("specimen.length", 0) == 0)
            throw usage_error("--length " + lacuna::to_text(o.length_um) + ": " + what_m);
        throw usage_error(bad.what());
    }
}

} // namespace cartilage
