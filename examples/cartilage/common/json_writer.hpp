// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include <lacuna/core/error.hpp>

namespace cartilage {

/// Writes JSON text, indented by two spaces: objects, arrays, texts, booleans and numbers.
class json_writer {
public:
    /// Opens an object or array: the value of `key`, or, if the key is empty, an element of an array or the whole text.
    json_writer& open(char bracket, std::string_view key = {}) {
        begin(key);
        text_ += bracket;
        ++depth_;
        first_ = true;
        return *this;
    }
    json_writer& close(char bracket) {
        --depth_;
        if (!first_) new_line();
        text_ += bracket;
        first_ = false;
        return *this;
    }
    json_writer& value(std::string_view key, std::string_view v) {
        begin(key);
        quote(v);
        return *this;
    }
    json_writer& value(std::string_view key, char const* v) { return value(key, std::string_view(v)); }
    json_writer& value(std::string_view key, std::string const& v) { return value(key, std::string_view(v)); }
    json_writer& value(std::string_view key, bool v) { return raw(key, v ? "true" : "false"); }
    /// JSON has no infinity and no NaN: both are written as null.
    json_writer& value(std::string_view key, double v) {
        return raw(key, std::isfinite(v) ? lacuna::to_text(v) : "null");
    }
    json_writer& value(std::string_view key, int v) { return raw(key, std::to_string(v)); }
    json_writer& value(std::string_view key, long long v) { return raw(key, std::to_string(v)); }
    json_writer& value(std::string_view key, unsigned long v) { return raw(key, std::to_string(v)); }
    json_writer& value(std::string_view key, unsigned long long v) { return raw(key, std::to_string(v)); }
    json_writer& null(std::string_view key) { return raw(key, "null"); }

    std::string text() const { return text_ + "\n"; }

private:
    json_writer& raw(std::string_view key, std::string_view v) {
        begin(key);
        text_ += v;
        return *this;
    }
    void begin(std::string_view key) {
        if (!first_) text_ += ',';
        if (depth_ > 0) new_line();
        first_ = false;
        if (key.empty()) return;
        quote(key);
        text_ += ": ";
    }
    void new_line() { text_ += '\n' + std::string(std::size_t(2 * depth_), ' '); }
    void quote(std::string_view v) {
        text_ += '"';
        for (char c : v) {
            if (c == '"' || c == '\\') {
                text_ += '\\';
                text_ += c;
            } else if (static_cast<unsigned char>(c) < 0x20) {
                char code[8];
                std::snprintf(code, sizeof code, "\\u%04x", unsigned(c));
                text_ += code;
            } else {
                text_ += c;
            }
        }
        text_ += '"';
    }

    std::string text_;
    int depth_ = 0;
    bool first_ = true;
};

} // namespace cartilage
