// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "closed_forms.hpp"
#include "column.hpp"

namespace poroelasticity {

/// A column on a sealed, rigid base under a load on its drained top.
struct terzaghi_setup {
    int layers = 40;             ///< of pores; even
    int cells = 1;               ///< width in disc diameters
    double slowness = 800;       ///< H^2 / c_v divided by the travel time of a wave through the drained column
    lattice_medium medium{};     ///< its conductance is set by `slowness`
    double strain = 1e-5;        ///< final strain
};

/// The column at time 0: the fluid carries the whole load, the skeleton none. This is undrained loading of an
/// incompressible fluid. The pressure divided by its initial value is the same for any fluid.
class terzaghi_column {
public:
    explicit terzaghi_column(terzaghi_setup const& s)
        : medium_(prepare(s)), body_(make_column(s.layers + 1, s.cells, medium_.radius, 1)),
          load_(s.strain * medium_.oedometric()), sim_(body_.packing, porous_parameters(medium_, load_)) {
        for (std::size_t i = 0; i < sim_.size(); ++i) {
            sim_.fix(i, {.x = true, .y = body_.row[i] == 0, .z = false, .rotation = body_.side[i] != 0});
            if (body_.row[i] == s.layers) sim_.apply(i, {0, -load_ * 2 * body_.radius * body_.share(i)});
        }
        sim_.fill_pores(column_pores(body_, {}));
        while (body_.row[top_] != s.layers) ++top_;
        start_ = sim_.position(top_)[1];
    }

    simulator& sim() { return sim_; }
    simulator const& sim() const { return sim_; }
    column const& body() const { return body_; }
    lattice_medium const& medium() const { return medium_; }
    double load() const { return load_; }                         ///< Pa
    /// T = c_v t / H^2.
    double time() const { return sim_.time() * medium_.diffusivity() / (body_.length() * body_.length()); }
    /// Settlement divided by the final settlement.
    double consolidation_degree() const {
        return (start_ - sim_.position(top_)[1]) / (load_ * body_.length() / medium_.oedometric());
    }

private:
    static lattice_medium prepare(terzaghi_setup const& s) {
        lattice_medium m = s.medium;
        double const height = s.layers * m.layer();
        m.set_consolidation_time(s.slowness * height / m.wave_speed(), height);
        return m;
    }

    lattice_medium medium_;
    column body_;
    double load_;
    simulator sim_;
    std::size_t top_ = 0;
    double start_ = 0;
};

} // namespace poroelasticity
