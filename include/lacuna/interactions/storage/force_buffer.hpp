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
/// The forces of all pairs: where they are kept, and how they are summed on the particles.
template <class Real, int Dim>
class force_buffer {
public:
    static constexpr int chunk_particles = force_gather<Real, Dim>::chunk_particles;
    static constexpr int width = native_width<Real>;

    /// Says how long forces are kept. Takes effect with the next build().
    /// \param transient nobody reads the force of a single pair: forces are kept no longer than it takes to sum them up,
    ///        chunk by chunk as they are evaluated, but for those that wait, see chunk_spans
    /// \param threads how many spans to make of the chunks, where there are enough of them; if not, it is one, and
    ///        forces are kept
    /// \return whether that is new
    bool set_force_retention(bool transient, int threads) noexcept {
        bool const fresh = transient != transient_ || threads != threads_;
        transient_ = transient;
        threads_ = threads;
        if (fresh) forces_.column = {}; // what it needs can be much less
        return fresh;
    }
    /// From now on the normal force of every pair is kept in a column of its own, in any mode.
    template <class Bonds, class Contacts>
    void keep_normals(Bonds const& bonds, Contacts const& contacts) {
        normals_kept_ = true;
        build_normals(bonds, contacts);
    }

    /// To be called when tables have changed.
    template <class Bonds, class Contacts>
    void build(std::size_t particles, Bonds const& bonds, Contacts const& contacts) {
        int const chunks = int((particles + chunk_particles - 1) / chunk_particles);
        spans_.build(chunks, threads_, particles, bonds, contacts);
        again_ = transient_ && spans_.count() == threads_;
        places_[0].build(bonds, particles, spans_, again_);
        places_[1].build(contacts, particles, spans_, again_);
        rows_.build(particles, places_, bonds, contacts);
        ahead_.build(particles, chunks, bonds, contacts);
        std::size_t const places = (places_[0].count() + places_[1].count()) * width;
        forces_.column.resize((places + 1) * pair_forces<Real, Dim>::records_per_pair);
        auto* zero = forces_.of(places);
        std::fill(zero, zero + 4 * pair_forces<Real, Dim>::records_per_pair, Real(0));
        if (normals_kept_) build_normals(bonds, contacts);
    }

    /// All forces are zero until they are evaluated.
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
    template <pair_kind Kind, class Table>
    force_offsets::row places(Table const& table, int chunk) const noexcept {
        return places_[std::size_t(Kind)].of_chunk(table, chunk);
    }
    /// Where the places of a chunk begin.
    template <pair_kind Kind, class Table>
    Real* begin(Table const& table, int chunk) noexcept {
        return forces_.of((offset<Kind>() + places<Kind>(table, chunk).begin) * width);
    }
    /// The force of one pair.
    template <pair_kind Kind>
    Real* of(int chunk, std::size_t slot) noexcept {
        return forces_.of(place_of<Kind>(chunk, slot));
    }
    /// Offset in column() of the force in a slot of a table; -1 when forces are not kept.
    template <pair_kind Kind>
    std::int32_t find(int chunk, std::int32_t slot) const noexcept {
        if (transient_) return -1;
        return std::int32_t(place_of<Kind>(chunk, std::size_t(slot))) * force_gather<Real, Dim>::reals_per_pair;
    }
    /// \}

    /// Normal forces of all pairs, N, positive in tension, see keep_normals(); the first is 0.
    Real const* normals() const noexcept { return normals_.data(); }
    /// Where the normal forces of a table's slots begin; nullptr when they are not kept.
    template <pair_kind Kind>
    Real* normals_of() noexcept {
        return normals_kept_ ? normals_.data() + width + (Kind == pair_kind::bond ? 0 : bond_slots_) : nullptr;
    }
    /// Place in normals() of a slot of a table.
    template <pair_kind Kind>
    std::int32_t find_normal(std::int32_t slot) const noexcept {
        return std::int32_t(width + (Kind == pair_kind::bond ? 0 : bond_slots_)) + slot;
    }

