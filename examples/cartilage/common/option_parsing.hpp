// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <string>
#include <system_error>
#include <vector>

#include "cartilage/common/options.hpp"

namespace CLI {
class App;
}

/// \file
/// Options that all commands share, and the parsing of their values.

namespace cartilage {

/// The arguments that determine a model, as text from the command line.
struct model_arguments {
    std::string preset = "literal", file, length, height, duration;
    std::vector<std::string> set;
    bool dry = false;
};

/// Adds --preset, --choices, --set, --length and --height.
void add_model_options(CLI::App& app, model_arguments& args);
/// Adds --dry and --duration, for commands that run a model.
void add_run_options(CLI::App& app, model_arguments& args);

/// The requested model. Zone, seed and load have their default values. \throws usage_error, std::invalid_argument
options model_options(model_arguments const& args);

/// Reads the command line with CLI11.
/// \return false if only help or the version was requested, which is then on stdout \throws usage_error
bool parse_arguments(CLI::App& app, int argc, char const* const* argv);
/// The zone of that name. \throws std::invalid_argument for other words, with the most similar zone
lacuna::cartilage_zone zone_of(std::string const& option, std::string const& word);
/// Splits a list at the separator. Empty text has one empty part.
std::vector<std::string> parts_of(std::string const& list, char separator);

/// \throws usage_error "option word: must be rule" in any case
[[noreturn]] void refuse(char const* option, std::string const& word, char const* rule);
/// A finite number > 0. \throws usage_error
double positive_number(char const* option, std::string const& word, char const* rule);
/// A whole number from `least` to `most`. \throws usage_error
template <class Integer>
Integer whole_number(char const* option, std::string const& word, Integer least, Integer most, char const* rule) {
    Integer value{};
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < least || value > most)
        refuse(option, word, rule);
    return value;
}

} // namespace cartilage
