// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

#include "particle_file.hpp"
#include "probes.hpp"
#include "scenario.hpp"
#include "toml_table.hpp"
#include "touching.hpp"

namespace lacuna_run {

namespace {

constexpr long long many = 1000000000000000LL;

settings read_settings(value const& from) {
    table const t(from, {"dimension", "real", "thickness", "mass", "contact_law", "bond_law", "integrator", "time_step",
                         "safety", "allow_unstable_step", "steps", "end_time", "gravity", "fluid_density", "threads", "damping"});
    settings s;
    if (t.has("dimension")) s.dimension = int(t["dimension"].integer(2, 3, "2 or 3"));
    s.single_precision = t.word("real", {"double", "float"}, 0) == 1;
    if (s.dimension == 3) t.must_be_left_out("thickness", "only discs have one (dimension = 2)");
    s.thickness = t.positive("thickness", 1);
    s.spheres = t.word("mass", {"disc", "sphere"}, s.dimension == 3) == 1;
    if (s.dimension == 3 && !s.spheres) t["mass"].refuse("\"sphere\" in three dimensions");
    s.contact = contact_law(t.word("contact_law", {"none", "frictional_spring", "hertz_mindlin"}, 1));
    s.bond = bond_law(t.word("bond_law", {"none", "brittle_spring", "parallel_bond"}, 1));
    s.velocity_verlet = t.word("integrator", {"symplectic_euler", "velocity_verlet"}, 0) == 1;
    if (t.has("time_step")) {
        value const step = t["time_step"];
        if (step.node->is_string()) {
            if (step.string() != "auto") step.refuse("\"auto\" or a number of seconds > 0");
        } else {
            s.time_step = step.positive();
        }
    }
    s.safety = t.positive("safety", 0.2);
    if (s.safety > 1) t["safety"].refuse("> 0 and <= 1");
    s.allow_unstable_step = t.flag("allow_unstable_step", false);
    if (t.has("steps") && t.has("end_time")) t["end_time"].refuse("left out: steps is given");
    if (t.has("end_time"))
        s.end_time = t["end_time"].positive();
    else
        s.steps = t["steps"].integer(0, many, "from 0 to 1e15");
    if (t.has("gravity")) s.gravity = t["gravity"].vector(s.dimension);
    s.fluid_density = t.not_negative("fluid_density", 0);
    if (t.has("threads")) s.threads = int(t["threads"].integer(1, 1024, "from 1 to 1024"));
    if (t.has("damping")) {
        table const damping(t["damping"], {"local", "mass", "viscous"});
        s.local_damping = damping.not_negative("local", 0);
        if (s.local_damping > 1) damping["local"].refuse("from 0 to 1");
        s.mass_damping = damping.not_negative("mass", 0);
        s.viscous_damping = damping.not_negative("viscous", 0);
    }
    return s;
}

/// Young's modulus and Poisson's ratio, of Hertzian contacts only.
template <class Body>
void read_elasticity(table const& t, settings const& s, Body& to) {
    if (s.contact != contact_law::hertz_mindlin)
        for (char const* key : {"young_modulus", "poisson_ratio"})
            t.must_be_left_out(key, "it belongs to contact_law = \"hertz_mindlin\"");
    if (t.has("young_modulus")) {
        to.young_modulus = t["young_modulus"].positive();
        to.poisson_ratio = t["poisson_ratio"].number();
        if (!(to.poisson_ratio > -1 && to.poisson_ratio <= 0.5)) t["poisson_ratio"].refuse("> -1 and <= 0.5");
    } else {
        t.must_be_left_out("poisson_ratio", "young_modulus is not given");
    }
}

std::vector<material> read_materials(value const& from, settings const& s) {
    auto const* all = from.node->as_table();
    if (!all) from.refuse("a table of materials");
    std::vector<material> found;
    for (auto const& [key, node] : *all) {
        material m;
        m.name = std::string(key.str());
        table const t({&node, from.path + "." + m.name},
                      {"density", "normal_stiffness", "shear_stiffness", "friction", "tensile_strength", "shear_strength",
                       "young_modulus", "poisson_ratio"});
        m.density = t["density"].positive();
        m.normal_stiffness = t["normal_stiffness"].positive();
        m.shear_stiffness = t["shear_stiffness"].not_negative();
        m.friction = t["friction"].not_negative();
        if (t.has("tensile_strength")) m.tensile_strength = t["tensile_strength"].not_negative();
        if (t.has("shear_strength")) m.shear_strength = t["shear_strength"].not_negative();
        read_elasticity(t, s, m);
        found.push_back(m);
    }
    if (found.empty()) from.refuse("at least one material");
    return found;
}

int material_number(value const& v, std::vector<material> const& materials) {
    std::string const name = v.string();
    std::vector<std::string> known;
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (materials[m].name == name) return int(m);
        known.push_back(materials[m].name);
    }
    std::string const near = nearest_word(name, known);
    v.refuse("the name of a material" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"));
}

/// One value for all particles or one for each.
template <class T, class Read>
std::vector<T> one_or_each(value const& v, std::size_t count, char const* of, Read const& read) {
    if (!v.node->is_array()) return std::vector<T>(count, read(v));
    auto const list = v.list();
    if (list.size() != count)
        v.refuse("one value or one per " + std::string(of) + ", of which there are " + std::to_string(count) + ", not " +
                 std::to_string(list.size()));
    std::vector<T> found;
    for (value const& one : list) found.push_back(read(one));
    return found;
}

std::vector<point> read_points(value const& v, int dimension) {
    std::vector<point> found;
    for (value const& one : v.list()) found.push_back(one.vector(dimension));
    return found;
}

std::vector<std::int32_t> read_numbers(value const& v, std::size_t particles) {
    std::vector<std::int32_t> found;
    for (value const& one : v.list()) found.push_back(one.index(particles, "particles"));
    return found;
}

fixed read_fix(value const& from, std::size_t particles, int dimension) {
    table const t(from, {"particles", "axes"});
    fixed f;
    f.particles = read_numbers(t["particles"], particles);
    value const axes = t["axes"];
    std::string const rule = dimension == 2 ? "some of the letters x, y, r" : "some of the letters x, y, z, r";
    std::string const letters = axes.string();
    if (letters.empty()) axes.refuse(rule);
    for (char const c : letters) {
        bool* const one = c == 'x' ? &f.x : c == 'y' ? &f.y : c == 'z' && dimension == 3 ? &f.z : c == 'r' ? &f.rotation : nullptr;
        if (one == nullptr || *one) axes.refuse(rule + (one ? ", each once" : ""));
        *one = true;
    }
    return f;
}

particles read_particles(value const& from, settings const& s, std::vector<material> const& materials,
                         std::string const& folder) {
    table const t(from, {"position", "radius", "material", "velocity", "spin", "fix", "file"});
    particles p;
    if (t.has("file")) {
        for (char const* key : {"position", "radius", "material", "velocity", "spin"})
            t.must_be_left_out(key, "the file has it");
        value const file = t["file"];
        if (folder.empty()) file.refuse("left out: no files here");
        read_particle_file((std::filesystem::path(folder) / file.string()).string(), file.path, s.dimension, materials, p);
    } else {
        p.position = read_points(t["position"], s.dimension);
        if (p.position.empty()) t["position"].refuse("at least one point");
        p.radius = one_or_each<double>(t["radius"], p.size(), "particle", [](value const& v) { return v.positive(); });
        p.material = one_or_each<int>(t["material"], p.size(), "particle",
                                      [&](value const& v) { return material_number(v, materials); });
        auto const one_per_particle = [&](value const& v, std::size_t count) {
            if (count != p.size()) v.refuse("one per particle, of which there are " + std::to_string(p.size()));
        };
        p.velocity.assign(p.size(), point{});
        p.spin.assign(p.size(), point{});
        if (t.has("velocity")) {
            p.velocity = read_points(t["velocity"], s.dimension);
            one_per_particle(t["velocity"], p.velocity.size());
        }
        if (t.has("spin")) {
            p.spin.clear();
            for (value const& one : t["spin"].list())
                p.spin.push_back(s.dimension == 2 ? point{one.number()} : one.vector(3));
            one_per_particle(t["spin"], p.spin.size());
        }
    }
    if (t.has("fix"))
        for (value const& one : t["fix"].list()) p.fix.push_back(read_fix(one, p.size(), s.dimension));
    return p;
}

bonds read_bonds(value const& from, scenario const& s) {
    table const t(from, {"pairs", "touching", "gap", "normal_stiffness", "shear_stiffness", "bending_stiffness",
                         "tensile_force", "shear_force"});
    if (s.simulation.bond == bond_law::none) from.refuse("left out: bond_law is \"none\"");
    bonds b;
    if (t.flag("touching", false)) {
        t.must_be_left_out("pairs", "touching is true");
        b.pairs = touching_pairs(s.bodies, s.simulation.dimension, t["gap"].not_negative());
    } else {
        t.must_be_left_out("gap", "touching is not true");
        std::set<pair> seen;
        for (value const& one : t["pairs"].list()) {
            auto const ends = one.list();
            if (ends.size() != 2) one.refuse("two particles");
            pair const p{ends[0].index(s.bodies.size(), "particles"), ends[1].index(s.bodies.size(), "particles")};
            if (p[0] == p[1]) one.refuse("two different particles");
            if (!seen.insert({std::min(p[0], p[1]), std::max(p[0], p[1])}).second) one.refuse("a pair that is not there yet");
            if (s.bodies.position[std::size_t(p[0])] == s.bodies.position[std::size_t(p[1])])
                one.refuse("two particles that are not at the same place");
            b.pairs.push_back(p);
        }
    }
    auto const own = [&](char const* key, std::optional<double> lacuna::bond_values::* field, bool zero_allowed) {
        if (!t.has(key)) return;
        auto const each = one_or_each<double>(t[key], b.pairs.size(), "bond", [&](value const& v) {
            return zero_allowed ? v.not_negative() : v.positive();
        });
        b.values.resize(b.pairs.size());
        for (std::size_t k = 0; k < each.size(); ++k) b.values[k].*field = each[k];
    };
    if (s.simulation.bond != bond_law::parallel_bond)
        t.must_be_left_out("bending_stiffness", "it belongs to bond_law = \"parallel_bond\"");
    own("normal_stiffness", &lacuna::bond_values::normal_stiffness, false);
    own("shear_stiffness", &lacuna::bond_values::shear_stiffness, true);
    own("bending_stiffness", &lacuna::bond_values::bending_stiffness, true);
    own("tensile_force", &lacuna::bond_values::tensile_force, true);
    own("shear_force", &lacuna::bond_values::shear_force, true);
    return b;
}

wall read_wall(value const& from, settings const& s) {
    table const t(from, {"point", "normal", "normal_stiffness", "shear_stiffness", "friction", "young_modulus", "poisson_ratio"});
    if (s.contact == contact_law::none) from.refuse("left out: contact_law is \"none\"");
    wall w;
    w.place = t["point"].vector(s.dimension);
    w.normal = t["normal"].vector(s.dimension);
    double const length = std::hypot(w.normal[0], w.normal[1], w.normal[2]);
    if (!(length > 0 && std::isfinite(length))) t["normal"].refuse("a vector of finite length > 0");
    w.normal_stiffness = t["normal_stiffness"].positive();
    w.shear_stiffness = t["shear_stiffness"].not_negative();
    w.friction = t["friction"].not_negative();
    read_elasticity(t, s, w);
    return w;
}

load read_load(value const& from, scenario const& s) {
    table const t(from, {"particles", "force", "torque", "velocity", "pressure", "side", "margin_diameters", "ramp_time"});
    int const dimension = s.simulation.dimension;
    load l;
    l.ramp_time = t.not_negative("ramp_time", 0);
    if (t.has("pressure")) {
        l.what = load::kind::pressure;
        for (char const* key : {"particles", "force", "torque", "velocity"}) t.must_be_left_out(key, "pressure is given");
        if (dimension == 3) t["pressure"].refuse("left out: in three dimensions a side has no row of particles");
        l.pressure = t["pressure"].number();
        l.where = side(t.word("side", {"top", "bottom", "left", "right"}, 0));
        l.margin_diameters = t.not_negative("margin_diameters", 0);
        return l;
    }
    for (char const* key : {"side", "margin_diameters"}) t.must_be_left_out(key, "it belongs to a pressure");
    l.particles = read_numbers(t["particles"], s.bodies.size());
    if (t.has("velocity")) {
        l.what = load::kind::velocity;
        for (char const* key : {"force", "torque"}) t.must_be_left_out(key, "velocity is given");
        l.velocity = t["velocity"].vector(dimension);
        return l;
    }
    if (!t.has("force") && !t.has("torque")) (void)t["force"];
    if (t.has("force")) l.force = t["force"].vector(dimension);
    if (t.has("torque")) l.torque = dimension == 2 ? point{t["torque"].number()} : t["torque"].vector(3);
    return l;
}

/// Loads on one particle act together only if they rise together.
void check_loads(std::vector<load> const& loads, std::size_t particles) {
    std::vector<std::int32_t> forced(particles, -1), moved(particles, -1);
    for (std::size_t n = 0; n < loads.size(); ++n) {
        std::string const path = "loads[" + std::to_string(n) + "]";
        for (auto const id : loads[n].particles) {
            auto const k = std::size_t(id);
            if (loads[n].what == load::kind::velocity) {
                if (moved[k] >= 0 && std::size_t(moved[k]) != n)
                    refuse(path + ".particles", std::to_string(id), "a particle whose velocity is not prescribed yet");
                moved[k] = std::int32_t(n);
            } else {
                if (forced[k] >= 0 && loads[std::size_t(forced[k])].ramp_time != loads[n].ramp_time)
                    refuse(path + ".ramp_time", lacuna::to_text(loads[n].ramp_time),
                           "that of loads[" + std::to_string(forced[k]) + "], which acts on particle " + std::to_string(id) +
                               " too");
                forced[k] = std::int32_t(n);
            }
        }
    }
}

pore_place read_place(table const& t, std::size_t pores, bool bare) {
    pore_place place;
    if (bare) t.must_be_left_out("near", "a bare network has no places: give the pore");
    if (t.has("pore")) {
        t.must_be_left_out("near", "pore is given");
        // How many pores a triangulation has is known only when it is made; then the number is checked again.
        place.pore = t["pore"].index(bare ? pores : std::size_t(2147483647), "pores");
    } else if (bare) {
        (void)t["pore"];
    } else {
        place.near = t["near"].vector(2);
    }
    return place;
}

void read_network(value const& from, fluid& f) {
    table const t(from, {"pores", "throats"});
    for (value const& one : t["pores"].list()) {
        table const pore(one, {"volume", "pressure"});
        f.pores.push_back({pore["volume"].positive(), pore.number("pressure", 0)});
    }
    if (f.pores.empty()) t["pores"].refuse("at least one pore");
    for (value const& one : t["throats"].list()) {
        table const throat(one, {"pores", "aperture", "length"});
        value const ends = throat["pores"];
        auto const two = ends.list();
        if (two.size() != 2) ends.refuse("two pores");
        bare_throat b;
        for (std::size_t k = 0; k < 2; ++k) b.pores[k] = two[k].index(f.pores.size(), "pores");
        if (b.pores[0] == b.pores[1]) ends.refuse("two different pores");
        b.aperture = throat["aperture"].positive();
        b.length = throat["length"].positive();
        f.throats.push_back(b);
    }
}

fluid read_fluid(value const& from, settings const& s) {
    table const t(from, {"bulk_modulus", "conductivity", "aperture", "solver", "time_step", "initial_pressure", "boundary",
                         "boundary_pressure", "reservoirs", "sources", "merge_conductance", "mechanical_coupling", "network"});
    if (s.dimension == 3) from.refuse("left out: pores exist in the plane only (dimension = 2)");
    fluid f;
    f.bulk_modulus = t["bulk_modulus"].positive();
    f.conductivity = t["conductivity"].not_negative();
    if (t.has("network")) {
        read_network(t["network"], f);
        t.must_be_left_out("aperture", "each throat of the network has its own");
    } else {
        value const law = t["aperture"];
        auto const* words = law.node->as_table();
        auto const* which = words ? words->get("law") : nullptr;
        if (which && which->is_string() && which->value_or(std::string()) == "constant") {
            table const a(law, {"law", "value"});
            f.constant_aperture = true;
            f.aperture = a["value"].not_negative();
        } else {
            table const a(law, {"law", "a0", "F0", "gap_multiplier"});
            (void)a["law"].word({"contact_force", "constant"});
            f.aperture = a["a0"].positive();
            f.half_force = a["F0"].positive();
            f.gap_factor = a.not_negative("gap_multiplier", 1);
            if (f.gap_factor > 1) a["gap_multiplier"].refuse("from 0 to 1");
        }
    }
    f.implicit = t.word("solver", {"explicit", "implicit"}, 0) == 1;
    if (t.has("time_step")) {
        value const step = t["time_step"];
        if (step.node->is_string()) {
            if (step.string() != "auto") step.refuse("\"auto\" or a number of seconds > 0");
        } else {
            f.time_step = step.positive();
        }
    }
    f.initial_pressure = t.number("initial_pressure", 0);
    f.drained = t.word("boundary", {"sealed", "drained"}, 0) == 1;
    if (f.drained && f.bare()) t["boundary"].refuse("\"sealed\": a bare network has no outside, but reservoirs");
    if (!f.drained) t.must_be_left_out("boundary_pressure", "boundary is not \"drained\"");
    f.boundary_pressure = t.number("boundary_pressure", 0);
    if (t.has("reservoirs"))
        for (value const& one : t["reservoirs"].list()) {
            table const r(one, {"near", "pore", "pressure"});
            f.reservoirs.push_back({read_place(r, f.pores.size(), f.bare()), r["pressure"].number()});
        }
    if (t.has("sources"))
        for (value const& one : t["sources"].list()) {
            table const r(one, {"near", "pore", "flow"});
            f.sources.push_back({read_place(r, f.pores.size(), f.bare()), r["flow"].number()});
        }
    if (t.has("merge_conductance")) f.merge_conductance = t["merge_conductance"].positive();
    f.mechanical_coupling = t.flag("mechanical_coupling", true);
    return f;
}

output read_output(value const& from, bool particles) {
    table const t(from, {"directory", "vtk_every", "picture_every", "checkpoint_every"});
    output o;
    if (t.has("directory")) {
        o.directory = t["directory"].string();
        if (o.directory.empty() || o.directory.find('\0') != std::string::npos) t["directory"].refuse("the name of a directory");
    }
    auto const every = [&](char const* key) {
        return t.has(key) ? t[key].integer(0, many, "from 0 (none) to 1e15 steps") : 0LL;
    };
    o.vtk_every = every("vtk_every");
    o.picture_every = every("picture_every");
    o.checkpoint_every = every("checkpoint_every");
    if (!particles && o.vtk_every > 0) t["vtk_every"].refuse("0: a bare network has no places to show");
    if (!particles && o.picture_every > 0) t["picture_every"].refuse("0: a bare network has no places to show");
    return o;
}

scenario read_tables(toml::table const& file, std::string const& folder) {
    value const all{&file, ""};
    table const t(all, {"simulation", "materials", "particles", "bonds", "walls", "loads", "fluid", "probes", "output"});
    scenario s;
    s.simulation = read_settings(t["simulation"]);
    if (t.has("fluid")) s.water = read_fluid(t["fluid"], s.simulation);
    if (s.water && s.water->bare()) {
        for (char const* key : {"materials", "particles", "bonds", "walls", "loads"})
            t.must_be_left_out(key, "fluid.network replaces the particles");
    } else {
        s.materials = read_materials(t["materials"], s.simulation);
        s.bodies = read_particles(t["particles"], s.simulation, s.materials, folder);
        if (t.has("bonds")) s.joints = read_bonds(t["bonds"], s);
        if (t.has("walls"))
            for (value const& one : t["walls"].list()) s.walls.push_back(read_wall(one, s.simulation));
        if (t.has("loads"))
            for (value const& one : t["loads"].list()) s.loads.push_back(read_load(one, s));
        check_loads(s.loads, s.bodies.size());
    }
    if (t.has("probes"))
        for (value const& one : t["probes"].list()) s.probes.push_back(read_probe(one, s));
    s.out = t.has("output") ? read_output(t["output"], s.bodies.size() > 0) : output{};
    return s;
}

std::string one_line(std::string_view text) {
    std::string line(text);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return line;
}

} // namespace

scenario read_scenario(std::string_view text, std::string const& name, std::string const& folder) {
    try {
        return read_tables(toml::parse(text), folder);
    } catch (toml::parse_error const& bad) {
        auto const& where = bad.source().begin;
        throw refusal(name + ":" + std::to_string(where.line) + ":" + std::to_string(where.column) + ": " +
                      one_line(bad.description()));
    }
}

scenario read_scenario_file(std::string const& path) {
    std::ifstream file(path, std::ios::binary);
    std::error_code ignored;
    if (!file || std::filesystem::is_directory(path, ignored)) throw refusal(path + ": cannot be read");
    std::string const text{std::istreambuf_iterator<char>(file), {}};
    std::string const folder = std::filesystem::path(path).parent_path().string();
    return read_scenario(text, path, folder.empty() ? "." : folder);
}

} // namespace lacuna_run
