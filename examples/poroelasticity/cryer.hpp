// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

#include "closed_forms.hpp"
#include "porous_model.hpp"

namespace poroelasticity {

/// A free, round packing of discs under a pressure all around, drained at its rim.
struct cryer_setup {
    double radius = 20;          ///< in disc diameters
    double slowness = 400;       ///< R^2 / c_v divided by the travel time of a wave through the drained radius
    lattice_medium medium{};     ///< its conductance is set by `slowness`
    double strain = 1e-5;        ///< load divided by the modulus of confined compression
};

/// All discs of a triangular lattice whose centres are within `radius`, m, of one of them. Discs on the outline, with
/// fewer than six neighbours, have the material `outline`.
inline discs round_body(double radius, double disc_radius) {
    discs p;
    double const d = 2 * disc_radius, row = std::sqrt(0.75) * d;
    int const reach = int(radius / row) + 2;
    for (int j = -reach; j <= reach; ++j)
        for (int i = -2 * reach; i <= 2 * reach; ++i) {
            point const x{(i + 0.5 * j) * d, j * row};
            if (norm(x) <= radius) p.add(x, disc_radius, inner);
        }
    std::vector<int> neighbours(p.size(), 0);
    for (std::size_t a = 0; a < p.size(); ++a)
        for (std::size_t b = a + 1; b < p.size(); ++b)
            if (norm(p.position[b] - p.position[a]) < 1.01 * d) {
                p.bonds.push_back({std::int32_t(a), std::int32_t(b)});
                ++neighbours[a];
                ++neighbours[b];
            }
    for (std::size_t a = 0; a < p.size(); ++a)
        if (neighbours[a] < 6) p.material[a] = outline;
    return p;
}

/// Pores of a packing that is drained all around.
inline network drained_pores(lacuna::points_view<double, 2> points, double const* radii) {
    auto const everywhere = [](auto const&) { return true; };
    auto net = lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii,
                                         lacuna::flow_boundaries(lacuna::reservoir("rim", everywhere, 0.0)));
    halve_surface_throats(net);
    return net;
}

/// Applies a pressure to every edge of the outline, half of the force to each of its two particles. \param pressure Pa
inline void press_outline(simulator& sim, network const& net, double pressure) {
    std::vector<point> force(sim.size());
    auto const points = sim.particles().positions();
    for (std::size_t t = net.interior_throats; t < net.throats(); ++t) {
        auto const i = std::size_t(net.throat_particle[0][t]), j = std::size_t(net.throat_particle[1][t]);
        // The pore lies to the left of the line from i to j, and the force points there.
        point const half = perpendicular(points[j] - points[i]) * (pressure / 2);
        for (auto k : {i, j}) force[std::size_t(sim.particles().id(k))] += half;
    }
    for (std::size_t id = 0; id < force.size(); ++id)
        if (norm(force[id]) > 0) sim.apply(id, force[id]);
}

/// The disc at time 0: the fluid carries the whole load, as in terzaghi_column.
class cryer_disc {
public:
    explicit cryer_disc(cryer_setup const& s)
        : packing_(round_body(s.radius * 2 * s.medium.radius, s.medium.radius)), medium_(s.medium),
          radius_(effective_radius(packing_)) {
        medium_.set_consolidation_time(s.slowness * radius_ / medium_.wave_speed(), radius_);
        load_ = s.strain * medium_.oedometric();
        sim_.emplace(packing_, porous_parameters(medium_, load_));
        sim_->fill_pores(drained_pores);
        auto const& net = sim_->flow().network();
        press_outline(*sim_, net, load_);
        for (std::size_t k = 0; k < net.pores(); ++k)
            if (norm(pore_middle(net, k, sim_->particles().positions())) < 2 * medium_.radius) middle_.push_back(k);
    }

    simulator& sim() { return *sim_; }
    simulator const& sim() const { return *sim_; }
    discs const& packing() const { return packing_; }
    lattice_medium const& medium() const { return medium_; }
    double load() const { return load_; } ///< Pa
    /// Radius of the circle with the same area as the packing, m.
    double radius() const { return radius_; }
    double time() const { return sim_->time() * medium_.diffusivity() / (radius_ * radius_); }
    /// Mean pressure of the pores around the middle disc, divided by the load.
    double middle_pressure() const {
        double sum = 0;
        for (std::size_t k : middle_) sum += sim_->flow().network().pressure[k];
        return sum / double(middle_.size()) / load_;
    }

private:
    static double effective_radius(discs const& p) {
        auto const points = lacuna::view_points(p.position);
        auto const mesh = lacuna::triangulate_body(points, p.radius.data());
        return std::sqrt(lacuna::mesh_size<double>(mesh, points) / std::numbers::pi);
    }

    discs packing_;
    lattice_medium medium_;
    double radius_, load_ = 0;
    std::optional<simulator> sim_;
    std::vector<std::size_t> middle_;
};

} // namespace poroelasticity
