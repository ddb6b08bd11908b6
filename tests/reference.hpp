// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// \file
/// Reads tests/reference/cases.json: values derived apart from this code, each with its formula, set-up and
/// tolerance. An id or a key that is not there is an error (std::out_of_range), never a silent zero.
///
///     reference("1a.t_c")                                        a number
///     reference("1b.zeta=0.1", "c")                              a number under a key
///     reference("8d.mixed_path", "psi=15", "kn=ks,sn=ss", 0)     keys and positions, as deep as needed
///     reference_list("2a.modes_fixed_fixed_N10")                 a row of numbers
///     reference_table("3b.patch_test", "G")                      rows of numbers
///     reference_text("5d.mass_identity", "identity")             a string

#ifndef LACUNA_REFERENCE_FILE
#define LACUNA_REFERENCE_FILE "tests/reference/cases.json"
#endif

namespace reference_detail {

inline nlohmann::json const& cases() {
    static nlohmann::json const all = [] {
        std::ifstream file(LACUNA_REFERENCE_FILE);
        if (!file) throw std::runtime_error("cannot read " LACUNA_REFERENCE_FILE);
        return nlohmann::json::parse(file);
    }();
    return all;
}

inline nlohmann::json const& step(nlohmann::json const& node, std::string const& key) {
    if (!node.is_object() || !node.contains(key)) throw std::out_of_range("reference: no key '" + key + "'");
    return node.at(key);
}
inline nlohmann::json const& step(nlohmann::json const& node, int position) {
    if (!node.is_array() || position < 0 || std::size_t(position) >= node.size())
        throw std::out_of_range("reference: no position " + std::to_string(position));
    return node.at(std::size_t(position));
}

} // namespace reference_detail

/// The value of case `id`, followed down its keys (text) and positions (int).
template <class... Keys>
nlohmann::json const& reference_node(std::string const& id, Keys const&... keys) {
    for (auto const& one : reference_detail::cases()) {
        if (one.at("id") != id) continue;
        nlohmann::json const* node = &one.at("value");
        ((node = &reference_detail::step(*node, keys)), ...);
        return *node;
    }
    throw std::out_of_range("reference: no case '" + id + "'");
}

template <class... Keys>
double reference(std::string const& id, Keys const&... keys) {
    auto const& node = reference_node(id, keys...);
    if (!node.is_number()) throw std::out_of_range("reference: '" + id + "' is not a number here");
    return node.template get<double>();
}

template <class... Keys>
std::vector<double> reference_list(std::string const& id, Keys const&... keys) {
    return reference_node(id, keys...).template get<std::vector<double>>();
}

template <class... Keys>
std::vector<std::vector<double>> reference_table(std::string const& id, Keys const&... keys) {
    return reference_node(id, keys...).template get<std::vector<std::vector<double>>>();
}

template <class... Keys>
std::string reference_text(std::string const& id, Keys const&... keys) {
    return reference_node(id, keys...).template get<std::string>();
}
