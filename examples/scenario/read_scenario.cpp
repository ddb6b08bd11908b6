// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

#include "particle_file.hpp"
#include "probes.hpp"
#include "scenario.hpp"
#include "toml_depth.hpp"
#include "toml_table.hpp"
#include "touching.hpp"

namespace lacuna_run {

namespace {

settings read_settings(value const& from) {
    table const t(from, "simulation");
    settings s;
    s.dimension = int(t.whole("dimension"));
    s.single_precision = t.word("real") == 1;
    s.thickness = t.number("thickness");
    s.spheres = t.has("mass") ? t.word("mass") == 1 : s.dimension == 3;
    if (s.dimension == 3 && !s.spheres) t["mass"].refuse("\"sphere\" in three dimensions");
    s.contact = contact_law(t.word("contact_law"));
    s.bond = bond_law(t.word("bond_law"));
    s.velocity_verlet = t.word("integrator") == 1;
    s.time_step = t.step("time_step");
    s.safety = t.number("safety");
    s.allow_unstable_step = t.flag("allow_unstable_step");
    s.end_time = t.given("end_time");
    if (!s.end_time) s.steps = t["steps"].whole_number();
    s.gravity = t.vector("gravity", s.dimension);
    s.fluid_density = t.number("fluid_density");
    s.threads = int(t.whole("threads"));
    if (t.has("damping")) {
        table const damping(t["damping"], "simulation.damping");
        s.local_damping = damping.number("local");
        s.mass_damping = damping.number("mass");
        s.viscous_damping = damping.number("viscous");
    }
    if (t.has("guards")) {
        table const guards(t["guards"], "simulation.guards");
        s.guards = {guards.flag("growth"),          guards.flag("energy"), guards.flag("overlap"),
                    guards.number("overlap_limit"), guards.flag("motion"), guards.number("motion_limit"),
                    guards.flag("resolution"),      guards.flag("walls"),  guards.flag("pores")};
    }
    return s;
}

/// Reads Young's modulus and Poisson's ratio of a material or wall, for Hertzian contacts.
template <class Solid>
void read_elasticity(table const& t, Solid& to) {
    to.young_modulus = t.given("young_modulus");
    if (to.young_modulus) to.poisson_ratio = t.number("poisson_ratio");
}

std::vector<material> read_materials(value const& from) {
    std::vector<material> found;
    for (auto const& [key, node] : *from.node->as_table()) {
        material m;
        m.name = std::string(key.str());
        table const t({&node, from.path + "." + m.name, from.context}, "materials.*");
        m.density = t.number("density"); // 0 with flow alone
        m.normal_stiffness = t.number("normal_stiffness");
        m.shear_stiffness = t.number("shear_stiffness");
        // The library requires a stiffness of every material, even of one without contacts and bonds.
        if (m.normal_stiffness == 0) m.normal_stiffness = 1;
        m.friction = t.number("friction");
        m.tensile_strength = t.given("tensile_strength");
        m.shear_strength = t.given("shear_strength");
        read_elasticity(t, m);
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
    v.refuse("the name of a material" + did_you_mean(name, known));
}

/// Reads one value for all or one for each. \param of "particle" or "bond", for messages
template <class T, class Read>
std::vector<T> one_or_each(value const& v, std::size_t count, char const* of, Read const& read) {
    if (!v.node->is_array()) return std::vector<T>(count, read(v));
    auto const list = v.list();
    if (list.size() != count)
        v.refuse("one value or one per " + std::string(of) + ": " + std::to_string(count) + " values, not " +
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
    table const t(from, "particles.fix[]");
    fixed f;
    f.particles = read_numbers(t["particles"], particles);
    value const axes = t["axes"];
    std::string const rule = dimension == 2 ? "some of the letters x, y, r" : "some of the letters x, y, z, r";
    std::string const letters = axes.string();
    if (letters.empty()) axes.refuse(rule);
    for (char const c : letters) {
        bool* const one = c == 'x'                     ? &f.x
                          : c == 'y'                   ? &f.y
                          : c == 'z' && dimension == 3 ? &f.z
                          : c == 'r'                   ? &f.rotation
                                                       : nullptr;
        if (one == nullptr || *one) axes.refuse(rule + (one ? ", each once" : ""));
        *one = true;
    }
    return f;
}

particle_list read_particles(value const& from, scenario const& all, std::string const& folder) {
    table const t(from, "particles");
    settings const& s = all.simulation;
    particle_list p;
    if (t.has("file")) {
        value const file = t["file"];
        if (folder.empty()) file.refuse("left out: this scenario has no folder");
        read_particle_file((std::filesystem::path(folder) / file.string()).string(), file.path, s.dimension,
                           all.materials, p);
        // With flow alone a file may still have a column of velocities.
        auto const moves = [](point const& v) { return v != point{}; };
        if (all.flow_alone() && (std::any_of(p.velocity.begin(), p.velocity.end(), moves) ||
                                 std::any_of(p.spin.begin(), p.spin.end(), moves)))
            file.refuse("a file of particles at rest: fluid.mechanical_coupling is false");
    } else {
        p.position = read_points(t["position"], s.dimension);
        if (p.position.empty()) t["position"].refuse("at least one point");
        p.radius = one_or_each<double>(t["radius"], p.size(), "particle", [](value const& v) { return v.number(); });
        p.material.assign(p.size(), 0);
        if (!all.flow_alone())
            p.material = one_or_each<int>(t["material"], p.size(), "particle",
                                          [&](value const& v) { return material_number(v, all.materials); });
        auto const one_per_particle = [&](value const& v, std::size_t count) {
            if (count != p.size()) v.refuse("one per particle: " + std::to_string(p.size()) + " values");
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
    for (value const& one : t.list("fix")) p.fix.push_back(read_fix(one, p.size(), s.dimension));
    return p;
}

bond_list read_bonds(value const& from, scenario const& s) {
    table const t(from, "bonds");
    bond_list b;
    if (t.flag("touching")) {
        b.pairs = touching_pairs(s.particles, s.simulation.dimension, t["gap"]);
    } else {
        std::set<pair> seen;
        for (value const& one : t["pairs"].list()) {
            auto const ends = one.list();
            if (ends.size() != 2) one.refuse("two particles");
            pair const p{ends[0].index(s.particles.size(), "particles"),
                         ends[1].index(s.particles.size(), "particles")};
            if (p[0] == p[1]) one.refuse("two different particles");
            if (!seen.insert({std::min(p[0], p[1]), std::max(p[0], p[1])}).second)
                one.refuse("a pair that was not listed before");
            if (s.particles.position[std::size_t(p[0])] == s.particles.position[std::size_t(p[1])])
                one.refuse("two particles at different positions");
            b.pairs.push_back(p);
        }
    }
    auto const own = [&](char const* key, std::optional<double> lacuna::bond_values::* field) {
        if (!t.has(key)) return;
        auto const each =
            one_or_each<double>(t[key], b.pairs.size(), "bond", [](value const& v) { return v.number(); });
        b.values.resize(b.pairs.size());
        for (std::size_t k = 0; k < each.size(); ++k) b.values[k].*field = each[k];
    };
    own("normal_stiffness", &lacuna::bond_values::normal_stiffness);
    own("shear_stiffness", &lacuna::bond_values::shear_stiffness);
    own("bending_stiffness", &lacuna::bond_values::bending_stiffness);
    own("tensile_force", &lacuna::bond_values::tensile_force);
    own("shear_force", &lacuna::bond_values::shear_force);
    return b;
}

wall read_wall(value const& from, settings const& s) {
    table const t(from, "walls[]");
    wall w;
    w.position = t["point"].vector(s.dimension);
    w.normal = t["normal"].vector(s.dimension);
    double const length = std::hypot(w.normal[0], w.normal[1], w.normal[2]);
    if (!(length > 0 && std::isfinite(length))) t["normal"].refuse("a vector of finite length > 0");
    w.normal_stiffness = t.number("normal_stiffness");
    w.shear_stiffness = t.number("shear_stiffness");
    if (w.normal_stiffness == 0) w.normal_stiffness = 1; // left out because young_modulus is given
    w.friction = t.number("friction");
    read_elasticity(t, w);
    return w;
}

load read_load(value const& from, scenario const& s) {
    table const t(from, "loads[]");
    int const dimension = s.simulation.dimension;
    load l;
    l.ramp_time = t.number("ramp_time");
    if (t.has("pressure")) {
        l.what = load::kind::pressure;
        l.pressure = t.number("pressure");
        l.where = side(t.word("side"));
        l.disc_area = t.word("area") == 1;
        l.margin_diameters = t.number("margin_diameters");
        return l;
    }
    l.particles = read_numbers(t["particles"], s.particles.size());
    if (t.has("velocity")) {
        l.what = load::kind::velocity;
        l.velocity = t.vector("velocity", dimension);
        return l;
    }
    if (!t.has("force") && !t.has("torque")) (void)t["force"];
    l.force = t.vector("force", dimension);
    if (t.has("torque")) l.torque = dimension == 2 ? point{t.number("torque")} : t.vector("torque", 3);
    return l;
}

/// Loads on one particle must have the same ramp_time. A particle with a prescribed velocity cannot be held along an
/// axis.
void check_loads(scenario const& s) {
    std::vector<std::int32_t> forced(s.particles.size(), -1), moved(s.particles.size(), -1);
    for (std::size_t n = 0; n < s.loads.size(); ++n) {
        std::string const path = "loads[" + std::to_string(n) + "]";
        for (auto const id : s.loads[n].particles) {
            auto const k = std::size_t(id);
            if (s.loads[n].what == load::kind::velocity) {
                if (moved[k] >= 0 && std::size_t(moved[k]) != n)
                    refuse(path + ".particles", std::to_string(id),
                           "a particle whose velocity is prescribed only once");
                moved[k] = std::int32_t(n);
            } else {
                if (forced[k] >= 0 && s.loads[std::size_t(forced[k])].ramp_time != s.loads[n].ramp_time)
                    refuse(path + ".ramp_time", lacuna::to_text(s.loads[n].ramp_time),
                           "equal to that of loads[" + std::to_string(forced[k]) + "], which also acts on particle " +
                               std::to_string(id));
                forced[k] = std::int32_t(n);
            }
        }
    }
    for (std::size_t n = 0; n < s.particles.fix.size(); ++n)
        for (auto const id : s.particles.fix[n].particles) {
            fixed const& f = s.particles.fix[n];
            if (moved[std::size_t(id)] >= 0 && (f.x || f.y || f.z))
                refuse("particles.fix[" + std::to_string(n) + "].axes", "particle " + std::to_string(id),
                       "\"r\" or left out: loads[" + std::to_string(moved[std::size_t(id)]) + "].velocity moves it");
        }
}

pore_location read_location(table const& t, std::size_t pores, bool bare) {
    pore_location location;
    // The number of pores is known only after the triangulation; the index is checked again then.
    if (t.has("pore") || bare)
        location.pore = t["pore"].index(bare ? pores : std::size_t(2147483647), "pores");
    else
        location.near = t["near"].vector(2);
    return location;
}

void read_network(value const& from, fluid_settings& f) {
    table const t(from, "fluid.network");
    for (value const& one : t.list("pores")) {
        table const pore(one, "fluid.network.pores[]");
        f.pores.push_back({pore.number("volume"), pore.number("pressure")});
    }
    if (f.pores.empty()) t["pores"].refuse("at least one pore");
    for (value const& one : t.list("throats")) {
        table const throat(one, "fluid.network.throats[]");
        value const ends = throat["pores"];
        auto const two = ends.list();
        if (two.size() != 2) ends.refuse("two pores");
        bare_throat b;
        for (std::size_t k = 0; k < 2; ++k) b.pores[k] = two[k].index(f.pores.size(), "pores");
        if (b.pores[0] == b.pores[1]) ends.refuse("two different pores");
        b.aperture = throat.number("aperture");
        b.length = throat.number("length");
        f.throats.push_back(b);
    }
}

void read_aperture(value const& from, fluid_settings& f) {
    table const t(from, "fluid.aperture");
    f.constant_aperture = t.word("law") == 1;
    if (f.constant_aperture) {
        f.aperture = t.number("value");
    } else {
        f.aperture = t.number("a0");
        if (double const given = t.number("F0"); given > 0) f.half_force = given; // 0: there are no forces
        f.gap_factor = t.number("gap_multiplier");
    }
}

/// No given pressure may be below the one at which the fluid tears.
void check_pressures(table const& t, fluid_settings const& f) {
    if (!f.minimum_pressure) return;
    auto const check = [&](std::string const& path, double pressure) {
        if (pressure < *f.minimum_pressure)
            refuse(path, lacuna::to_text(pressure),
                   ">= fluid.minimum_pressure, " + lacuna::to_text(*f.minimum_pressure));
    };
    check(t.path("initial_pressure"), f.initial_pressure);
    if (f.drained) check(t.path("boundary_pressure"), f.boundary_pressure);
    for (std::size_t k = 0; k < f.reservoirs.size(); ++k)
        check(t.path("reservoirs") + "[" + std::to_string(k) + "].pressure", f.reservoirs[k].pressure);
    for (std::size_t k = 0; k < f.pores.size(); ++k)
        check(t.path("network.pores") + "[" + std::to_string(k) + "].pressure",
              f.initial_pressure + f.pores[k].pressure);
}

fluid_settings read_fluid(value const& from) {
    table const t(from, "fluid");
    fluid_settings f;
    f.bulk_modulus = t.number("bulk_modulus");
    f.conductivity = t.number("conductivity");
    if (t.has("network"))
        read_network(t["network"], f);
    else
        read_aperture(t["aperture"], f);
    f.implicit = t.word("solver") == 1;
    f.time_step = t.step("time_step");
    f.initial_pressure = t.number("initial_pressure");
    f.drained = t.word("boundary") == 1;
    f.boundary_pressure = t.number("boundary_pressure");
    for (value const& one : t.list("reservoirs")) {
        table const r(one, "fluid.reservoirs[]");
        f.reservoirs.push_back({read_location(r, f.pores.size(), f.bare()), r.number("pressure")});
    }
    for (value const& one : t.list("sources")) {
        table const r(one, "fluid.sources[]");
        f.sources.push_back({read_location(r, f.pores.size(), f.bare()), r.number("flow")});
    }
    f.duration = t.given("duration");
    f.minimum_pressure = t.given("minimum_pressure");
    check_pressures(t, f);
    if (t.has("remeshing")) {
        table const remeshing(t["remeshing"], "fluid.remeshing");
        f.remeshing = remeshing.word("rule") == 1;
        f.remeshing_interval = int(remeshing.whole("interval"));
        f.remeshing_on_broken_bond = remeshing.flag("on_broken_bond");
    }
    f.merge_conductance = t.given("merge_conductance");
    f.mechanical_coupling = t.flag("mechanical_coupling");
    return f;
}

output_settings read_output(value const& from) {
    table const t(from, "output");
    output_settings o;
    if (t.has("directory")) {
        o.directory = t["directory"].string();
        if (o.directory.empty() || o.directory.find('\0') != std::string::npos)
            t["directory"].refuse("the name of a directory");
    }
    o.vtk_every = t.whole("vtk_every");
    o.picture_every = t.whole("picture_every");
    o.checkpoint_every = t.whole("checkpoint_every");
    return o;
}

scenario read_tables(toml::table const& file, std::string const& folder) {
    auto const context = check_keys(file);
    table const t({&file, "", context.get()}, "");
    scenario s;
    s.simulation = read_settings(t["simulation"]);
    if (t.has("fluid")) s.fluid = read_fluid(t["fluid"]);
    if (!s.fluid || !s.fluid->bare()) {
        if (!s.flow_alone() || t.has("materials")) s.materials = read_materials(t["materials"]);
        s.particles = read_particles(t["particles"], s, folder);
        if (t.has("bonds")) s.bonds = read_bonds(t["bonds"], s);
        for (value const& one : t.list("walls")) s.walls.push_back(read_wall(one, s.simulation));
        for (value const& one : t.list("loads")) s.loads.push_back(read_load(one, s));
        check_loads(s);
    }
    for (value const& one : t.list("probes")) s.probes.push_back(read_probe(one, s));
    s.output = t.has("output") ? read_output(t["output"]) : output_settings{};
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
    require_shallow(text, name);
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
    int const reason = errno;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) throw refusal(path + ": cannot be read: it is a directory");
    if (!file) throw refusal(path + ": cannot be read: " + std::strerror(reason));
    std::string const text{std::istreambuf_iterator<char>(file), {}};
    if (text.find_first_not_of(" \t\r\n") == text.npos) throw refusal(path + ": is empty, it must be a scenario");
    std::string const folder = std::filesystem::path(path).parent_path().string();
    return read_scenario(text, path, folder.empty() ? "." : folder);
}

} // namespace lacuna_run
