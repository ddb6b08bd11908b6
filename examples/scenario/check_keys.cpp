// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "toml_table.hpp"

namespace lacuna_run {

namespace {

/// A file while it is checked: what tells which keys mean something.
class checker {
public:
    explicit checker(toml::table const& file) : file_(file) {
        auto const whole = file_["simulation"]["dimension"].value<long long>();
        dimension_ = whole && *whole == 3 ? 3 : 2;
        for (key const& row : keys) {
            std::string_view const all = row.path;
            auto const dot = all.rfind('.');
            below_[std::string(dot == all.npos ? "" : all.substr(0, dot))].emplace_back(all.substr(dot + 1), &row);
        }
    }

    void table(toml::table const& t, std::string const& path, std::string const& rows) const {
        auto const& known = below_.at(rows);
        for (auto const& [name, node] : t)
            if (std::none_of(known.begin(), known.end(), [&](auto const& one) { return one.first == name.str(); }))
                refuse_unknown({&node, path_of(path, name.str())}, std::string(name.str()), known);
        for (auto const& [name, row] : known) {
            auto const* node = t.get(name);
            if (node == nullptr) continue;
            value const v{node, path_of(path, name)};
            if (row->what != kind::tables || !node->is_array() || node->as_array()->empty()) must_mean_something(*row, v, t);
            entry(*row, v, t);
        }
    }

private:
    using rows_below = std::vector<std::pair<std::string, key const*>>;

    static std::string path_of(std::string const& path, std::string_view name) {
        return path.empty() ? std::string(name) : path + "." + std::string(name);
    }

    static void refuse_unknown(value const& v, std::string const& word, rows_below const& known) {
        std::vector<std::string> names;
        for (auto const& one : known) names.push_back(one.first);
        v.refuse("a known key" + did_you_mean(word, names));
    }

    void must_mean_something(key const& row, value const& v, toml::table const& beside) const {
        for (condition const& c : conditions)
            if ((row.where & c.what) != 0 && !holds(c.what, beside)) v.refuse(std::string("left out: ") + c.otherwise);
    }

    std::string word(char const* key, char const* standard) const {
        return file_["simulation"][key].value_or(std::string(standard));
    }

    /// \param beside the table in which the key stands
    bool holds(needs what, toml::table const& beside) const {
        auto const is = [&](char const* key, char const* text) { return beside[key].value_or(std::string()) == text; };
        switch (what) {
        case always: return true;
        case in_plane: return dimension_ == 2;
        case with_particles: return !file_["fluid"]["network"];
        case with_contacts: return word("contact_law", "frictional_spring") != "none";
        case with_hertz: return word("contact_law", "frictional_spring") == "hertz_mindlin";
        case with_bonds: return word("bond_law", "brittle_spring") != "none";
        case with_parallel_bonds: return word("bond_law", "brittle_spring") == "parallel_bond";
        case no_steps: return !beside.contains("steps");
        case no_file: return !beside.contains("file");
        case touching_bonds: return beside["touching"].value_or(false);
        case listed_bonds: return !beside["touching"].value_or(false);
        case young_given: return beside.contains("young_modulus");
        case no_velocity: return !beside.contains("velocity");
        case no_pressure: return !beside.contains("pressure");
        case pressure_given: return beside.contains("pressure");
        case drained: return is("boundary", "drained");
        case bare_network: return bool(file_["fluid"]["network"]);
        case no_pore: return !beside.contains("pore");
        case no_throat: return !beside.contains("throat");
        case constant_aperture: return is("law", "constant");
        case contact_aperture: return is("law", "contact_force");
        }
        return true;
    }

    void entry(key const& row, value const& v, toml::table const& beside) const {
        auto const each = [&](auto const& one) {
            for (value const& part : v.list()) one(part);
        };
        auto const each_or_one = [&](auto const& one) { v.node->is_array() ? each(one) : one(v); };
        auto const number = [&](value const& one) { (void)one.number(row.good); };
        auto const turn = [&](value const& one) { dimension_ == 2 ? (void)one.number() : (void)one.vector(3); };
        switch (row.what) {
        case kind::table: sub_table(v, row.path); break;
        case kind::tables:
            each([&](value const& one) {
                must_mean_something(row, one, beside);
                sub_table(one, std::string(row.path) + "[]");
            });
            break;
        case kind::named:
            if (!v.node->is_table()) v.refuse("a table of tables with names");
            for (auto const& [name, node] : *v.node->as_table())
                sub_table({&node, v.path + "." + std::string(name.str())}, std::string(row.path) + ".*");
            break;
        case kind::number: number(v); break;
        case kind::step:
            if (!v.node->is_string())
                number(v);
            else if (v.string() != "auto")
                v.refuse("\"auto\" or a number of seconds > 0");
            break;
        case kind::whole: (void)v.whole(row.good); break;
        case kind::flag: (void)v.flag(); break;
        case kind::word: (void)v.word(row.good.choices); break;
        case kind::quantity:
        case kind::text: (void)v.string(); break;
        case kind::vector: (void)v.vector(dimension_); break;
        case kind::turn: turn(v); break;
        case kind::points: each([&](value const& one) { (void)one.vector(dimension_); }); break;
        case kind::turns: each(turn); break;
        case kind::each_number: each_or_one(number); break;
        case kind::each_text: each_or_one([](value const& one) { (void)one.string(); }); break;
        case kind::numbers:
        case kind::two: each([](value const& one) { (void)one.whole_number(); }); break;
        case kind::pairs: each([](value const& one) { (void)one.list(); }); break;
        case kind::index: (void)v.whole_number(); break;
        }
    }

    void sub_table(value const& v, std::string const& rows) const {
        if (!v.node->is_table()) v.refuse("a table");
        table(*v.node->as_table(), v.path, rows);
    }

    toml::table const& file_;
    std::map<std::string, rows_below> below_; ///< of each table, in the order of the rows
    int dimension_;
};

} // namespace

void check_keys(toml::table const& file) { checker(file).table(file, "", ""); }

} // namespace lacuna_run
