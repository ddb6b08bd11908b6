// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <lacuna/core/text.hpp>

#include "scenario.hpp"

namespace lacuna_run {
/// \throws refusal
void refuse_syntax(char const* broken);
}

// A bad file can break what toml++ 3.3 asserts (a table header that ends before its key): with assertions on that would end
// the program, with assertions off they are promises to the compiler. Here they are refusals; a compiled toml++ has its own.
#ifdef TOML_ASSERT
#error "toml++ is to be included by this header only"
#endif
#define TOML_HEADER_ONLY 1
#define TOML_ASSERT(condition) ((condition) ? void(0) : lacuna_run::refuse_syntax(#condition))
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace lacuna_run {

/// A value of the file and its full path, from which refusals are made.
struct value {
    toml::node const* node;
    std::string path;

    /// As it stands in the file, shortened: what refusals quote.
    std::string text() const;
    [[noreturn]] void refuse(std::string const& rule) const { lacuna_run::refuse(path, text(), rule); }

    /// \name Typed values. \throws refusal
    /// \{
    double number() const;
    double positive() const;
    double not_negative() const;
    long long integer(long long low, long long high, std::string const& rule) const;
    /// A number that counts something, of which there are `count`.
    std::int32_t index(std::size_t count, std::string const& of) const;
    bool flag() const;
    std::string string() const;
    /// One of the words, by its place among them.
    int word(std::initializer_list<char const*> words) const;
    std::vector<value> list() const;
    /// `dimension` numbers; the others are 0.
    point vector(int dimension) const;
    /// \}
};

/// A table of the file, all of whose keys are known.
class table {
public:
    /// \throws refusal for a value that is no table, or has a key that is not `known`
    table(value const& from, std::initializer_list<char const*> known);

    bool has(char const* key) const { return toml_->get(key) != nullptr; }
    /// \throws refusal when it is missing
    value operator[](char const* key) const;
    std::string path(char const* key) const { return path_.empty() ? key : path_ + "." + key; }

    double number(char const* key, double otherwise) const { return has(key) ? (*this)[key].number() : otherwise; }
    double positive(char const* key, double otherwise) const { return has(key) ? (*this)[key].positive() : otherwise; }
    double not_negative(char const* key, double otherwise) const {
        return has(key) ? (*this)[key].not_negative() : otherwise;
    }
    bool flag(char const* key, bool otherwise) const { return has(key) ? (*this)[key].flag() : otherwise; }
    int word(char const* key, std::initializer_list<char const*> words, int otherwise) const {
        return has(key) ? (*this)[key].word(words) : otherwise;
    }
    /// \throws refusal for a key that is there although it means nothing here
    void must_be_left_out(char const* key, std::string const& because) const {
        if (has(key)) (*this)[key].refuse("left out: " + because);
    }

private:
    toml::table const* toml_;
    std::string path_;
};

using lacuna::nearest_word;

} // namespace lacuna_run
