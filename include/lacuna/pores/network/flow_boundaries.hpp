// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/network/flow_source.hpp>
#include <lacuna/pores/network/pore_network.hpp>

/// \file
/// Where fluid enters and leaves: rules for throats on the boundary, sources at points, initial pressures.
/// \code
/// auto net = make_pore_network(mesh, points, radii, flow_boundaries(reservoir("inlet", on_side{body_side::left}, 1e5),
///                                                                   injection("jet", on_side{body_side::top}, 1e-9)));
/// hold_pressure_at(net, points, "gauge", {0, 0}, 0.0);
/// \endcode
/// network().sources then has "inlet", "jet" and "gauge". A solver's set_source() changes the value of a source.

namespace lacuna {

/// Choice of boundary throats: those nearest to one side of the bounding box of the packing.
struct on_side {
    body_side side;
    template <class Real, int Dim>
    bool operator()(boundary_throat<Real, Dim> const& throat) const noexcept {
        return throat.side == side;
    }
};

/// Choice of boundary throats: those all of whose particles are chosen, for instance the loaded ones.
struct between_chosen {
    std::vector<std::uint8_t> chosen; ///< 1 or 0 per particle; particles beyond its end are not chosen
    template <class Real, int Dim>
    bool operator()(boundary_throat<Real, Dim> const& throat) const noexcept {
        for (auto const i : throat.particles)
            if (std::size_t(i) >= chosen.size() || !chosen[std::size_t(i)]) return false;
        return true;
    }
};

/// One rule of flow_boundaries(): a source, and the choice of the throats at which it acts.
template <class Choice>
struct boundary_rule {
    flow_source source;
    Choice choice;
};

/// Rule: a reservoir of the given pressure [Pa] lies behind the chosen throats, which are drained.
/// \param choice callable boundary_throat -> bool
/// \throws std::invalid_argument for a pressure that is not finite.
template <class Choice>
boundary_rule<Choice> reservoir(std::string name, Choice choice, double pressure) {
    require_finite("flow source " + name, pressure);
    return {{std::move(name), flow_source_kind::pressure, pressure}, std::move(choice)};
}

/// Rule: fluid enters the pores at the chosen throats at a given rate [m^3/s], negative for outflow. The throats stay
/// sealed. Each pore gets a share proportional to the distance of the throat's particles (in space: to the throat's
/// area).
/// \param choice callable boundary_throat -> bool
/// \throws std::invalid_argument for a rate that is not finite.
template <class Choice>
boundary_rule<Choice> injection(std::string name, Choice choice, double rate) {
    require_finite("flow source " + name, rate);
    return {{std::move(name), flow_source_kind::rate, rate}, std::move(choice)};
}

/// The boundary callable that flow_boundaries() returns, for make_pore_network().
template <class... Choices>
class boundary_rules {
public:
    explicit boundary_rules(boundary_rule<Choices>... rules) : rules_(std::move(rules)...) {}

    template <class Real, int Dim>
    throat_boundary<Real> operator()(boundary_throat<Real, Dim> const& throat) const {
        throat_boundary<Real> end;
        std::int32_t number = 0;
        auto const look = [&](auto const& rule) {
            if (end.source < 0 && rule.choice(throat)) {
                end.source = number;
                if (rule.source.kind == flow_source_kind::pressure) {
                    end.kind = boundary_kind::drained;
                    end.pressure = Real(rule.source.value);
                }
            }
            ++number;
        };
        std::apply([&](auto const&... rule) { (look(rule), ...); }, rules_);
        return end;
    }
    std::vector<flow_source> sources() const {
        return std::apply([](auto const&... rule) { return std::vector<flow_source>{rule.source...}; }, rules_);
    }

private:
    std::tuple<boundary_rule<Choices>...> rules_;
};

/// Boundary conditions given by rules. A throat follows the first rule that chooses it, and is sealed if none does.
/// make_pore_network() refuses a rule that no throat follows.
template <class... Choices>
boundary_rules<Choices...> flow_boundaries(boundary_rule<Choices>... rules) {
    return boundary_rules<Choices...>(std::move(rules)...);
}

/// The pore whose triangle or tetrahedron contains a point, or else the one whose middle is nearest.
/// \throws std::invalid_argument for a network without pores or particles, or a point that is not finite.
template <class Real, int Dim>
std::size_t find_pore(pore_network<Real, Dim> const& net, points_view<Real, Dim> points, vec<Real, Dim> const& at) {
    if (net.bare() || net.pores() == 0) refuse("network", "bare or empty", "one of pores between particles");
    for (int axis = 0; axis < Dim; ++axis) require_finite("point", double(at[axis]));
    std::size_t nearest = 0;
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t p = 0; p < net.pores(); ++p) {
        typename pore_mesh<Dim>::simplex simplex;
        for (std::size_t c = 0; c < simplex.size(); ++c) simplex[c] = net.corner[c][p];
        bool inside = true;
        for (std::size_t c = 0; c < simplex.size(); ++c)
            inside = inside && detail::height_within<Real, Dim>(detail::side_of(simplex, c), points, at) >= Real(0);
        if (inside) return p;
        Real const apart = squared_norm(pore_middle(net, p, points) - at);
        if (apart < least) {
            least = apart;
            nearest = p;
        }
    }
    return nearest;
}

