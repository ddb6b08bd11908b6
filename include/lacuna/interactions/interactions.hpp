// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/interactions/bond_failure.hpp>
#include <lacuna/interactions/bond_list.hpp>
#include <lacuna/interactions/bond_moments.hpp>
#include <lacuna/interactions/storage/contact_list.hpp>
#include <lacuna/interactions/storage/force_buffer.hpp>
#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/interactions/interaction_parameters.hpp>
#include <lacuna/interactions/pair_loop.hpp>
#include <lacuna/laws/damping.hpp>
#include <lacuna/laws/no_contact.hpp>
#include <lacuna/neighbors/periodic_search.hpp>
#include <lacuna/neighbors/verlet_list.hpp>
#include <lacuna/particles/domain.hpp>
#include <lacuna/particles/material.hpp>

namespace lacuna {

struct interactions_archive;

LACUNA_BEGIN_PACKS
/// Bonds and contacts: their tables, histories and forces, and the hand-over from a failed bond to a contact.
template <class Real, int Dim, contact_law<Dim> ContactLaw, bond_law<Dim> BondLaw, damping_policy Damping,
          neighbor_search Search, domain_policy Domain = open_domain>
class interactions {
public:
    using store_type = particle_store<Real, Dim>;
    using contact_table = pair_table<ContactLaw, Real, Dim>;
    using bond_table = pair_table<BondLaw, Real, Dim>;
    using material = material_of<ContactLaw, BondLaw>;
    using search_type = std::conditional_t<Domain::periodic, periodic_search<Search>, Search>;
    static constexpr int chunk_particles = contact_table::chunk_particles;
    static_assert(chunk_particles == verlet_list<search_type>::block_particles);

    interactions() = default;
    /// \param bonds stable ids of the two particles of each bond
    /// \param thickness of a 2D packing, m
    /// \param own individual values of bonds: none, or one entry per bond
    /// \throws std::invalid_argument as make_bonds(), give_own_rows() and require_stated_stiffness(), and for a period
    ///         that is too short
    interactions(store_type const& store, std::span<std::array<std::int32_t, 2> const> bonds,
                 std::span<material const> materials, double thickness, interaction_parameters const& parameters,
                 typename Damping::parameters const& damping, std::span<bond_values const> own = {})
        : parameters_(parameters), damping_(damping), materials_(int(materials.size())) {
        for (auto const& a : materials)
            for (auto const& b : materials) {
                contact_parameters_.add(ContactLaw::combine(a.contact, b.contact, thickness));
                bond_parameters_.add(BondLaw::combine(a.bond, b.bond, thickness));
            }
        if (store.size() > 0)
            for (auto const& row : contact_parameters_.row)
                require_stated_stiffness<ContactLaw, Dim>(row, double(store.radius(0)));
        Real longest = 0;
        auto bond_entries = make_bonds<BondLaw, bond_entry>(
            store, bonds, [&](std::int32_t i, std::int32_t j) { return parameter_row(store, i, j); }, longest);
        if (!own.empty()) {
            give_own_rows(store, bond_entries, own, bond_parameters_);
            bond_rows_.resize(bonds.size());
            for (auto const& e : bond_entries) bond_rows_[std::size_t(e.label)] = e.parameter;
        }
        bond_records_.assign(bonds.size(), {});
        for (std::size_t b = 0; b < bonds.size(); ++b) bond_records_[b].particles = bonds[b];
        make_neighbors(store, longest);
        assign_bonds(store, bond_entries);
        rebuild_tables(store, true);
    }

