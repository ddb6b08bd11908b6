// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>

#include "cartilage/study/study_json.hpp"

namespace cartilage {

/// A value of a results file that may have been edited. Reading checks its type and range; an error names its path. It
/// refers to the value that contains it, which has to outlive it.
class stored_value {
public:
    explicit stored_value(json const& whole) : value_(&whole) {}

    /// \throws std::invalid_argument "path = value: must be rule"
    [[noreturn]] void refuse(std::string const& rule) const {
        std::string text = value_ == nullptr         ? "(missing)"
                           : value_->is_structured() ? "(a list or an object)"
                                                     : value_->dump();
        if (text.size() > 60) text = text.substr(0, 57) + "...";
        lacuna::refuse(path(), text, rule);
    }

    stored_value operator[](char const* key) const {
        if (!value_->is_object()) refuse("an object");
        auto const found = value_->find(key);
        stored_value part(found == value_->end() ? nullptr : &*found, this, key, 0);
        if (part.value_ == nullptr) part.refuse("given");
        return part;
    }
    /// Calls take(element) for each element of a list.
    template <class Take>
    void each(Take const& take) const {
        if (!value_->is_array()) refuse("a list");
        for (std::size_t k = 0; k < value_->size(); ++k) take(stored_value(&(*value_)[k], this, nullptr, k));
    }
    /// Calls take(row) for each `width` numbers of a flat list.
    template <class Take>
    void each_row(std::size_t width, Take const& take) const {
        if (!value_->is_array() || value_->size() % width != 0) refuse("a list in rows of " + std::to_string(width));
        for (std::size_t first = 0; first < value_->size(); first += width)
            take([&](std::size_t k) { return stored_value(&(*value_)[first + k], this, nullptr, first + k); });
    }
    bool is_null() const noexcept { return value_->is_null(); }

    double number() const {
        if (!value_->is_number()) refuse("a number");
        double const x = value_->get<double>();
        if (!std::isfinite(x)) refuse("finite");
        return x;
    }
    double number(double low, double high) const {
        double const x = number();
        if (!(x >= low && x <= high)) refuse("from " + lacuna::to_text(low) + " to " + lacuna::to_text(high));
        return x;
    }
    double positive() const {
        double const x = number();
        if (!(x > 0)) refuse("> 0");
        return x;
    }
    double not_negative() const { return number(0, std::numeric_limits<double>::max()); }
    template <class Integer>
    Integer integer(Integer low, Integer high) const {
        bool const good = value_->is_number_unsigned()  ? std::in_range<Integer>(value_->get<std::uint64_t>())
                          : value_->is_number_integer() ? std::in_range<Integer>(value_->get<std::int64_t>())
                                                        : false;
        Integer const n = good ? value_->get<Integer>() : Integer(0);
        if (!good || n < low || n > high)
            refuse("a whole number from " + std::to_string(low) + " to " + std::to_string(high));
        return n;
    }
    bool flag() const {
        if (!value_->is_boolean()) refuse("true or false");
        return value_->get<bool>();
    }
    std::string text() const {
        if (!value_->is_string()) refuse("a text");
        return value_->get<std::string>();
    }
    std::vector<double> numbers() const {
        std::vector<double> found;
        each([&](stored_value const& v) { found.push_back(v.number()); });
        return found;
    }
    /// A list of `count` numbers, or, if none_allowed is true, an empty list.
    std::vector<double> numbers(std::size_t count, bool none_allowed) const {
        auto found = numbers();
        if (found.size() != count && !(none_allowed && found.empty()))
            refuse("a list of " + std::to_string(count) + " numbers, not " + std::to_string(found.size()));
        return found;
    }

private:
    stored_value(json const* value, stored_value const* parent, char const* key, std::size_t index)
        : value_(value), parent_(parent), key_(key), index_(index) {}

    std::string path() const {
        if (parent_ == nullptr) return "the file";
        std::string const before = parent_->parent_ == nullptr ? "" : parent_->path();
        if (key_ == nullptr) return before + "[" + std::to_string(index_) + "]";
        return before.empty() ? key_ : before + "." + key_;
    }

    json const* value_;
    stored_value const* parent_ = nullptr;
    char const* key_ = nullptr;
    std::size_t index_ = 0;
};

} // namespace cartilage
