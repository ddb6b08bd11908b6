// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include <lacuna/core/error.hpp>

/// \file
/// What readers of text files share: bytes, words, numbers, and the word that was meant.

namespace lacuna {

/// The bytes of a file.
/// \param name of the file in the message
/// \throws std::invalid_argument naming the file when it cannot be read
inline std::string read_file(std::string const& path, std::string const& name) {
    std::FILE* const file = std::fopen(path.c_str(), "rb");
    std::string bytes;
    bool failed = file == nullptr;
    if (file != nullptr) {
        char buffer[65536];
        for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, file)) > 0;) bytes.append(buffer, count);
        failed = std::ferror(file) != 0; // of a folder, too
        std::fclose(file);
    }
    if (failed) refuse(name, "\"" + path + "\"", "a file that can be read");
    return bytes;
}

/// The words of a line, which blanks part.
inline std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    for (std::size_t from = 0; (from = line.find_first_not_of(" \t\r", from)) != std::string_view::npos;) {
        auto const to = std::min(line.find_first_of(" \t\r", from), line.size());
        words.emplace_back(line.substr(from, to - from));
        from = to;
    }
    return words;
}

/// A number that takes the whole word.
/// \param field for the message
/// \throws std::invalid_argument for what is no number, or not finite
inline double read_number(std::string const& field, std::string const& word) {
    char* end = nullptr;
    double const x = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0') refuse(field, "\"" + word + "\"", "a number");
    if (!std::isfinite(x)) refuse(field, word, "finite");
    return x;
}

/// A whole number from `least` to 2^31 - 1. \throws std::invalid_argument
inline int read_integer(std::string const& field, std::string const& word, int least) {
    double const x = read_number(field, word);
    if (x != std::floor(x) || x < least || x > 2147483647.0)
        refuse(field, word, "a whole number from " + std::to_string(least) + " on");
    return int(x);
}

/// The known word that is nearest to another, or an empty one when none is near.
inline std::string nearest_word(std::string_view word, std::vector<std::string> const& known) {
    std::string best;
    std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
    if (word.size() > 60) return best;
    for (std::string const& candidate : known) {
        // Levenshtein's distance, row by row.
        std::vector<std::size_t> row(candidate.size() + 1);
        std::iota(row.begin(), row.end(), std::size_t(0));
        for (std::size_t i = 1; i <= word.size(); ++i) {
            std::size_t diagonal = row[0];
            row[0] = i;
            for (std::size_t j = 1; j <= candidate.size(); ++j) {
                std::size_t const changed = diagonal + (word[i - 1] != candidate[j - 1]);
                diagonal = row[j];
                row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
            }
        }
        if (row.back() < least) {
            least = row.back();
            best = candidate;
        }
    }
    return best;
}

} // namespace lacuna
