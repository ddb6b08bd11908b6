// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <lacuna/core/prefetch.hpp>
#include <lacuna/core/records.hpp>

/// \file
/// Access to aggregates of one scalar type (a law's parameters and history) as rows of numbers.

namespace lacuna {

/// Number of scalars in an aggregate template that has only members of type T (and vec of T).
template <template <class> class Aggregate, class T>
inline constexpr std::size_t field_count = sizeof(Aggregate<T>) / sizeof(T);

namespace detail {
/// Scalar number f of an aggregate of T. Copies of whole aggregates would go through memory; single members stay in
/// registers.
template <class T, class Aggregate>
auto& field(Aggregate& aggregate, std::size_t f) noexcept {
    if constexpr (std::is_const_v<Aggregate>)
        return reinterpret_cast<T const*>(&aggregate)[f];
    else
        return reinterpret_cast<T*>(&aggregate)[f];
}
} // namespace detail

/// The same aggregate in another scalar type, field by field.
/// \param convert callable: scalar of the source -> scalar of the target
template <class To, class From, class Target, class Source, class Convert>
Target convert_fields(Source const& source, Convert const& convert) noexcept {
    constexpr std::size_t count = sizeof(Source) / sizeof(From);
    static_assert(sizeof(Source) == count * sizeof(From) && sizeof(Target) == count * sizeof(To) &&
                      std::is_trivially_copyable_v<Source> && std::is_trivially_copyable_v<Target>,
                  "parameters and history of a law must be aggregates of their scalar type only");
    std::array<From, count> from;
    std::array<To, count> to;
    __builtin_memcpy(&from, &source, sizeof source);
    for (std::size_t f = 0; f < count; ++f) to[f] = convert(from[f]);
    Target target;
    __builtin_memcpy(static_cast<void*>(&target), &to, sizeof target);
    return target;
}

/// An array of aggregates stored pack by pack, as [pack][field][lane]: the fields of one pack of pairs are contiguous,
/// and each takes one load.
template <template <class> class Aggregate, class Real, int W>
class field_packs {
public:
    static constexpr std::size_t fields = field_count<Aggregate, Real>;
    using lanes = pack<Real, W>;

    void resize(std::size_t packs) { resize_with_room(data_, packs * fields * W); }

    Aggregate<lanes> load(std::size_t p) const noexcept {
        Real const* from = data_.data() + p * fields * W;
        Aggregate<lanes> r;
        for (std::size_t f = 0; f < fields; ++f) detail::field<lanes>(r, f) = lanes::load(from + f * W);
        return r;
    }
    /// Prefetches a pack; an index beyond the end is harmless.
    void prefetch(std::size_t p) const noexcept {
        lacuna::prefetch(data_.data() + p * fields * W, fields * sizeof(lanes));
    }
    void store(std::size_t p, Aggregate<lanes> const& value) noexcept {
        Real* to = data_.data() + p * fields * W;
        for (std::size_t f = 0; f < fields; ++f) detail::field<lanes>(value, f).store(to + f * W);
    }
    /// Entry `k`; entries are counted across packs, W in each.
    Aggregate<Real> get(std::size_t k) const noexcept {
        std::array<Real, fields> row;
        for (std::size_t f = 0; f < fields; ++f) row[f] = data_[(k / W * fields + f) * W + k % W];
        Aggregate<Real> r;
        __builtin_memcpy(static_cast<void*>(&r), &row, sizeof r);
        return r;
    }
    void set(std::size_t k, Aggregate<Real> const& value) noexcept {
        std::array<Real, fields> row;
        __builtin_memcpy(&row, &value, sizeof value);
        for (std::size_t f = 0; f < fields; ++f) data_[(k / W * fields + f) * W + k % W] = row[f];
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(fixed_length{data_});
    }

private:
    std::vector<Real, aligned_allocator<Real>> data_;
};

} // namespace lacuna
