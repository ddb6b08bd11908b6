// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/aperture.hpp>

namespace lacuna {

/// Parameters of the fluid and its throats. Defaults are those of the paper's Table 1 where it gives a value.
template <aperture_law Aperture>
struct flow_parameters {
    using aperture_type = Aperture;

    double bulk_modulus = 2.2e9; ///< K_f of the fluid, Pa; > 0
    /// k of the paper's eq. 14, C = k a^3 / l in m^3/(s Pa), so in m/(s Pa); 1/(s Pa) for a law of the section
    /// (hydraulic_section); >= 0
    double conductivity = 1e-9;
    /// Least pore volume, as a share of the pore's triangle when the network was built (in space: of
    /// pore_network::size); > 0, <= 1.
    double minimum_volume_fraction = 1e-3;
    /// The liquid tears below this pressure: the pressure stays here, and vapour fills the rest of the pore. Pa; <= 0
    double minimum_pressure = -std::numeric_limits<double>::infinity();
    double initial_pressure = 0; ///< added to the pressures of the network, Pa; no sum below minimum_pressure
    /// Duration of the run, s; > 0. Throats through which practically nothing passes in this time are skipped, see
    /// deactivate_slow_throats(); with infinity none is. The number of calls of run() does not matter.
    double duration = std::numeric_limits<double>::infinity();
    double skip_ratio = 1e6; ///< see deactivate_slow_throats(); > 0, infinity to skip none
    /// Flow steps within one time step; each takes an equal part of the volume change. 0: as many as are safe.
    int substeps = 1;
    /// Fluid flows through throats in one of `interval` steps of a simulation, for the time of all of them. In the
    /// other steps pressures follow the volumes only. So the stiffness of the fluid acts in every step: the bound of
    /// the time step stays rigorous, and no energy enters, as it would with constant pressures. In steps left over at
    /// the end of a run nothing flows.
    int interval = 1;
    /// Conductance above which a throat merges its two pores (pore_clusters), m^3/(s Pa); > 0, infinity: never.
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
    /// \throws std::invalid_argument for a pressure that is not finite, or below minimum_pressure.
    void require_pressure(std::string const& name, double pressure) const {
        require_finite(name, pressure);
        if (!(pressure >= minimum_pressure)) refuse(name, pressure, ">= minimum_pressure");
    }
};

} // namespace lacuna
