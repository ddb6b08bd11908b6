// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <lacuna/interactions/storage/force_offsets.hpp>
#include <lacuna/interactions/storage/force_gather.hpp>
#include <lacuna/interactions/storage/prefetcher.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The forces of all pairs: their storage, and their sums on the particles.
template <class Real, int Dim>
class force_buffer {
public:
    static constexpr int chunk_particles = force_gather<Real, Dim>::chunk_particles;
    static constexpr int width = native_width<Real>;

    /// Sets how long single pair forces are stored. Takes effect with the next build().
    /// \param transient true: the model reads no single pair force. A force is then stored only until the sums that
    ///        need it are done, chunk by chunk; chunks that wait are an exception, see chunk_spans
    /// \param threads number of spans into which the chunks are cut. With too few chunks there is one span, and all
    ///        forces are stored
    /// \return whether a setting has changed
    bool set_force_retention(bool transient, int threads) noexcept {
        bool const changed = transient != transient_ || threads != threads_;
        transient_ = transient;
        threads_ = threads;
        if (changed) forces_.column = {}; // the new mode may need much less memory
        return changed;
    }
    /// From now on stores the normal force of every pair in a separate column, in any mode.
    template <class BondLaw, class ContactLaw>
    void keep_normals(pair_table<BondLaw, Real, Dim> const& bonds, pair_table<ContactLaw, Real, Dim> const& contacts) {
        stores_normals_ = true;
        build_normals(bonds, contacts);
    }

    /// Adapts the storage to the tables. Call it when the tables have changed.
    template <class BondLaw, class ContactLaw>
    void build(std::size_t particles, pair_table<BondLaw, Real, Dim> const& bonds,
               pair_table<ContactLaw, Real, Dim> const& contacts) {
        int const chunks = int((particles + chunk_particles - 1) / chunk_particles);
        spans_.build(chunks, threads_, particles, bonds, contacts);
        reuses_memory_ = transient_ && spans_.count() == threads_;
        offsets_[0].build(bonds, particles, spans_, reuses_memory_);
        offsets_[1].build(contacts, particles, spans_, reuses_memory_);
        rows_.build(particles, offsets_, bonds, contacts);
        prefetcher_.build(particles, chunks, bonds, contacts);
        std::size_t const slots = (offsets_[0].count() + offsets_[1].count()) * width;
        forces_.column.resize((slots + 1) * pair_forces<Real, Dim>::records_per_pair);
        auto* zero = forces_.of(slots);
        std::fill(zero, zero + 4 * pair_forces<Real, Dim>::records_per_pair, Real(0));
        if (stores_normals_) build_normals(bonds, contacts);
    }

    /// Sets all stored forces to zero; the next evaluation overwrites them.
    void forget() noexcept {
        auto& column = forces_.column;
        std::fill(column.data(), column.data() + 4 * column.size(), Real(0));
        std::fill(normals_.begin(), normals_.end(), Real(0));
    }

    chunk_spans const& spans() const noexcept { return spans_; }
    int threads() const noexcept { return threads_; }
    int chunks() const noexcept { return rows_.chunks(); }
    Real const* column() const noexcept { return forces_.of(0); }

    /// \name Positions of the forces of bonds and contacts
    /// \{
    template <pair_kind Kind, class Law>
    force_offsets::row offsets(pair_table<Law, Real, Dim> const& table, int chunk) const noexcept {
        return offsets_[std::size_t(Kind)].of_chunk(table, chunk);
    }
    /// First force record of a chunk.
    template <pair_kind Kind, class Law>
    Real* begin(pair_table<Law, Real, Dim> const& table, int chunk) noexcept {
        return forces_.of((first_pack<Kind>() + offsets<Kind>(table, chunk).begin) * width);
    }
    /// Force record of the pair in a slot of a table.
    template <pair_kind Kind>
    Real* of(int chunk, std::size_t slot) noexcept {
        return forces_.of(force_slot<Kind>(chunk, slot));
    }
    /// Offset in column() of the force of the pair in a slot of a table; -1 if single forces are discarded.
    template <pair_kind Kind>
    std::int32_t find(int chunk, std::int32_t slot) const noexcept {
        if (transient_) return -1;
        return std::int32_t(force_slot<Kind>(chunk, std::size_t(slot))) * force_gather<Real, Dim>::reals_per_pair;
    }
    /// \}

    /// Normal forces of all pairs, N, positive in tension; the first is 0. Requires keep_normals().
    Real const* normals() const noexcept { return normals_.data(); }
    /// Normal forces of a table, by slot; nullptr if they are not stored.
    template <pair_kind Kind>
    Real* normals_of() noexcept {
        return stores_normals_ ? normals_.data() + width + (Kind == pair_kind::bond ? 0 : bond_slots_) : nullptr;
    }
    /// Index in normals() of a slot of a table.
    template <pair_kind Kind>
    std::int32_t find_normal(std::int32_t slot) const noexcept {
        return std::int32_t(width + (Kind == pair_kind::bond ? 0 : bond_slots_)) + slot;
    }

