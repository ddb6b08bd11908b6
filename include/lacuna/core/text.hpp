// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <lacuna/core/error.hpp>

/// \file
/// Shared by readers of text files: bytes, words, numbers, and suggestions for misspelt words. Numbers are read by
/// std::from_chars and written by std::to_chars, which ignore the program's locale.

namespace lacuna {

/// Reads all bytes of a file.
/// \param name the field in the message
/// \throws std::invalid_argument naming the file if it cannot be read
inline std::string read_file(std::string const& path, std::string const& name) {
    std::FILE* const file = std::fopen(path.c_str(), "rb");
    std::string bytes;
    bool failed = file == nullptr;
    if (file != nullptr) {
        char buffer[65536];
        for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, file)) > 0;) bytes.append(buffer, count);
        failed = std::ferror(file) != 0; // also for a folder
        std::fclose(file);
    }
    if (failed) refuse(name, "\"" + path + "\"", "a file that can be read");
    return bytes;
}

/// The text of a file without a UTF-8 byte order mark at its start.
/// \param name of the file in messages
/// \throws std::invalid_argument for UTF-16, and for a NUL byte, with its line
inline std::string_view plain_text(std::string_view text, std::string const& name) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) refuse(name, "UTF-16", "a text in UTF-8");
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    auto const nul = text.find('\0');
    if (nul == std::string_view::npos) return text;
    auto const before = text.substr(0, nul);
    auto const lines = std::count(before.begin(), before.end(), before.find('\n') == before.npos ? '\r' : '\n');
    refuse(name + ":" + std::to_string(lines + 1), "a NUL byte", "text");
}

/// Removes the first line from a text and returns it in `line`, without its end (LF, CR LF or CR). False if the text is
/// empty.
inline bool take_line(std::string_view& text, std::string_view& line) {
    if (text.empty()) return false;
    auto const end = std::min(text.find_first_of("\r\n"), text.size());
    line = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + (text.substr(end).starts_with("\r\n") ? 2 : 1)));
    return true;
}

/// The text without blanks at its start and end.
inline std::string_view trimmed(std::string_view text) {
    auto const first = text.find_first_not_of(" \t\r");
    return first == text.npos ? text.substr(0, 0) : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The text with the letters A to Z in lower case.
inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

/// The words of a line, separated by blanks.
inline std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    for (std::size_t from = 0; (from = line.find_first_not_of(" \t\r", from)) != std::string_view::npos;) {
        auto const to = std::min(line.find_first_of(" \t\r", from), line.size());
        words.emplace_back(line.substr(from, to - from));
        from = to;
    }
    return words;
}

/// A word as messages show it: in quotes, with control characters as "\xNN"; the middle of a word over 60 bytes is left
/// out.
inline std::string in_quotes(std::string_view word) {
    constexpr std::size_t most = 60;
    std::string text = "\"";
    for (std::size_t k = 0; k < word.size(); ++k) {
        if (word.size() > most && k == most / 2) {
            text += "...";
            k = word.size() - most / 2;
        }
        auto const c = static_cast<unsigned char>(word[k]);
        constexpr char const* digits = "0123456789abcdef";
        if (c < 0x20 || c == 0x7F)
            text += std::string("\\x") + digits[c / 16] + digits[c % 16];
        else
            text += word[k];
    }
    return text + '"';
}

namespace detail {

/// Describes the first byte or character of a word that is not printable ASCII; empty if there is none.
inline std::string odd_character(std::string_view word) {
    auto const odd = std::find_if(word.begin(), word.end(), [](char c) { return c < 0x20 || c > 0x7E; });
    if (odd == word.end()) return {};
    auto const lead = static_cast<unsigned char>(*odd);
    char digits[16] = {};
    std::size_t const length = lead < 0xC0 || lead > 0xF7 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    if (length == 1 || word.end() - odd < std::ptrdiff_t(length)) {
        std::to_chars(digits, digits + sizeof digits, unsigned(lead), 16);
        return std::string(lead == 0 ? "a NUL byte" : "the byte 0x") + (lead == 0 ? "" : digits);
    }
    unsigned long point = lead & (0xFFu >> (length + 1));
    for (std::size_t k = 1; k < length; ++k)
        point = point << 6 | (static_cast<unsigned char>(odd[std::ptrdiff_t(k)]) & 0x3F);
    std::to_chars(digits, digits + sizeof digits, point, 16);
    std::string code = digits;
    for (char& c : code) c = c >= 'a' ? char(c - 'a' + 'A') : c;
    code.insert(0, code.size() < 4 ? 4 - code.size() : 0, '0');
    switch (point) {
    case 0xA0: case 0x2007: case 0x202F: return "a no-break space, U+" + code;
    case 0x2009: return "a thin space, U+2009";
    case 0x2212: return "a minus sign that is no hyphen, U+2212";
    case 0x2010: case 0x2011: case 0x2013: return "a dash that is no hyphen, U+" + code;
    case 0x2019: return "an apostrophe, U+2019";
    case 0xFEFF: return "an invisible byte order mark, U+FEFF";
    default: return "the character U+" + code;
    }
}

/// The rule for the refusal of a word that is not a number. It says what is wrong with the word if that is known.
inline std::string number_rule(std::string_view word) {
    if (std::string const odd = odd_character(word); !odd.empty()) return "a number; it has " + odd;
    std::string const lower = lower_case(word);
    auto const has = [&](std::string_view marks) { return lower.find_first_of(marks) != lower.npos; };
    bool const digits = has("0123456789");
    if (digits && lower.find("0x") != lower.npos) return "a decimal number, not a hexadecimal one";
    if (digits && lower.find_first_not_of("0123456789+-.d") == lower.npos)
        return "a number with \"e\" before its exponent, not \"d\"";
    if (digits && has("'_")) return "a number without marks between thousands";
    if (digits && has(",")) return "a number with a decimal point, without commas";
    return "a number";
}

/// True if a decimal number that is out of range is too small, false if it is too large.
inline bool is_tiny(std::string_view word) {
    auto const mark = std::min(word.find_first_of("eE"), word.size());
    std::string_view const mantissa = word.substr(0, mark);
    std::string_view exponent = word.substr(std::min(mark + 1, word.size()));
    bool const negative = exponent.starts_with('-');
    if (negative || exponent.starts_with('+')) exponent.remove_prefix(1);
    double power = 0; // a double: exponents may have many digits
    for (char const c : exponent) power = std::min(10 * power + (c - '0'), 1e9);
    auto const first = mantissa.find_first_of("123456789");
    if (first == mantissa.npos) return true;
    auto const point = std::min(mantissa.find('.'), mantissa.size());
    return (negative ? -power : power) + double(point) - double(first) < 0;
}

} // namespace detail

