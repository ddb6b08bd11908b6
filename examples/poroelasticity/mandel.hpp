// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "closed_forms.hpp"
#include "rigid_plate.hpp"

namespace poroelasticity {

/// A slab compressed between two rigid, smooth plates. The fluid leaves at its two free sides.
struct mandel_setup {
    int half_layers = 24;        ///< of pores, from the middle to a free side
    int cells = 1;               ///< distance between the plates in disc diameters
    double slowness = 1000;      ///< L^2 / c_v divided by the travel time of a wave through half the drained slab
    double ramp = 0.01;          ///< time T within which the load rises
    lattice_medium medium{};     ///< its conductance is set by `slowness`
    double strain = 1e-5;        ///< load divided by the modulus of confined compression
};

/// The slab, initially at rest and at pressure 0, under a load that rises and then stays constant.
class mandel_slab {
public:
    explicit mandel_slab(mandel_setup const& s)
        : medium_(prepare(s)), body_(make_column(2 * s.half_layers + 1, s.cells, medium_.radius, 0)), ramp_(s.ramp),
          stress_(s.strain * medium_.oedometric()), sim_(body_.packing, porous_parameters(medium_, 0)) {
        hold_mirrors(sim_, body_);
        for (std::size_t i = 0; i < sim_.size(); ++i)
            if (body_.row[i] == s.half_layers)
                sim_.fix(i, {.x = true, .y = body_.side[i] != 0, .z = false, .rotation = body_.side[i] != 0});
        sim_.fill_pores(column_pores(body_, {.near_drained = true}));
        double const undrained = medium_.oedometric() + 1 / medium_.storage();
        std::vector<std::size_t> held;
        for (std::size_t i = 0; i < sim_.size(); ++i)
            if (body_.side[i] > 0) held.push_back(i);
        plate_.emplace(sim_, body_.packing, held, 1, undrained * body_.length() / (2 * body_.radius), 0.5);
    }

    void step() {
        double const risen = ramp_ > 0 && time() < ramp_ ? time() / ramp_ : 1;
        plate_->move(sim_, risen * stress_ * body_.length());
        sim_.step();
    }
    simulator const& sim() const { return sim_; }
    column const& body() const { return body_; }
    lattice_medium const& medium() const { return medium_; }
    double half_width() const { return body_.length() / 2; }
    double time() const { return sim_.time() * medium_.diffusivity() / (half_width() * half_width()); }
    /// Undrained pressure under the load, p_0 = B sigma / 2, Pa.
    double undrained_pressure() const { return medium_.skempton() * stress_ / 2; }
    /// Mean pressure of the two layers beside the middle, divided by p_0.
    double middle_pressure() const {
        int const m = body_.rows / 2;
        return (layer_pressure(sim_, body_, m - 1) + layer_pressure(sim_, body_, m)) / 2 / undrained_pressure();
    }

private:
    static lattice_medium prepare(mandel_setup const& s) {
        lattice_medium m = s.medium;
        double const half = s.half_layers * m.layer();
        m.set_consolidation_time(s.slowness * half / m.wave_speed(), half);
        return m;
    }

    lattice_medium medium_;
    column body_;
    double ramp_, stress_;
    simulator sim_;
    std::optional<rigid_plate> plate_;
};

} // namespace poroelasticity
