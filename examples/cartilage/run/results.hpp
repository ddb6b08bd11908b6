// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/draw/picture_scene.hpp>
#include <lacuna/interactions/break_event.hpp>

#include "cartilage/common/options.hpp"
#include "cartilage/specimen/specimen.hpp"

/// \file
/// Results of a run as plain data in SI units: breaks by fibre and layer, and the picture of the damage.

namespace cartilage {

/// A broken bond.
struct crack_record {
    long long step = 0;
    double time = 0; ///< s
    int bond = 0;    ///< index in the specimen
    int first = 0;   ///< index of its first particle
    int second = 0;  ///< index of its second particle
    bool shear = false; ///< broke in shear; else in tension
    int fibre = -1;     ///< index of its fibre; -1: a cross link
    std::array<double, 2> position{};  ///< m
    std::array<double, 2> direction{}; ///< along the bond
    double normal_force = 0;           ///< N, positive in tension
    double shear_force = 0;            ///< N
    double energy = 0;                 ///< J, stored in the bond when it broke
};

/// Damage of the fibres of one zone and layer.
struct layer_result {
    std::string zone;
    int layer = 0; ///< surface: 0 is the top fibre; deep: 0 is the centre; middle: 0 is the top fifth
    std::size_t fibres = 0;
    std::size_t bonds = 0;
    std::size_t broken = 0;
    double broken_fraction() const { return bonds == 0 ? 0.0 : double(broken) / double(bonds); }
};

/// Result of `cartilage run`.
struct run_result {
    specimen_report specimen;
    long long steps = 0;
    double time_step = 0;         ///< s
    double time_step_limit = 0;   ///< s, the rigorous bound
    double end_time = 0;          ///< s
    double wall_seconds = 0;
    std::string ended;            ///< "duration", "limit", "quiet" or "interrupted"
    bool interrupted = false;
    std::vector<crack_record> cracks;
    std::vector<layer_result> layers;
    std::size_t fibres_cut = 0;         ///< fibres with at least one broken bond
    std::optional<double> peak_pore_pressure; ///< Pa, none in a dry run
    std::vector<std::pair<std::string, double>> energy; ///< J, by name
    double energy_residual = 0;                         ///< J

    std::size_t broken(bool shear) const {
        std::size_t n = 0;
        for (crack_record const& c : cracks) n += std::size_t(c.shear == shear);
        return n;
    }
    double broken_fraction() const {
        return specimen.bonds == 0 ? 0.0 : double(cracks.size()) / double(specimen.bonds);
    }
    double particle_steps_per_second() const {
        return wall_seconds > 0 ? double(steps) * double(specimen.particles) / wall_seconds : 0.0;
    }
};

/// The record of a break. Its direction is that of the bond in the specimen before loading.
crack_record crack_of(specimen const& s, lacuna::break_event<2> const& event);

/// Counts the cracks of `r` in each layer (sorted by zone, then layer) and the fibres with at least one crack.
void sort_cracks(specimen const& s, run_result& r);

/// The scene of the damage, without the moment at which it is. \param position of each particle, by id, m
/// \param pores at that moment
lacuna::scene damage_scene(specimen const& s, options const& o, std::span<lacuna::vec<double, 2> const> position,
                           std::span<crack_record const> cracks, std::vector<lacuna::scene::pore> pores);

} // namespace cartilage
