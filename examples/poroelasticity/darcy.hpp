// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <lacuna/core/eigen_sparse.hpp>
#include <lacuna/packings/random_packing.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

#include "column.hpp"

namespace poroelasticity {

/// Steady flow from a reservoir on the left to one on the right through a random packing of bonded, fixed discs.
struct darcy_setup {
    double length = 24, height = 16;   ///< in mean disc diameters
    double pressure = 1e3;             ///< of the left reservoir, Pa; 0 on the right
    std::uint64_t seed = 1;
    lattice_medium medium{};           ///< disc radius, stiffness, fluid
};

/// Discs of unequal size, with a ratio of radii up to 4 : 3. Apertures grow with the gap between discs.
struct darcy_model : lacuna::default_model<2> {
    using contact_law = lacuna::no_contact;
    using flow = lacuna::implicit_flow;
};

class darcy_body {
public:
    using simulator_type = lacuna::simulation<darcy_model>;

    explicit darcy_body(darcy_setup const& s) : setup_(s), packing_(pack(s)), sim_(packing_, parameters(s)) {
        for (std::size_t i = 0; i < sim_.size(); ++i) sim_.fix(i);
        sim_.fill_pores([&](lacuna::points_view<double, 2> points, double const* radii) {
            using lacuna::body_side, lacuna::on_side;
            return lacuna::make_pore_network(
                lacuna::triangulate_body(points, radii), points, radii,
                lacuna::flow_boundaries(lacuna::reservoir("inlet", on_side{body_side::left}, s.pressure),
                                        lacuna::reservoir("outlet", on_side{body_side::right}, 0.0)));
        });
    }

    simulator_type& sim() { return sim_; }
    simulator_type const& sim() const { return sim_; }
    discs const& packing() const { return packing_; }
    darcy_setup const& setup() const { return setup_; }

    /// Flow out of the left reservoir and into the right one, m^3/s.
    double inflow() const { return sim_.flow().network().sources[0].rate; }
    double outflow() const { return -sim_.flow().network().sources[1].rate; }
    /// Extent of the packing between its outermost centres, m.
    double extent(int axis) const {
        auto const less = [axis](point const& a, point const& b) { return a[axis] < b[axis]; };
        auto const [low, high] = std::minmax_element(packing_.position.begin(), packing_.position.end(), less);
        return (*high)[axis] - (*low)[axis];
    }
    /// Permeability divided by viscosity that corresponds to a flow, m^2/(s Pa).
    double permeability(double flow) const { return flow * extent(0) / (setup_.pressure * extent(1)); }

    /// Steady pressures, Pa, and flow, m^3/s.
    struct steady_state {
        std::vector<double> pressure;
        double flow = 0;
    };
    /// Solves the steady state directly: apertures and conductances follow from the distances of the discs.
    steady_state solve() const {
        auto const& net = sim_.flow().network();
        auto const& particles = sim_.particles();
        auto const& law = sim_.settings().flow;
        auto const n = Eigen::Index(net.pores());
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::VectorXd source = Eigen::VectorXd::Zero(n);
        std::vector<double> conductance;
        for (std::size_t t = 0; t < net.open_throats(); ++t) {
            auto const i = std::size_t(net.throat_particle[0][t]), j = std::size_t(net.throat_particle[1][t]);
            double const reach = particles.radius(i) + particles.radius(j);
            double const gap = norm(particles.position(j) - particles.position(i)) - reach;
            double const aperture =
                law.aperture.residual_aperture + law.aperture.gap_factor * std::max(gap, 0.0);
            double const c = law.conductivity * std::pow(aperture, 3) / reach;
            conductance.push_back(c);
            auto const a = Eigen::Index(net.throat_pore[0][t]);
            entries.emplace_back(a, a, c);
            if (t >= net.interior_throats) {
                source[a] += c * net.reservoir_pressure(t);
                continue;
            }
            auto const b = Eigen::Index(net.throat_pore[1][t]);
            entries.emplace_back(b, b, c);
            entries.emplace_back(a, b, -c);
            entries.emplace_back(b, a, -c);
        }
        Eigen::SparseMatrix<double> matrix(n, n);
        matrix.setFromTriplets(entries.begin(), entries.end());
        Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> const solver(matrix);
        Eigen::VectorXd const p = solver.solve(source);
        steady_state s{{p.data(), p.data() + n}, 0};
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t)
            if (net.reservoir_pressure(t) > 0)
                s.flow += conductance[t] * (net.reservoir_pressure(t) - p[net.throat_pore[0][t]]);
        return s;
    }

private:
    static discs pack(darcy_setup const& s) {
        double const d = 2 * s.medium.radius;
        lacuna::random_packing_parameters p;
        p.width = s.length * d;
        p.height = s.height * d;
        p.r_min = s.medium.radius * 6 / 7;
        p.r_max = s.medium.radius * 8 / 7;
        p.seed = s.seed;
        auto packing = lacuna::random_packing(p);
        for (std::size_t a = 0; a < packing.size(); ++a)
            for (std::size_t b = a + 1; b < packing.size(); ++b) {
                double const reach = packing.radius[a] + packing.radius[b];
                if (norm(packing.position[b] - packing.position[a]) < 1.02 * reach)
                    packing.bonds.push_back({std::int32_t(a), std::int32_t(b)});
            }
        return packing;
    }
    static simulator_type::parameters parameters(darcy_setup const& s) {
        simulator_type::parameters p;
        p.materials.front().bond.normal_stiffness = s.medium.normal_stiffness;
        p.materials.front().bond.shear_stiffness = s.medium.shear_stiffness;
        p.materials.front().density = s.medium.disc_mass / (std::numbers::pi * s.medium.radius * s.medium.radius);
        p.flow.bulk_modulus = s.medium.bulk_modulus;
        p.flow.aperture.residual_aperture = 0.05 * s.medium.radius;
        p.flow.aperture.gap_factor = 0.5;
        p.flow.conductivity = s.medium.conductance * 2 * s.medium.radius / std::pow(0.05 * s.medium.radius, 3);
        p.flow.skip_ratio = std::numeric_limits<double>::infinity();
        // The void at one disc fills within about V / (K_f C); diffusion over n discs takes n^2 times as long.
        p.time_step = s.length * s.length * lattice_medium::porosity() * 4 * s.medium.radius * s.medium.radius /
                      (s.medium.bulk_modulus * s.medium.conductance);
        return p;
    }
    darcy_setup setup_;
    discs packing_;
    simulator_type sim_;
};

/// Steady flow through the triangular lattice: a column between reservoirs at both ends.
class lattice_flow {
public:
    lattice_flow(int layers, int cells, lattice_medium const& medium, double pressure)
        : pressure_(pressure), body_(make_column(layers + 1, cells, medium.radius, 0)),
          sim_(body_.packing, porous_parameters(medium, 0)) {
        for (std::size_t i = 0; i < sim_.size(); ++i) sim_.fix(i);
        sim_.fill_pores(column_pores(body_, {.near_drained = true, .near_pressure = pressure}));
    }
    simulator& sim() { return sim_; }
    simulator const& sim() const { return sim_; }
    column const& body() const { return body_; }
    /// Permeability divided by viscosity from the flow at one end, m^2/(s Pa). \param end 0: near, 1: far
    double permeability(std::size_t end) const {
        return std::fabs(sim_.flow().network().sources[end].rate) * body_.length() / (pressure_ * body_.width());
    }

private:
    double pressure_;
    column body_;
    simulator sim_;
};

} // namespace poroelasticity
