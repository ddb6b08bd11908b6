// SPDX-License-Identifier: BSD-3-Clause
#include "toml_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

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

double value::positive() const {
    double const found = number();
    if (!(found > 0)) refuse("> 0");
    return found;
}

double value::not_negative() const {
    double const found = number();
    if (!(found >= 0)) refuse(">= 0");
    return found;
}

long long value::integer(long long low, long long high, std::string const& rule) const {
    auto const* whole = node->as_integer();
    if (!whole) refuse("a whole number");
    if (whole->get() < low || whole->get() > high) refuse(rule);
    return whole->get();
}

std::int32_t value::index(std::size_t count, std::string const& of) const {
    std::string const rule =
        count == 0 ? "left out: there are no " + of : "from 0 to " + std::to_string(count - 1) + ", the last of the " + of;
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

int value::word(std::initializer_list<char const*> words) const {
    std::string rule;
    std::string const found = node->is_string() ? string() : "";
    int place = 0;
    for (char const* word : words) {
        if (node->is_string() && found == word) return place;
        rule += (place == 0 ? "\"" : ", \"") + std::string(word) + "\"";
        ++place;
    }
    refuse("one of " + rule);
}

std::vector<value> value::list() const {
    auto const* array = node->as_array();
    if (!array) refuse("a list");
    std::vector<value> found;
    for (std::size_t k = 0; k < array->size(); ++k)
        found.push_back({array->get(k), path + "[" + std::to_string(k) + "]"});
    return found;
}

point value::vector(int dimension) const {
    auto const found = list();
    if (found.size() != std::size_t(dimension)) refuse("a list of " + std::to_string(dimension) + " numbers");
    point result{};
    for (std::size_t axis = 0; axis < found.size(); ++axis) result[axis] = found[axis].number();
    return result;
}

table::table(value const& from, std::initializer_list<char const*> known)
    : toml_(from.node->as_table()), path_(from.path) {
    if (!toml_) from.refuse("a table");
    for (auto const& [key, node] : *toml_) {
        std::string const name(key.str());
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        std::string const near = nearest_word(name, {known.begin(), known.end()});
        std::string rule = "a known key";
        if (!near.empty()) rule += " (did you mean \"" + near + "\"?)";
        value{&node, path(name.c_str())}.refuse(rule);
    }
}

value table::operator[](char const* key) const {
    value const found{toml_->get(key), path(key)};
    if (found.node == nullptr) found.refuse("given");
    return found;
}

} // namespace lacuna_run
