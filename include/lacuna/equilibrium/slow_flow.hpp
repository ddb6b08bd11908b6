// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/equilibrium/stiffness_matrix.hpp>
#include <lacuna/equilibrium/unknowns.hpp>
#include <lacuna/pores/flow/pressure_system.hpp>
#include <lacuna/pores/flow/sealed_pressure.hpp>
#include <lacuna/pores/flow/solved_flow.hpp>
#include <lacuna/pores/network/padded_array.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The fluid of an equilibrium in one step of slow time: backward Euler, solved together with the displacements. Each
/// pore has one unknown, its pressure, and one equation, with the volumes V of the pore and W of the vapour:
///
///   (V - W) exp((p - p_0) / K_f) = V_0 - W_0 + dt (sum of C (p_j - p) + sources)
///
/// Without flow this is sealed_pressure(). The conductances C are those of the start of the step. A liquid at its least
/// pressure tears: then W is what the equation gives, otherwise W = 0.
///
/// The unknown is p / scale, in m, so that the rows have the size of the displacements' rows. The matrix is symmetric
/// and quasi-definite: L D L^T needs no pivots.
/// \tparam Flow a flow solver
template <class Flow, int Dim>
class slow_flow {
public:
    using vector = Eigen::VectorXd;
    using point = vec<double, Dim>;
    static constexpr std::size_t corners = std::size_t(Dim) + 1;

    /// Reads the state at the start of a step of dt [s]. Adds the elements of pores and throats to the matrix.
    /// \param numbers the pressures' unknowns follow these
    void begin(Flow const& flow, double dt, unknowns<Dim> const& numbers, stiffness_matrix& matrix) {
        flow_ = &flow;
        dt_ = dt;
        first_ = numbers.count();
        auto const& net = flow.network();
        std::size_t const pores = net.pores();
        start_.assign(net.pressure.begin(), net.pressure.end());
        liquid_.resize(pores);
        torn_.resize(pores);
        for (std::size_t p = 0; p < pores; ++p) {
            liquid_[p] = net.old_volume[p] - net.vapour_of(p);
            torn_[p] = net.vapour_of(p) > 0;
        }
        find_sources();
        pressure_ = start_;
        volume_.assign(net.old_volume.begin(), net.old_volume.end());
        traction_.assign(pores, {});
        add_elements(numbers, matrix);
    }
    int pressures() const noexcept { return int(flow_->network().pores()); }
    std::size_t pores() const noexcept { return flow_->network().pores(); }
    double time_step() const noexcept { return dt_; }

    /// Chooses the scale of the unknowns. \param stiffness typical stiffness of a pair, N/m
    void set_scale(double stiffness, points_view<double, Dim> points, double const* radii) {
        measure(points, radii);
        double sum = 0;
        for (auto const& t : traction_) sum += norm(t[0]);
        scale_ = sum > 0 ? stiffness * double(pores()) / sum : 1.0;
    }

    /// Finds pressures, flows and the residuals of the equations, for new positions and pressures.
    /// \param u all unknowns; those of pores whose pressure is held are set here
    void update(vector& u, points_view<double, Dim> points, double const* radii) {
        double const least = flow_->settings().minimum_pressure;
        measure(points, radii);
        for (std::size_t p = 0; p < pores(); ++p) {
            double& unknown = u[first_ + int(p)];
            double wanted = start_[p] + scale_ * unknown;
            if (held_[p]) {
                wanted = held_at_[p];
            } else if (torn_[p] || wanted < least) {
                torn_[p] = 1;
                wanted = least;
            }
            unknown = (wanted - start_[p]) / scale_;
            pressure_[p] = wanted;
        }
        find_flows();
        find_residuals();
        for (std::size_t p = 0; p < pores(); ++p)
            if (torn_[p] && residual_[p] > 0) torn_[p] = 0; // the void has closed
    }

    double pressure(std::size_t p) const noexcept { return pressure_[p]; }
    /// Forces on the corners of a pore for 1 Pa, N.
    std::array<point, corners> const& traction(std::size_t p) const noexcept { return traction_[p]; }

