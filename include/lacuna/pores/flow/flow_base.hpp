// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/parallel.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/pores/flow/corner_forces.hpp>
#include <lacuna/pores/flow/flow_sums.hpp>
#include <lacuna/pores/flow/flow_time_step.hpp>
#include <lacuna/pores/flow/merging.hpp>
#include <lacuna/pores/flow/source_exchange.hpp>
#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/pores/flow/pore_pass.hpp>
#include <lacuna/pores/flow/sealed_pressure.hpp>
#include <lacuna/pores/flow/solved_flow.hpp>
#include <lacuna/pores/flow/throat_pass.hpp>
#include <lacuna/pores/flow/tractions.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// Base of the flow solvers: geometry, apertures, boundaries, tractions, balances. Derived solvers compute the flows of
/// a step.
template <class Real, int Dim, class Parameters>
class flow_base {
public:
    using parameters = Parameters;
    using network_type = pore_network<Real, Dim>;

    network_type const& network() const noexcept { return network_; }
    parameters const& settings() const noexcept { return parameters_; }
    /// Updated by steps with a ledger. The volumes of the sources (network().sources) are updated by all steps.
    flow_ledger<Real> const& ledger() const noexcept { return ledger_; }

    /// Clusters of merged pores.
    pore_clusters<Real, Dim> const& clusters() const noexcept { return clusters_; }

    /// Sets the pressure of a pore, Pa.
    /// \throws std::invalid_argument for a pore that does not exist, or a pressure not finite or below the minimum.
    void set_pressure(std::size_t pore, Real pressure) {
        if (pore >= network_.pores()) refuse("pore", double(pore), "a pore of the network");
        parameters_.require_pressure("pressure of pore " + std::to_string(pore), double(pressure));
        network_.pressure[pore] = pressure;
        values_set_ = true;
    }
    /// Changes the value that a source prescribes, Pa or m^3/s, from the next step on.
    /// \throws std::invalid_argument for a source that does not exist, a value that is not finite, or a pressure below
    ///         the minimum.
    void set_source(std::size_t number, double value) {
        if (number >= network_.sources.size()) refuse("flow source", double(number), "a source of the network");
        auto& source = network_.sources[number];
        std::string const name = "flow source " + source.name;
        if (source.kind == flow_source_kind::pressure)
            parameters_.require_pressure(name, value);
        else
            require_finite(name, value);
        source.value = value;
        values_set_ = true;
        if (source.kind == flow_source_kind::rate) return;
        for (std::size_t d = 0; d < network_.drained_throats; ++d)
            if (network_.drained_source[d] == std::int32_t(number)) network_.drained_pressure[d] = Real(value);
    }

    /// Whether set_pressure() or set_source() was called.
    bool values_were_set() const noexcept { return values_set_; }

    /// Updates the pore volumes. The next step still uses the change since the last step. step() calls it itself.
    /// \param points centres of all particles, m; \param radii of all particles, m
    void refresh_geometry(points_view<Real, Dim> points, Real const* radii) {
        if (network_.bare()) return;
        if (!forces_.built()) set_force_retention(true);
        update_geometry(particle_records(points, radii).data(), 1);
    }

    /// Stores for each throat the index of its pair's normal force. Call it whenever the pairs are stored in another
    /// order.
    /// \param lookup callable (particle i, particle j) -> index of the pair's normal force; 0 if there is no such pair
    template <class Lookup>
    void map_throats(Lookup const& lookup) {
        if (!network_.bare()) throats_.map(network_, lookup);
    }

    /// Updates the apertures of all throats, including skipped ones.
    /// \param particles records of all particles, as in particle_store; here and below
    /// \param normal_forces of the pairs, N, positive in tension, the first is 0; here and below
    void refresh_apertures(particle_column<Real> const& particles, Real const* normal_forces,
                           int threads = 1) noexcept {
        if (network_.bare()) return;
        for_each_chunk(throats_.chunks(true), threads, [&](int c) {
            throats_.template pass<true, false, aperture_type>(c, network_, particles.data(), normal_forces,
                                                               parameters_.aperture);
        });
    }