    /// Searches for contact candidates again once particles have moved so far that the list could miss one. Replaces
    /// the bonds that failed in the last step by contacts. Call it before the forces of a step.
    /// \return whether the tables have changed
    bool update(store_type const& store) {
        bool const searched = has_contacts() && neighbors_.due(store.positions());
        if (searched) neighbors_.build_for_motion(store.positions(), store.radii());
        if (!searched && broken_.empty()) return false;
        rebuild_tables(store, false);
        return true;
    }
    /// Searches for contact candidates now, wherever the particles were before, and replaces failed bonds by contacts.
    void search_again(store_type const& store) {
        if (has_contacts()) neighbors_.build_for_motion(store.positions(), store.radii());
        rebuild_tables(store, false);
    }
    /// Adds the largest displacement of a chunk's particles in a step, m. Call it after each step for each chunk.
    void add_path(int chunk, Real path) noexcept {
        if (has_contacts()) neighbors_.add_path(std::size_t(chunk), path);
    }

    int chunks() const noexcept { return forces_.chunks(); }

    /// As force_buffer::set_force_retention(); rebuilds the buffer at once.
    void set_force_retention(store_type const& store, bool transient, int threads) {
        if (!forces_.set_force_retention(transient, threads)) return;
        neighbors_.set_threads(threads);
        forces_.build(store.size(), bonds_, contacts_);
    }
    /// As force_buffer::keep_normals(). find_normal_force() requires it.
    void keep_normal_forces() { forces_.keep_normals(bonds_, contacts_); }
    /// True if single pair forces are discarded once they are summed up. Then either use a chunk's sums right after its
    /// evaluation, by for_fresh_force_sums(). Or call prepare_force_sums() once and keep_force_sums() for each chunk,
    /// and use for_force_sums() later.
    bool forces_are_transient() const noexcept { return forces_.forces_are_transient(); }
    void prepare_force_sums(store_type const& store) { forces_.prepare_force_sums(store.size()); }
    void keep_force_sums(store_type const& store, int chunk) { forces_.keep_force_sums(chunk, store.size()); }
    template <class Use>
    void for_fresh_force_sums(int chunk, Use const& use) const {
        forces_.for_fresh_force_sums(chunk, use);
    }
    chunk_spans const& spans() const noexcept { return forces_.spans(); }

    /// Evaluates the forces of the pairs that a chunk of particles owns. Chunks are independent of each other.
    /// \tparam WithEnergy whether energies are summed up for energy()
    /// \tparam Commit false: a trial, which leaves histories as they are, breaks no bond and records no overlap
    /// \param time_step length of the step that led to the present positions, s
    template <bool WithEnergy, bool Commit = true>
    void evaluate(store_type const& store, int chunk, Real time_step) {
        auto& energy = chunk_results_[std::size_t(chunk)].energy;
        energy = {};
        auto ahead = forces_.plan_prefetch(store, chunk, bonds_, contacts_);
        overlap_limits<Real> const limits{deepest_, watched_};
        if constexpr (!is_absent<BondLaw>)
            evaluate_chunk<pair_kind::bond, WithEnergy, Commit, BondLaw, Damping, Domain>(
                bonds_, chunk, bond_parameters_, damping_, store, time_step,
                output<pair_kind::bond>(bonds_, chunk, moments_), ahead, energy[0], limits,
                [&](std::size_t pack) { break_bonds(store, chunk, pack, time_step); });
        if constexpr (!is_absent<ContactLaw>)
            evaluate_chunk<pair_kind::contact, WithEnergy, Commit, ContactLaw, Damping, Domain>(
                contacts_, chunk, contact_parameters_, damping_, store, time_step,
                output<pair_kind::contact>(contacts_, chunk, contact_moments_), ahead, energy[1], limits,
                [&](std::size_t pack) { note_overlaps(store, chunk, pack); });
    }
    /// As force_buffer::for_force_sums().
    template <class Use>
    void for_force_sums(int chunk, Use const& use) const {
        forces_.for_force_sums(chunk, use);
    }

    /// Adds the moments of the pairs in the last evaluation to `out`; see lacuna::add_moments().
    void add_moments([[maybe_unused]] store_type const& store,
                     [[maybe_unused]] record_column<Real>& out) const noexcept {
        if constexpr (carries_moment<BondLaw>) lacuna::add_moments(store, bonds_, moments_, out);
        if constexpr (carries_moment<ContactLaw>) lacuna::add_moments(store, contacts_, contact_moments_, out);
    }

