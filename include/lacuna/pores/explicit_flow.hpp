// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/pores/flow.hpp>
#include <lacuna/pores/flow_parameters.hpp>
#include <lacuna/pores/flow_time_step.hpp>
#include <lacuna/pores/geometry.hpp>
#include <lacuna/pores/pore_network.hpp>
#include <lacuna/pores/tractions.hpp>

namespace lacuna {

/// The paper's explicit scheme, eq. 14 to 16: all flows from the old pressures, then all pressures.
///
/// A pore's pressure below `minimum_pressure` is held there; the volume that the liquid does not fill is remembered
/// as vapour, which closes before the pressure rises again, so that no mass is made.
template <class Real, int Dim, aperture_law Aperture>
class explicit_flow_solver {
    static_assert(Dim == 2, "explicit_flow: pores exist in the plane only, so far (Dim = 2)");

public:
    using parameters = flow_parameters<Aperture>;
    using network_type = pore_network<Real, Dim>;

    /// Rigid pores: a bare network, whose volumes and apertures stay as given.
    /// \throws std::invalid_argument for parameters out of range.
    explicit_flow_solver(parameters const& p, network_type network) : parameters_(p), network_(std::move(network)) {
        parameters_.validate("flow");
        auto const count = network_.pores();
        std::fill(network_.pressure.begin(), network_.pressure.end(), Real(p.initial_pressure));
        floor_.assign(count, Real(0));
        inflow_.assign(count, Real(0));
        next_.assign(count, Real(0));
        active_.reserve(network_.open_throats());
        if (!network_.bare()) {
            for (std::size_t i = 0; i < count; ++i)
                floor_[i] = Real(p.minimum_volume_fraction * p.thickness) * network_.size[i];
            Real const aperture = Aperture::aperture(p.aperture, Real(0), Real(0));
            std::fill(network_.aperture.begin(), network_.aperture.end(), aperture);
        }
        for (std::size_t t = 0; t < network_.throats(); ++t) set_conductance(t);
        collect_active();
    }

    /// Pores of a body, at its present geometry and the apertures of pairs at zero force that touch.
    /// \param points centres, m; \param radii m: of all particles, here and below
    explicit_flow_solver(parameters const& p, network_type network, points_view<Real, Dim> points, Real const* radii)
        : explicit_flow_solver(p, std::move(network)) {
        refresh_geometry(points, radii);
        network_.old_volume = network_.volume;
    }

    network_type const& network() const noexcept { return network_; }
    parameters const& settings() const noexcept { return parameters_; }
    flow_ledger<Real> const& ledger() const noexcept { return ledger_; }

    void set_pressure(std::size_t pore, Real pressure) noexcept { network_.pressure[pore] = pressure; }

    /// Goes back to an earlier network() and ledger() of the same body.
    void restore(network_type network, flow_ledger<Real> const& ledger) {
        network_ = std::move(network);
        ledger_ = ledger;
        collect_active();
    }

    /// New pore volumes. The volume change that advance() sees is that since its last call.
    void refresh_geometry(points_view<Real, Dim> points, Real const* radii) noexcept {
        if (network_.bare()) return;
        auto const thickness = Real(parameters_.thickness);
        for (std::size_t first = 0; first < network_.pores(); first += width) {
            int const lanes = lanes_from(first);
            vec<row, 2> x[3];
            row r[3];
            for (std::size_t c = 0; c < 3; ++c)
                for (int k = 0; k < width; ++k) {
                    auto const i = std::size_t(network_.corner[c][first + std::size_t(std::min(k, lanes - 1))]);
                    x[c][0].v[k] = points(i, 0);
                    x[c][1].v[k] = points(i, 1);
                    r[c].v[k] = radii[i];
                }
            store(network_.volume, first, lanes,
                  pore_volume(x[0], x[1], x[2], r[0], r[1], r[2], row(thickness), load(floor_, first, lanes)));
        }
    }

    /// New apertures from the pairs at the throats; skipped throats keep theirs unless `all`.
    /// \param lookup callable (particle i, particle j) -> throat_state, or (throat, i, j) -> throat_state
    template <class Lookup>
    void refresh_apertures(Lookup const& lookup, bool all = false) {
        if (network_.bare()) return;
        auto const refresh = [&](std::size_t t) {
            auto const i = network_.throat_particle[0][t], j = network_.throat_particle[1][t];
            auto const state = [&] {
                if constexpr (requires { lookup(t, i, j); })
                    return lookup(t, i, j);
                else
                    return lookup(i, j);
            }();
            network_.aperture[t] = Aperture::aperture(parameters_.aperture, Real(state.normal_force), Real(state.gap));
            set_conductance(t);
        };
        if (all)
            for (std::size_t t = 0; t < network_.open_throats(); ++t) refresh(t);
        else
            for (auto const t : active_) refresh(std::size_t(t));
    }