    /// Skips, from now on, throats through which practically nothing passes within `duration` [s]. These are throats
    /// whose own step limit, 2 / (K_f C (1/V_1 + 1/V_2)), exceeds `skip_ratio` times the duration: in that time they
    /// equalise at most 2 / skip_ratio of a pressure difference. Throats that have opened since are used again. Call it
    /// after refresh_apertures(), at the start and whenever throats may have opened.
    /// \return number of skipped throats
    /// \throws std::invalid_argument for a duration that is not positive.
    std::size_t deactivate_slow_throats(Real duration) {
        if (!(duration > Real(0))) refuse("duration", double(duration), "> 0");
        for (std::size_t t = 0; t < network_.open_throats(); ++t) {
            double const limit = throat_time_step(network_, t, parameters_.bulk_modulus);
            network_.inactive[t] = limit <= parameters_.skip_ratio * double(duration) ? 0 : 1;
            if (network_.inactive[t]) network_.flow[t] = Real(0);
        }
        throats_.collect_active(network_);
        clusters_.update(network_);
        return network_.open_throats() - throats_.active_throats();
    }

    /// The same for flow_parameters::duration.
    std::size_t deactivate_slow_throats() { return deactivate_slow_throats(Real(parameters_.duration)); }

    /// Forces on the corners of a pore for 1 Pa in it, N, even if the pore is at its least volume.
    std::array<vec<Real, Dim>, std::size_t(Dim) + 1> pore_tractions(std::size_t pore, points_view<Real, Dim> points,
                                                                    Real const* radii) const noexcept {
        return lacuna::pore_tractions(network_, thickness_, pore, points, radii);
    }

    /// A pore at the given positions.
    struct pore_at {
        Real volume; ///< m^3; not less than the least volume
        bool open;   ///< above its least volume; else it exerts no forces
        std::array<vec<Real, Dim>, std::size_t(Dim) + 1> traction; ///< forces on its corners for 1 Pa, N
    };
    /// Volume of a pore, and its tractions, at other positions than those of the last step.
    pore_at pore_geometry(std::size_t pore, points_view<Real, Dim> points, Real const* radii) const noexcept {
        auto const shape = measure_corners(network_, pore, points, radii);
        pore_at at{void_of(shape) * thickness_, true, {}};
        Real const least = Real(parameters_.minimum_volume_fraction) * thickness_ * network_.size[pore];
        at.open = at.volume > least;
        at.volume = std::max(at.volume, least);
        for (std::size_t c = 0; c < at.traction.size(); ++c) at.traction[c] = shape.traction[c] * thickness_;
        return at;
    }
    /// Moves the pores to new positions without flow: the pressures follow the volumes exactly (sealed_pressure()), or
    /// stay while fluid enters and leaves from outside.
    /// \param sealed whether pressures follow the volumes
    void settle_pores(points_view<Real, Dim> points, Real const* radii, bool sealed) {
        if (network_.bare()) return;
        for (std::size_t p = 0; p < network_.pores(); ++p) {
            Real const now = pore_geometry(p, points, radii).volume;
            if (sealed) {
                auto const filled =
                    sealed_pressure(parameters_, double(network_.pressure[p]), double(network_.old_volume[p]),
                                    double(network_.vapour_of(p)), double(now));
                network_.pressure[p] = Real(filled.pressure);
                if (!network_.vapour.empty()) network_.vapour[p] = Real(filled.vapour);
            }
            network_.volume[p] = network_.old_volume[p] = now;
        }
    }

    /// \name Steps whose flow is solved together with the motion of the particles (equilibrium::advance())
    /// \{
    /// Lets fluid flow through all throats, also those that deactivate_slow_throats() skips.
    void activate_all_throats() {
        std::fill(network_.inactive.begin(), network_.inactive.end(), 0);
        throats_.collect_active(network_);
    }
    /// Pores on which flow sources act directly, with the sources and their shares.
    auto const& fed_pores() const noexcept { return exchange_.pores(); }
    /// Takes the result of a step of dt [s], with the particles at their new positions. Updates ledger and sources.
    void take_flow(solved_flow const& next, points_view<Real, Dim> points, Real const* radii, Real dt) {
        open_step(ledger_);
        std::fill(throat_sums_.begin(), throat_sums_.end(), throat_sums<Real>{});
        for (std::size_t t = 0; t < network_.open_throats(); ++t) network_.flow[t] = Real(next.flow[t]);
        add_up_throats(dt, 1);
        auto pores = take_pores(network_, next, parameters_.bulk_modulus,
                                [&](std::size_t p) { return pore_geometry(p, points, radii).volume; });
        add_up_throats(dt, 1);
        throat_sums<Real> throats;
        for (auto const& s : throat_sums_) throats += s;
        exchange_.take(network_, next, throats);
        exchange_.count(network_, dt, true);
        exchange_.close(network_, dt);
        book(ledger_, pores, throats);
    }
    /// \}