    /// Makes an intact bond fail at the forces of the step just evaluated, whatever its strength: in tension if it
    /// pulls, else in shear. collect_events() gives the failure.
    /// \param bond its number in the input
    void break_bond(store_type const& store, std::int32_t bond, Real time_step) {
        auto const slot = std::size_t(bond_records_[std::size_t(bond)].slot);
        int chunk = 0;
        while (slot >= bonds_.first_slot(chunk) + bonds_.chunk_size(chunk)) ++chunk;
        break_bond(store, chunk, slot, time_step, true);
    }
    /// Failures of the step just evaluated, in the order of the pairs. The caller adds the step's number and time.
    std::span<break_event<Dim> const> collect_events() {
        events_.clear();
        fracture_energy_ = {};
        for (auto& chunk : chunk_results_) {
            for (auto& e : chunk.failures) {
                events_.push_back(e.event);
                broken_.push_back(e.contact);
                fracture_energy_[e.event.mode == bond_state::broken_in_shear] += e.released;
                auto& record = bond_records_[std::size_t(e.event.bond)];
                record.state = e.event.mode;
                record.slot = -1;
            }
            chunk.failures.clear();
        }
        return events_;
    }
    /// Energy that the step's failures took out of the springs: in tension, then in shear, consistent with the
    /// integrator, J.
    std::array<double, 2> const& fracture_energy() const noexcept { return fracture_energy_; }

    /// Elastic energy that the pairs lost when bonds failed in the last evaluation, at constant positions, J.
    double energy_of_failures() const noexcept {
        double lost = 0;
        for (auto const& chunk : chunk_results_) lost -= chunk.energy[2].stored;
        return lost;
    }
    /// Energies of the last evaluation with WithEnergy, summed over the chunks in their order.
    pair_energy energy() const noexcept {
        pair_energy total;
        for (auto const& chunk : chunk_results_) {
            for (auto const& e : chunk.energy) total += e;
            total.in_bonds += chunk.energy[0].stored;
        }
        return total;
    }

    /// Sets the overlap beyond which deep_overlap() reports a contact.
    /// \param limit overlap over the smaller radius, 1; infinite: no limit
    void set_deepest_overlap(double limit) noexcept { deepest_ = Real(limit); }
    /// Internal indices of two particles in contact that overlap by more than the limit; {-1, -1} if there are none.
    std::array<std::int32_t, 2> deep_overlap() const noexcept {
        for (auto const& chunk : chunk_results_)
            if (chunk.deep_overlap[0] >= 0) return chunk.deep_overlap;
        return {-1, -1};
    }
    /// Makes evaluations record contacts that overlap by more than this share of the smaller radius, 1. Only for laws
    /// that stiffen.
    void watch_overlaps(double share) noexcept { watched_ = Real(share); }
    /// Largest overlap recorded since the last call, as a share of the smaller radius, 1; 0: none. Resets the record.
    double take_deepest() noexcept {
        double deepest = 0;
        if constexpr (stiffens<ContactLaw, Dim>)
            for (auto& chunk : chunk_results_)
                deepest = std::max(deepest, double(std::exchange(chunk.overlap_share, Real(0))));
        return deepest;
    }
    /// Distance by which two particles outside the candidate list may still approach before they could touch, m;
    /// infinite without contacts.
    double remaining() const noexcept {
        return has_contacts() ? double(neighbors_.remaining())
                              : std::numeric_limits<double>::infinity();
    }
    bool has_contacts() const noexcept { return !is_absent<ContactLaw> && parameters_.contacts; }