/// Reads a word as a decimal number; "inf" and "nan" are numbers, too. A number out of range gives 0 or infinity.
/// Returns nullopt for a word that is not a number.
inline std::optional<double> number_of(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
    double x = 0;
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (error == std::errc::invalid_argument || end != word.data() + word.size()) return std::nullopt;
    if (error == std::errc()) return x;
    bool const negative = word.starts_with('-');
    double const size = detail::is_tiny(word.substr(negative)) ? 0.0 : std::numeric_limits<double>::infinity();
    return negative ? -size : size;
}

/// Reads a whole word as a finite number.
/// \param field for the message
/// \throws std::invalid_argument for a word that is not a number or not finite; it says what is wrong if that is known
inline double read_number(std::string const& field, std::string_view word) {
    auto const x = number_of(word);
    if (!x) refuse(field, in_quotes(word), detail::number_rule(word));
    if (!std::isfinite(*x)) refuse(field, word, "finite");
    return *x;
}

/// Reads a whole number from `least` to `most`. \throws std::invalid_argument for any other word
inline long long read_whole(std::string const& field, std::string_view word, long long least, long long most) {
    double const x = read_number(field, word);
    std::string_view const digits = word.substr(word.starts_with('+'));
    long long n = 0;
    auto const [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    // "1.0" and "1e3" are whole numbers, too.
    if (error != std::errc() || end != digits.data() + digits.size())
        n = x == std::floor(x) && std::fabs(x) < 9e15 ? static_cast<long long>(x) : least - 1;
    if (n < least || n > most)
        refuse(field, word, "a whole number from " + std::to_string(least) +
                                (most < 2147483647 ? " to " + std::to_string(most) : std::string(" on")));
    return n;
}

/// Reads a whole number from `least` to 2^31 - 1. \throws std::invalid_argument for any other word
inline int read_integer(std::string const& field, std::string_view word, int least) {
    return int(read_whole(field, word, least, 2147483647));
}

/// Formats one number like printf in the locale "C". The format has one conversion %e, %f or %g, which may have the
/// flag + and a precision. \throws std::invalid_argument for another format
inline std::string formatted(std::string_view format, double value) {
    std::string text;
    bool done = false;
    for (std::size_t k = 0; k < format.size(); ++k) {
        if (format[k] != '%') {
            text += format[k];
            continue;
        }
        if (format.substr(k).starts_with("%%")) {
            text += format[k++];
            continue;
        }
        bool const plus = format.substr(k + 1).starts_with('+');
        k += plus ? 2 : 1;
        int digits = 6;
        if (format.substr(k).starts_with('.'))
            k = std::size_t(std::from_chars(format.data() + k + 1, format.data() + format.size(), digits).ptr -
                            format.data());
        auto const kind = format.substr(std::min(k, format.size()), 1).find_first_of("efg") == 0 ? format[k] : '?';
        if (done || kind == '?' || digits < 0 || digits > 100)
            refuse("format", in_quotes(format), "one conversion %e, %f or %g");
        done = true;
        char buffer[512];
        auto const form = kind == 'e'   ? std::chars_format::scientific
                          : kind == 'f' ? std::chars_format::fixed
                                        : std::chars_format::general;
        auto const end = std::to_chars(buffer, buffer + sizeof buffer, value, form, digits).ptr;
        if (plus && !std::signbit(value)) text += '+';
        text.append(buffer, end);
    }
    return text;
}

/// The known word that is nearest to `word` in Levenshtein's distance; empty if none is near.
inline std::string nearest_word(std::string_view word, std::vector<std::string> const& known) {
    std::string best;
    std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
    if (word.size() > 60) return best;
    for (std::string const& candidate : known) {
        // One row of the table of distances at a time.
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