    /// Energy stored in the compressed fluid, sum of V p^2 / 2 K_f, J.
    Real storage_energy() const noexcept {
        return lacuna::storage_energy(network_, parameters_.bulk_modulus);
    }

    /// The paper's eq. 19 as printed, s; not safe where apertures differ. Skipped throats count. Infinite with a law of
    /// the section, which has no aperture in the sense of eq. 19.
    Real mean_throat_limit() const {
        if constexpr (throat_section_law<aperture_type>) return std::numeric_limits<Real>::infinity();
        return lacuna::mean_throat_limit(network_, parameters_.bulk_modulus, parameters_.conductivity);
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(network_, ledger_, exchange_);
        if constexpr (Archive::is_loading::value) {
            throats_.collect_active(network_);
            clusters_.build(network_, parameters_.merge_conductance);
        }
    }

protected:
    using aperture_type = typename parameters::aperture_type;
    /// Rigid pores of a bare network, whose volumes and apertures stay constant.
    flow_base(parameters const& p, network_type network) : flow_base(p, std::move(network), Real(1)) {}
    /// Pores of a packing in its present geometry.
    flow_base(parameters const& p, network_type network, Real thickness, points_view<Real, Dim> points,
              Real const* radii)
        : flow_base(p, std::move(network), thickness) {
        refresh_geometry(points, radii);
        network_.old_volume = network_.volume;
        // The pairs of a facet need not touch: the aperture depends on their distance.
        if constexpr (Dim == 3) refresh_apertures(particle_records(points, radii), std::array<Real, 1>{}.data());
    }

    /// Replaces network and ledger.
    /// \return whether the throats connect the same pores as before
    bool restore_state(network_type network, flow_ledger<Real> const& ledger) {
        bool const same = network.corner == network_.corner && network.throat_pore == network_.throat_pore &&
                          network.size == network_.size && network.pores() == network_.pores() &&
                          network.open_throats() == network_.open_throats();
        network_ = std::move(network);
        ledger_ = ledger;
        fit_vapour();
        if (same) {
            pores_.set_padding(network_);
            throats_.collect_active(network_);
            exchange_.build(network_);
            clusters_.build(network_, parameters_.merge_conductance);
        } else {
            build_tables();
        }
        return same;
    }

    bool flows() const noexcept { return throats_.active_throats() > 0; }
    Real substep_limit() const noexcept {
        return clusters_.on() ? clusters_.critical_time_step(network_, parameters_.bulk_modulus)
                              : flow_critical_time_step(network_, parameters_.bulk_modulus);
    }

    /// Updates the volumes, and the forces for 1 Pa.
    void update_geometry(Real const* particles, int threads) noexcept {
        for_each_chunk(pores_.chunks(), threads,
                       [&](int c) { pores_.update_geometry(c, network_, particles, thickness_, forces_); });
    }
    /// Forces of the pressures, summed over the particles; after update_geometry().
    void apply_pressures(record_column<Real>* tractions, int threads) noexcept {
        for_each_chunk(pores_.chunks(), threads, [&](int c) { pores_.apply_pressures(c, network_, forces_); });
        write_tractions(tractions, threads);
    }
    /// Allocates memory for the forces on the corners. \param transient see corner_forces
    void set_force_retention(bool transient) {
        if (forces_.built() && forces_.transient() == transient) return;
        forces_.build(network_, pore_table<Real, Dim>::chunk_packs * pore_table<Real, Dim>::width, transient);
    }
    /// Whether forces can be summed as soon as they are computed. That requires one thread, throats in the order of
    /// their pores, and pressures that do not change after the pass over the pores.
    bool can_stream(int threads) const noexcept {
        return threads == 1 && throats_.in_order() && exchange_.pores().empty() && !clusters_.on();
    }

