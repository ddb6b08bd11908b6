// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include <lacuna/core/text.hpp>
#include <lacuna/core/version.hpp>

/// \file
/// What the command lines of all programs have in common: version, refusals in one line, the option that was meant.

namespace programs {

/// Name and version of a program, compiler and the optional components that it was built with.
inline std::string version_text(std::string const& program) {
    std::string text = program + " " + std::to_string(LACUNA_VERSION_MAJOR) + "." + std::to_string(LACUNA_VERSION_MINOR) + "." +
                       std::to_string(LACUNA_VERSION_PATCH);
#if defined(__clang__)
    text.append(", built by clang++ ").append(std::to_string(__clang_major__));
#elif defined(__GNUC__)
    text.append(", built by g++ ").append(std::to_string(__GNUC__)).append(".").append(std::to_string(__GNUC_MINOR__));
#endif
    std::string parts;
    auto const add = [&](char const* part) { parts.append(parts.empty() ? "" : ", ").append(part); };
#if defined(LACUNA_HAS_PORES)
    add("pores");
#endif
#if defined(LACUNA_HAS_PICTURES)
    add("pictures");
#endif
#if defined(LACUNA_HAS_CHECKPOINTS)
    add("checkpoints");
#endif
#if defined(LACUNA_HAS_COMPRESSION)
    add("compression");
#endif
#if defined(LACUNA_HAS_OPENMP)
    add("openmp");
#endif
    return text.append(", with ").append(parts.empty() ? "no components" : parts);
}

namespace detail {

/// The options, and the names of commands, that may stand on the command line of an app or of its commands.
inline void names_of(CLI::App const& app, std::vector<std::string>& options, std::vector<std::string>& commands) {
    for (auto const* option : app.get_options())
        for (std::string const& name : option->get_lnames()) options.push_back("--" + name);
    for (auto const* command : app.get_subcommands([](CLI::App const*) { return true; })) {
        commands.push_back(command->get_name());
        names_of(*command, options, commands);
    }
}

/// " (did you mean --force?)", or nothing, for the first word of a command line that nothing is called.
inline std::string meant(CLI::App const& app, int argc, char const* const* argv) {
    std::vector<std::string> options, commands;
    names_of(app, options, commands);
    auto const is = [](std::vector<std::string> const& names, std::string const& word) {
        return std::find(names.begin(), names.end(), word) != names.end();
    };
    for (int k = 1; k < argc; ++k) {
        std::string_view const all = argv[k];
        std::string const word(all.substr(0, all.find('=')));
        bool const option = word.size() > 2 && word.rfind("--", 0) == 0;
        bool const command = k == 1 && !commands.empty() && !word.empty() && word[0] != '-';
        if (!(option && !is(options, word)) && !(command && !is(commands, word))) continue;
        std::string const near = lacuna::nearest_word(word, option ? options : commands);
        return near.empty() ? "" : " (did you mean " + near + "?)";
    }
    return "";
}

} // namespace detail

/// Lets CLI11 read the command line.
/// \return false: help or the version was asked for, and is on stdout
/// \throws std::invalid_argument with one line
inline bool parse(CLI::App& app, int argc, char const* const* argv) {
    try {
        app.parse(argc, argv);
        return true;
    } catch (CLI::Success const& asked) {
        app.exit(asked);
        return false;
    } catch (CLI::ParseError const& bad) {
        std::string line = bad.what();
        std::replace(line.begin(), line.end(), '\n', ' ');
        throw std::invalid_argument(line + detail::meant(app, argc, argv));
    }
}

} // namespace programs
