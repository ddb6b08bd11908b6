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
/// From arguments on the command line to numbers and models: what all commands have in common.

namespace cartilage {

/// The arguments that decide on a model, as written.
struct model_arguments {
    std::string preset = "literal", file, length, height, duration;
    std::vector<std::string> set;
    bool dry = false;
};

/// --preset, --choices, --set, --length and --height.
void add_model_options(CLI::App& app, model_arguments& args);
/// --dry and --duration, of commands that run a model.
void add_run_options(CLI::App& app, model_arguments& args);

/// The model that was asked for; zone, seed and load are left as they are. \throws usage_error
options understand_model(model_arguments const& args);

/// Lets CLI11 read the command line; false: help was asked for, and is on stdout. \throws usage_error
bool parse_arguments(CLI::App& app, int argc, char const* const* argv);
/// \throws std::invalid_argument for what is no zone, with the one that was meant
lacuna::cartilage_zone zone_of(std::string const& option, std::string const& word);
/// "a,b" in two; empty text has one empty part.
std::vector<std::string> parts_of(std::string const& list, char separator);

/// \throws usage_error "option word: must be rule"
[[noreturn]] void refuse(char const* option, std::string const& word, char const* rule);
/// \throws usage_error
double positive_number(char const* option, std::string const& word, char const* rule);
/// \throws usage_error
template <class Integer>
Integer whole_number(char const* option, std::string const& word, Integer least, Integer most, char const* rule) {
    Integer value{};
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < least || value > most)
        refuse(option, word, rule);
    return value;
}

} // namespace cartilage
