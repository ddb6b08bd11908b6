// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <lacuna/interactions/force_places.hpp>
#include <lacuna/interactions/force_rows.hpp>

namespace lacuna {

/// The forces of all pairs: where they are kept, and how they are summed on the particles.
template <class Real, int Dim>
class force_store {
public:
    static constexpr int chunk_particles = force_rows<Real, Dim>::chunk_particles;
    static constexpr int width = native_width<Real>;

    /// Says how the particles of a chunk move: as soon as its pairs are evaluated, before the next chunk's pairs are,
    /// but for the frontiers of spans(), or when all pairs are evaluated. Takes effect with the next build().
    /// \param streaming as soon as evaluated, and nobody else reads forces: they are kept no longer than it takes
    /// \param threads how many spans to make of the chunks, where there are enough of them; if not, it is one, and
    ///        particles move when all pairs are evaluated
    /// \return whether that is new
    bool set_mode(bool streaming, int threads) noexcept {
        bool const fresh = streaming != streaming_ || threads != threads_;
        streaming_ = streaming;
        threads_ = threads;
        return fresh;
    }

    /// To be called when tables have changed.
    template <class Bonds, class Contacts>
    void build(std::size_t particles, Bonds const& bonds, Contacts const& contacts) {
        int const chunks = int((particles + chunk_particles - 1) / chunk_particles);
        int const reach = threads_ > 1 ? std::max(reach_of(bonds, particles), reach_of(contacts, particles)) : 0;
        spans_ = chunk_spans(chunks, threads_, reach);
        bool const again = streaming_ && spans_.count() == threads_;
        places_[0].build(bonds, particles, spans_, again);
        places_[1].build(contacts, particles, spans_, again);
        rows_.build(particles, places_, bonds, contacts);
        std::size_t const places = (places_[0].count() + places_[1].count()) * width;
        forces_.column.resize((places + 1) * pair_forces<Real, Dim>::records_per_pair);
        auto* zero = forces_.of(places);
        std::fill(zero, zero + 4 * pair_forces<Real, Dim>::records_per_pair, Real(0));
    }

    /// All forces are zero until they are evaluated.
    void forget() noexcept {
        auto& column = forces_.column;
        std::fill(column.data(), column.data() + 4 * column.size(), Real(0));
    }

    chunk_spans const& spans() const noexcept { return spans_; }
    int chunks() const noexcept { return rows_.chunks(); }
    Real const* column() const noexcept { return forces_.of(0); }

    /// \name Places of bonds (Which = 0) and contacts (Which = 1)
    /// \{
    template <int Which, class Table>
    force_places::row places(Table const& table, int chunk) const noexcept {
        return places_[Which].of_chunk(table, chunk);
    }
    /// Where the places of a chunk begin.
    template <int Which, class Table>
    Real* begin(Table const& table, int chunk) noexcept {
        return forces_.of((offset<Which>() + places<Which>(table, chunk).begin) * width);
    }
    /// The force of one pair.
    template <int Which>
    Real* of(int chunk, std::size_t slot) noexcept {
        return forces_.of((offset<Which>() + places_[Which](chunk, slot / width)) * width + slot % width);
    }
    /// Offset in column() of the force in a slot of a table; -1 when forces are not kept.
    template <int Which>
    std::int32_t find(std::int32_t slot) const noexcept {
        if (streaming_) return -1;
        return (std::int32_t(offset<Which>()) * width + slot) * force_rows<Real, Dim>::reals_per_pair;
    }
    /// \}

    /// Calls use(sum) with the sum of pair forces on the particles of a chunk, once all pairs that concern them are
    /// evaluated: those of the chunks up to and including this one, because a pair belongs to its lower-numbered
    /// particle. The usual numbers of pairs per particle have a loop of their own, of fixed length.
    template <class Use>
    void with_sums(int chunk, Use const& use) const {
        switch (rows_.half_row(chunk)) {
        case 3: return use(force_sum<Real, Dim, 3>(rows_, forces_.of(0), chunk));
        case 4: return use(force_sum<Real, Dim, 4>(rows_, forces_.of(0), chunk));
        case 5: return use(force_sum<Real, Dim, 5>(rows_, forces_.of(0), chunk));
        default: return use(force_sum<Real, Dim>(rows_, forces_.of(0), chunk));
        }
    }

private:
    template <int Which>
    std::size_t offset() const noexcept {
        return Which == 0 ? 0 : places_[0].count();
    }
    /// Largest distance, in chunks, from a pair's first particle to its second.
    template <class Table>
    static int reach_of(Table const& table, std::size_t particles) noexcept {
        int most = 0;
        for (std::size_t s = 0; s < table.slots(); ++s)
            if (!table.is_filler(s, particles))
                most = std::max(most, table.j(s) / chunk_particles - table.i(s) / chunk_particles);
        return most;
    }

    pair_forces<Real, Dim> forces_;
    force_rows<Real, Dim> rows_;
    chunk_spans spans_;
    std::array<force_places, 2> places_;
    bool streaming_ = false;
    int threads_ = 1;
};

} // namespace lacuna
