// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <lacuna/observe/growing_file.hpp>
#include <lacuna/draw/picture_scene.hpp>

#include "../terminal_progress.hpp"

/// \file
/// Uniaxial compression of a bonded specimen between two platens, as data: what is asked for, and what comes out.

namespace uniaxial {

enum class specimen_kind {
    random, ///< discs of radii 0.75 to 1.25 of the mean
    lattice ///< equal discs in straight chains along the load: moduli with closed forms
};

/// SI units; stresses and strains are positive in compression.
struct request {
    specimen_kind specimen = specimen_kind::random;
    double width = 0.04;            ///< m
    double height = 0.08;           ///< m
    double radius = 0.6e-3;         ///< mean, m
    double thickness = 1e-3;        ///< m
    std::uint64_t seed = 1;         ///< of the packing and of the strengths
    double bond_modulus = 10e9;     ///< k_n = bond_modulus * thickness, Pa
    double shear_ratio = 0.5;       ///< k_s / k_n, of bonds and contacts
    double tensile_strength = 12e6; ///< of a bond, mean, Pa
    double cohesion = 24e6;         ///< of a bond, mean, Pa
    double internal_friction = 0.6; ///< of bonds: tan phi of Mohr and Coulomb's line
    double friction = 0.5;          ///< of contacts, platens included
    double weibull_modulus = 8;     ///< of the strengths' scatter; infinite: none
    bool elastic = false;           ///< bonds that never break: moduli alone
    double strain = 0.015;          ///< at which a run ends at the latest
    long long steps = 60000;        ///< to get there

    /// \throws std::invalid_argument naming field, value and rule.
    void validate() const;
};

/// One row of the stress-strain curve.
struct sample {
    double strain = 0;         ///< of the whole specimen, by the platens
    double stress = 0;         ///< mean force on the platens over the first section, Pa
    double middle_strain = 0;  ///< along the load, of the middle half: least squares over its particles' displacements
    double lateral_strain = 0; ///< across the load, the same; negative where the specimen gets wider
    long long tension_cracks = 0, shear_cracks = 0;
};

/// A figure, and what a closed form gives for it where there is one.
struct figure {
    std::string quantity, unit;
    double value = 0;
    std::optional<double> reference{};
};

struct outcome {
    request asked;
    std::vector<sample> curve;
    double young_modulus = 0; ///< Pa
    double poisson_ratio = 0;
    double strength = 0;      ///< UCS, the highest stress, Pa
    std::size_t peak = 0;     ///< row of the highest stress
    std::size_t particles = 0, bonds = 0;
    long long steps = 0;
    double time_step = 0;
    std::string ended; ///< "strain", "failure", or "stopped by" a signal: then as far as it came
    lacuna::scene end; ///< the specimen after the run

    std::vector<figure> figures() const;
};

/// First line and a row of uniaxial.csv.
std::string row_heading();
std::string row_of(sample const& s);

/// \param rows file that is begun and grows by the curve's rows as they come; null: none
/// \param progress is told how far the run is; null: nobody
/// \throws std::invalid_argument for a bad request, std::runtime_error for a run that failed
outcome run(request const& asked, lacuna::growing_file* rows = nullptr, programs::terminal_progress* progress = nullptr);

/// Young's modulus that the outline of a strip of `chains` straight chains of touching discs shows under a load along
/// them, and Poisson's ratio, by the moduli of the triangular lattice: the strip deforms as the lattice does, and lacks
/// the half of the slanted bonds beyond its outer chains. All lengths over the diameter, stiffness over k_n.
double strip_modulus(int chains, double shear_ratio);
double lattice_modulus(double shear_ratio);
double lattice_poisson_ratio(double shear_ratio);

} // namespace uniaxial
