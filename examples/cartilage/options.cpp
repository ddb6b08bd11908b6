// SPDX-License-Identifier: BSD-3-Clause
#include "options.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include <lacuna/core/version.hpp>

namespace cartilage {

namespace {

#define CARTILAGE_TEXT_OF(x) #x
#define CARTILAGE_TEXT(x) CARTILAGE_TEXT_OF(x)
constexpr char const* version_text = "cartilage, Lacuna " CARTILAGE_TEXT(LACUNA_VERSION_MAJOR) "." CARTILAGE_TEXT(
    LACUNA_VERSION_MINOR) "." CARTILAGE_TEXT(LACUNA_VERSION_PATCH);

/// The command line as written, before it is understood.
struct words {
    std::string zone, preset = "literal", load, seed = "1", length, height, duration, threads = "1";
    std::string out, picture_every, file;
    std::vector<std::string> set;
    bool dry = false, quiet = false, force = false;
};

[[noreturn]] void refuse(char const* option, std::string const& word, char const* rule) {
    throw usage_error(std::string(option) + " " + (word.empty() ? "''" : word) + ": must be " + rule);
}

double positive_number(char const* option, std::string const& word, char const* rule) {
    char* end = nullptr;
    double const value = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !(value > 0) || !std::isfinite(value)) refuse(option, word, rule);
    return value;
}

template <class Integer>
Integer whole_number(char const* option, std::string const& word, Integer least, Integer most, char const* rule) {
    Integer value{};
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < least || value > most)
        refuse(option, word, rule);
    return value;
}

void add_choice_options(CLI::App& app, words& w) {
    app.add_option("--preset", w.preset, "literal: as the paper says; lattice: equal radii, no chance (literal)")
        ->type_name("NAME");
    app.add_option("--choices", w.file, "file of choices that differ from the preset, a line 'name = value' each")
        ->type_name("FILE");
    app.add_option("--set", w.set, "one choice that differs; may be repeated")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->allow_extra_args(false);
}

void add_specimen_options(CLI::App& app, words& w) {
    app.add_option("--zone", w.zone, "surface, middle, deep or whole")->required()->type_name("ZONE");
    app.add_option("--seed", w.seed, "of the packing (1)")->type_name("N");
    app.add_option("--length", w.length, "of the specimen, horizontal (as the choice domain says: 120)")
        ->type_name("UM");
    app.add_option("--height", w.height, "of the specimen (as the choice domain says: 300)")->type_name("UM");
    add_choice_options(app, w);
    app.add_option("--out", w.out, "directory for the results (named after zone, load and seed)")->type_name("DIR");
    app.add_flag("--force", w.force, "replace the results that are in DIR");
    app.add_flag("--quiet", w.quiet, "no progress, no table");
}

std::string contents_of(std::string const& path) {
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) refuse("--choices", path, "a file that can be read");
    return text;
}

/// The choices of preset, file and single settings, in this order.
choices understand_choices(words const& w) {
    choices c;
    try {
        c = preset_choices(w.preset);
    } catch (std::invalid_argument const&) {
        std::string names;
        for (auto name : preset_names()) names += (names.empty() ? "" : " or ") + std::string(name);
        refuse("--preset", w.preset, names.c_str());
    }
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

options understand(words const& w, command what) {
    options o;
    o.what = what;
    try {
        o.zone = lacuna::parse_cartilage_zone(w.zone);
    } catch (std::invalid_argument const&) {
        refuse("--zone", w.zone, "surface, middle, deep or whole");
    }
    o.preset = w.preset;
    o.open = understand_choices(w);
    if (o.open.duration > 0) o.duration_ns = o.open.duration;
    std::uint64_t const largest_seed = UINT64_MAX;
    o.seed = whole_number<std::uint64_t>("--seed", w.seed, 0, largest_seed, "a whole number >= 0");
    bool const tall = o.open.domain == domain_rule::tall;
    auto const extent = [](char const* option, std::string const& word, double plain) {
        return word.empty() ? plain : positive_number(option, word, "a number of micrometres > 0");
    };
    o.length_um = extent("--length", w.length, tall ? 120 : 300);
    o.height_um = extent("--height", w.height, tall ? 300 : 120);
    o.quiet = w.quiet;
    o.force = w.force;
    if (what == command::run) {
        o.load_MPa = positive_number("--load", w.load, "a number of MPa > 0");
        o.threads = whole_number<int>("--threads", w.threads, 1, 1024, "a whole number from 1 to 1024");
        if (!w.picture_every.empty())
            o.picture_every = whole_number<long long>("--picture-every", w.picture_every, 1, 1LL << 60,
                                                      "a whole number of steps > 0");
        o.dry = w.dry;
    }
    o.out = w.out;
    if (o.out.empty()) {
        o.out = "cartilage-" + w.zone;
        if (what == command::run) o.out += "-" + lacuna::to_text(o.load_MPa) + "MPa";
        o.out += "-seed" + std::to_string(o.seed);
    }
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
    return o;
}

} // namespace

lacuna::cartilage_specimen_parameters options::specimen() const {
    lacuna::cartilage_specimen_parameters p;
    p.zone = zone;
    p.preset = open.packing == packing_rule::lattice ? lacuna::specimen_preset::lattice
                                                     : lacuna::specimen_preset::literal;
    p.length = length_um / 1e6;
    p.height = height_um / 1e6;
    p.seed = seed;
    if (open.radii == radius_rule::equal) p.r_min = p.r_max = p.diameter() / 2;
    p.fibre_spacing = open.fibre_spacing;
    p.middle_fibre_length = open.middle_fibre_length * 1e-6;
    p.deep_fraction = open.deep_fraction;
    p.surface_fraction = open.surface_fraction;
    p.middle_fraction = 1 - open.deep_fraction - open.surface_fraction;
    p.fill = open.fill;
    p.contact_tolerance = open.contact_tolerance;
    p.thickness = open.thickness / 1e6;
    p.wall_distance = open.wall_distance;
    return p;
}

std::optional<options> parse_command_line(int argc, char const* const* argv) {
    words w;
    CLI::App app("Articular cartilage under load: a bonded-particle model with pore fluid, after Hong, Evans and "
                 "Mente.\nResults go into a directory: summary.json, cracks.csv, pictures as PNG and SVG.\n"
                 "Exit status: 0 done, 2 bad request, 3 run became unstable, 130 interrupted.",
                 "cartilage");
    app.set_version_flag("--version", version_text);
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::simple);
    app.get_formatter()->column_width(28);

    CLI::App& run = *app.add_subcommand("run", "Load a specimen and see where it cracks");
    add_specimen_options(run, w);
    run.add_option("--load", w.load, "on the top row, at once")->required()->type_name("MPA");
    run.add_option("--duration", w.duration, "simulated time (until quiet, 40 at most)")->type_name("NS");
    run.add_option("--threads", w.threads, "the results do not depend on it (1)")->type_name("N");
    run.add_flag("--dry", w.dry, "without pore fluid");
    run.add_option("--picture-every", w.picture_every, "a damage picture every so many steps")->type_name("STEPS");

    CLI::App& pack = *app.add_subcommand("pack", "Build a specimen, draw it and give its statistics");
    add_specimen_options(pack, w);

    try {
        app.parse(argc, argv);
    } catch (CLI::Success const& wish) {
        app.exit(wish);
        return std::nullopt;
    } catch (CLI::ParseError const& bad) {
        std::string line = bad.what();
        for (char& c : line)
            if (c == '\n') c = ' ';
        throw usage_error(line);
    }
    return understand(w, run.parsed() ? command::run : command::pack);
}

} // namespace cartilage
