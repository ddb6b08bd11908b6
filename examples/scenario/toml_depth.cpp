// SPDX-License-Identifier: BSD-3-Clause
#include "toml_depth.hpp"

#include <algorithm>
#include <cstddef>

#include "scenario.hpp"

namespace lacuna_run {

namespace {

constexpr int most = 64;

/// Index behind the string that begins at `at`. An unclosed string ends at the end of its line or of the text.
std::size_t end_of_string(std::string_view text, std::size_t at) {
    char const quote = text[at];
    std::string const three(3, quote);
    bool const lines = text.substr(at, 3) == three;
    for (at += lines ? 3 : 1; at < text.size(); ++at) {
        if (text[at] == '\\' && quote == '"')
            ++at;
        else if (lines ? text.substr(at, 3) == three : text[at] == quote)
            return at + (lines ? 3 : 1);
        else if (!lines && text[at] == '\n')
            return at;
    }
    return text.size();
}

} // namespace

void require_shallow(std::string_view text, std::string const& name) {
    std::size_t counted = 0;
    long long line = 1;
    int depth = 0, parts = 0;
    auto const refuse_here = [&](std::string const& what) {
        throw refusal(name + ":" + std::to_string(line) + ": " + what);
    };
    for (std::size_t at = 0; at < text.size();) {
        std::size_t next = at + 1;
        switch (text[at]) {
        case '\0': refuse_here("a NUL byte: must be text"); break;
        case '"':
        case '\'': next = end_of_string(text, at); break;
        case '#': next = std::min(text.find('\n', at), text.size()); break;
        case '[':
        case '{':
            parts = 0;
            if (++depth > most) refuse_here("must be at most " + std::to_string(most) + " nested lists and tables");
            break;
        case ']':
        case '}': depth = depth > 0 ? depth - 1 : 0; break;
        case '.':
            if (++parts > most) refuse_here("must be keys of at most " + std::to_string(most) + " parts");
            break;
        case ',':
        case '=':
        case '\n': parts = 0; break;
        default: break;
        }
        for (; counted < next; ++counted) line += text[counted] == '\n';
        at = next;
    }
}

} // namespace lacuna_run