    /// True if single pair forces are discarded. Call keep_force_sums() for each chunk before for_force_sums().
    bool forces_are_transient() const noexcept { return reuses_memory_; }
    /// Stores the sums of a chunk until the next evaluation. The condition of for_fresh_force_sums() must hold.
    void keep_force_sums(int chunk, std::size_t particles) {
        constexpr std::size_t records = pair_forces<Real, Dim>::records_per_pair;
        std::size_t const first = std::size_t(chunk) * chunk_particles;
        int const count = int(std::min(particles - first, std::size_t(chunk_particles)));
        for_fresh_force_sums(chunk, [&](auto const& sum) {
            for (int k = 0; k < count; ++k) {
                auto const total = sum(k);
                if constexpr (Dim == 2) {
                    sums_.set(first + std::size_t(k), total);
                } else {
                    for (std::size_t r = 0; r < records; ++r)
                        sums_.set(records * (first + std::size_t(k)) + r, total[r]);
                }
            }
        });
    }
    /// Allocates the memory of keep_force_sums().
    void prepare_force_sums(std::size_t particles) {
        std::size_t const records = pair_forces<Real, Dim>::records_per_pair * particles;
        if (sums_.size() != records) sums_.resize(records);
    }
    /// Calls use(sum) with a callable for the sums of pair forces on the particles of a chunk: sum(k) is the sum on the
    /// k-th particle, as for force_sum. All pairs must be evaluated.
    template <class Use>
    void for_force_sums(int chunk, Use const& use) const {
        if (!reuses_memory_) return for_fresh_force_sums(chunk, use);
        constexpr std::size_t records = pair_forces<Real, Dim>::records_per_pair;
        use([this, first = std::size_t(chunk) * chunk_particles](int k) {
            std::size_t const at = records * (first + std::size_t(k));
            if constexpr (Dim == 2)
                return sums_[at];
            else
                return std::array<record<Real>, 2>{sums_[at], sums_[at + 1]};
        });
    }

    /// As for_force_sums(), but only the pairs of these particles must be evaluated. A pair belongs to its
    /// lower-numbered particle, so these are pairs of the chunks up to and including this one. The usual numbers of
    /// pairs per particle have separate loops of fixed length.
    template <class Use>
    void for_fresh_force_sums(int chunk, Use const& use) const {
        switch (rows_.half_row(chunk)) {
        case 3: return use(force_sum<Real, Dim, 3>(rows_, forces_.of(0), chunk));
        case 4: return use(force_sum<Real, Dim, 4>(rows_, forces_.of(0), chunk));
        case 5: return use(force_sum<Real, Dim, 5>(rows_, forces_.of(0), chunk));
        case force_gather<Real, Dim>::uneven:
            return use(force_sum<Real, Dim, force_gather<Real, Dim>::uneven>(rows_, forces_.of(0), chunk));
        default: return use(force_sum<Real, Dim>(rows_, forces_.of(0), chunk));
        }
    }

    /// Data to prefetch during the evaluation of a chunk.
    template <class BondLaw, class ContactLaw>
    prefetcher::plan plan_prefetch(particle_store<Real, Dim> const& store, int chunk,
                                   pair_table<BondLaw, Real, Dim> const& bonds,
                                   pair_table<ContactLaw, Real, Dim> const& contacts) const noexcept {
        prefetcher::plan plan;
        if (!prefetcher_.pays()) return plan;
        auto const packs_of = [&](auto const& table) {
            return chunk < table.chunks() ? table.end_pack(chunk) - table.first_pack(chunk) : 0;
        };
        std::size_t const packs = packs_of(bonds) + packs_of(contacts);
        auto const [first, end] = prefetcher_.newly_read(chunk + 1);
        auto const own = std::size_t(chunk) * chunk_particles;
        plan.any = true;
        // In 3D the particles that a chunk reads first lie scattered: the pair loop prefetches those of each pack.
        plan.streams = {
            prefetcher::stream(store.particle_records().data() + store.particle_records().stride * first,
                               Dim == 2 ? store.particle_records().stride * (end - first) * sizeof(Real) : 0, packs),
            prefetcher::stream(rows_.rows(chunk), rows_.bytes(chunk), packs),
            prefetcher::stream(store.inverse_masses() + own, chunk_particles * sizeof(Real), packs)};
        return plan;
    }

private:
    template <class BondLaw, class ContactLaw>
    void build_normals(pair_table<BondLaw, Real, Dim> const& bonds, pair_table<ContactLaw, Real, Dim> const& contacts) {
        bond_slots_ = bonds.slots();
        resize_with_room(normals_, width + bond_slots_ + contacts.slots());
    }
    template <pair_kind Kind>
    std::size_t first_pack() const noexcept {
        return Kind == pair_kind::bond ? 0 : offsets_[0].count();
    }
    template <pair_kind Kind>
    std::size_t force_slot(int chunk, std::size_t slot) const noexcept {
        return (first_pack<Kind>() + offsets_[std::size_t(Kind)](chunk, slot / width)) * width + slot % width;
    }

    pair_forces<Real, Dim> forces_;
    force_gather<Real, Dim> rows_;
    prefetcher prefetcher_;
    chunk_spans spans_;
    std::array<force_offsets, 2> offsets_;
    record_column<Real> sums_;      // force sums of the particles, while single forces are discarded
    aligned_vector<Real> normals_;  // a pack of zeros, then the slots of the bonds, then those of the contacts
    std::size_t bond_slots_ = 0;
    bool transient_ = false, reuses_memory_ = false, stores_normals_ = false;
    int threads_ = 1;
};
LACUNA_END_PACKS

} // namespace lacuna
