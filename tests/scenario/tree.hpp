// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>

/// \file
/// Scenarios that tests build key by key.

/// A small TOML file as a tree: inline tables within inline tables.
struct tree {
    std::map<std::string, tree> below;
    std::string value;
    bool list = false;
    std::string further; ///< further entries of the list, ", { ... }"

    /// \param path "loads[].force", "materials.*.density"
    void set(std::string_view path, std::string const& to) {
        auto const dot = path.find('.');
        std::string name(path.substr(0, dot));
        bool const is_list = name.size() > 2 && name.substr(name.size() - 2) == "[]";
        if (is_list) name.resize(name.size() - 2);
        tree& one = below[name == "*" ? "matrix" : name];
        one.list = one.list || is_list;
        if (dot == path.npos)
            one.value = to;
        else
            one.set(path.substr(dot + 1), to);
    }
    /// The entry at that path, or nullptr.
    tree const* find(std::string_view path) const {
        auto const dot = path.find('.');
        std::string name(path.substr(0, dot));
        if (name.size() > 2 && name.substr(name.size() - 2) == "[]") name.resize(name.size() - 2);
        auto const at = below.find(name == "*" ? "matrix" : name);
        if (at == below.end()) return nullptr;
        return dot == path.npos ? &at->second : at->second.find(path.substr(dot + 1));
    }
    std::string text(bool outermost = true) const {
        if (below.empty()) return value;
        std::string all;
        for (auto const& [name, one] : below)
            all += (all.empty() ? "" : outermost ? "\n" : ", ") + name + " = " + one.text(false);
        return outermost ? all + "\n" : list ? "[ { " + all + " }" + further + " ]" : "{ " + all + " }";
    }
};

/// The key's path as in refusals.
inline std::string refused_path(std::string path) {
    for (auto const& [old, replacement] : {std::pair<std::string, std::string>{"[]", "[0]"}, {"*", "matrix"}})
        for (auto at = path.find(old); at != path.npos; at = path.find(old, at + replacement.size()))
            path.replace(at, old.size(), replacement);
    return path;
}
