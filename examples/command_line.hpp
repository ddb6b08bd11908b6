// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#if __has_include(<unistd.h>)
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <CLI/CLI.hpp>

#include <lacuna/core/text.hpp>
#include <lacuna/core/version.hpp>

/// \file
/// Common parts of the programs' command lines: version, refusals in one line, suggestions for misspelt words.

namespace programs {

/// Name and version of a program, its compiler and its optional components.
inline std::string version_text(std::string const& program) {
    std::string text = program + " " + std::to_string(LACUNA_VERSION_MAJOR) + "." +
                       std::to_string(LACUNA_VERSION_MINOR) + "." + std::to_string(LACUNA_VERSION_PATCH);
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

/// " (did you mean --force?)", or "" if no known word is similar.
inline std::string meant(std::string const& word, std::vector<std::string> const& known) {
    std::string const near = lacuna::nearest_word(word, known);
    return near.empty() ? "" : " (did you mean " + near + "?)";
}
/// The words as "a, b or c".
inline std::string list_of(std::vector<std::string> const& words) {
    std::string text;
    for (std::size_t k = 0; k < words.size(); ++k)
        text += (k == 0 ? "" : k + 1 < words.size() ? ", " : " or ") + words[k];
    return text;
}
/// The index of a word among the known words.
/// \throws std::invalid_argument "--case word: must be a, b or c (did you mean b?)"
inline std::size_t index_of(std::string const& option, std::string const& word, std::vector<std::string> const& known) {
    auto const at = std::find(known.begin(), known.end(), word);
    if (at != known.end()) return std::size_t(at - known.begin());
    throw std::invalid_argument(option + " " + (word.empty() ? "''" : word) + ": must be " + list_of(known) +
                                meant(word, known));
}

/// Flushes stdout. A closed pipe is no error.
/// \throws std::runtime_error if stdout cannot be written, for example on a full disk
inline void finish_output() {
    errno = 0;
    std::cout.flush();
    bool const sound = std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (sound) return;
    int const reason = errno;
#if __has_include(<unistd.h>)
    struct stat out {};
    if (fstat(fileno(stdout), &out) == 0 && (S_ISFIFO(out.st_mode) || S_ISSOCK(out.st_mode))) return;
#endif
    throw std::runtime_error(std::string("cannot write to the standard output") +
                             (reason != 0 ? std::string(": ") + std::strerror(reason) : ""));
}

namespace detail {

/// Collects the options and commands of an app and of its commands.
inline void names_of(CLI::App const& app, std::vector<std::string>& options, std::vector<std::string>& commands) {
    for (auto const* option : app.get_options())
        for (std::string const& name : option->get_lnames()) options.push_back("--" + name);
    for (auto const* command : app.get_subcommands([](CLI::App const*) { return true; })) {
        commands.push_back(command->get_name());
        names_of(*command, options, commands);
    }
}

/// A message of one line about the first unknown word of a command line; empty if all words are known.
inline std::string unknown_word(CLI::App const& app, int argc, char const* const* argv) {
    std::vector<std::string> options, commands;
    names_of(app, options, commands);
    for (int k = 1; k < argc; ++k) {
        std::string_view const all = argv[k];
        std::string const word(all.substr(0, all.find('=')));
        bool const option = word.size() > 2 && word.rfind("--", 0) == 0;
        bool const command = k == 1 && !commands.empty() && !word.empty() && word[0] != '-';
        auto const& known = option ? options : commands;
        if ((!option && !command) || std::find(known.begin(), known.end(), word) != known.end()) continue;
        std::string const rule = option ? "an option: --help shows all" : list_of(commands);
        return word + ": must be " + rule + meant(word, known);
    }
    return "";
}

} // namespace detail

/// Lets CLI11 read the command line.
/// \return false if help or the version was requested and printed
/// \throws std::invalid_argument with a message of one line; std::runtime_error as finish_output()
inline bool parse(CLI::App& app, int argc, char const* const* argv) {
    try {
        app.parse(argc, argv);
        return true;
    } catch (CLI::Success const& asked) {
        app.exit(asked);
        finish_output();
        return false;
    } catch (CLI::ParseError const& bad) {
        std::string line = bad.what();
        std::replace(line.begin(), line.end(), '\n', ' ');
        std::string const unknown = detail::unknown_word(app, argc, argv);
        throw std::invalid_argument(unknown.empty() ? line : unknown);
    }
}

} // namespace programs