    /// Leaves out, from now on, the throats through which practically nothing passes within `duration` [s]: those
    /// whose own step limit, 2 / (K_f C (1/V_1 + 1/V_2)), is more than `skip_ratio` times as long (they let at most
    /// 2 / skip_ratio of a pressure difference through), and takes up again those that have opened. Call it after
    /// refresh_apertures(lookup, true), at the start and whenever throats may have opened.
    /// \return how many throats are skipped
    /// \throws std::invalid_argument for a duration that is not positive.
    std::size_t skip_idle_throats(Real duration) {
        require_positive("duration", double(duration));
        for (std::size_t t = 0; t < network_.open_throats(); ++t) {
            auto const other = network_.throat_pore[1][t];
            Real rate = Real(1) / network_.volume[std::size_t(network_.throat_pore[0][t])];
            if (other >= 0) rate += Real(1) / network_.volume[std::size_t(other)];
            double const limit = 2 / (parameters_.bulk_modulus * double(network_.conductance[t]) * double(rate));
            network_.idle[t] = limit <= parameters_.skip_ratio * double(duration) ? 0 : 1;
            if (network_.idle[t]) network_.flow[t] = Real(0);
        }
        collect_active();
        return network_.open_throats() - active_.size();
    }

    /// One step of dt [s]: eq. 14 for all throats from the old pressures, then eq. 15 for all pores.
    void advance(Real dt) noexcept {
        bool const flowing = !active_.empty();
        Real in = 0, gross = 0;
        if (flowing) {
            for (auto const t : active_) {
                auto const k = std::size_t(t);
                network_.flow[k] = network_.conductance[k] * (far_pressure(k, network_.pressure) - near_pressure(k));
                gross += lacuna::abs(network_.flow[k]) * dt;
                if (k >= network_.interior_throats) in += network_.flow[k] * dt;
            }
            sum_flows(dt);
        }
        update_pressures(flowing, in, gross);
        network_.pressure.swap(next_);
        if (flowing)
            for (auto const t : active_) {
                auto const k = std::size_t(t);
                auto const a = std::size_t(network_.throat_pore[0][k]);
                Real const moved = network_.flow[k] * dt;
                Real const far = (far_pressure(k, network_.pressure) + far_pressure(k, next_)) * Real(0.5);
                ledger_.dissipation += moved * (far - (network_.pressure[a] + next_[a]) * Real(0.5));
                if (k >= network_.interior_throats) ledger_.reservoir_work += moved * far;
            }
        ledger_.boundary_inflow += in;
    }

    /// Adds the forces of the pore pressures on all particles, as pores/tractions.hpp has it.
    void add_tractions(points_view<Real, Dim> points, Real const* radii, Real* force,
                       std::size_t stride) const noexcept {
        if (!network_.bare()) add_tractions(points, radii, force, stride, 0, points.size());
    }
    /// The same for particles `begin` to `end` - 1: ranges give the same bits as all at once.
    void add_tractions(points_view<Real, Dim> points, Real const* radii, Real* force, std::size_t stride,
                       std::size_t begin, std::size_t end) const noexcept {
        lacuna::add_tractions(network_, Real(parameters_.thickness), points, radii, force, stride, begin, end);
    }

    /// Forces on the three corners of a pore for 1 Pa in it, N.
    std::array<vec<Real, Dim>, 3> pore_tractions(std::size_t pore, points_view<Real, Dim> points,
                                                 Real const* radii) const noexcept {
        return lacuna::pore_tractions(network_, Real(parameters_.thickness), pore, points, radii);
    }

    /// Energy stored in the compressed fluid, sum of V p^2 / 2 K_f, J.
    Real storage_energy() const noexcept {
        Real sum(0);
        for (std::size_t i = 0; i < network_.pores(); ++i)
            sum += network_.volume[i] * network_.pressure[i] * network_.pressure[i];
        return sum / Real(2 * parameters_.bulk_modulus);
    }

    /// Largest safe dt of advance(), s, as pores/flow_time_step.hpp has it: skipped throats do not count.
    Real critical_time_step() const { return flow_critical_time_step(network_, parameters_.bulk_modulus); }
    /// Eq. 19 as printed, s: not safe where apertures differ. Skipped throats count.
    Real equation_19_time_step() const {
        return lacuna::equation_19_time_step(network_, parameters_.bulk_modulus, parameters_.conductivity);
    }

private:
    static constexpr int width = native_width<Real>;
    using row = pack<Real, width>;

