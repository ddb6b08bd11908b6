// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <cmath>
#include <vector>

#include <lacuna/observe/crack_record.hpp>
#include "cartilage/specimen/cartilage_specimen.hpp"
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation.hpp>

#include "simulation/specimens.hpp"

using namespace lacuna;

namespace {

cartilage_specimen<double> small_specimen(specimen_preset preset) {
    cartilage_specimen_parameters p;
    p.preset = preset;
    p.length = 80e-6;
    p.height = 60e-6;
    return make_cartilage_specimen<double>(p);
}

struct outcome {
    std::size_t broken;
    energy_ledger energy;
    double highest_pressure;
};

struct with_energy {
    static constexpr stage stages = stage::end;
    static constexpr bool needs_energy = true;
    template <class Simulation>
    void on_end(Simulation const&) {}
};

/// The paper's model with water in the pores.
outcome coupled_run(cartilage_specimen<double> const& s, double load_MPa, long long steps) {
    simulation<specimens::wet> sim(s.discs, specimens::parameters(s));
    cartilage::set_up(sim, s, load_MPa * 1e6, {});
    crack_record<break_event<2>> cracks;
    sim.run(steps, cracks, with_energy{});
    double highest = 0;
    for (std::size_t p = 0; p < sim.flow().network().pores(); ++p)
        highest = std::max(highest, std::fabs(sim.flow().network().pressure[p]));
    return {cracks.events().size(), sim.energy(), highest};
}
outcome coupled_run(double load_MPa, long long steps) {
    return coupled_run(small_specimen(specimen_preset::literal), load_MPa, steps);
}

} // namespace

TEST_CASE("cartilage cracks far above its capacity and not far below") {
    auto const high = coupled_run(1000, 1500);
    REQUIRE(high.broken > 0);
    REQUIRE(high.energy.fracture > 0);
    REQUIRE(high.highest_pressure > 1e6);
    auto const low = coupled_run(0.5, 1500);
    REQUIRE(low.broken == 0);
    REQUIRE(low.energy.fracture == 0);
    REQUIRE(low.highest_pressure > 0);
}

TEST_CASE("the energy of a coupled run with cracks, friction and fluid adds up") {
    auto const run = coupled_run(60, 3000);
    REQUIRE(run.broken > 0);
    REQUIRE(run.energy.friction > 0);
    REQUIRE(run.energy.fluid_storage > 0.01 * run.energy.largest());
    REQUIRE_THAT(run.energy.residual(), WithinAbs(0, 1e-3 * run.energy.largest()));
}

TEST_CASE("the energy of a coupled run of the paper's specimen, 120 by 300 um, adds up") {
    auto const s = make_cartilage_specimen<double>({});
    REQUIRE(s.discs.size() > 3000);
    auto const run = coupled_run(s, 60, 1000);
    REQUIRE(run.broken > 0);
    REQUIRE(run.energy.friction > 0);
    REQUIRE(run.energy.fluid_storage > 0.01 * run.energy.largest());
    REQUIRE_THAT(run.energy.residual(), WithinAbs(0, 1e-3 * run.energy.largest()));
}

