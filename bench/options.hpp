// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <exception>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Command line of benches that print a table or JSON, and the median of their rounds.

namespace bench {

/// Reads `--json` and options that take a whole number from 1 to 1024.
/// \param numbers names of options and the variables for their values
/// \return false for an unknown option or a bad value
inline bool read_options(int count, char** words, std::initializer_list<std::pair<char const*, int*>> numbers,
                         bool& json) {
    for (int k = 1; k < count; ++k) {
        std::string const name = words[k];
        if (name == "--json") {
            json = true;
            continue;
        }
        auto const known = std::find_if(numbers.begin(), numbers.end(), [&](auto const& n) { return name == n.first; });
        if (known == numbers.end() || k + 1 == count) return false;
        try {
            *known->second = std::stoi(words[++k]);
        } catch (std::exception const&) {
            return false;
        }
        if (*known->second < 1 || *known->second > 1024) return false;
    }
    return true;
}

/// Median of a list that is not empty.
inline double median(std::vector<double> list) {
    std::sort(list.begin(), list.end());
    return (list[(list.size() - 1) / 2] + list[list.size() / 2]) / 2;
}

} // namespace bench