    int lanes_from(std::size_t first) const noexcept {
        return int(std::min(std::size_t(width), network_.pores() - first));
    }
    static row load(std::vector<Real> const& from, std::size_t first, int lanes, Real rest = Real(0)) noexcept {
        if (lanes == width) return row::load(from.data() + first);
        row r(rest);
        for (int k = 0; k < lanes; ++k) r.v[k] = from[first + std::size_t(k)];
        return r;
    }
    static void store(std::vector<Real>& to, std::size_t first, int lanes, row const& value) noexcept {
        if (lanes == width) return value.store(to.data() + first);
        for (int k = 0; k < lanes; ++k) to[first + std::size_t(k)] = value[k];
    }

    void set_conductance(std::size_t t) noexcept {
        Real const a = network_.aperture[t];
        network_.conductance[t] = t < network_.open_throats()
                                      ? Real(parameters_.conductivity) * (a * a * a / network_.length[t])
                                      : Real(0);
    }
    void collect_active() {
        active_.clear();
        for (std::size_t t = 0; t < network_.open_throats(); ++t)
            if (!network_.idle[t]) active_.push_back(std::int32_t(t));
    }
    Real near_pressure(std::size_t t) const noexcept {
        return network_.pressure[std::size_t(network_.throat_pore[0][t])];
    }
    Real far_pressure(std::size_t t, std::vector<Real> const& pressure) const noexcept {
        return t < network_.interior_throats ? pressure[std::size_t(network_.throat_pore[1][t])]
                                             : network_.reservoir_pressure[t];
    }

    /// Volume that comes into each pore in dt, its throats in a fixed order.
    void sum_flows(Real dt) noexcept {
        auto const& table = network_.pore_throats;
        for (std::size_t i = 0; i < network_.pores(); ++i) {
            Real sum(0);
            for (auto e = table.first[i]; e < table.first[i + 1]; ++e) {
                auto const entry = std::size_t(table.entry[std::size_t(e)]);
                Real const q = network_.flow[entry / 2];
                sum += entry % 2 == 0 ? q : -q;
            }
            inflow_[i] = sum * dt;
        }
    }

    void update_pressures(bool flowing, Real in, Real gross) noexcept {
        bool const tears = parameters_.minimum_pressure > -std::numeric_limits<double>::infinity();
        row const stiffness = Real(parameters_.bulk_modulus), least = Real(parameters_.minimum_pressure);
        row const compliance = Real(1 / parameters_.bulk_modulus), half = Real(0.5);
        row content = Real(0), changed = Real(0), work = Real(0), vapour_work = Real(0), prefactor = Real(0);
        for (std::size_t first = 0; first < network_.pores(); first += width) {
            int const lanes = lanes_from(first);
            row const volume = load(network_.volume, first, lanes, Real(1));
            row const grown = volume - load(network_.old_volume, first, lanes, Real(1));
            row const old = load(network_.pressure, first, lanes);
            row const came = flowing ? load(inflow_, first, lanes) : row(Real(0));
            row next = old + stiffness / volume * (came - grown);
            row torn = Real(0);
            if (tears) {
                row const vapour = load(network_.vapour, first, lanes);
                row const wanted = next - stiffness / volume * vapour;
                next = max(wanted, least);
                // No vapour at all where the pressure holds: rounding must not leave a trace of it.
                row const now = select(wanted < least, (least - wanted) * volume * compliance, row(Real(0)));
                torn = now - vapour;
                store(network_.vapour, first, lanes, now);
            }
            row const middle = (next + old) * half;
            content += volume * (next - old) * compliance + grown - torn;
            changed += lacuna::abs(grown);
            work += middle * grown;
            vapour_work += middle * torn;
            prefactor += old * old * grown * (compliance * half);
            store(next_, first, lanes, next);
            store(network_.old_volume, first, lanes, volume);
        }
        ledger_.pressure_work += sum(work);
        ledger_.vapour_work += sum(vapour_work);
        ledger_.prefactor_work += sum(prefactor);
        ledger_.mass_residual = sum(content) - in;
        ledger_.gross_volume = gross + sum(changed);
    }

    parameters parameters_;
    network_type network_;
    flow_ledger<Real> ledger_;
    std::vector<Real> floor_, inflow_, next_;
    std::vector<std::int32_t> active_;
};

/// Flow policy: explicit_flow_solver with an aperture law of one's choice.
template <aperture_law Aperture>
struct explicit_flow_with {
    using parameters = flow_parameters<Aperture>;
    template <class Real, int Dim>
    using solver = explicit_flow_solver<Real, Dim, Aperture>;
};

/// Flow policy: the paper's explicit scheme with the aperture from the contact force.
using explicit_flow = explicit_flow_with<contact_force_aperture>;

} // namespace lacuna