    /// Adds the residuals of the equations and their derivatives.
    void linearise(vector& forces, stiffness_matrix& matrix) const {
        auto const& net = flow_->network();
        double const bulk = flow_->settings().bulk_modulus;
        for (std::size_t p = 0; p < pores(); ++p) {
            constexpr int last = int(corners) * Dim;
            Eigen::Matrix<double, last + 1, last + 1> element = Eigen::Matrix<double, last + 1, last + 1>::Zero();
            element(last, last) = -scale_ * scale_ * volume_[p] / bulk;
            if (!fixed(p)) {
                for (std::size_t c = 0; c < corners; ++c)
                    for (int axis = 0; axis < Dim; ++axis) {
                        int const at = int(c) * Dim + axis;
                        element(last, at) = element(at, last) = -scale_ * traction_[p][c][axis];
                    }
                forces[first_ + int(p)] -= scale_ * residual_[p] * start_share(p);
            }
            matrix.add(first_element_ + p, element);
        }
        for (std::size_t t = 0; t < net.open_throats(); ++t) {
            auto const a = std::size_t(net.throat_pore[0][t]);
            bool const inside = t < net.interior_throats, free_a = !fixed(a);
            auto const b = inside ? std::size_t(net.throat_pore[1][t]) : a;
            bool const free_b = inside && !fixed(b);
            double const share = inside ? std::sqrt(start_share(a) * start_share(b)) : start_share(a);
            double const k = -scale_ * scale_ * dt_ * net.conductance[t] * share;
            Eigen::Matrix2d element;
            element << (free_a ? k : 0.0), 0.0, (free_a && free_b ? -k : 0.0), (free_b ? k : 0.0);
            matrix.add(first_throat_ + t, element);
        }
    }
    /// Largest error of the equations, as the force of the pressure that it makes in a closed pore, N.
    /// \param rounding of the positions, m
    double error(double rounding) const noexcept {
        double most = 0;
        double const bulk = flow_->settings().bulk_modulus;
        for (std::size_t p = 0; p < pores(); ++p) {
            if (fixed(p)) continue;
            double area = 0;
            for (auto const& t : traction_[p]) area = std::max(area, norm(t));
            double const noise = 16 * std::numeric_limits<double>::epsilon() * (volume_[p] + gross_[p]);
            if (std::fabs(residual_[p]) <= noise + rounding * area) continue;
            most = std::max(most, std::fabs(residual_[p]) * bulk / volume_[p] * area);
        }
        return most;
    }

    /// Solves the equations of the fluid alone to rounding, with the particles where they are now.
    solved_flow finish(points_view<double, Dim> points, double const* radii) {
        measure(points, radii);
        find_flows();
        auto const& net = flow_->network();
        if (!(ends_ == net.throat_pore && system_.content().size() == pores() &&
              system_.leak().size() == net.open_throats())) {
            system_.analyse(pores(), net.throat_pore, net.open_throats());
            ends_ = net.throat_pore;
        }
        find_residuals();
        double before = std::numeric_limits<double>::infinity();
        for (int round = 0; round < 8; ++round) {
            double const left = imbalance();
            if (left <= 2 || !(left < 0.5 * before)) break;
            before = change_torn() ? std::numeric_limits<double>::infinity() : left;
            correct();
        }
        return result();
    }
    /// Pressures at the start and at the end of the step, Pa.
    std::vector<double> const& start() const noexcept { return start_; }
    std::vector<double> const& end() const noexcept { return pressure_; }

private:
    bool fixed(std::size_t p) const noexcept { return held_[p] || torn_[p]; }
    /// Volume at the start's pressure per volume now, inverse.
    double start_share(std::size_t p) const noexcept {
        return std::exp((start_[p] - pressure_[p]) / flow_->settings().bulk_modulus);
    }

    void find_sources() {
        auto const& net = flow_->network();
        held_.assign(pores(), 0);
        held_at_.assign(pores(), 0.0);
        supply_.assign(pores(), 0.0);
        for (auto const& f : flow_->fed_pores()) {
            auto const& source = net.sources[f.source];
            if (source.kind == flow_source_kind::pressure) {
                held_[f.pore] = 1;
                held_at_[f.pore] = source.value;
            } else {
                supply_[f.pore] += source.value * f.share * dt_;
            }
        }
    }
    void add_elements(unknowns<Dim> const& numbers, stiffness_matrix& matrix) {
        auto const& net = flow_->network();
        for (std::size_t p = 0; p < pores(); ++p) {
            std::array<int, corners * std::size_t(Dim) + 1> n{};
            for (std::size_t c = 0; c < corners; ++c)
                for (int axis = 0; axis < Dim; ++axis)
                    n[c * std::size_t(Dim) + std::size_t(axis)] =
                        net.bare() ? -1 : numbers.of(std::size_t(net.corner[c][p]), axis);
            n.back() = first_ + int(p);
            auto const element = matrix.add_element(n);
            if (p == 0) first_element_ = element;
        }
        for (std::size_t t = 0; t < net.open_throats(); ++t) {
            auto const far = net.throat_pore[1][t];
            std::array<int, 2> const n{first_ + int(net.throat_pore[0][t]), far >= 0 ? first_ + int(far) : -1};
            auto const element = matrix.add_element(n);
            if (t == 0) first_throat_ = element;
        }
    }

