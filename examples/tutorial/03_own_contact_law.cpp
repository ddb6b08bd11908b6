// SPDX-License-Identifier: BSD-3-Clause
//
// 3. Your own contact law: one formula, written over its scalar type.
//
// A contact that yields (Walton and Braun 1986, J. Rheology 30, 949). It has stiffness k_1 in loading and the higher
// stiffness k_2 in unloading, so that a dent remains. The coefficient of restitution is sqrt(k_1 / k_2) at any speed.
// The engine evaluates the formula for packs of numbers. No file of the library changes.

#include <cmath>
#include <string>

#include <lacuna/laws/law_defaults.hpp>
#include <lacuna/simulation.hpp>

#include "check.hpp"

// This max works for numbers, packs of numbers and dual numbers.
using lacuna::max;

struct yielding_contact : lacuna::law_defaults<yielding_contact> {
    struct material { // input of each material; two materials combine as springs in series
        double loading = 1e6, unloading = 4e6; // k_1, k_2, N/m
        void validate(std::string const& name) const {
            lacuna::require_positive(name + ".loading", loading);
            if (!(unloading >= loading)) lacuna::refuse(name + ".unloading", unloading, ">= loading");
        }
    };
    template <class T> struct parameters { T loading, unloading; };
    template <class T, int Dim> struct history { T touching_distance, deepest; }; // state of a pair, m

    template <class T, int Dim>
    static lacuna::pair_response<T, Dim, history<T, Dim>>
    evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        T overlap = max(h.touching_distance - m.distance, T(0)), deepest = max(overlap, h.deepest);
        T yielded = T(1) - p.loading / p.unloading; // share of the largest overlap that remains as a dent
        T pressed = p.unloading * max(overlap - deepest * yielded, T(0));
        T plastic = T(0.5) * p.loading * yielded * (deepest * deepest - h.deepest * h.deepest);
        return {-pressed, {}, {h.touching_distance, deepest}, T(0.5) * pressed * pressed / p.unloading, plastic};
    }
    template <class T> static T stiffness(parameters<T> const& p) { return p.unloading; } // the largest
};

struct model : lacuna::default_model<2> {
    using contact_law = yielding_contact;
};

int main() {
    lacuna::packing<double, 2> discs;
    discs.add({0.0, 0.0}, 0.5);
    discs.add({1.001, 0.0}, 0.5);

    lacuna::simulation_parameters<model> p;
    p.materials[0].contact = {.loading = 1e6, .unloading = 4e6};
    p.safety = 0.01;

    lacuna::simulation<model> sim(discs, p);
    sim.set_velocity(0, {1.0, 0.0}); // m/s
    while (sim.velocity(1)[0] == 0 || sim.force(1)[0] != 0) sim.step();

    double const parting = sim.velocity(1)[0] - sim.velocity(0)[0];
    return tutorial::check("coefficient of restitution", parting, std::sqrt(1e6 / 4e6), 1e-3);
}
