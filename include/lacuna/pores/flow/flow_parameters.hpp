// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/aperture.hpp>

namespace lacuna {

/// Parameters of the fluid and its throats; Table 1 of the paper where it gives a value.
template <aperture_law Aperture>
struct flow_parameters {
    using aperture_type = Aperture;

    double bulk_modulus = 2.2e9; ///< K_f of the fluid, Pa; > 0
    /// k of eq. 14: C = k a^3 / l in m^3/(s Pa), so m/(s Pa); of a section (hydraulic_section) 1/(s Pa); >= 0
    double conductivity = 1e-9;
    /// Least pore volume, as a share of the pore's triangle when the network was built (in space of
    /// pore_network::size); > 0, <= 1.
    double minimum_volume_fraction = 1e-3;
    double minimum_pressure = -std::numeric_limits<double>::infinity(); ///< the fluid tears below, Pa; <= 0
    double initial_pressure = 0; ///< on top of the network's own, Pa; nowhere below minimum_pressure
    /// Of the run, s: throats through which practically nothing passes within it are left out, see deactivate_slow_throats(); > 0,
    /// infinite: none is. It does not depend on how a run is cut into calls of run().
    double duration = std::numeric_limits<double>::infinity();
    double skip_ratio = 1e6; ///< see deactivate_slow_throats(); > 0, infinity to skip none
    /// Flow steps within one step, between which the change of volume is spread evenly; 0: as many as are safe.
    int substeps = 1;
    /// Fluid flows through throats in one of so many steps of a simulation, for the time of all of them. In the others
    /// pressures follow the volumes alone: the fluid's stiffness acts in every step, so the step's bound stays rigorous
    /// and no energy comes in, as it would with pressures that wait. Of steps left over at the end of a run nothing has
    /// flowed.
    int interval = 1;
    /// A throat that lets more through than this joins its two pores into one (pore_clusters), m^3/(s Pa); > 0,
    /// infinity: never.
    double merge_conductance = std::numeric_limits<double>::infinity();
    typename Aperture::parameters aperture{};

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name) const {
        require_positive(name + ".bulk_modulus", bulk_modulus);
        require_not_negative(name + ".conductivity", conductivity);
        if (!(minimum_volume_fraction > 0 && minimum_volume_fraction <= 1))
            refuse(name + ".minimum_volume_fraction", minimum_volume_fraction, "> 0 and <= 1");
        if (!(minimum_pressure <= 0)) refuse(name + ".minimum_pressure", minimum_pressure, "<= 0");
        require_finite(name + ".initial_pressure", initial_pressure);
        if (!(initial_pressure >= minimum_pressure))
            refuse(name + ".initial_pressure", initial_pressure, ">= minimum_pressure");
        require_in(name + ".substeps", substeps, 0, 1000000);
        require_in(name + ".interval", interval, 1, 1000000);
        if (!(duration > 0)) refuse(name + ".duration", duration, "> 0");
        if (!(skip_ratio > 0)) refuse(name + ".skip_ratio", skip_ratio, "> 0");
        if (!(merge_conductance > 0)) refuse(name + ".merge_conductance", merge_conductance, "> 0");
        aperture.validate(name + ".aperture");
    }
    /// \throws std::invalid_argument for a pressure that the fluid cannot have.
    void require_pressure(std::string const& name, double pressure) const {
        require_finite(name, pressure);
        if (!(pressure >= minimum_pressure)) refuse(name, pressure, ">= minimum_pressure");
    }
};

} // namespace lacuna
