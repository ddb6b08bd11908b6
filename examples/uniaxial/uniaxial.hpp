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
/// Uniaxial compression of a bonded specimen between two platens: the request, the run and its outcome.

namespace uniaxial {

enum class specimen_kind {
    random, ///< discs with radii of 0.75 to 1.25 times the mean
    lattice ///< equal discs in straight chains along the load; its moduli have closed forms
};

/// Settings of a test. SI units; stresses and strains are positive in compression.
struct request {
    specimen_kind specimen = specimen_kind::random;
    double width = 0.04;            ///< m
    double height = 0.08;           ///< m
    double radius = 0.6e-3;         ///< mean of the discs, m
    double thickness = 1e-3;        ///< m
    std::uint64_t seed = 1;         ///< of the packing and the strengths
    double bond_modulus = 10e9;     ///< k_n = bond_modulus * thickness, Pa
    double shear_ratio = 0.5;       ///< k_s / k_n, of bonds and contacts
    double tensile_strength = 12e6; ///< mean of the bonds, Pa
    double cohesion = 24e6;         ///< mean of the bonds, Pa
    double internal_friction = 0.6; ///< of bonds: tan phi in the Mohr-Coulomb criterion
    double friction = 0.5;          ///< of contacts, also with the platens
    double weibull_modulus = 8;     ///< scatter of the strengths; infinite: none
    bool elastic = false;           ///< bonds never break; only the moduli are measured
    double strain = 0.015;          ///< the run ends at this strain at the latest
    long long steps = 60000;        ///< number of steps to that strain
    bool equilibrium = false;       ///< static equilibria instead of steps in time
    int load_steps = 100;           ///< equilibria up to that strain, besides those after failures of bonds

    /// \throws std::invalid_argument naming field, value and rule.
    void validate() const;
};

/// One row of the stress-strain curve. With equilibria the cracks of a row are those before the bonds failed that its
/// stress breaks.
struct sample {
    double strain = 0;         ///< of the specimen, from the motion of the platens
    double stress = 0;         ///< mean force on the platens divided by the initial section, Pa
    double middle_strain = 0;  ///< of the middle half along the load, by least squares over displacements of particles
    double lateral_strain = 0; ///< the same across the load; negative if the specimen widens
    long long tension_cracks = 0, shear_cracks = 0;
};

/// A result, with its closed form if there is one.
struct figure {
    std::string quantity, unit;
    double value = 0;
    std::optional<double> reference{};
};

/// The outcome of a test. SI units.
struct outcome {
    request asked;
    std::vector<sample> curve;
    double young_modulus = 0; ///< Pa
    double poisson_ratio = 0;
    double strength = 0;      ///< uniaxial compressive strength: the highest stress, Pa
    std::size_t peak = 0;     ///< row of `curve` with the highest stress
    std::size_t particles = 0, bonds = 0;
    long long steps = 0;
    double time_step = 0;
    long long load_steps = 0; ///< that were reached
    int factorisations = 0;   ///< of stiffness matrices
    /// "strain", "failure", or "stopped by SIGNAL"; then the curve ends early. Of equilibria also "mechanism": there is
    /// none beyond the end of the curve, and "not converged": none was found.
    std::string ended;
    lacuna::scene end; ///< the specimen after the run

    /// The results for tables.
    std::vector<figure> figures() const;
};

/// First line of uniaxial.csv.
std::string row_heading();
/// A row of uniaxial.csv.
std::string row_of(sample const& s);

/// Runs a test.
/// \param rows file that receives the rows of the curve during the run; may be null
/// \param progress display of the progress; may be null
/// \throws std::invalid_argument for a bad request, std::runtime_error for a run that failed
outcome run(request const& asked, lacuna::growing_file* rows = nullptr,
            programs::terminal_progress* progress = nullptr);

/// Young's modulus of a strip of `chains` straight chains of touching discs under a load along the chains, referred to
/// the width of its outline. The strip deforms as the lattice does, but lacks the slanted bonds beyond its outer
/// chains. In units of k_n over the thickness; README.md derives it.
/// \param shear_ratio k_s / k_n
double strip_modulus(int chains, double shear_ratio);
/// Young's modulus of the triangular lattice in units of k_n over the thickness.
double lattice_modulus(double shear_ratio);
/// Poisson's ratio of the triangular lattice.
double lattice_poisson_ratio(double shear_ratio);

} // namespace uniaxial
