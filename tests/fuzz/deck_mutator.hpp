// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "key_table.hpp"

/// \file
/// Changes a deck of lacuna-run like a user's mistakes: a number, a word, a line, or a key from the table of keys.

namespace fuzz {

class deck_mutator {
public:
    explicit deck_mutator(unsigned seed) : random_(seed) {}

    std::string operator()(std::string deck) {
        for (unsigned k = 1 + below(3); k > 0; --k) change(deck);
        return deck;
    }

private:
    unsigned below(std::size_t count) { return unsigned(random_() % count); }
    template <class List>
    auto const& one_of(List const& list) {
        return list[below(std::size(list))];
    }

    void change(std::string& deck) {
        switch (below(8)) {
        case 0:
        case 1:
        case 2: return replace_number(deck);
        case 3: return remove_line(deck);
        case 4: return repeat_line(deck);
        case 5:
        case 6: return add_key(deck);
        default: return replace_word(deck);
        }
    }

    std::string number() {
        static constexpr char const* extremes[] = {
            "0",      "-0.0", "-1",    "1",    "2",     "3",    "0.5",        "1e308",       "-1e308",
            "5e-324", "1e30", "1e-30", "1e15", "1e-15", "1e7",  "2147483647", "-2147483648", "9223372036854775807",
            "1e400",  "nan",  "inf",   "0x10", "\"1\"", "true", "[]",         "[1.0]"};
        return one_of(extremes);
    }

    void replace_number(std::string& deck) {
        std::vector<std::pair<std::size_t, std::size_t>> found;
        for (std::size_t k = 0; k < deck.size();) {
            bool const begins =
                std::isdigit(static_cast<unsigned char>(deck[k])) &&
                (k == 0 || !(std::isalnum(static_cast<unsigned char>(deck[k - 1])) || deck[k - 1] == '_'));
            std::size_t end = k;
            while (begins && end < deck.size() &&
                   (std::isalnum(static_cast<unsigned char>(deck[end])) || deck[end] == '.'))
                ++end;
            if (begins) found.emplace_back(k, end - k);
            k = std::max(end, k + 1);
        }
        if (found.empty()) return;
        auto const [at, length] = one_of(found);
        std::string by = number();
        // A third of the new numbers are variations of the old one.
        if (below(3) == 0)
            by = deck.substr(at, length) + one_of(std::vector<std::string>{"e3", "e-3", "1", "e9", "e-9"});
        deck.replace(at, length, by);
    }

    std::vector<std::size_t> lines(std::string const& deck) const {
        std::vector<std::size_t> begins{0};
        for (std::size_t k = 0; k + 1 < deck.size(); ++k)
            if (deck[k] == '\n') begins.push_back(k + 1);
        return begins;
    }
    std::string line_at(std::string const& deck, std::size_t at) const {
        return deck.substr(at, std::min(deck.find('\n', at), deck.size() - 1) - at + 1);
    }
    void remove_line(std::string& deck) {
        if (deck.empty()) return;
        auto const at = one_of(lines(deck));
        deck.erase(at, line_at(deck, at).size());
    }
    void repeat_line(std::string& deck) {
        if (deck.empty()) return;
        auto const from = one_of(lines(deck)), to = one_of(lines(deck));
        deck.insert(to, line_at(deck, from));
    }

    /// A value, in most cases of the kind that the key needs.
    std::string value_of(lacuna_run::key const& k) {
        using lacuna_run::kind;
        if (below(8) == 0) return number();
        switch (k.what) {
        case kind::flag: return below(2) ? "true" : "false";
        case kind::word: {
            std::vector<std::string> words(1);
            for (char const* c = k.good.choices; *c != '\0'; ++c) {
                if (*c == '|')
                    words.emplace_back();
                else
                    words.back() += *c;
            }
            return "\"" + one_of(words) + "\"";
        }
        case kind::vector:
        case kind::two: return "[" + number() + ", " + number() + "]";
        case kind::points: return "[[" + number() + ", 0.0], [1.0, " + number() + "]]";
        case kind::pairs: return "[[0, 1], [1, " + number() + "]]";
        case kind::numbers: return "[0, " + number() + "]";
        case kind::table: return "{ }";
        case kind::tables: return "[ { } ]";
        case kind::step: return below(2) ? "\"auto\"" : number();
        case kind::text:
        case kind::each_text: return "\"m\"";
        default: return number();
        }
    }

    /// Adds a key of the table to its section, and the section if it is missing.
    void add_key(std::string& deck) {
        lacuna_run::key const& k = one_of(lacuna_run::keys);
        std::string const path = k.path;
        auto const dot = path.rfind('.');
        if (dot == std::string::npos) return;
        std::string section = path.substr(0, dot);
        bool const list = section.size() > 2 && section.substr(section.size() - 2) == "[]";
        for (std::size_t at; (at = section.find("[]")) != std::string::npos;) section.erase(at, 2);
        if (auto const star = section.find('*'); star != std::string::npos) section.replace(star, 1, "m");
        std::string const head = list ? "[[" + section + "]]\n" : "[" + section + "]\n";
        std::string const line = path.substr(dot + 1) + " = " + value_of(k) + "\n";
        auto const at = deck.find(head);
        if (at == std::string::npos)
            deck += "\n" + head + line;
        else
            deck.insert(at + head.size(), line);
    }

    void replace_word(std::string& deck) {
        std::vector<std::size_t> quotes;
        for (std::size_t k = 0; k < deck.size(); ++k)
            if (deck[k] == '"') quotes.push_back(k);
        if (quotes.size() < 2) return;
        std::size_t const first = 2 * below(quotes.size() / 2);
        static constexpr char const* words[] = {
            "none",  "float", "constant",      "implicit",    "drained",         "hertz_mindlin",        "top",
            "",      "m",     "pore.pressure", "throat.flow", "energy.residual", "contact.normal_force", "xyr",
            "sphere"};
        deck.replace(quotes[first] + 1, quotes[first + 1] - quotes[first] - 1, one_of(words));
    }

    std::minstd_rand random_;
};

} // namespace fuzz