    /// The whole step if can_stream(). Throats, pores and sums over particles are computed block by block, while their
    /// data are in the cache. A throat belongs to its lower-numbered pore. So after the flows of a block's throats,
    /// nothing reads the old pressures of its pores any more.
    void fused_step(Real const* particles, Real const* normal_forces, Real dt, bool flowing,
                    record_column<Real>* tractions) noexcept {
        auto const fluid = constants();
        auto const flow_through = [&](std::size_t first, std::size_t end) {
            throats_.template pass<true, true, aperture_type>(first, end, network_, particles, normal_forces,
                                                              parameters_.aperture);
        };
        std::size_t done = 0;
        // Drained throats are not in the order of their pores.
        if (flowing) flow_through(throats_.first_beyond(network_, network_.pores(), 0), throats_.packs(false).size());
        std::size_t const block = pore_table<Real, Dim>::chunk_packs * pore_table<Real, Dim>::width;
        for (int c = 0; c < pores_.chunks(); ++c) {
            if (flowing) {
                std::size_t const end = throats_.first_beyond(network_, std::size_t(c + 1) * block, done);
                flow_through(done, end);
                done = end;
            }
            pores_.template advance<true, false>(c, network_, particles, fluid, dt, flowing, Real(1), forces_,
                                                 pore_sums_[std::size_t(c)]);
            if (tractions) forces_.write_complete(std::size_t(c), *tractions);
        }
        exchange_.count(network_, dt, flowing);
    }

    /// The paper's eq. 14 from the present pressures, for all throats that are not skipped.
    /// \tparam Moves whether to update the apertures first
    template <bool Moves>
    void compute_flows(Real const* particles, Real const* normal_forces, int threads) noexcept {
        for_each_chunk(throats_.chunks(false), threads, [&](int c) {
            throats_.template pass<Moves, true, aperture_type>(c, network_, particles, normal_forces,
                                                               parameters_.aperture);
        });
    }

    /// The paper's eq. 15 for all pores over dt [s], from the flows stored in the network, and the exchange with
    /// sources.
    /// \tparam Fused whether to update the pores' geometry and write their forces in the same pass
    /// \param flowing whether anything flows through throats
    /// \param part see pore_table::advance()
    /// \param tractions as in step(); used if Fused
    template <bool Fused, bool WithLedger>
    void advance_pressures(Real const* particles, Real dt, Real part, bool flowing, int threads,
                           [[maybe_unused]] record_column<Real>* tractions = nullptr) noexcept {
        auto const fluid = constants();
        exchange_.remember(network_);
        if constexpr (WithLedger) {
            clusters_.remember(network_);
            std::fill(throat_sums_.begin(), throat_sums_.end(), throat_sums<Real>{});
            add_up_throats(flowing ? dt : Real(0), threads);
        }
        for_each_chunk(pores_.chunks(), threads, [&](int c) {
            pores_.template advance<Fused, WithLedger>(c, network_, particles, fluid, dt, flowing, part, forces_,
                                                       pore_sums_[std::size_t(c)]);
            if (Fused && tractions && forces_.transient()) forces_.write_complete(std::size_t(c), *tractions);
        });
        pore_sums<Real> pores;
        throat_sums<Real> throats;
        exchange_.apply(network_, fluid, dt, flowing, pores, throats);
        clusters_.template equalise<WithLedger>(network_, fluid, pores);
        if constexpr (Fused) {
            for (auto const& f : exchange_.pores())
                pores_.rewrite_forces(f.pore, network_, particles, thickness_, forces_);
            for (auto const p : clusters_.members())
                pores_.rewrite_forces(std::size_t(p), network_, particles, thickness_, forces_);
            if (!forces_.transient()) write_tractions(tractions, threads);
        }
        if constexpr (WithLedger) {
            add_up_throats(flowing ? dt : Real(0), threads);
            for (auto const& s : throat_sums_) throats += s;
            for (int c = 0; c < pores_.chunks(); ++c) pores += pore_sums_[std::size_t(c)];
            book(ledger_, pores, throats);
        }
    }

