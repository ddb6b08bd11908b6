// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "toml_table.hpp"

namespace lacuna_run {

/// Decides which keys apply in a file, from the file as a whole.
class file_context {
public:
    explicit file_context(toml::table const& file) : file_(file) {
        // value<int>() of toml++ converts a floating-point number without a check of its range.
        auto const* whole = file_["simulation"]["dimension"].as_integer();
        dimension_ = whole && whole->get() == 3 ? 3 : 2;
        for (key const& row : keys) {
            std::string_view const all = row.path;
            auto const dot = all.rfind('.');
            below_[std::string(dot == all.npos ? "" : all.substr(0, dot))].emplace_back(all.substr(dot + 1), &row);
        }
    }

    void table(toml::table const& t, std::string const& path, std::string const& rows) const {
        auto const& known = below_.at(rows);
        for (auto const& [name, node] : t) {
            std::string const text(name.str());
            if (std::none_of(known.begin(), known.end(), [&](auto const& one) { return one.first == text; }))
                refuse_unknown({&node, path_of(path, text)}, text, known);
        }
        if (auto const* node = path.empty() ? t.get("simulation") : nullptr)
            entry(*find_key("simulation"), {node, "simulation"});
        // A key that must be left out is refused before the values of other keys.
        for (bool const applies : {true, false})
            for (auto const& [name, row] : known)
                if (auto const* node = t.get(name)) {
                    value const v{node, path_of(path, name)};
                    applies ? require_applicable(*row, v, t) : entry(*row, v);
                }
    }

