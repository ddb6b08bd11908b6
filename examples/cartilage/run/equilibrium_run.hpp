// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <lacuna/draw/picture_scene.hpp>
#include <lacuna/equilibrium/parameters.hpp>
#include <lacuna/observe/run_directory.hpp>

#include "cartilage/run/results.hpp"
#include "cartilage/specimen/specimen.hpp"

/// \file
/// A specimen under a load that grows from equilibrium to equilibrium. Loads in MPa, all else in SI units.

namespace cartilage {

/// How a specimen is loaded.
struct equilibrium_request {
    options model;       ///< its load_MPa is the highest load; picture_every counts load steps
    int steps = 40;      ///< equal steps of the load from 0 to the highest one
    int iterations = 200; ///< of one solve, at most
    bool drained = false; ///< pore pressures stay 0; else pores are sealed
    /// The bonds that break at once where several are overloaded; groups are fibres.
    lacuna::failure_choice failures = lacuna::failure_choice::first;
};

/// Damage of one layer.
struct equilibrium_layer : layer_result {
    std::optional<double> cut_MPa; ///< load of its first break
};

/// What a specimen does under a load that grows.
struct equilibrium_run {
    /// How it ended: "complete" (90 % of the fibres are cut), "limit" (equilibrium at the highest load), "mechanism"
    /// (no equilibrium above a load), "not_converged" or "interrupted".
    std::string ended;
    bool held = false;    ///< there is an equilibrium at a small load
    double load_MPa = 0;  ///< at the end
    std::optional<double> first_crack_MPa;   ///< of the first break of a fibre's bond
    std::optional<double> capacity_MPa;      ///< at which a fibre of the first layer and another fibre are cut
    std::optional<double> capacity_half_MPa; ///< at which half of the first layer's bonds are broken
    std::optional<double> complete_MPa;      ///< at which 90 % of the fibres are cut
    std::vector<crack_record> cracks;        ///< in the order of breaking
    std::vector<double> crack_MPa;           ///< load of each crack
    std::vector<equilibrium_layer> layers;
    std::size_t fibres_cut = 0;
    double unbalanced = 0;                   ///< largest unbalanced force at the end over the largest force, 1
    std::vector<lacuna::regularisation_trial> trials; ///< of the last load
    int factorisations = 0;
    double seconds = 0;                      ///< computing time

    /// "strength" or "mechanism": whether the specimen stands at all, and as long as no fibre is cut.
    char const* result() const { return held && (ended != "mechanism" || first_crack_MPa) ? "strength" : "mechanism"; }
    /// The load above which there is no equilibrium, if there is one.
    std::optional<double> ends_MPa() const { return ended == "mechanism" ? std::optional(load_MPa) : std::nullopt; }
};

/// No equilibrium was found, nor that there is none. The message names load and residual; the exit status is 3.
class no_convergence : public std::runtime_error {
public:
    explicit no_convergence(equilibrium_run const& r);
};

/// Checks that the request has a meaning in equilibrium. \throws usage_error that names what has none
void validate(equilibrium_request const& r);

/// Loads the specimen from equilibrium to equilibrium, up to complete damage, the highest load, or the load at which
/// equilibrium ends.
/// \param out receives the pictures on the way; null: none \param progress null: none
/// \param damage receives the scene at the end; null: none
/// \throws std::invalid_argument if the model cannot be built
equilibrium_run find_strength(specimen const& s, equilibrium_request const& r, lacuna::run_directory* out,
                              std::FILE* progress, lacuna::scene* damage);

/// find_strength() for one model. Each is compiled once, in equilibrium_models.cpp and equilibrium_models_beam.cpp.
template <class Model>
equilibrium_run find_strength_of(specimen const& s, equilibrium_request const& r, lacuna::run_directory* out,
                                 std::FILE* progress, lacuna::scene* damage);

} // namespace cartilage