    /// Takes several flow steps within one of dt [s]; the pores' geometry must be up to date.
    /// \param flow callable (whether it is the first substep, its duration [s], its share of the remaining volume
    ///        change) that writes the flows into the network
    template <bool WithLedger, class Flow>
    void take_substeps(int count, Real dt, int threads, Flow const& flow) {
        bool const flowing = flows() && dt > Real(0);
        Real const part = dt / Real(count);
        for (int s = 0; s < count; ++s) {
            Real const share = Real(1) / Real(count - s);
            if (flowing) flow(s == 0, part, share);
            advance_pressures<false, WithLedger>(nullptr, part, share, flowing, threads);
        }
    }

    template <bool WithLedger>
    void begin_step() noexcept {
        if constexpr (WithLedger) open_step(ledger_);
        clusters_.update(network_);
        Real const lost = clusters_.settle(network_, constants());
        if constexpr (WithLedger) ledger_.dissipation += lost;
    }
    void end_step(Real dt) noexcept {
        if (dt > Real(0)) exchange_.close(network_, dt);
    }

    parameters parameters_;
    Real thickness_;
    bool values_set_ = false;
    network_type network_;
    flow_ledger<Real> ledger_;
    source_exchange<Real> exchange_;
    pore_clusters<Real, Dim> clusters_;

private:
    void write_tractions(record_column<Real>* tractions, int threads) const noexcept {
        if (!tractions) return;
        for_each_chunk(forces_.chunks(), threads, [&](int c) { forces_.write(c, *tractions); });
    }

    flow_base(parameters const& p, network_type network, Real thickness)
        : parameters_(p), thickness_(thickness), network_(std::move(network)) {
        parameters_.validate("flow");
        require_positive("thickness", double(thickness));
        if (Dim == 3 && thickness != Real(1)) refuse("thickness", double(thickness), "1 in space");
        for (std::size_t k = 0; k < network_.pores(); ++k) {
            network_.pressure[k] += Real(p.initial_pressure);
            parameters_.require_pressure("initial pressure of pore " + std::to_string(k), double(network_.pressure[k]));
        }
        for (auto const& source : network_.sources)
            if (source.kind == flow_source_kind::pressure)
                parameters_.require_pressure("flow source " + source.name, source.value);
        if constexpr (!throat_section_law<aperture_type>) if (!network_.bare()) {
            Real const aperture = aperture_type::aperture(p.aperture, Real(0), Real(0));
            std::fill(network_.aperture.begin(), network_.aperture.end(), aperture);
        }
        for (std::size_t t = 0; t < network_.open_throats(); ++t) {
            Real const a = network_.aperture[t];
            network_.conductance[t] = Real(p.conductivity) * (a * a * a / network_.length[t]);
        }
        fit_vapour();
        build_tables();
    }

    /// Sizes the array of vapour: empty for a fluid that never tears, otherwise one entry per pore.
    void fit_vapour() {
        if (!(parameters_.minimum_pressure > -std::numeric_limits<double>::infinity()))
            network_.vapour = {};
        else if (network_.vapour.empty())
            network_.vapour.assign(network_.pores(), Real(0));
    }
    /// Adds up the throats' energies with the present pressures; see throat_table::add_up().
    void add_up_throats(Real dt, int threads) noexcept {
        for_each_chunk(throats_.chunks(false), threads,
                       [&](int c) { throats_.add_up(c, network_, dt, throat_sums_[std::size_t(c)]); });
    }

    void build_tables() {
        pores_.build(network_, Real(parameters_.minimum_volume_fraction) * thickness_);
        throats_.build(network_, Real(parameters_.conductivity));
        pore_sums_.resize(std::size_t(std::max(pores_.chunks(), 1)));
        throat_sums_.resize(std::size_t(throats_.chunks(true)));
        forces_ = {};
        exchange_.build(network_);
        clusters_.build(network_, parameters_.merge_conductance);
    }

    pore_constants<Real> constants() const noexcept {
        return {Real(parameters_.bulk_modulus), thickness_, Real(parameters_.minimum_pressure)};
    }

    pore_table<Real, Dim> pores_;
    throat_table<Real, Dim> throats_;
    corner_forces<Real, Dim> forces_;
    std::vector<pore_sums<Real>> pore_sums_;
    std::vector<throat_sums<Real>> throat_sums_;
};
LACUNA_END_PACKS

} // namespace lacuna