TEST_CASE("the energy of a coupled run with flowing water adds up, and so do its terms") {
    auto const s = specimens::small();
    auto sim = specimens::make(s, 1, 150);
    crack_record<break_event<2>> cracks;
    sim.run(3000, cracks, with_energy{});
    auto const& e = sim.energy();
    REQUIRE(cracks.events().size() > 0);
    INFO("kinetic " << e.kinetic << " rotation " << e.rotation << " strain " << e.strain << " in bonds "
                    << e.bond_strain << " friction " << e.friction << " fracture " << e.fracture << " in shear "
                    << e.shear_fracture << " stored in fluid " << e.fluid_storage << " viscous " << e.fluid_viscous
                    << " out " << e.fluid_outflow << " fluid's work " << e.fluid_work << " external " << e.external
                    << " residual " << e.residual());
    REQUIRE(e.friction > 0);
    REQUIRE(e.fluid_viscous > 0);
    REQUIRE(e.rotation > 0);
    REQUIRE(e.rotation < e.kinetic);
    REQUIRE(e.bond_strain > 0);
    REQUIRE(e.bond_strain < e.strain);
    REQUIRE(e.shear_fracture <= e.fracture);
    REQUIRE_THAT(e.residual(), WithinAbs(0, 1e-3 * e.largest()));
    // The work of the particles on the fluid is stored in it, dissipated, or has flowed out.
    REQUIRE_THAT(-e.fluid_work, WithinRel(e.fluid_storage + e.fluid_viscous + e.fluid_outflow, 1e-9));
    // Terms that follow from the state, recomputed here.
    double stored = 0;
    auto const& net = sim.flow().network();
    for (std::size_t p = 0; p < net.pores(); ++p)
        stored += net.volume[p] * net.pressure[p] * net.pressure[p] / (2 * sim.settings().flow.bulk_modulus);
    REQUIRE_THAT(e.fluid_storage, WithinRel(stored, 1e-12));
    double released = 0;
    for (auto const& event : cracks.events()) released += event.energy;
    REQUIRE_THAT(e.fracture, WithinRel(released, 0.2));
}

TEST_CASE("an inverted pore stops the run") {
    auto p = specimens::parameters(specimens::small());
    p.walls.clear();
    p.time_step = 1e-9;
    packing<double, 2> discs;
    for (vec<double, 2> const x : {vec<double, 2>{0, 0}, {3e-6, 0}, {1.5e-6, 2e-6}}) discs.add(x, 0.5e-6, 1);
    simulation<specimens::wet> sim(discs, p);
    sim.fill_pores([](points_view<double, 2> points, double const* radii) {
        return make_pore_network(regular_triangulation(points, radii), points, radii);
    });
    // The upper particle passes between the two others.
    for (std::size_t k = 0; k < 3; ++k) sim.fix(k);
    sim.set_velocity(2, {0, -1e-8 / p.time_step});
    try {
        sim.run(1000);
        FAIL("nothing was thrown");
    } catch (unstable_run const& e) {
        // 2e-6 m at 1e-8 m per step; pores are checked at least every 64 steps.
        REQUIRE(e.step() >= 199);
        REQUIRE(e.step() < 199 + 64);
        REQUIRE_THAT(e.what(), contains_text("pore 0 between particles") && contains_text("is inverted") &&
                                   contains_text("step " + std::to_string(e.step())));
    }
}

TEST_CASE("a symmetric packing under a symmetric load stays symmetric") {
    auto const s = small_specimen(specimen_preset::lattice);
    double const middle = 0.5 * (s.left + s.right);
    std::vector<std::size_t> partner(s.discs.size());
    for (std::size_t i = 0; i < s.discs.size(); ++i) {
        vec<double, 2> const mirrored{2 * middle - s.discs.position[i][0], s.discs.position[i][1]};
        std::size_t nearest = 0;
        for (std::size_t j = 0; j < s.discs.size(); ++j)
            if (norm(s.discs.position[j] - mirrored) < norm(s.discs.position[nearest] - mirrored)) nearest = j;
        REQUIRE(norm(s.discs.position[nearest] - mirrored) < 1e-9 * s.discs.radius[i]);
        partner[i] = nearest;
    }
    simulation<specimens::wet> sim(s.discs, specimens::parameters(s));
    cartilage::set_up(sim, s, 100e6, {});
    sim.run(500);
    double moved = 0, apart = 0;
    for (std::size_t i = 0; i < sim.size(); ++i) {
        auto const u = sim.position(i) - s.discs.position[i];
        auto const v = sim.position(partner[i]) - s.discs.position[partner[i]];
        moved = std::max(moved, norm(u));
        apart = std::max(apart, norm(vec<double, 2>{u[0] + v[0], u[1] - v[1]}));
    }
    REQUIRE(moved > 1e-10);
    INFO("moved " << moved << " m, apart " << apart << " m");
    // Rounding differs between the halves, and collisions of neighbours amplify it.
    REQUIRE_THAT(apart, WithinAbs(0, 1e-5 * moved));
}