    /// Whether forces are not kept but for their sums: keep_force_sums() is due for each chunk before for_force_sums() is called.
    bool forces_are_transient() const noexcept { return again_; }
    /// Keeps the sums of a chunk, for which the same holds as for for_fresh_force_sums(), until the next evaluation.
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
                    for (std::size_t r = 0; r < records; ++r) sums_.set(records * (first + std::size_t(k)) + r, total[r]);
                }
            }
        });
    }
    /// Makes room for keep_force_sums().
    void prepare_force_sums(std::size_t particles) {
        std::size_t const records = pair_forces<Real, Dim>::records_per_pair * particles;
        if (sums_.size() != records) sums_.resize(records);
    }
    /// Calls use(sum) with the sum of pair forces on the particles of a chunk, once all pairs are evaluated.
    template <class Use>
    void for_force_sums(int chunk, Use const& use) const {
        if (!again_) return for_fresh_force_sums(chunk, use);
        constexpr std::size_t records = pair_forces<Real, Dim>::records_per_pair;
        use([this, first = std::size_t(chunk) * chunk_particles](int k) {
            std::size_t const at = records * (first + std::size_t(k));
            if constexpr (Dim == 2)
                return sums_[at];
            else
                return std::array<record<Real>, 2>{sums_[at], sums_[at + 1]};
        });
    }

    /// Calls use(sum) with the sum of pair forces on the particles of a chunk, once all pairs that concern them are
    /// evaluated: those of the chunks up to and including this one, because a pair belongs to its lower-numbered
    /// particle. The usual numbers of pairs per particle have a loop of their own, of fixed length.
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

    /// What to ask the memory for during the evaluation of a chunk.
    template <class Store, class Bonds, class Contacts>
    prefetcher::plan plan_prefetch(Store const& store, int chunk, Bonds const& bonds, Contacts const& contacts) const noexcept {
        prefetcher::plan plan;
        if (!ahead_.pays()) return plan;
        auto const packs_of = [&](auto const& table) {
            return chunk < table.chunks() ? table.end_pack(chunk) - table.first_pack(chunk) : 0;
        };
        std::size_t const packs = packs_of(bonds) + packs_of(contacts);
        auto const [first, end] = ahead_.fresh(chunk + 1);
        auto const own = std::size_t(chunk) * chunk_particles;
        plan.any = true;
        // In space a chunk's fresh particles lie anywhere: the loop asks for those of each pack.
        plan.streams = {prefetcher::stream(store.bodies().data() + store.bodies().stride * first,
                                           Dim == 2 ? store.bodies().stride * (end - first) * sizeof(Real) : 0, packs),
                        prefetcher::stream(rows_.rows(chunk), rows_.bytes(chunk), packs),
                        prefetcher::stream(store.inverse_masses() + own, chunk_particles * sizeof(Real), packs)};
        return plan;
    }

private:
    template <class Bonds, class Contacts>
    void build_normals(Bonds const& bonds, Contacts const& contacts) {
        bond_slots_ = bonds.slots();
        resize_with_room(normals_, width + bond_slots_ + contacts.slots());
    }
    template <pair_kind Kind>
    std::size_t offset() const noexcept {
        return Kind == pair_kind::bond ? 0 : places_[0].count();
    }
    template <pair_kind Kind>
    std::size_t place_of(int chunk, std::size_t slot) const noexcept {
        return (offset<Kind>() + places_[std::size_t(Kind)](chunk, slot / width)) * width + slot % width;
    }

    pair_forces<Real, Dim> forces_;
    force_gather<Real, Dim> rows_;
    prefetcher ahead_;
    chunk_spans spans_;
    std::array<force_offsets, 2> places_;
    record_column<Real> sums_;      // of the particles, while forces are not kept
    aligned_vector<Real> normals_;  // a pack of zeros, then by slot of the bonds, of the contacts
    std::size_t bond_slots_ = 0;
    bool transient_ = false, again_ = false, normals_kept_ = false;
    int threads_ = 1;
};
LACUNA_END_PACKS

} // namespace lacuna
