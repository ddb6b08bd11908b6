// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/interactions/interaction_parameters.hpp>
#include <lacuna/interactions/walls.hpp>
#include <lacuna/laws/bond_values.hpp>
#include <lacuna/model.hpp>
#include <lacuna/motion/velocity_verlet.hpp>
#include <lacuna/particles/material.hpp>
#include <lacuna/pores/remesh/remesh.hpp>
#include <lacuna/simulation/guard_parameters.hpp>

namespace lacuna {

/// Settings of a simulation, with those of its parts nested. SI units.
template <class Model>
struct simulation_parameters {
    static constexpr int dim = Model::dim;
    using material = material_of<typename Model::contact_law, typename Model::bond_law>;

    std::vector<material> materials{material{}};    ///< the material number of a particle is an index into these
    double thickness = 1;                           ///< out of plane, m; 2D only
    mass_model mass = dim == 2 ? mass_model::disc : mass_model::sphere;
    std::vector<bond_values> bonds{};               ///< individual values of bonds; empty, or one entry per bond
    vec<double, dim> gravity{};                     ///< m/s^2
    /// Density of a fluid at rest around and between the particles, kg/m^3. Particles lose the weight of the fluid that
    /// they displace (Archimedes). Pore pressures are those above hydrostatic_pressure(). 0: the fluid has no weight.
    double fluid_density = 0;
    interaction_parameters interactions{};
    typename Model::domain::template parameters<dim> domain{}; ///< periodic or open
    typename Model::damping::parameters damping{};
    std::vector<wall<typename Model::contact_law, dim>> walls{};
    typename Model::flow::parameters flow{};
    typename Model::forces::parameters forces{};    ///< of the model's own forces, see body_force
    remesh_parameters remeshing{};                  ///< of the pores, as the packing deforms; models with flow
    /// Given time step, s; 0: the library chooses safety times the critical time step. A given step ends the run once
    /// contacts make it unsafe.
    double time_step = 0;
    double safety = 0.2;                            ///< fraction of the critical time step
    /// Only if no time_step is given. True: the step follows the critical one as contacts form or get deeper and bonds
    /// fail. False: the step of the start stays until it exceeds the critical one.
    bool follow_critical_step = true;
    /// True: velocities given to particles hold at the time of the positions (velocity Verlet). False: they hold half a
    /// step earlier.
    bool velocities_on_time = starts_on_time<typename Model::integrator>;
    /// Allows a given time step above the stable limit. Then the guards `growth` and `energy` have no effect.
    bool allow_unstable_step = false;
    guard_parameters guards{};                      ///< conditions that end a run
    double start_time = 0;                          ///< s
    int threads = 1;                                ///< number of threads; has an effect in programs built with OpenMP
    /// Whether the forces of all pairs are stored after a step, for pair_force() and force(). If not, each force is
    /// discarded once it is summed up. That saves a third of the memory traffic of large models. The results are the
    /// same.
    bool keep_pair_forces = true;

    /// Share of a particle's weight that remains under buoyancy in the fluid of fluid_density, for each given density.
    /// \param densities of particles, kg/m^3
    std::vector<double> weight_shares(std::vector<double> const& densities) const {
        std::vector<double> shares;
        for (double const density : densities) shares.push_back(1 - fluid_density / density);
        return shares;
    }
    /// Hydrostatic pressure at x, rho_f g . (x - surface), Pa. Add it to the pressure of a pore to get the total
    /// pressure.
    /// \param x m
    /// \param surface any point of the fluid's surface, where the pressure is zero, m
    double hydrostatic_pressure(vec<double, dim> const& x, vec<double, dim> const& surface) const noexcept {
        return fluid_density * dot(gravity, x - surface);
    }

    /// \throws std::invalid_argument with the part, the field, the value and the rule
    void validate() const {
        if (materials.empty()) refuse("materials.size()", 0.0, "at least 1");
        for (std::size_t m = 0; m < materials.size(); ++m)
            materials[m].validate("materials[" + std::to_string(m) + "]");
        require_positive("thickness", thickness);
        for (int axis = 0; axis < dim; ++axis) require_finite("gravity", gravity[axis]);
        require_not_negative("fluid_density", fluid_density);
        interactions.validate("interactions");
        domain.validate("domain");
        damping.validate("damping");
        for (std::size_t w = 0; w < walls.size(); ++w) walls[w].validate("walls[" + std::to_string(w) + "]");
        flow.validate("flow");
        forces.validate("forces");
        remeshing.validate("remeshing");
        if (dim == 3 && remeshing.rule != remesh_rule::never)
            refuse("remeshing.rule", "when_needed", "never: in space pores keep their mesh");
        guards.validate("guards");
        require_not_negative("time_step", time_step);
        require_positive("safety", safety);
        require_finite("start_time", start_time);
        require_in("threads", threads, 1, 1024);
    }
};

} // namespace lacuna
