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
/// What a run leaves behind, as plain data in SI units: breaks sorted to fibres and layers, and the picture of the damage.

namespace cartilage {

/// One break of a bond.
struct crack_record {
    long long step = 0;
    double time = 0; ///< s
    int bond = 0;    ///< number in the specimen
    int first = 0;   ///< its particles
    int second = 0;
    bool shear = false; ///< else tension
    int fibre = -1;
    std::array<double, 2> position{};  ///< m
    std::array<double, 2> direction{}; ///< along the bond
    double normal_force = 0;           ///< N, positive in tension
    double shear_force = 0;            ///< N
    double energy = 0;                 ///< J, stored in the bond and lost with it
};

/// Fibres of the same zone and layer.
struct layer_result {
    std::string zone;
    int layer = 0; ///< surface: 0 on top; deep: 0 at the centre; middle: fifths of the depth, 0 on top
    std::size_t fibres = 0;
    std::size_t bonds = 0;
    std::size_t broken = 0;
    double broken_fraction() const { return bonds == 0 ? 0.0 : double(broken) / double(bonds); }
};

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

/// The record of a break, with its fibre and the direction in which the bond was laid.
crack_record crack_of(specimen const& s, lacuna::break_event<2> const& event);

/// Sorts the cracks of `r` to layers (by zone, then number) and counts the fibres with at least one.
void sort_cracks(specimen const& s, run_result& r);

/// The damage at a time of the run. \param position of the particles by id, m \param pores as they stand
lacuna::scene damage_scene(specimen const& s, options const& o, std::span<lacuna::vec<double, 2> const> position,
                           std::span<crack_record const> cracks, std::vector<lacuna::scene::pore> pores, double time);

} // namespace cartilage