    /// Calls visit(pair_tangent) for every bond, then for the contacts that touch or may touch under the assumption.
    /// The stiffnesses are derivatives of the laws.
    template <class Visit>
    void for_each_pair_tangent(store_type const& store, contact_assumption const& assumed, Visit const& visit) const {
        if constexpr (!is_absent<BondLaw>) visit_bond_tangents<BondLaw>(store, bonds_, bond_parameters_, visit);
        if constexpr (!is_absent<ContactLaw>)
            visit_contact_tangents<ContactLaw>(store, contacts_, contact_parameters_, assumed, visit);
    }
    /// Calls visit(contact_seen, pair_stiffness) for the contacts that touch or may touch under the assumption.
    template <class Visit>
    void for_each_depth(store_type const& store, contact_assumption const& assumed, Visit const& visit) const {
        visit_depths<ContactLaw>(store, contacts_, contact_parameters_, assumed, visit);
    }

    /// Offset in force_column() of the force record of the pair (i, j), internal indices in any order. -1 if there is
    /// no such pair, or if single forces are discarded. The record has the force on the lower-numbered particle; its
    /// fourth number is the normal force.
    std::int32_t find_force(std::int32_t i, std::int32_t j) const noexcept {
        if (i > j) std::swap(i, j);
        std::int32_t slot = bonds_.find(i, j);
        if (slot >= 0) return forces_.template find<pair_kind::bond>(i / chunk_particles, slot);
        slot = contacts_.find(i, j);
        return slot >= 0 ? forces_.template find<pair_kind::contact>(i / chunk_particles, slot) : -1;
    }
    Real const* force_column() const noexcept { return forces_.column(); }
    /// Index in normal_forces() of the pair (i, j), internal indices in any order; 0 if there is no such pair.
    std::int32_t find_normal_force(std::int32_t i, std::int32_t j) const noexcept {
        if (i > j) std::swap(i, j);
        std::int32_t slot = bonds_.find(i, j);
        if (slot >= 0) return forces_.template find_normal<pair_kind::bond>(slot);
        slot = contacts_.find(i, j);
        return slot >= 0 ? forces_.template find_normal<pair_kind::contact>(slot) : 0;
    }
    /// Normal forces of all pairs, N, positive in tension; the first is 0. Requires keep_normal_forces().
    Real const* normal_forces() const noexcept { return forces_.normals(); }

    bond_table const& bonds() const noexcept { return bonds_; }
    contact_table const& contacts() const noexcept { return contacts_; }
    std::span<bond_record const> bond_records() const noexcept { return bond_records_; }
    parameter_table<ContactLaw, Real> const& contact_parameters() const noexcept { return contact_parameters_; }
    parameter_table<BondLaw, Real> const& bond_parameters() const noexcept { return bond_parameters_; }
    /// Row in bond_parameters() of the bond with the given number, intact or not.
    std::size_t row_of_bond(store_type const& store, std::int32_t bond) const noexcept {
        auto const& ids = bond_records_[std::size_t(bond)].particles;
        auto const i = store.internal(std::size_t(ids[0])), j = store.internal(std::size_t(ids[1]));
        return std::size_t(bond_row(store, bond, std::min(i, j), std::max(i, j)));
    }
    typename Damping::parameters const& damping() const noexcept { return damping_; }
    verlet_list<search_type> const& neighbors() const noexcept { return neighbors_; }

private:
    friend struct lacuna::interactions_archive; // writes and reads the state, in a header of its own
    using contact_entry = typename contact_table::entry;
    using bond_entry = typename bond_table::entry;
    using pending_event = bond_failure<contact_entry, Dim>;

