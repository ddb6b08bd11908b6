// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

/// \file
/// Tables in text files: cells separated by commas, semicolons, tabs or blanks, with or without quotes. Used by
/// particle_csv.hpp.

namespace lacuna::detail {

/// A line of a table.
struct csv_row {
    std::size_t line = 0;
    std::vector<std::string> cells{};
};

/// The cells of a line, without quotes around them and without blanks at their ends.
/// \param separator between cells; ' ' stands for any number of blanks
/// \throws std::invalid_argument for quotes that are not closed, or that close before the end of a cell
inline std::vector<std::string> csv_cells(std::string_view line, char separator, std::string const& where) {
    if (separator == ' ') return words_of(line);
    std::string_view const blanks = separator == '\t' ? " \r" : " \t\r";
    std::vector<std::string> found;
    for (std::size_t from = 0;;) {
        std::size_t end = std::min(line.find_first_not_of(blanks, from), line.size());
        std::string cell;
        if (end < line.size() && line[end] == '"') {
            std::size_t const first = end++;
            for (;; ++end) {
                if (end >= line.size()) refuse(where, in_quotes(line.substr(first)), "a cell whose quotes are closed");
                if (line[end] != '"') {
                    cell += line[end];
                } else if (line.substr(end + 1).starts_with('"')) {
                    cell += line[end++];
                } else {
                    break;
                }
            }
            cell = trimmed(cell);
            end = std::min(line.find_first_not_of(blanks, end + 1), line.size());
            if (end < line.size() && line[end] != separator)
                refuse(where, in_quotes(line.substr(first)), "a cell that ends with its quotes");
        } else {
            end = std::min(line.find(separator, from), line.size());
            cell = trimmed(line.substr(from, end - from));
        }
        found.push_back(std::move(cell));
        if (end >= line.size()) return found;
        from = end + 1;
    }
}

/// The separator of the cells of a heading: the first of semicolon, tab and comma that occurs outside quotes, or else
/// blanks.
inline char csv_separator(std::string_view heading) {
    std::string unquoted;
    bool inside = false;
    for (char const c : heading) {
        if (c == '"') inside = !inside;
        if (!inside) unquoted += c;
    }
    unquoted = trimmed(unquoted);
    for (char const mark : {';', '\t', ','})
        if (unquoted.find(mark) != unquoted.npos) return mark;
    return ' ';
}

/// Whether a cell begins like a number.
inline bool csv_starts_number(std::string_view cell) {
    return !cell.empty() && std::string_view("+-.,0123456789").find(cell[0]) != std::string_view::npos;
}

/// Whether a cell has one comma, which cannot be a separator of thousands.
inline bool has_decimal_comma(std::string_view cell) {
    if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
    auto const comma = cell.find(',');
    if (comma == cell.npos || cell.find(',', comma + 1) != cell.npos) return false;
    std::size_t const after = std::min(cell.find_first_not_of("0123456789", comma + 1), cell.size()) - comma - 1;
    return after != 3 || comma < 1 || comma > 3 || cell[0] == '0';
}

/// A table: the line that names its columns, and its rows.
struct csv_table {
    csv_row heading;
    std::vector<csv_row> rows;
    char separator = ',';

    /// Reads a text. The heading is its first line. If that is a row of numbers, the heading is a comment above it,
    /// such as "# x y z r", or Yade's with the word format and x_y_z_r. Other comments (#) and empty lines are skipped.
    /// \param name name of the file in messages
    /// \param is_heading callable (cells of a comment) -> whether they name columns
    /// \throws std::invalid_argument naming file and line
    template <class IsHeading>
    static csv_table read(std::string_view text, std::string const& name, IsHeading const& is_heading) {
        csv_table table;
        std::string_view line;
        std::size_t number = 0;
        text = plain_text(text, name);
        while (take_line(text, line)) {
            std::string const where = name + ":" + std::to_string(++number);
            line = trimmed(line);
            if (line.find_first_not_of(" \t\"") == line.npos) continue;
            bool const headed = !table.heading.cells.empty();
            if (line[0] == '#') {
                if (table.rows.empty()) table.try_comment(line.substr(1), number, where, is_heading);
            } else if (!headed ||
                       (table.from_comment_ && table.rows.empty() && !csv_starts_number(line.substr(line[0] == '"')))) {
                table.take_heading(line, number, where);
            } else {
                table.take_row(line, number, where);
            }
        }
        if (table.heading.cells.empty()) refuse(name, "(empty)", "a heading that names the columns, and rows");
        return table;
    }

