// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/bond_values.hpp>
#include <lacuna/simulation/guard_parameters.hpp>

/// \file
/// A scenario as plain data: the checked content of its TOML file, with every default filled in. SI units.

namespace lacuna_run {

/// A scenario that cannot be run. The message is one line "full.path = value: must be rule".
class refusal : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// \throws refusal "path = value: must be rule"
[[noreturn]] inline void refuse(std::string const& path, std::string const& value, std::string const& rule) {
    throw refusal(path + " = " + value + ": must be " + rule);
}

using point = std::array<double, 3>; ///< in the plane the third number is 0
using pair = std::array<std::int32_t, 2>;

enum class contact_law { none, frictional_spring, hertz_mindlin };
enum class bond_law { none, brittle_spring, parallel_bond };

struct settings {
    int dimension = 2;
    bool single_precision = false;
    double thickness = 1;
    bool spheres = false; ///< masses of spheres; false: of discs
    contact_law contact = contact_law::frictional_spring;
    bond_law bond = bond_law::brittle_spring;
    bool velocity_verlet = false;
    double time_step = 0; ///< 0: auto
    double safety = 0.2;
    bool allow_unstable_step = false;
    lacuna::guard_parameters guards;
    std::optional<long long> steps;
    std::optional<double> end_time;
    point gravity{};
    double fluid_density = 0; ///< of the fluid at rest whose buoyancy reduces the weight of particles, kg/m^3
    int threads = 1;
    double local_damping = 0, mass_damping = 0, viscous_damping = 0;
};

struct material {
    std::string name;
    double density = 0, normal_stiffness = 0, shear_stiffness = 0, friction = 0;
    std::optional<double> tensile_strength, shear_strength;
    std::optional<double> young_modulus; ///< of Hertzian contacts, Pa; none: derived from normal_stiffness
    double poisson_ratio = 0;
};

struct fixed {
    std::vector<std::int32_t> particles;
    bool x = false, y = false, z = false, rotation = false;
};

struct particle_list {
    std::vector<point> position, velocity, spin; ///< in the plane the spin is the first number
    std::vector<double> radius;
    std::vector<double> density; ///< one per particle if a file has that column, else empty
    std::vector<int> material;   ///< index in scenario::materials
    std::vector<fixed> fix;
    std::size_t size() const noexcept { return position.size(); }
};

struct bond_list {
    std::vector<pair> pairs;
    std::vector<lacuna::bond_values> values; ///< one per pair, or empty
};

struct wall {
    point position{}, normal{};
    double normal_stiffness = 0, shear_stiffness = 0, friction = 0;
    std::optional<double> young_modulus;
    double poisson_ratio = 0;
};

enum class side { top, bottom, left, right };

struct load {
    enum class kind { force, velocity, pressure } what = kind::force;
    std::vector<std::int32_t> particles;
    point force{}, torque{}, velocity{};
    double pressure = 0, margin_diameters = 0, ramp_time = 0;
    bool disc_area = false; ///< pressure acts on the face pi r^2; false: on the side 2 r thickness
    side where = side::top;
};

/// A pore, given by its number or as the pore nearest to a point.
struct pore_location {
    std::optional<point> near;
    std::int32_t pore = -1; ///< used if `near` is empty
};

struct bare_pore {
    double volume = 0, pressure = 0;
};
struct bare_throat {
    pair pores{};
    double aperture = 0, length = 0;
};

struct fluid_settings {
    struct reservoir {
        pore_location where;
        double pressure = 0;
    };
    struct source {
        pore_location where;
        double flow = 0;
    };
    double bulk_modulus = 2.2e9, conductivity = 1e-9;
    bool constant_aperture = false;
    double aperture = 1e-7; ///< a0, or the constant aperture, m
    double half_force = 1;  ///< F0, N
    double gap_factor = 1;  ///< gap_multiplier
    bool implicit = false;
    double time_step = 0; ///< 0: auto
    std::optional<double> duration; ///< s: throats with negligible flow within this time are left out
    double initial_pressure = 0;
    bool drained = false;
    double boundary_pressure = 0;
    std::vector<reservoir> reservoirs;
    std::vector<source> sources;
    std::optional<double> minimum_pressure; ///< Pa: the fluid tears below it
    bool remeshing = false;                 ///< rebuild the pores when the mesh no longer fits
    int remeshing_interval = 100;
    bool remeshing_on_broken_bond = false;
    std::optional<double> merge_conductance;
    bool mechanical_coupling = true;
    std::vector<bare_pore> pores; ///< of a bare network; empty: pores are triangulated between particles
    std::vector<bare_throat> throats;
    bool bare() const noexcept { return !pores.empty(); }
};

enum class quantity {
    position, velocity, spin, rotation, force, torque,
    bond_normal_force, bond_shear_force, bond_broken,
    contact_normal_force, contact_shear_force,
    pore_pressure, pore_volume, throat_flow, wall_force,
    kinetic, strain, friction, damping, fracture, fluid_energy, external, residual,
    broken_tension, broken_shear, contacts
};

struct probe {
    std::string name; ///< as in the file
    quantity what{};
    int axis = -1; ///< -1: no component, or the magnitude
    std::int32_t index = -1;
    pair particles{-1, -1};
    pore_location where; ///< of probes of pores and throats
    std::int32_t throat = -1;
    long long every = 1;
    std::string column; ///< heading in probes.csv
};

struct output_settings {
    std::string directory = "out";
    long long vtk_every = 0, picture_every = 0, checkpoint_every = 0;
};

struct scenario {
    settings simulation;
    std::vector<material> materials;
    particle_list particles;
    bond_list bonds;
    std::vector<wall> walls;
    std::vector<load> loads;
    std::optional<fluid_settings> fluid;
    std::vector<probe> probes;
    output_settings output;
    /// Whether only fluid moves: in a bare network, or between fixed particles.
    bool flow_alone() const noexcept { return fluid && (fluid->bare() || !fluid->mechanical_coupling); }
};

/// Reads and checks the text of a scenario.
/// \param name of the file, for messages about its syntax
/// \param folder to which paths in the scenario are relative; empty: paths are refused
/// \throws refusal
scenario read_scenario(std::string_view text, std::string const& name, std::string const& folder);

/// The same from a file. \throws refusal, also for a file that cannot be read
scenario read_scenario_file(std::string const& path);

} // namespace lacuna_run
