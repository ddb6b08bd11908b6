// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh/no_pores.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/network/pore_network.hpp>

#include "frames.hpp"
#include "scenario.hpp"
#include "summary.hpp"

/// \file
/// Pore networks of scenarios: construction, and the values for probes and files.

namespace lacuna_run {

struct any_throat {
    template <class Throat>
    bool operator()(Throat const&) const noexcept {
        return true;
    }
};

/// \throws refusal for a pore number that does not exist in the network
template <class Network>
void check_pore(pore_location const& location, Network const& net, std::string const& path) {
    if (!location.near && std::size_t(location.pore) >= net.pores())
        refuse(path, std::to_string(location.pore),
               "from 0 to " + std::to_string(net.pores() - 1) + ", the last of the pores");
}
template <class Network>
void check_location(probe const& p, Network const& net) {
    bool const of_pores =
        p.what == quantity::pore_pressure || p.what == quantity::pore_volume || p.what == quantity::throat_flow;
    if (of_pores && p.throat < 0) check_pore(p.where, net, "the pore of probe " + p.column);
}

template <class Real>
std::size_t pore_at(pore_location const& location, lacuna::pore_network<Real, 2> const& net,
                    lacuna::points_view<Real, 2> points) {
    if (!location.near) return std::size_t(location.pore);
    return lacuna::find_pore(net, points, lacuna::vec<Real, 2>{Real((*location.near)[0]), Real((*location.near)[1])});
}

/// Adds the reservoirs and sources of the scenario to a network.
template <class Real>
void add_sources(fluid_settings const& f, lacuna::pore_network<Real, 2>& net, lacuna::points_view<Real, 2> points) {
    for (std::size_t r = 0; r < f.reservoirs.size(); ++r) {
        std::string const name = "reservoirs[" + std::to_string(r) + "]";
        check_pore(f.reservoirs[r].where, net, "fluid." + name + ".pore");
        lacuna::hold_pressure(net, name, pore_at(f.reservoirs[r].where, net, points), f.reservoirs[r].pressure);
    }
    for (std::size_t r = 0; r < f.sources.size(); ++r) {
        std::string const name = "sources[" + std::to_string(r) + "]";
        check_pore(f.sources[r].where, net, "fluid." + name + ".pore");
        lacuna::inject(net, name, pore_at(f.sources[r].where, net, points), f.sources[r].flow);
    }
}

/// Makes the network between particles. \throws std::invalid_argument if there are no pores
template <class Real>
lacuna::pore_network<Real, 2> make_network(fluid_settings const& f, lacuna::points_view<Real, 2> points,
                                           Real const* radii) {
    auto const mesh = lacuna::triangulate_body(points, radii);
    if (mesh.size() == 0) lacuna::refuse_no_pores(points, radii);
    auto net = f.drained ? lacuna::make_pore_network(mesh, points, radii,
                                                     lacuna::flow_boundaries(lacuna::reservoir("boundary", any_throat{},
                                                                                               f.boundary_pressure)))
                         : lacuna::make_pore_network(mesh, points, radii);
    add_sources(f, net, points);
    return net;
}

/// The value of a probe of pores or throats: Pa, m^3 or m^3/s.
template <class Real>
double read_of_pores(probe const& p, lacuna::pore_network<Real, 2> const& net, lacuna::points_view<Real, 2> points) {
    if (p.what != quantity::throat_flow) {
        auto const pore = pore_at(p.where, net, points);
        return double(p.what == quantity::pore_pressure ? net.pressure[pore] : net.volume[pore]);
    }
    if (p.throat >= 0) return double(net.flow[std::size_t(p.throat)]);
    if (p.where.near) {
        // The throat with the nearest middle. Flow is positive from the pore on its right to the pore on its left.
        std::size_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t t = 0; t < net.throats(); ++t) {
            double apart = 0;
            for (int axis = 0; axis < 2; ++axis) {
                double const middle = 0.5 * (double(points(std::size_t(net.throat_particle[0][t]), axis)) +
                                             double(points(std::size_t(net.throat_particle[1][t]), axis)));
                apart += (middle - (*p.where.near)[std::size_t(axis)]) * (middle - (*p.where.near)[std::size_t(axis)]);
            }
            if (apart < least) {
                least = apart;
                nearest = t;
            }
        }
        return net.throats() > 0 ? double(net.flow[nearest]) : 0;
    }
    double into = 0; // the pore, through all its throats
    auto const pore = std::size_t(p.where.pore);
    net.throats_of.for_each(pore, [&](std::size_t t, int side) { into += (side == 0 ? 1 : -1) * double(net.flow[t]); });
    return into;
}

/// Adds pores and sources for summary.json.
template <class Real>
void add_pores(run_numbers& n, lacuna::pore_network<Real, 2> const& net, lacuna::points_view<Real, 2> points) {
    for (std::size_t p = 0; p < net.pores(); ++p) {
        run_numbers::pore one{{}, double(net.volume[p]), double(net.pressure[p])};
        if (!net.bare()) {
            auto const middle = lacuna::pore_middle(net, p, points);
            one.middle = point{double(middle[0]), double(middle[1])};
        }
        n.pores.push_back(one);
    }
    for (auto const& source : net.sources) n.sources.push_back({source.name, source.volume, source.rate});
}

/// Adds the pores for pictures and VTK: triangles of particle ids.
/// \param id_of callable corner of the network -> particle id
template <class Real, class IdOf>
void add_pores(frame_data& f, lacuna::pore_network<Real, 2> const& net, IdOf const& id_of) {
    for (std::size_t p = 0; p < net.pores(); ++p) {
        frame_data::pore one{};
        for (std::size_t c = 0; c < 3; ++c) one.corners[c] = id_of(std::size_t(net.corner[c][p]));
        one.pressure = double(net.pressure[p]);
        one.volume = double(net.volume[p]);
        f.pores.push_back(one);
    }
}

} // namespace lacuna_run