    /// Whether the numbers of some columns have decimal commas.
    /// \throws std::invalid_argument if that is ambiguous: "1,000" may be one or a thousand
    bool has_decimal_commas(std::vector<std::size_t> const& columns, std::string const& name) const {
        csv_row const* first = nullptr;
        std::size_t at = 0;
        bool certain = false;
        for (csv_row const& row : rows)
            for (std::size_t const c : columns) {
                std::string const& cell = row.cells[c];
                if (cell.find('.') != cell.npos) return false;
                if (cell.find(',') == cell.npos) continue;
                if (first == nullptr) first = &row, at = c;
                certain = certain || has_decimal_comma(cell);
            }
        if (first != nullptr && !certain)
            refuse(name + ":" + std::to_string(first->line), in_quotes(first->cells[at]),
                   "a number without a comma, which may be a decimal comma or separate thousands");
        return certain;
    }

private:
    void take_heading(std::string_view line, std::size_t number, std::string const& where) {
        if (csv_starts_number(line.substr(line[0] == '"')))
            refuse(where, in_quotes(line), "a heading that names the columns, such as \"x,y,z,r\"");
        separator = csv_separator(line);
        heading = {number, csv_cells(line, separator, where)};
        from_comment_ = false;
        while (heading.cells.size() > 1 && heading.cells.back().empty()) heading.cells.pop_back();
    }
    template <class IsHeading>
    void try_comment(std::string_view line, std::size_t number, std::string const& where, IsHeading const& is_heading) {
        if (!heading.cells.empty() && !from_comment_) return;
        std::string text(trimmed(line));
        bool const yade = text.starts_with("format ");
        if (yade) {
            text.erase(0, 7);
            std::replace(text.begin(), text.end(), '_', ' ');
        }
        char const mark = csv_separator(text);
        std::vector<std::string> cells;
        try {
            cells = csv_cells(text, mark, where);
        } catch (std::invalid_argument const&) {
            return; // quotes that are not closed: a comment for readers
        }
        if (!yade && !is_heading(cells)) return;
        heading = {number, std::move(cells)};
        separator = mark;
        from_comment_ = true;
    }
    void take_row(std::string_view line, std::size_t number, std::string const& where) {
        csv_row row{number, csv_cells(line, separator, where)};
        auto const empty = [](std::string const& cell) { return cell.empty(); };
        if (std::all_of(row.cells.begin(), row.cells.end(), empty)) return;
        std::size_t const wanted = heading.cells.size();
        while (row.cells.size() > wanted && row.cells.back().empty()) row.cells.pop_back();
        if (row.cells.size() != wanted)
            refuse(where, std::to_string(row.cells.size()) + " cells",
                   "as many as the heading has, " + std::to_string(wanted) +
                       (row.cells.size() == 1 ? std::string(", separated by ") + mark_name() + " as there"
                                              : std::string()) +
                       (row.cells.size() > wanted && separator == ',' ? "; decimal commas need cells in quotes" : ""));
        rows.push_back(std::move(row));
    }
    char const* mark_name() const noexcept {
        return separator == ';' ? "semicolons" : separator == '\t' ? "tabs" : separator == ',' ? "commas" : "blanks";
    }

    bool from_comment_ = false;
};

} // namespace lacuna::detail
