// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/observe/stop_signal.hpp>

/// \file
/// The outcome of a case: quantities and curves with their references, and a pressure field.

namespace poroelasticity {

/// A quantity and its reference.
struct outcome_row {
    std::string quantity;
    double value, reference;
    /// Relative error; for a reference of zero the absolute value.
    double error() const { return reference == 0 ? std::fabs(value) : std::fabs(value / reference - 1); }
};

/// A curve of the run with the closed form at the same points.
struct outcome_curve {
    struct point {
        double x, value, reference;
    };
    std::string name;
    std::vector<point> points;
};

/// Pores with their pressures, Pa, and discs at one moment.
struct pressure_field {
    using point = lacuna::vec<double, 2>;
    struct pore {
        std::array<point, 3> corners;
        double pressure;
    };
    struct disc {
        point middle;
        double radius;
    };
    std::vector<pore> pores;
    std::vector<disc> discs;
    std::string moment; ///< description for the picture
};

/// The outcome of a case.
struct outcome {
    std::string name, title, x_label, y_label;
    bool logarithmic = true; ///< whether the x axis is logarithmic
    std::vector<outcome_row> rows;
    std::vector<outcome_curve> curves;
    pressure_field field;
    std::size_t particles = 0, pores = 0;
    long long steps = 0;
    bool stopped = false; ///< by a signal; then the curves are incomplete and some rows are missing

    /// Whether to continue after a step: false once a signal has arrived.
    bool should_continue() {
        stopped = stopped || lacuna::stop_signal() != 0;
        return !stopped;
    }
    void add(std::string quantity, double value, double reference) {
        rows.push_back({std::move(quantity), value, reference});
    }
};

/// The present field of a simulation. Leaves out particles with radii below `least`, m.
template <class Simulation>
pressure_field field_of(Simulation const& sim, double least, std::string moment) {
    pressure_field f;
    f.moment = std::move(moment);
    auto const& net = sim.flow().network();
    auto const points = sim.particles().positions();
    for (std::size_t k = 0; k < net.pores(); ++k)
        f.pores.push_back({{points[std::size_t(net.corner[0][k])], points[std::size_t(net.corner[1][k])],
                            points[std::size_t(net.corner[2][k])]},
                           net.pressure[k]});
    for (std::size_t i = 0; i < sim.size(); ++i)
        if (sim.radius(i) > least) f.discs.push_back({sim.position(i), sim.radius(i)});
    return f;
}

/// Times that are evenly spaced on a logarithmic axis.
inline std::vector<double> logarithmic_times(double first, double last, int count) {
    std::vector<double> times;
    for (int k = 0; k < count; ++k) times.push_back(first * std::pow(last / first, double(k) / (count - 1)));
    return times;
}

} // namespace poroelasticity
