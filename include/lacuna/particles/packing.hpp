// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/particles/packing_grid.hpp>
#include <lacuna/particles/touching.hpp>

namespace lacuna {

/// The particles and bonds from which a simulation starts. All lengths in m. `position`, `radius` and `material` have
/// one entry per particle. `density` has one entry per particle or is empty; `bond_type` has one entry per bond or is
/// empty.
template <class Real, int Dim>
struct packing {
    std::vector<vec<Real, Dim>> position;
    std::vector<Real> radius;
    std::vector<int> material;
    std::vector<std::array<std::int32_t, 2>> bonds; ///< pairs of particle numbers, each pair once
    std::vector<double> density{};                  ///< of each particle, kg/m^3; empty: those of their materials
    /// Type of each bond, counted from 0, as read from a file; see by_bond_type(). A simulation of bonds of several
    /// types needs the values of its bonds.
    std::vector<int> bond_type{};
    vec<double, Dim> period{}; ///< of the periodic box for which the packing was made, m; 0 along open axes

    std::size_t size() const noexcept { return position.size(); }

    /// Appends a particle and returns its number.
    std::int32_t add(vec<Real, Dim> const& x, Real r, int m = 0) {
        position.push_back(x);
        radius.push_back(r);
        material.push_back(m);
        return std::int32_t(position.size() - 1);
    }
    /// Checks that the arrays with one entry per particle have the same length.
    /// \throws std::invalid_argument unless there is one radius, one material, and one or no density per particle
    void require_one_each() const {
        auto const check = [&](char const* name, std::size_t count) {
            if (count != size()) refuse(name, double(count), "one per particle");
        };
        check("packing.radius.size()", radius.size());
        check("packing.material.size()", material.size());
        if (!density.empty()) check("packing.density.size()", density.size());
    }
    /// Checks that bonds of several types have values.
    /// \param values number of bonds for which the caller gives values
    /// \throws std::invalid_argument for bonds of several types without values, which would all be alike
    void require_bond_kinds(std::size_t values) const {
        if (bond_type.empty()) return;
        if (bond_type.size() != bonds.size())
            refuse("packing.bond_type.size()", double(bond_type.size()), "one per bond, or none");
        for (int const type : bond_type)
            if (values == 0 && type != bond_type[0])
                refuse("parameters.bonds", "none",
                       "one entry per bond, by_bond_type(): the packing has bonds of types " +
                           std::to_string(bond_type[0] + 1) + " and " + std::to_string(type + 1) +
                           "; or packing.bond_type cleared");
    }
    /// Checks that the packing fits into a domain.
    /// \param domain period of the domain, 0 along open axes, m
    /// \throws std::invalid_argument if the packing was made for another period
    void require_period(vec<double, Dim> const& domain) const {
        for (int axis = 0; axis < Dim; ++axis)
            if (period[axis] > 0 && period[axis] != domain[axis])
                refuse("domain.period", domain[axis],
                       "that of the packing's box along this axis, " + to_text(period[axis]));
    }
};

/// Returns the values of each bond by its type, for simulation_parameters::bonds.
/// \param of_type values for each type; the index is that of packing.bond_type
/// \throws std::invalid_argument for a type without values
template <class Values, class Real, int Dim>
std::vector<Values> by_bond_type(packing<Real, Dim> const& packing, std::vector<Values> const& of_type) {
    std::vector<Values> values;
    for (std::size_t b = 0; b < packing.bonds.size(); ++b) {
        int const type = packing.bond_type.empty() ? 0 : packing.bond_type.at(b);
        require_in("packing.bond_type", type, 0, double(of_type.size()) - 1);
        values.push_back(of_type[std::size_t(type)]);
    }
    return values;
}

/// The same packing in another scalar type.
template <class Real, class From, int Dim>
packing<Real, Dim> convert_packing(packing<From, Dim> const& from) {
    packing<Real, Dim> to;
    for (std::size_t i = 0; i < from.size(); ++i) {
        vec<Real, Dim> x{};
        for (int axis = 0; axis < Dim; ++axis) x[axis] = Real(from.position[i][axis]);
        to.add(x, Real(from.radius[i]), from.material[i]);
    }
    to.bonds = from.bonds;
    to.density = from.density;
    to.bond_type = from.bond_type;
    to.period = from.period;
    return to;
}

/// Summary of a packing of discs.
struct packing_statistics {
    std::size_t particles = 0;
    std::size_t bonded = 0;        ///< particles with at least one bond
    std::size_t bonds = 0;
    double area_fraction = 0;      ///< sum of disc areas over the given area, 1
    double mean_radius = 0;        ///< m
    double max_overlap = 0;        ///< largest overlap of a pair over the smaller radius of the pair, 1
    double mean_coordination = 0;  ///< mean number of neighbours with gap <= tolerance * smaller radius
    std::size_t loose = 0;         ///< particles with fewer than two such neighbours
};

/// Computes the statistics of a packing of discs.
/// \param discs the packing, m
/// \param area the area that contains the discs, m^2; 0 leaves the area fraction at 0
/// \param contact_tolerance largest gap, relative to the smaller radius, that still counts as touching
template <class Real>
packing_statistics measure_packing(packing<Real, 2> const& discs, double area, double contact_tolerance) {
    packing_statistics s;
    s.particles = discs.size();
    s.bonds = discs.bonds.size();
    if (discs.size() == 0) return s;
    std::vector<char> bonded(discs.size(), 0);
    for (auto const& bond : discs.bonds) bonded[std::size_t(bond[0])] = bonded[std::size_t(bond[1])] = 1;
    std::vector<vec<double, 2>> x(discs.size());
    double largest = 0, disc_area = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        double const r = double(discs.radius[i]);
        x[i] = {double(discs.position[i][0]), double(discs.position[i][1])};
        largest = r > largest ? r : largest;
        s.mean_radius += r;
        disc_area += 3.14159265358979323846 * r * r;
        s.bonded += std::size_t(bonded[i]);
    }
    s.mean_radius /= double(discs.size());
    if (area > 0) s.area_fraction = disc_area / area;

    detail::disc_grid grid(x, 2 * largest);
    std::size_t touching = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        std::size_t neighbours = 0;
        double const r = double(discs.radius[i]);
        grid.for_each_near(x[i], (2 + contact_tolerance) * largest * (1 + 1e-8), [&](std::size_t j) {
            if (j == i) return;
            double const other = double(discs.radius[j]);
            double const smaller = r < other ? r : other;
            double const gap = (norm(x[j] - x[i]) - r - other) / smaller;
            if (-gap > s.max_overlap) s.max_overlap = -gap;
            if (touches(x[i], r, x[j], other, contact_tolerance * smaller)) ++neighbours;
        });
        touching += neighbours;
        if (neighbours < 2) ++s.loose;
    }
    s.mean_coordination = double(touching) / double(x.size());
    return s;
}

} // namespace lacuna
