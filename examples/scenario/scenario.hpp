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
/// A scenario as plain data: what its TOML file says, checked, with every default filled in. SI units.

namespace lacuna_run {

/// A scenario that cannot be run; the message is one line "full.path = value: must be rule".
class refusal : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

[[noreturn]] inline void refuse(std::string const& path, std::string const& value, std::string const& rule) {
    throw refusal(path + " = " + value + ": must be " + rule);
}

using point = std::array<double, 3>; ///< the third is 0 in the plane
using pair = std::array<std::int32_t, 2>;

enum class contact_law { none, frictional_spring, hertz_mindlin };
enum class bond_law { none, brittle_spring, parallel_bond };

struct settings {
    int dimension = 2;
    bool single_precision = false;
    double thickness = 1;
    bool spheres = false; ///< mass of spheres, else of discs
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
    double fluid_density = 0;
    int threads = 1;
    double local_damping = 0, mass_damping = 0, viscous_damping = 0;
};

struct material {
    std::string name;
    double density = 0, normal_stiffness = 0, shear_stiffness = 0, friction = 0;
    std::optional<double> tensile_strength, shear_strength;
    std::optional<double> young_modulus; ///< of Hertzian contacts; without, from normal_stiffness
    double poisson_ratio = 0;
};

struct fixed {
    std::vector<std::int32_t> particles;
    bool x = false, y = false, z = false, rotation = false;
};

struct particles {
    std::vector<point> position, velocity, spin; ///< spin: in the plane the first number
    std::vector<double> radius;
    std::vector<double> density; ///< of each particle where a file has it, else none
    std::vector<int> material; ///< number in `materials`
    std::vector<fixed> fix;
    std::size_t size() const noexcept { return position.size(); }
};

struct bonds {
    std::vector<pair> pairs;
    std::vector<lacuna::bond_values> values; ///< one per pair, or none
};

struct wall {
    point place{}, normal{};
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
    bool disc_area = false; ///< the pressure acts on the disc's face, else on the strip that it covers
    side where = side::top;
};

/// A place in the pore network: a pore, or the pore nearest to a point.
struct pore_place {
    std::optional<point> near;
    std::int32_t pore = -1;
};

struct bare_pore {
    double volume = 0, pressure = 0;
};
struct bare_throat {
    pair pores{};
    double aperture = 0, length = 0;
};

struct fluid {
    struct reservoir {
        pore_place where;
        double pressure = 0;
    };
    struct source {
        pore_place where;
        double flow = 0;
    };
    double bulk_modulus = 2.2e9, conductivity = 1e-9;
    bool constant_aperture = false;
    double aperture = 1e-7; ///< a0, or the constant one
    double half_force = 1, gap_factor = 1;
    bool implicit = false;
    double time_step = 0; ///< 0: auto
    std::optional<double> duration; ///< throats through which practically nothing passes within it are left out, s
    double initial_pressure = 0;
    bool drained = false;
    double boundary_pressure = 0;
    std::vector<reservoir> reservoirs;
    std::vector<source> sources;
    std::optional<double> minimum_pressure; ///< the fluid tears below it
    bool remeshing = false;                 ///< pores are made anew when the mesh does not fit any more
    int remeshing_interval = 100;
    bool remeshing_on_broken_bond = false;
    std::optional<double> merge_conductance;
    bool mechanical_coupling = true;
    std::vector<bare_pore> pores; ///< of a bare network; empty: triangulated particles
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
    std::string name; ///< as it was written
    quantity what{};
    int axis = -1; ///< -1: none, or the magnitude
    std::int32_t index = -1;
    pair particles{-1, -1};
    pore_place where; ///< of pores and throats
    std::int32_t throat = -1;
    long long every = 1;
    std::string column; ///< heading in probes.csv
};

struct output {
    std::string directory = "out";
    long long vtk_every = 0, picture_every = 0, checkpoint_every = 0;
};

struct scenario {
    settings simulation;
    std::vector<material> materials;
    particles bodies;
    bonds joints;
    std::vector<wall> walls;
    std::vector<load> loads;
    std::optional<fluid> water;
    std::vector<probe> probes;
    output out;
    /// Whether fluid flows between particles that stay where they are, or without any.
    bool flow_alone() const noexcept { return water && (water->bare() || !water->mechanical_coupling); }
};

/// Reads and checks the text of a scenario.
/// \param name of the file, for messages about its syntax
/// \param folder that files named in it are relative to; empty: such files are refused
/// \throws refusal
scenario read_scenario(std::string_view text, std::string const& name, std::string const& folder);

/// The same from a file. \throws refusal, also for a file that cannot be read
scenario read_scenario_file(std::string const& path);

} // namespace lacuna_run
