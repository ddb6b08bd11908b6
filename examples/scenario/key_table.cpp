// SPDX-License-Identifier: BSD-3-Clause
#include "key_table.hpp"

#include <algorithm>
#include <vector>

#include "probes.hpp"

namespace lacuna_run {

namespace {

constexpr std::size_t width = 112, indent = 30;

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

/// Whether the section describes the key.
bool is_in(key const& k, std::string_view section) {
    std::string_view const path = k.path;
    // The rows of its keys describe a table without a meaning of its own.
    if ((k.what == kind::table || k.what == kind::tables) && *k.meaning == '\0') return false;
    return begins(path, section) && path.size() > section.size() && path.substr(section.size()) != ".*" &&
           (path[section.size()] == '.' || path[section.size()] == '[');
}

/// The key's path within its section: "density" of "materials.*.density".
std::string name_in(key const& k, std::string_view section) {
    std::string_view path = k.path;
    path.remove_prefix(section.size());
    for (std::string_view const lead : {"[]", ".*", "."})
        if (begins(path, lead)) path.remove_prefix(lead.size());
    return std::string(path);
}

/// Unit, choices or range, meaning and condition, as one line.
std::string description(key const& k, char const* quote) {
    std::string text;
    auto const add = [&](std::string const& part) {
        if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
    };
    add(k.unit);
    std::string choices = quote;
    for (char const* c = k.good.choices; *c != '\0'; ++c)
        *c == '|' ? choices += std::string(quote) + ", " + quote : choices += *c;
    if (*k.good.choices != '\0') add(choices + quote);
    add(k.good.text);
    add(k.meaning);
    for (condition const& c : conditions)
        if ((k.where & c.what) != 0) add(c.where);
    return text;
}

/// Breaks `head` and the words of `text` into lines; all but the first are indented.
std::string wrapped(std::string head, std::string const& text) {
    if (text.empty()) return head + "\n";
    head += head.size() + 2 > indent ? "\n" + std::string(indent, ' ') : std::string(indent - head.size(), ' ');
    std::string result, line = head;
    std::size_t column = indent;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t const end = std::min(text.find(' ', at), text.size());
        if (column > indent && column + 1 + (end - at) > width) {
            result += line + "\n";
            line.assign(indent, ' ');
            column = indent;
        }
        if (column > indent) line += ' ', ++column;
        line += text.substr(at, end - at);
        column += end - at;
        at = end + 1;
    }
    return result + line + "\n";
}

/// Whether a default is a TOML value and not a phrase.
bool is_toml(std::string const& default_value) {
    return default_value == "true" || default_value == "false" ||
           (!default_value.empty() && default_value.back() == '"') ||
           (!default_value.empty() && default_value.find_first_not_of("0123456789.e+-") == std::string::npos);
}

bool is_list(key const& k) { return k.what == kind::tables; }

std::string heading(std::string_view section) {
    key const& k = *find_key(section);
    std::string const name(section);
    if (k.what == kind::named) return "[" + name + ".NAME]";
    return is_list(k) ? "[[" + name + "]]" : "[" + name + "]";
}

std::string name_of(quantity_row const& q) {
    char const* const axes[] = {"", ".x|y|z", "[.x|y|z]"};
    return std::string(q.name) + axes[int(q.axes)];
}

std::string quantities_help() {
    std::string text = "  Quantities, and the key that selects the particle, bond, ...:\n";
    for (quantity_row const& q : quantities) {
        std::string description = q.unit;
        for (std::string const part : {key_of(q.of), q.meaning})
            if (!part.empty()) description += (description.empty() ? "" : "; ") + part;
        text += wrapped("    " + name_of(q), description);
    }
    return text;
}

} // namespace

std::string keys_help() {
    std::string text =
        "\nA scenario is one TOML file in SI units. \"name = value\" shows a key and its default.\n"
        "A key that has no effect together with the others is refused.\n"
        "\"Flow alone\": only fluid moves; fluid.network is given, or fluid.mechanical_coupling is false.\n";
    for (std::string_view const section : sections) {
        text += "\n" + wrapped(heading(section), description(*find_key(section), "\""));
        for (key const& k : keys) {
            if (!is_in(k, section)) continue;
            std::string head = "  " + name_in(k, section);
            std::string const default_value = k.default_value;
            std::string what = description(k, "\"");
            if (default_value == required)
                what = "(must be given) " + what;
            else if (is_toml(default_value))
                head += " = " + default_value;
            else if (!default_value.empty())
                what += (what.empty() ? "default: " : "; default: ") + default_value;
            if (k.what == kind::tables) head += " = [ { ... } ]";
            if (k.what == kind::table) head += " = { ... }";
            text += wrapped(head, what);
        }
        if (section == "probes") text += quantities_help();
    }
    return text +
           "\nExit status: 0 done, 1 a file could not be written, 2 the scenario is refused (nothing is written),\n"
           "3 the run became unstable (results so far are written), 130 and 143 stopped by Ctrl-C and SIGTERM\n"
           "(results so far are written, and --restart continues from there).\n";
}

std::string keys_markdown(std::string_view section) {
    std::string text = "| `" + heading(section) + "` | default | |\n| --- | --- | --- |\n";
    for (key const& k : keys) {
        if (!is_in(k, section)) continue;
        std::string const default_value = std::string_view(k.default_value) == required ? "–" : k.default_value;
        text += "| `" + name_in(k, section) + "` | " + default_value + " | " + description(k, "`") + " |\n";
    }
    return text;
}

std::string quantities_markdown() {
    std::string text = "| quantity | selected by | |\n| --- | --- | --- |\n";
    for (quantity_row const& q : quantities) {
        std::string axes = name_of(q), which = key_of(q.of);
        for (auto at = axes.find('|'); at != axes.npos; at = axes.find('|', at + 2)) axes.replace(at, 1, ", ");
        for (char const* const between : {", ", " or "})
            for (auto at = which.find(between); at != which.npos; at = which.find(between, at + 4))
                which.replace(at, std::string(between).size(), "`" + std::string(between) + "`");
        std::string description = q.unit;
        if (*q.meaning != '\0') description += (description.empty() ? "" : "; ") + std::string(q.meaning);
        text += "| `" + axes + "` | " + (which.empty() ? "" : "`" + which + "`") + " | " + description + " |\n";
    }
    return text;
}

} // namespace lacuna_run
