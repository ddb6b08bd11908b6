// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/packings/fibres.hpp>
#include <lacuna/particles/packing.hpp>

#include "cartilage/common/zone.hpp"

namespace lacuna {

/// How a specimen is built. `literal`: as the paper states, with random radii and random free particles. `lattice`:
/// equal radii on hexagonal lattices, nothing random, symmetric left to right.
enum class specimen_preset { literal, lattice };

/// Index of a particle's material in a cartilage specimen (the columns of Table 1).
enum cartilage_material : int { free_matrix = 0, surface_collagen = 1, middle_collagen = 2, deep_collagen = 3 };

/// Parameters of a cartilage specimen. Lengths in m; "diameters" are mean diameters, r_min + r_max.
struct cartilage_specimen_parameters {
    cartilage_zone zone = cartilage_zone::surface;
    specimen_preset preset = specimen_preset::literal;
    double length = 120e-6;           ///< horizontal, m (Table 2)
    double height = 300e-6;           ///< vertical, m (Table 2)
    double r_min = 1.5e-6;            ///< smallest radius, m (Table 2); preset lattice uses the mean radius
    double r_max = 2e-6;              ///< largest radius, m (Table 2)
    double fibre_spacing = 4;         ///< between centres of neighbouring fibres, diameters; adjusted to the size
    int fibre_layers = 0; ///< number of surface fibres; of deep fibres from the centre fibre to one side; depth of the
                          ///< middle network in fibre spacings; 0: as many as fit
    bool link_fibres = false;         ///< bonds between fibres where they touch: see link_fibres()
    bool link_matrix = false;         ///< bonds between fibres and free particles where they touch
    double deep_fraction = 1.0 / 3;   ///< share of the height, from the bottom; zone `whole` only
    double middle_fraction = 1.0 / 3; ///< share of the height, above the deep zone; zone `whole` only
    double surface_fraction = 1.0 / 3; ///< share of the height, on top; zone `whole` only
    double middle_fibre_length = 60e-6; ///< longest fibre of the middle zone's network, m
    int minimum_fibre_particles = 4;  ///< shorter pieces of the middle zone's network are left out
    double fill = 0.9;                ///< free particles are added up to this area fraction of the specimen, or until
                                      ///< the packing is jammed, at about 0.85
    double contact_tolerance = 0.01;  ///< largest overlap of a pair, relative to its smaller radius
    double thickness = 0;             ///< out of plane, m; 0: one diameter
    double loaded_margin = 7;         ///< length of the unloaded top row at each end, diameters
    double wall_distance = 2;         ///< from the specimen's sides to the side walls, diameters
    std::uint64_t seed = 1;           ///< preset literal only

    double diameter() const noexcept { return r_min + r_max; }

    /// Checks all parameters. \throws std::invalid_argument that names the field, its value and the rule
    void validate() const {
        require_positive("specimen.r_min", r_min);
        require_positive("specimen.r_max", r_max);
        if (r_max < r_min) refuse("specimen.r_max", r_max, "at least r_min = " + to_text(r_min));
        if (r_max > 2 * r_min) refuse("specimen.r_max", r_max, "at most 2 r_min = " + to_text(2 * r_min));
        require_positive("specimen.length", length);
        require_positive("specimen.height", height);
        require_in("specimen.fibre_spacing", fibre_spacing, 2.0, 1e3);
        if (fibre_layers < 0) refuse("specimen.fibre_layers", double(fibre_layers), "at least 0");
        require_not_negative("specimen.loaded_margin", loaded_margin);
        require_not_negative("specimen.wall_distance", wall_distance);
        require_not_negative("specimen.thickness", thickness);
        require_in("specimen.fill", fill, 0.3, 1.0);
        require_in("specimen.contact_tolerance", contact_tolerance, 1e-3, 0.05);
        if (minimum_fibre_particles < 2)
            refuse("specimen.minimum_fibre_particles", double(minimum_fibre_particles), "at least 2");
        double const d = diameter();
        if (!(middle_fibre_length >= minimum_fibre_particles * d) || !std::isfinite(middle_fibre_length))
            refuse("specimen.middle_fibre_length", middle_fibre_length,
                   "at least minimum_fibre_particles diameters = " + to_text(minimum_fibre_particles * d));
        if (zone == cartilage_zone::whole) {
            require_in("specimen.deep_fraction", deep_fraction, 0.0, 1.0);
            require_in("specimen.middle_fraction", middle_fraction, 0.0, 1.0);
            require_in("specimen.surface_fraction", surface_fraction, 0.0, 1.0);
            double const sum = deep_fraction + middle_fraction + surface_fraction;
            if (std::fabs(sum - 1) > 1e-9)
                refuse("specimen.deep_fraction + middle_fraction + surface_fraction", sum, "1");
            for (double share : {deep_fraction, middle_fraction, surface_fraction})
                if (share * height < (fibre_spacing + 1) * d)
                    refuse("specimen.height", height,
                           "enough for one fibre spacing and a diameter in each zone, " +
                               to_text((fibre_spacing + 1) * d));
        }
        if (height < (fibre_spacing + 2) * d)
            refuse("specimen.height", height,
                   "at least one fibre spacing and two diameters, " + to_text((fibre_spacing + 2) * d));
        if (length < (fibre_spacing + 2) * d)
            refuse("specimen.length", length,
                   "at least one fibre spacing and two diameters, " + to_text((fibre_spacing + 2) * d));
        if (length < (2 * loaded_margin + 2) * d)
            refuse("specimen.length", length,
                   "more than twice loaded_margin plus two diameters, " + to_text((2 * loaded_margin + 2) * d));
        if (length / d > 1e7 / (height / d))
            refuse("specimen.height", height, "such that length * height holds at most 1e7 particles");
    }
};

/// One collagen fibre of a specimen.
struct cartilage_fibre : fibre_chain {
    cartilage_zone zone = cartilage_zone::surface;
    /// Surface: counted downwards from the top fibre, 0. Deep: counted from the centre fibre, 0, to both sides. Middle:
    /// the fifth of the zone's depth at the fibre's mean height; 0 is the top fifth.
    int layer = 0;
    /// Deep: as `layer`, but negative to the left of the centre fibre. Other zones: as `layer`.
    int order = 0;
};

/// A specimen, ready to be loaded. Lengths in m, x to the right from the left side, y upward from the bottom.
template <class Real>
struct cartilage_specimen {
    packing<Real, 2> discs;             ///< material: cartilage_material; bonds: fibres, fibre links, matrix links
    std::size_t fibre_links = 0;        ///< bonds between fibres
    std::size_t matrix_links = 0;       ///< bonds between fibres and free particles
    std::vector<std::int32_t> fibre;    ///< per particle: index of its fibre, -1 for free particles
    std::vector<cartilage_fibre> fibres;
    std::vector<std::int32_t> fixed;    ///< bottom row, left to right
    std::vector<std::int32_t> top;      ///< top row, left to right
    std::vector<std::int32_t> loaded;   ///< the top row except `loaded_margin` at each end
    Real left{}, right{};               ///< sides of the specimen
    Real wall_left{}, wall_right{};     ///< planes of the side walls
    Real length{}, height{}, thickness{};
    Real deep_top{};                    ///< height of the top of the deep zone (0: no deep zone)
    Real middle_top{};                  ///< height of the top of the middle zone (= deep_top: no middle zone)
    Real surface_spacing{};             ///< of the surface fibres, adjusted to the height
    Real deep_spacing{};                ///< of the deep fibres, adjusted to the length
    packing_statistics statistics;      ///< pairs with gaps up to 2 contact_tolerance count as contacts
};

} // namespace lacuna
