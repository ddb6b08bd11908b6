// SPDX-License-Identifier: BSD-3-Clause
#include "options.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <system_error>

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
    std::string zone, preset = "literal", load, seed = "1", length = "120", height = "300", duration, threads = "1";
    std::string out, picture_every;
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

void add_specimen_options(CLI::App& app, words& w) {
    app.add_option("--zone", w.zone, "surface, middle, deep or whole")->required()->type_name("ZONE");
    app.add_option("--seed", w.seed, "of the packing (1)")->type_name("N");
    app.add_option("--length", w.length, "of the specimen, horizontal (120)")->type_name("UM");
    app.add_option("--height", w.height, "of the specimen (300)")->type_name("UM");
    app.add_option("--preset", w.preset, "literal: as the paper says; lattice: equal radii, no chance (literal)")
        ->type_name("NAME");
    app.add_option("--out", w.out, "directory for the results (named after zone, load and seed)")->type_name("DIR");
    app.add_flag("--force", w.force, "replace the results that are in DIR");
    app.add_flag("--quiet", w.quiet, "no progress, no table");
}

lacuna::specimen_preset preset_of(std::string const& name) {
    if (name == "literal") return lacuna::specimen_preset::literal;
    if (name == "lattice") return lacuna::specimen_preset::lattice;
    refuse("--preset", name, "literal or lattice");
}

options understand(words const& w, command what) {
    options o;
    o.what = what;
    try {
        o.zone = lacuna::parse_cartilage_zone(w.zone);
    } catch (std::invalid_argument const&) {
        refuse("--zone", w.zone, "surface, middle, deep or whole");
    }
    o.preset = preset_of(w.preset);
    std::uint64_t const largest_seed = UINT64_MAX;
    o.seed = whole_number<std::uint64_t>("--seed", w.seed, 0, largest_seed, "a whole number >= 0");
    o.length_um = positive_number("--length", w.length, "a number of micrometres > 0");
    o.height_um = positive_number("--height", w.height, "a number of micrometres > 0");
    o.quiet = w.quiet;
    o.force = w.force;
    if (what == command::run) {
        o.load_MPa = positive_number("--load", w.load, "a number of MPa > 0");
        if (!w.duration.empty())
            o.duration_ns = positive_number("--duration", w.duration, "a number of nanoseconds > 0");
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
        if (what_m.rfind("specimen.height", 0) == 0) throw usage_error("--height " + w.height + ": " + what_m);
        if (what_m.rfind("specimen.length", 0) == 0) throw usage_error("--length " + w.length + ": " + what_m);
        throw usage_error(bad.what());
    }
    return o;
}

} // namespace

lacuna::cartilage_specimen_parameters options::specimen() const {
    lacuna::cartilage_specimen_parameters p;
    p.zone = zone;
    p.preset = preset;
    p.length = length_um / 1e6;
    p.height = height_um / 1e6;
    p.seed = seed;
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