    /// The first condition of a key that fails, or nullptr.
    condition const* broken(key const& row, toml::table const& beside) const {
        for (condition const& c : conditions)
            if ((row.where & c.what) != 0 && !holds(c.what, beside)) return &c;
        return nullptr;
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

    void require_applicable(key const& row, value const& v, toml::table const& beside) const {
        auto const* c = broken(row, beside);
        if (c == nullptr || *c->otherwise == '\0') return;
        auto const* list = v.node->as_array();
        bool const first = row.what == kind::tables && list && !list->empty();
        (first ? v.list()[0] : v).refuse(std::string("left out: ") + c->otherwise);
    }

    std::string word(char const* key, char const* standard) const {
        return file_["simulation"][key].value_or(std::string(standard));
    }
    bool bare() const { return bool(file_["fluid"]["network"]); }
    bool flow_alone() const { return bare() || !file_["fluid"]["mechanical_coupling"].value_or(true); }
    bool contacts() const { return !flow_alone() && word("contact_law", "frictional_spring") != "none"; }
    bool hertz() const { return contacts() && word("contact_law", "frictional_spring") == "hertz_mindlin"; }
    bool bonds() const {
        return !flow_alone() && word("bond_law", "brittle_spring") != "none" && file_.contains("bonds");
    }
    bool implicit() const { return file_["fluid"]["solver"].value_or(std::string()) == "implicit"; }
    bool is_number(char const* section) const { return file_[section]["time_step"].value_or(0.0) > 0; }

    /// Whether bonds take a value from the materials and not from `own_key` in [bonds].
    bool bonds_take(char const* own_key) const { return bonds() && !file_["bonds"][own_key]; }
    bool young(toml::table const& material) const { return hertz() && material.contains("young_modulus"); }

    bool has_gravity() const {
        auto const* g = file_["simulation"]["gravity"].as_array();
        return g && std::any_of(g->begin(), g->end(), [](auto const& x) { return x.value_or(0.0) != 0; });
    }

    /// The thickness enters the mass of discs, the volume of pores, and the areas of bonds and pressures.
    bool thickness_matters() const {
        if (word("mass", "disc") != "sphere" || file_.contains("fluid")) return true;
        if (auto const* all = file_["materials"].as_table(); all && bonds())
            for (auto const& [name, node] : *all)
                if (auto const* m = node.as_table())
                    if ((m->contains("tensile_strength") && bonds_take("tensile_force")) ||
                        (m->contains("shear_strength") && bonds_take("shear_force")))
                        return true;
        auto const* loads = file_["loads"].as_array();
        return loads && std::any_of(loads->begin(), loads->end(), [](toml::node const& one) {
                   auto const* load = one.as_table();
                   return load && load->contains("pressure") &&
                          (*load)["area"].value_or(std::string("strip")) == "strip";
               });
    }

    /// \param beside the table in which the key stands
    bool holds(needs what, toml::table const& beside) const {
        auto const is = [&](char const* key, char const* text) { return beside[key].value_or(std::string()) == text; };
        switch (what) {
        case always: return true;
        case in_plane: return dimension_ == 2;
        case with_particles: return !bare();
        case moving: return !flow_alone();
        case with_contacts: return contacts();
        case with_hertz: return hertz();
        case with_bonds: return word("bond_law", "brittle_spring") != "none";
        case with_parallel_bonds: return word("bond_law", "brittle_spring") == "parallel_bond";
        case bonds_for_it: return is("bond_law", "none") || file_.contains("bonds");
        case with_forces: return contacts() || bonds();
        case thickness_used: return thickness_matters();
        case gravity_given: return has_gravity();
        case own_step: return !(flow_alone() && is_number("fluid"));
        case auto_step: return !is_number("simulation") && !(flow_alone() && is_number("fluid"));
        case bounded_step: return !flow_alone() || (!implicit() && (is_number("simulation") || is_number("fluid")));
        case density_used:
        case material_used: return !flow_alone();
        case friction_used: return contacts();
        case normal_besides_young: return !young(beside) || bonds_take("normal_stiffness");
        case shear_besides_young: return !young(beside) || bonds_take("shear_stiffness");
        case normal_used: return contacts() || bonds_take("normal_stiffness");
        case shear_used: return contacts() || bonds_take("shear_stiffness");
        case tension_used: return bonds_take("tensile_force");
        case shearing_used: return bonds_take("shear_force");
        case no_young: return !beside.contains("young_modulus");
        case materials_named: return !flow_alone() || bool(file_["particles"]["file"]);
        case bonds_there: return bonds();
        case lasting_pores: return file_["fluid"]["remeshing"]["rule"].value_or(std::string()) != "when_needed";
        case remeshed: return is("rule", "when_needed");
        default: return holds_beside(what, beside);
        }
    }

    /// Conditions that depend on the key's own table.
    bool holds_beside(needs what, toml::table const& beside) const {
        auto const is = [&](char const* key, char const* text) { return beside[key].value_or(std::string()) == text; };
        switch (what) {
        case no_steps: return !beside.contains("steps");
        case young_given: return beside.contains("young_modulus");
        case no_file: return !beside.contains("file");
        case touching_bonds: return beside["touching"].value_or(false);
        case listed_bonds: return !beside["touching"].value_or(false);
        case no_velocity: return !beside.contains("velocity");
        case no_pressure: return !beside.contains("pressure");
        case pressure_given: return beside.contains("pressure");
        case drained: return is("boundary", "drained");
        case explicit_flow: return !implicit();
        case bare_network: return bare();
        case no_pore: return !beside.contains("pore");
        case no_throat: return !beside.contains("throat");
        case constant_aperture: return is("law", "constant");
        case contact_aperture: return is("law", "contact_force");
        default: return true;
        }
    }

    void entry(key const& row, value const& v) const {
        auto const each = [&](auto const& one) {
            for (value const& part : v.list()) one(part);
        };
        auto const each_or_one = [&](auto const& one) { v.node->is_array() ? each(one) : one(v); };
        auto const number = [&](value const& one) { (void)one.number(row.good); };
        auto const rotation = [&](value const& one) { dimension_ == 2 ? (void)one.number() : (void)one.vector(3); };
        switch (row.what) {
        case kind::table: sub_table(v, row.path); break;
        case kind::tables:
            each([&](value const& one) { sub_table(one, std::string(row.path) + "[]"); });
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
        case kind::rotation: rotation(v); break;
        case kind::points: each([&](value const& one) { (void)one.vector(dimension_); }); break;
        case kind::rotations: each(rotation); break;
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
    std::map<std::string, rows_below> below_; ///< the keys of each table, in the order of the rows
    int dimension_;
};

std::shared_ptr<file_context const> check_keys(toml::table const& file) {
    auto context = std::make_shared<file_context const>(file);
    context->table(file, "", "");
    return context;
}

bool is_applicable(file_context const& context, key const& row, toml::table const& beside) {
    return context.broken(row, beside) == nullptr;
}

} // namespace lacuna_run
