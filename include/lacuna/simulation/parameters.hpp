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

/// Settings of a simulation; they nest those of its parts. SI units.
template <class Model>
struct simulation_parameters {
    static constexpr int dim = Model::dim;
    using material = material_of<typename Model::contact_law, typename Model::bond_law>;

    std::vector<material> materials{material{}};    ///< a particle's material number counts these
    double thickness = 1;                           ///< out of plane, m; 2D only
    mass_model mass = dim == 2 ? mass_model::disc : mass_model::sphere;
    std::vector<bond_values> bonds{};               ///< values of single bonds; none, or one entry per bond
    vec<double, dim> gravity{};                     ///< m/s^2
    /// Of a fluid at rest around and between the particles, kg/m^3: they lose the weight of what they displace
    /// (Archimedes), and pore pressures are those above the hydrostatic one, hydrostatic_pressure(). 0: no weight.
    double fluid_density = 0;
    interaction_parameters interactions{};
    typename Model::domain::template parameters<dim> domain{}; ///< periodic or open
    typename Model::damping::parameters damping{};
    std::vector<wall<typename Model::contact_law, dim>> walls{};
    typename Model::flow::parameters flow{};
    typename Model::forces::parameters forces{};    ///< of the model's own, see body_force
    remesh_parameters remeshing{};                  ///< of the pores, as the body deforms; models with flow
    double time_step = 0; ///< s; 0: safety times the critical time step. A given one that contacts make unsafe ends the run
    double safety = 0.2;                            ///< fraction of the critical time step
    /// Without a time_step given: the step follows the critical one as contacts form or get deeper and bonds fail. False:
    /// it stays as it was found at the start, until the critical one is below it.
    bool follow_critical_step = true;
    /// Velocities given to particles are those at the time of the positions: velocity Verlet. Else they are those of
    /// half a step before.
    bool velocities_on_time = starts_on_time<typename Model::integrator>;
    /// Run even with a given time step above the bound; then growing speeds and energy from nowhere end no run either.
    bool allow_unstable_step = false;
    guard_parameters guards{};                      ///< what ends a run
    double start_time = 0;                          ///< s
    int threads = 1;                                ///< takes effect in programs built with OpenMP
    /// Keep the forces of all pairs after a step, for pair_force() and force(). Without, each force is forgotten once it
    /// is summed up, which saves a third of the memory traffic of large models. The results are the same.
    bool keep_pair_forces = true;

    /// What a fluid of fluid_density leaves of a particle's weight, for each density given.
    std::vector<double> weight_shares(std::vector<double> const& densities) const {
        std::vector<double> shares;
        for (double const density : densities) shares.push_back(1 - fluid_density / density);
        return shares;
    }
    /// Pressure at x of the fluid at rest below its surface, rho_f g . (x - surface), Pa: to be added to a pore's pressure.
    /// \param x m; \param surface any point at which it is zero, m
    double hydrostatic_pressure(vec<double, dim> const& x, vec<double, dim> const& surface) const noexcept {
        return fluid_density * dot(gravity, x - surface);
    }

    /// \throws std::invalid_argument naming the part, the field, the value and the rule.
    void validate() const {
        if (materials.empty()) refuse("materials.size()", 0.0, "at least 1");
        for (std::size_t m = 0; m < materials.size(); ++m) materials[m].validate("materials[" + std::to_string(m) + "]");
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
