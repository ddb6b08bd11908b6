// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/report/html.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace cartilage {

std::string html_text(std::string_view plain) {
    std::string text;
    for (char const c : plain) {
        switch (c) {
        case '&': text += "&amp;"; break;
        case '<': text += "&lt;"; break;
        case '>': text += "&gt;"; break;
        case '"': text += "&quot;"; break;
        default: text += c;
        }
    }
    return text;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        std::size_t const left = bytes.size() - k;
        auto const byte = [&](std::size_t i) {
            return i < left ? unsigned(static_cast<unsigned char>(bytes[k + i])) : 0U;
        };
        unsigned const three = byte(0) << 16 | byte(1) << 8 | byte(2);
        text += letters[three >> 18];
        text += letters[three >> 12 & 63];
        text += left > 1 ? letters[three >> 6 & 63] : '=';
        text += left > 2 ? letters[three & 63] : '=';
    }
    return text;
}

std::string file_bytes(std::string const& path) {
    auto const close = [](std::FILE* file) { std::fclose(file); };
    std::unique_ptr<std::FILE, decltype(close)> const file(std::fopen(path.c_str(), "rb"), close);
    if (!file) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
    std::string bytes;
    char buffer[1 << 16];
    while (std::size_t const got = std::fread(buffer, 1, sizeof buffer, file.get())) bytes.append(buffer, got);
    if (std::ferror(file.get()) != 0) throw std::runtime_error("cannot read " + path);
    return bytes;
}

std::string html_picture(std::string const& path, std::string_view type, std::string_view alt) {
    return "<img alt=\"" + html_text(alt) + "\" src=\"data:" + std::string(type) + ";base64," +
           base64(file_bytes(path)) + "\">";
}

std::string html_table(std::string_view caption, std::vector<std::string> const& head,
                       std::vector<std::vector<std::string>> const& rows, table_cells cells) {
    std::string text = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + html_text(caption) +
                       (cells == table_cells::wrapped ? "\"><table class=\"wrapped\">" : "\"><table>") + "<caption>" +
                       html_text(caption) + "</caption>\n<thead><tr>";
    for (std::string const& cell : head) text += "<th scope=\"col\">" + html_text(cell) + "</th>";
    text += "</tr></thead>\n<tbody>\n";
    for (auto const& row : rows) {
        text += "<tr>";
        for (std::size_t k = 0; k < row.size(); ++k)
            text += (k == 0 ? "<th scope=\"row\">" : "<td>") + html_text(row[k]) + (k == 0 ? "</th>" : "</td>");
        text += "</tr>\n";
    }
    return text + "</tbody></table></div>\n";
}

} // namespace cartilage