    /// Makes the candidate list.
    /// \param bond length of the longest bond, m
    void make_neighbors(store_type const& store, Real bond) {
        Real const skin = Real(parameters_.skin) * median_radius(store.radii());
        Real longest = std::numeric_limits<Real>::infinity();
        if constexpr (Domain::periodic) {
            Real first = 0, second = 0;
            for (Real const r : store.radii()) {
                second = std::max(second, std::min(first, r));
                first = std::max(first, r);
            }
            Real const reach = first + second + std::max(skin, Real(parameters_.initial_contact_tolerance) * second);
            for (int axis = 0; axis < Dim; ++axis)
                if (Real const length = store.period().length[axis]; length > 0) {
                    require_long_period(length, std::max(reach, bond));
                    longest = std::min(longest, length / Real(2.005));
                }
        }
        neighbors_ = verlet_list<search_type>({.skin = skin, .margin = 0, .longest = longest});
        search_type search;
        if constexpr (Domain::periodic) {
            neighbors_.set_period(store.period().length);
            search.set_period(store.period().length);
        }
        if (!has_contacts()) return;
        neighbors_.build_for_motion(store.positions(), store.radii());
        neighbors_.add(pairs_touching_apart(store, search, parameters_.initial_contact_tolerance));
    }
    /// Refuses a period so short that a particle could meet two images of the same partner.
    /// \param reach largest distance at which two particles meet, or length of the longest bond, m
    static void require_long_period(Real length, Real reach) {
        if (!(length >= Real(2.01) * reach))
            refuse("domain.period", double(length),
                   "0 or at least 2.01 times the distance at which particles meet, " + to_text(2.01 * double(reach)));
    }
    /// Adds to the candidates the contacts that act beyond the range of the search: old ones, and those of failed
    /// bonds.
    void hold_contacts(store_type const& store) {
        bool const may = parameters_.initial_contact_tolerance > 0 || bonds_.size() < bond_records_.size();
        if (!has_contacts() || !may) return;
        held_.clear();
        auto const look = [&](contact_entry const& e) {
            if (acts_apart<ContactLaw>(store, contact_parameters_.row[std::size_t(e.parameter)], e))
                held_.push_back({e.i, e.j});
        };
        for (std::size_t s = 0; s < contacts_.slots(); ++s)
            if (!contacts_.is_padding(s, store.size())) look(contacts_.get(s));
        for (contact_entry const& e : broken_) look(e);
        detail::sort_pairs(held_.data(), held_.data() + held_.size());
        neighbors_.add(held_);
    }
    std::int32_t parameter_row(store_type const& store, std::int32_t i, std::int32_t j) const noexcept {
        return store.material(std::size_t(i)) * materials_ + store.material(std::size_t(j));
    }

    void rebuild_tables(store_type const& store, bool first) {
        if (!broken_.empty()) {
            bonds_.filter(store, [&](std::size_t s) {
                return bond_records_[std::size_t(bonds_.label(s))].state == bond_state::intact;
            });
            number_bonds(bond_records_, bonds_, store.size());
            std::sort(broken_.begin(), broken_.end(), pair_before<contact_entry>);
        }
        if constexpr (!is_absent<ContactLaw>) {
            hold_contacts(store);
            double const tolerance = first ? parameters_.initial_contact_tolerance : 0;
            auto const make = [&](neighbor_pair const& pair) {
                return contact_entry{pair.i, pair.j, parameter_row(store, pair.i, pair.j), -1,
                                     first_history<ContactLaw>(store, pair, tolerance)};
            };
            merge_contacts(neighbors_.pairs(), bonds_, broken_, contacts_, store, forces_.threads(), make);
        }
        broken_.clear();
        build_rows(store);
    }

    void assign_bonds(store_type const& store, std::span<bond_entry const> entries) {
        bonds_.assign(entries, store);
        if constexpr (carries_moment<BondLaw>) moments_.resize(bonds_.slots() * rotation_dim<Dim>);
        number_bonds(bond_records_, bonds_, store.size());
    }
    /// Parameter row of a bond: its individual row, or the row of its materials.
    std::int32_t bond_row(store_type const& store, std::int32_t bond, std::int32_t i, std::int32_t j) const noexcept {
        return bond_rows_.empty() ? parameter_row(store, i, j) : bond_rows_[std::size_t(bond)];
    }

