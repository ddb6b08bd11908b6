// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/common/option_parsing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

#include "cartilage/common/presets.hpp"
#include "command_line.hpp"

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
    if (text.empty()) refuse("--choices", path, "a file with lines \"name = value\", not an empty one");
    return std::string(lacuna::plain_text(text, path));
}

/// The table of the open choices for --help.
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

/// The choices of the preset, then of the file, then of the single settings.
choices read_choices(model_arguments const& args) {
    choices c;
    std::vector<std::string> presets;
    for (auto name : preset_names()) presets.emplace_back(name);
    c = preset_choices(presets[programs::index_of("--preset", args.preset, presets)]);
    if (!args.file.empty()) set_choices(c, contents_of(args.file), args.file);
    for (std::string const& one : args.set) {
        try {
            set_choice(c, one);
        } catch (std::invalid_argument const& bad) {
            throw usage_error(std::string("--set: ") + bad.what());
        }
    }
    if (!args.duration.empty())
        c.duration = positive_number("--duration", args.duration, "a number of nanoseconds > 0");
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

bool parse_arguments(CLI::App& app, int argc, char const* const* argv) {
    app.get_formatter()->column_width(28);
    auto const version = programs::version_text("cartilage");
    app.set_version_flag("--version", version);
    for (auto* command : app.get_subcommands([](CLI::App const*) { return true; }))
        command->set_version_flag("--version", version);
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
    return all_zones[programs::index_of(option, word, names)];
}

void add_model_options(CLI::App& app, model_arguments& args) {
    app.footer(choices_help());
    app.add_option("--length", args.length, "length of the specimen, horizontal, um (from the choice domain: 120)")
        ->type_name("UM");
    app.add_option("--height", args.height, "height of the specimen, um (from the choice domain: 300)")
        ->type_name("UM");
    app.add_option(
           "--preset", args.preset,
           "literal: as the paper states; lattice: equal radii on lattices, nothing random; calibrated: nearest to "
           "the paper's loads, for --dry (literal)")
        ->type_name("NAME");
    app.add_option("--choices", args.file, "file of choices that differ from the preset, one 'name = value' a line")
        ->type_name("FILE");
    app.add_option("--set", args.set, "one choice that differs from preset and file; may be repeated")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->allow_extra_args(false);
}

void add_run_options(CLI::App& app, model_arguments& args) {
    app.add_option("--duration", args.duration, "simulated time, ns (until quiet, at most 40)")->type_name("NS");
    app.add_flag("--dry", args.dry, "without pore fluid");
}

options model_options(model_arguments const& args) {
    options o;
    o.preset = args.preset;
    o.choices = read_choices(args);
    if (o.choices.duration > 0) o.duration_ns = o.choices.duration;
    bool const tall = o.choices.domain == domain_rule::tall;
    auto const extent = [](char const* option, std::string const& word, double plain) {
        return word.empty() ? plain : positive_number(option, word, "a number of micrometres > 0");
    };
    o.length_um = extent("--length", args.length, tall ? 120 : 300);
    o.height_um = extent("--height", args.height, tall ? 300 : 120);
    o.dry = args.dry;
    return o;
}

} // namespace cartilage
