// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "column.hpp"

/// \file
/// Bodies of the cases in slow time.

namespace poroelasticity {

/// Mandel's slab: a column along x whose upper mirror is a rigid, smooth plate. It is loaded at once.
class mandel_body {
public:
    /// \param half_layers of pores, from the middle to a free side
    /// \param cells distance between the plates in disc diameters
    mandel_body(int half_layers, int cells)
        : body_(make_column(2 * half_layers + 1, cells, medium_.radius, 0)), stress_(1e-5 * medium_.oedometric()),
          sim_(body_.packing, porous_parameters(medium_, 0)) {
        std::vector<std::size_t> plate;
        for (std::size_t i = 0; i < sim_.size(); ++i) {
            bool const upper = body_.side[i] > 0;
            sim_.fix(i, {.x = body_.row[i] == half_layers, .y = body_.side[i] < 0, .z = false,
                         .rotation = body_.side[i] != 0});
            if (upper) plate.push_back(i);
        }
        sim_.attach_to_rigid_plate(plate, 1);
        double const force = stress_ * body_.length() / double(plate.size());
        for (auto const i : plate) sim_.apply(i, {0, -force});
        sim_.fill_pores(column_pores(body_, {.near_drained = true}));
    }

    simulator& sim() { return sim_; }
    lattice_medium const& medium() const { return medium_; }
    /// L^2 / c, s, with half of the width.
    double tau() const { return std::pow(body_.length() / 2, 2) / medium_.diffusivity(); }
    /// Mean pressure of the two layers beside the middle, divided by the undrained pressure p_0 = B sigma / 2.
    double middle_pressure() const {
        int const m = body_.rows / 2;
        return (layer_pressure(sim_, body_, m - 1) + layer_pressure(sim_, body_, m)) / (medium_.skempton() * stress_);
    }

private:
    lattice_medium medium_{};
    column body_;
    double stress_;
    simulator sim_;
};

/// A column of cartilage in confined compression, drained at its top: the modulus, permeability and thickness are those
/// of the bovine humeral head (Soltz and Ateshian; aggregate modulus 0.64 MPa, 3.62e-16 m^4/(N s)). Its fluid is water.
class cartilage_column {
public:
    static constexpr double modulus = 0.64e6;          ///< Pa
    static constexpr double permeability = 3.62e-16;   ///< m^4/(N s)
    static constexpr double thickness = 1e-3;          ///< m
    static constexpr double final_strain = 1e-4;

    /// \param layers of pores, even
    /// \param held whether the top is moved, instead of loaded
    cartilage_column(int layers, bool held)
        : medium_(make_medium(layers)), body_(make_column(layers + 1, 1, medium_.radius, 1)),
          sim_(body_.packing, porous_parameters(medium_, 0)) {
        for (std::size_t i = 0; i < sim_.size(); ++i) {
            bool const at_top = body_.row[i] == layers;
            sim_.fix(i, {.x = true, .y = body_.row[i] == 0 || (held && at_top), .z = false,
                         .rotation = body_.side[i] != 0});
            if (at_top) top_.push_back(i);
            if (at_top && !held) sim_.apply(i, {0, -load() * 2 * medium_.radius * body_.share(i)});
        }
        sim_.fill_pores(column_pores(body_, {}));
        while (body_.row[above_] != 1) ++above_;
    }

    simulator& sim() { return sim_; }
    lattice_medium const& medium() const { return medium_; }
    double load() const { return final_strain * modulus; } ///< Pa
    double tau() const { return body_.length() * body_.length() / medium_.diffusivity(); } ///< s
    /// Moves the top down. \param rate of the strain, 1/s
    void move_top(double rate) {
        for (auto const i : top_) sim_.set_velocity(i, {0, -rate * body_.length()});
    }
    double strain() const { return 1 - sim_.position(top_[0])[1] / body_.length(); }
    double base_pressure() const { return layer_pressure(sim_, body_, 0); } ///< Pa
    /// Stress at the base, of the lattice and of the fluid, divided by modulus times final strain.
    double base_stress() const {
        return (1 - sim_.position(above_)[1] / medium_.layer()) / final_strain + base_pressure() / load();
    }

private:
    static lattice_medium make_medium(int layers) {
        lattice_medium m;
        m.radius = thickness / (layers * std::sqrt(3.0));
        m.bulk_modulus = 2.2e9;
        double const share = modulus / m.oedometric();
        m.normal_stiffness *= share;
        m.shear_stiffness *= share;
        m.conductance = permeability * std::sqrt(3.0);
        return m;
    }

    lattice_medium medium_;
    column body_;
    simulator sim_;
    std::vector<std::size_t> top_;
    std::size_t above_ = 0; // a particle of the row above the base
};

/// Holds the disc in the middle of a free body, and the direction to one of its neighbours.
inline void hold_middle(simulator& sim, discs const& packing) {
    std::size_t middle = 0, beside = 0;
    for (std::size_t i = 0; i < packing.size(); ++i)
        if (norm(packing.position[i]) < norm(packing.position[middle])) middle = i;
    auto const apart = [&](std::size_t i) {
        auto const d = packing.position[i] - packing.position[middle];
        return std::hypot(d[0] - 2 * packing.radius[middle], d[1]);
    };
    for (std::size_t i = 0; i < packing.size(); ++i)
        if (apart(i) < apart(beside)) beside = i;
    sim.fix(middle, {.x = true, .y = true, .z = false, .rotation = false});
    sim.fix(beside, {.x = false, .y = true, .z = false, .rotation = false});
}

} // namespace poroelasticity