    void build_rows(store_type const& store) {
        forces_.build(store.size(), bonds_, contacts_);
        if constexpr (carries_moment<ContactLaw>) contact_moments_.resize(contacts_.slots() * rotation_dim<Dim>);
        chunk_results_.resize(std::size_t(forces_.chunks()));
        for (auto& chunk : chunk_results_) chunk.deep_overlap = {-1, -1}, chunk.overlap_share = 0;
    }

    template <pair_kind Kind, class Law>
    chunk_output<Real> output(pair_table<Law, Real, Dim> const& table, int chunk, std::vector<Real>& moments) noexcept {
        return {forces_.template begin<Kind>(table, chunk), forces_.template offsets<Kind>(table, chunk),
                forces_.template normals_of<Kind>(), moments.data()};
    }
    void note_overlaps(store_type const& store, int chunk, std::size_t pack) {
        if (auto const found = find_deep_overlap(store, contacts_, pack, deepest_); found[0] >= 0)
            chunk_results_[std::size_t(chunk)].deep_overlap = found;
        if constexpr (stiffens<ContactLaw, Dim>) {
            auto& share = chunk_results_[std::size_t(chunk)].overlap_share;
            share = std::max(share, deepest_of_pack(store, contacts_, pack));
        }
    }
    [[gnu::noinline]] void break_bonds(store_type const& store, int chunk, std::size_t pack, Real time_step) {
        for (std::size_t s = pack * bond_table::width; s < (pack + 1) * bond_table::width; ++s)
            if (!bonds_.is_padding(s, store.size())) break_bond(store, chunk, s, time_step, false);
    }
    void break_bond(store_type const& store, int chunk, std::size_t slot, Real time_step, bool anyway) {
        bond_entry const bond = bonds_.get(slot);
        std::int32_t const row = parameter_row(store, bond.i, bond.j);
        auto const failed = fail_bond<BondLaw, ContactLaw>(
            store, bond, bond_parameters_.row[std::size_t(bond.parameter)], contact_parameters_.row[std::size_t(row)],
            row, time_step, forces_.template of<pair_kind::bond>(chunk, slot), anyway);
        if (!failed) return;
        if constexpr (carries_moment<BondLaw>)
            std::fill_n(moments_.begin() + std::ptrdiff_t(slot * rotation_dim<Dim>), rotation_dim<Dim>, Real(0));
        auto& results = chunk_results_[std::size_t(chunk)];
        results.energy[2] += {failed->stored, 0, 0, -failed->event.energy};
        results.failures.push_back(*failed);
    }

    interaction_parameters parameters_;
    typename Damping::parameters damping_;
    int materials_ = 0;
    parameter_table<ContactLaw, Real> contact_parameters_;
    parameter_table<BondLaw, Real> bond_parameters_;
    verlet_list<search_type> neighbors_;
    std::vector<neighbor_pair> held_; // buffer of hold_contacts()
    bond_table bonds_;
    contact_table contacts_;
    force_buffer<Real, Dim> forces_;
    std::vector<Real> moments_, contact_moments_; // on the first particle of each pair, by slot; laws with moments only
    std::vector<bond_record> bond_records_;
    std::vector<std::int32_t> bond_rows_; // parameter row of each bond; empty without individual values
    std::vector<contact_entry> broken_;
    std::vector<break_event<Dim>> events_;
    /// Results of the last evaluation of one chunk.
    struct chunk_result {
        std::vector<pending_event> failures;
        std::array<pair_energy, 3> energy{};             ///< of bonds, of contacts, correction for bonds that failed
        std::array<std::int32_t, 2> deep_overlap{-1, -1}; ///< a pair with an overlap beyond deepest_
        Real overlap_share = 0; ///< the deepest overlap beyond watched_, over the smaller radius
    };
    std::vector<chunk_result> chunk_results_;
    Real deepest_ = 1, watched_ = 1; // limits of overlaps, over the smaller radius
    std::array<double, 2> fracture_energy_{};
};
LACUNA_END_PACKS

} // namespace lacuna
