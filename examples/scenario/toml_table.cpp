// SPDX-License-Identifier: BSD-3-Clause
#include "toml_table.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace lacuna_run {

void refuse_syntax(char const* broken) { throw refusal(std::string("not a TOML file: ") + broken); }

std::string value::text() const {
    if (node == nullptr) return "(missing)";
    if (node->is_table()) return "{...}";
    if (auto const* list = node->as_array()) return list->empty() ? "[]" : "[...]";
    if (auto const* number = node->as_floating_point()) return lacuna::to_text(number->get());
    if (auto const* number = node->as_integer()) return std::to_string(number->get());
    if (auto const* one = node->as_boolean()) return one->get() ? "true" : "false";
    if (auto const* one = node->as_string()) {
        std::string quoted = "\"";
        for (char const c : one->get()) {
            if (quoted.size() > 60) {
                quoted += "...";
                break;
            }
            quoted += static_cast<unsigned char>(c) < 32 ? '?' : c;
        }
        return quoted + "\"";
    }
    return "a date or time";
}

double value::number() const {
    double found = 0;
    if (auto const* real = node->as_floating_point())
        found = real->get();
    else if (auto const* whole = node->as_integer())
        found = double(whole->get());
    else
        refuse("a number");
    if (!std::isfinite(found)) refuse("finite");
    return found;
}

double value::number(rule const& good) const {
    double const found = number();
    if (found < good.least || (found == good.least && good.above_least) || found > good.most) refuse(good.text);
    if (good.least == 0 && good.above_least && !std::isfinite(1 / found)) refuse("at least 1e-300");
    return found;
}

long long value::whole(rule const& good) const {
    return integer((long long)(good.least), (long long)(good.most), good.text);
}

long long value::whole_number() const {
    auto const* whole = node->as_integer();
    if (!whole) refuse("a whole number");
    return whole->get();
}

long long value::integer(long long low, long long high, std::string const& rule) const {
    long long const found = whole_number();
    if (found < low || found > high) refuse(rule);
    return found;
}

std::int32_t value::index(std::size_t count, std::string const& of) const {
    std::string const rule = count == 0 ? "left out: there are no " + of
                                        : "from 0 to " + std::to_string(count - 1) + ", the last of the " + of;
    return std::int32_t(integer(0, (long long)(count) - 1, rule));
}

bool value::flag() const {
    auto const* one = node->as_boolean();
    if (!one) refuse("true or false");
    return one->get();
}

std::string value::string() const {
    auto const* one = node->as_string();
    if (!one) refuse("a string");
    return one->get();
}

int value::word(std::string_view choices) const {
    auto const known = words_in(choices);
    std::string const found = node->is_string() ? string() : "";
    for (std::size_t index = 0; index < known.size() && node->is_string(); ++index)
        if (found == known[index]) return int(index);
    refuse("one of " + quoted(known) + did_you_mean(found, known));
}

std::vector<value> value::list() const {
    auto const* array = node->as_array();
    if (!array) refuse("a list");
    std::vector<value> found;
    for (std::size_t k = 0; k < array->size(); ++k)
        found.push_back({array->get(k), path + "[" + std::to_string(k) + "]", context});
    return found;
}

point value::vector(int dimension) const {
    auto const found = list();
    if (found.size() != std::size_t(dimension)) refuse("a list of " + std::to_string(dimension) + " numbers");
    point result{};
    for (std::size_t axis = 0; axis < found.size(); ++axis) result[axis] = found[axis].number();
    return result;
}

std::vector<std::string> words_in(std::string_view choices) {
    std::vector<std::string> words(1);
    for (char const c : choices)
        if (c == '|')
            words.emplace_back();
        else
            words.back() += c;
    return words;
}

std::string quoted(std::vector<std::string> const& words) {
    std::string text;
    for (std::string const& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
    return text;
}

std::string did_you_mean(std::string const& word, std::vector<std::string> const& known) {
    std::string const near = nearest_word(word, known);
    return near.empty() ? "" : " (did you mean \"" + near + "\"?)";
}

table::table(value const& from, std::string rows)
    : toml_(from.node->as_table()), context_(from.context), path_(from.path), rows_(std::move(rows)) {
    if (!toml_) from.refuse("a table");
}

value table::operator[](char const* key) const {
    value const found{toml_->get(key), path(key), context_};
    if (found.node == nullptr) found.refuse("given");
    return found;
}

std::string_view table::default_of(char const* key) const {
    auto const* row = find_key(rows_.empty() ? key : rows_ + "." + key);
    if (row == nullptr) throw std::logic_error("no row for the key " + path(key));
    if (std::string_view(row->default_value) != required) return row->default_value;
    if (is_applicable(*context_, *row, *toml_)) (void)(*this)[key];
    return "0";
}

double table::number(char const* key) const {
    if (has(key)) return (*this)[key].number();
    return lacuna::read_number(path(key), std::string(default_of(key)));
}

long long table::whole(char const* key) const {
    if (has(key)) return (*this)[key].whole_number();
    return (long long)(lacuna::read_number(path(key), std::string(default_of(key))));
}

bool table::flag(char const* key) const { return has(key) ? (*this)[key].flag() : default_of(key) == "true"; }

int table::word(char const* key) const {
    auto const text = has(key) ? (*this)[key].string() : std::string(default_of(key));
    auto const known = words_in(find_key(rows_ + "." + key)->good.choices);
    for (std::size_t index = 0; index < known.size(); ++index)
        if (text == known[index] || text == quoted({known[index]})) return int(index);
    (*this)[key].refuse("given");
}

point table::vector(char const* key, int dimension) const {
    if (has(key)) return (*this)[key].vector(dimension);
    (void)default_of(key);
    return {};
}

std::vector<value> table::list(char const* key) const {
    if (has(key)) return (*this)[key].list();
    (void)default_of(key);
    return {};
}

} // namespace lacuna_run