namespace detail {
template <class Real, int Dim>
std::size_t add_source(pore_network<Real, Dim>& net, std::string name, flow_source_kind kind, double value,
                       std::size_t pore) {
    if (pore >= net.pores()) refuse("pore of flow source " + name, double(pore), "a pore of the network");
    require_finite("flow source " + name, value);
    net.sources.push_back({std::move(name), kind, value, {std::int32_t(pore)}, {1.0}});
    return net.sources.size() - 1;
}
} // namespace detail

/// \name Sources at one pore, given by its number or by a point
/// Call these before the network is passed to its solver.
/// \return the number of the source
/// \throws std::invalid_argument for a pore that does not exist, a value that is not finite, and as find_pore().
/// \{

/// Injects fluid into a pore at a rate in m^3/s; a negative rate removes fluid.
template <class Real, int Dim>
std::size_t inject(pore_network<Real, Dim>& net, std::string name, std::size_t pore, double rate) {
    return detail::add_source(net, std::move(name), flow_source_kind::rate, rate, pore);
}
template <class Real, int Dim>
std::size_t inject_at(pore_network<Real, Dim>& net, points_view<Real, Dim> points, std::string name,
                      vec<Real, Dim> const& at, double rate) {
    return inject(net, std::move(name), find_pore(net, points, at), rate);
}
/// Holds the pressure of a pore, Pa.
template <class Real, int Dim>
std::size_t hold_pressure(pore_network<Real, Dim>& net, std::string name, std::size_t pore, double pressure) {
    return detail::add_source(net, std::move(name), flow_source_kind::pressure, pressure, pore);
}
template <class Real, int Dim>
std::size_t hold_pressure_at(pore_network<Real, Dim>& net, points_view<Real, Dim> points, std::string name,
                             vec<Real, Dim> const& at, double pressure) {
    return hold_pressure(net, std::move(name), find_pore(net, points, at), pressure);
}
/// \}

/// Sets the initial pressures, Pa. The solver adds its `initial_pressure`.
/// \param pressure callable point in the middle of the pore [m] -> pressure [Pa]
/// \throws std::invalid_argument for a pressure that is not finite.
template <class Real, int Dim, class Pressure>
void set_pressures(pore_network<Real, Dim>& net, points_view<Real, Dim> points, Pressure const& pressure) {
    for (std::size_t p = 0; p < net.pores(); ++p) {
        auto const value = Real(pressure(pore_middle(net, p, points)));
        require_finite("initial pressure of pore " + std::to_string(p), double(value));
        net.pressure[p] = value;
    }
}

/// Number of the source with a given name.
/// \throws std::invalid_argument if there is none.
template <class Real, int Dim>
std::size_t find_source(pore_network<Real, Dim> const& net, std::string const& name) {
    for (std::size_t s = 0; s < net.sources.size(); ++s)
        if (net.sources[s].name == name) return s;
    refuse("flow source", name, "one of the network's");
}

} // namespace lacuna