    void measure(points_view<double, Dim> points, double const* radii) {
        if (flow_->network().bare()) return;
        for (std::size_t p = 0; p < pores(); ++p) {
            auto const now = flow_->pore_geometry(p, points, radii);
            volume_[p] = now.volume;
            traction_[p] = now.open ? now.traction : std::array<point, corners>{};
        }
    }
    double far_pressure(std::size_t t) const noexcept {
        auto const& net = flow_->network();
        return t < net.interior_throats ? pressure_[std::size_t(net.throat_pore[1][t])] : net.reservoir_pressure(t);
    }
    void find_flows() {
        auto const& net = flow_->network();
        flows_.resize(net.open_throats());
        for (std::size_t t = 0; t < flows_.size(); ++t)
            flows_[t] = net.conductance[t] * (far_pressure(t) - pressure_[std::size_t(net.throat_pore[0][t])]);
    }
    /// Volumes that each pore has too much, for its pressure and volume.
    void find_residuals() {
        auto const& net = flow_->network();
        residual_.assign(pores(), 0.0);
        gross_.assign(pores(), 0.0);
        auto const add = [&](std::size_t p, double volume) {
            residual_[p] += volume;
            gross_[p] += std::fabs(volume);
        };
        for (std::size_t t = 0; t < flows_.size(); ++t) {
            add(std::size_t(net.throat_pore[0][t]), flows_[t] * dt_);
            if (t < net.interior_throats) add(std::size_t(net.throat_pore[1][t]), -flows_[t] * dt_);
        }
        for (std::size_t p = 0; p < pores(); ++p) {
            add(p, supply_[p]);
            double const strain = (pressure_[p] - start_[p]) / flow_->settings().bulk_modulus;
            residual_[p] -= volume_[p] * std::expm1(strain) + (volume_[p] - liquid_[p]);
        }
    }

    /// Largest residual over what rounding leaves, 1.
    double imbalance() const noexcept {
        double most = 0;
        for (std::size_t p = 0; p < pores(); ++p)
            if (!fixed(p))
                most = std::max(most, std::fabs(residual_[p]) /
                                          (std::numeric_limits<double>::epsilon() * (volume_[p] + gross_[p])));
        return most;
    }
    /// Tears liquids below the least pressure and closes voids. \return whether any changed
    bool change_torn() {
        bool changed = false;
        double const least = flow_->settings().minimum_pressure;
        for (std::size_t p = 0; p < pores(); ++p) {
            if (held_[p]) continue;
            bool const tears = torn_[p] ? residual_[p] <= 0 : pressure_[p] < least;
            changed = changed || tears != bool(torn_[p]);
            torn_[p] = tears;
        }
        return changed;
    }
    /// One step of Newton's method for the pressures.
    void correct() {
        auto const& net = flow_->network();
        double const bulk = flow_->settings().bulk_modulus, least = flow_->settings().minimum_pressure;
        std::vector<double> right(pores(), 0.0), change(pores(), 0.0);
        for (std::size_t p = 0; p < pores(); ++p) {
            system_.held()[p] = fixed(p);
            system_.content()[p] = volume_before(flow_->settings(), start_[p], pressure_[p], volume_[p]) / bulk;
            if (!fixed(p)) right[p] = residual_[p];
        }
        for (std::size_t t = 0; t < flows_.size(); ++t) system_.leak()[t] = dt_ * net.conductance[t];
        system_.factorise();
        system_.solve(right, change, 0);
        for (std::size_t p = 0; p < pores(); ++p) {
            if (torn_[p]) change[p] = least - pressure_[p];
            pressure_[p] += change[p];
        }
        for (std::size_t t = 0; t < flows_.size(); ++t)
            flows_[t] += net.conductance[t] *
                         ((t < net.interior_throats ? change[std::size_t(net.throat_pore[1][t])] : 0.0) -
                          change[std::size_t(net.throat_pore[0][t])]);
        find_residuals();
    }
    solved_flow result() const {
        auto const& net = flow_->network();
        solved_flow next{start_, pressure_, std::vector<double>(pores(), 0.0), flows_, {}};
        for (std::size_t p = 0; p < pores(); ++p)
            if (torn_[p])
                next.vapour[p] = std::clamp(-residual_[p] * start_share(p), 0.0, volume_[p]);
        for (auto const& f : flow_->fed_pores()) {
            auto const& source = net.sources[f.source];
            next.fed.push_back(source.kind == flow_source_kind::pressure ? -residual_[f.pore]
                                                                         : source.value * f.share * dt_);
        }
        return next;
    }

    Flow const* flow_ = nullptr;
    double dt_ = 0, scale_ = 1;
    int first_ = 0;
    std::size_t first_element_ = 0, first_throat_ = 0;
    std::vector<double> start_, liquid_; // pressure, Pa, and liquid, m^3, at the start
    std::vector<double> supply_;         // volume from rates in the step, m^3
    std::vector<char> held_, torn_;
    std::vector<double> held_at_, pressure_, volume_, flows_, residual_, gross_;
    std::vector<std::array<point, corners>> traction_;
    pressure_system system_; // of the pressures alone
    std::array<padded_array<std::int32_t>, 2> ends_; // of its throats
};
LACUNA_END_PACKS

} // namespace lacuna
