// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/state.hpp>

/// \file
/// Records of four numbers, in which hot loops read a particle's position, velocity and forces.
///
/// A loop over pairs visits particles in no regular order. With one array per coordinate, each number would need its
/// own load. With records, one load brings four numbers, and a few shuffles transpose W records into four packs.

namespace lacuna {

/// Allocator for arrays that start on a cache line.
template <class T>
struct aligned_allocator {
    using value_type = T;
    static constexpr std::align_val_t alignment{64};
    aligned_allocator() = default;
    template <class U>
    aligned_allocator(aligned_allocator<U> const&) noexcept {}
    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), alignment)); }
    void deallocate(T* memory, std::size_t) noexcept { ::operator delete(memory, alignment); }
    friend bool operator==(aligned_allocator, aligned_allocator) noexcept { return true; }
};
template <class T>
using aligned_vector = std::vector<T, aligned_allocator<T>>;

/// Resizes an array whose length changes little after the first call. If it exceeds its capacity, it reserves an eighth
/// more than requested; the array itself would double its capacity.
template <class Array>
void resize_with_room(Array& array, std::size_t count) {
    if (count > array.capacity() && !array.empty()) array.reserve(count + count / 8);
    array.resize(count);
}

/// Four consecutive numbers.
template <class Real>
using record = pack<Real, 4>;

/// An array with one entry per particle or pair; an entry has `Records` records.
template <class Real, int Records = 1>
class record_column {
public:
    /// Numbers in an entry.
    static constexpr std::size_t stride = 4 * Records;
    record_column() = default;
    explicit record_column(std::size_t count) { resize(count); }
    void assign(std::size_t count, record<Real> const& value) {
        data_.resize(stride * count);
        for (std::size_t k = 0; k < count; ++k)
            for (int r = 0; r < Records; ++r) set(k, value, r);
    }
    void resize(std::size_t count) { resize_with_room(data_, stride * count); }
    std::size_t size() const noexcept { return data_.size() / stride; }
    /// The first record of entry `k`; of(k, r) is its record `r`.
    record<Real> operator[](std::size_t k) const noexcept { return of(k, 0); }
    record<Real> of(std::size_t k, int r) const noexcept {
        return record<Real>::load(data_.data() + stride * k + 4 * std::size_t(r));
    }
    void set(std::size_t k, record<Real> const& value, int r = 0) noexcept {
        value.store(data_.data() + stride * k + 4 * std::size_t(r));
    }
    /// Number `lane` of entry `k`.
    Real& at(std::size_t k, int lane) noexcept { return data_[stride * k + std::size_t(lane)]; }
    Real at(std::size_t k, int lane) const noexcept { return data_[stride * k + std::size_t(lane)]; }
    Real* data() noexcept { return data_.data(); }
    Real const* data() const noexcept { return data_.data(); }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(fixed_length{data_});
    }

private:
    aligned_vector<Real> data_;
};

/// The array of particles: an entry has a record for the position and one for the velocity. In double precision it
/// fills one cache line.
template <class Real>
using particle_column = record_column<Real, 2>;

namespace detail {
template <class V, class H>
V join(H low, H high) noexcept {
    if constexpr (sizeof(H) == 16 && sizeof(low[0]) == 8)
        return __builtin_shufflevector(low, high, 0, 1, 2, 3);
    else if constexpr (sizeof(H) == 32 && sizeof(low[0]) == 8)
        return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    else if constexpr (sizeof(H) == 16)
        return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    else
        return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
} // namespace detail

/// Transposes W records, `at(0)` to `at(W - 1)`: result[l][k] is number l of at(k).
template <class T, int W, class At>
std::array<pack<T, W>, 4> transpose_load(At const& at) noexcept {
    using P = pack<T, W>;
    if constexpr (sizeof(T) == 8 && W == 8) {
        using full = typename P::native;
        auto two = [&](int a, int b) { return detail::join<full>(at(a).v, at(b).v); };
        full a = two(0, 2), b = two(1, 3), c = two(4, 6), d = two(5, 7);
        full ab0 = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
        full ab1 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
        full cd0 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
        full cd1 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
        return {P(full(__builtin_shufflevector(ab0, cd0, 0, 1, 4, 5, 8, 9, 12, 13))),
                P(full(__builtin_shufflevector(ab1, cd1, 0, 1, 4, 5, 8, 9, 12, 13))),
                P(full(__builtin_shufflevector(ab0, cd0, 2, 3, 6, 7, 10, 11, 14, 15))),
                P(full(__builtin_shufflevector(ab1, cd1, 2, 3, 6, 7, 10, 11, 14, 15)))};
    } else if constexpr (W == 2) {
        using both = typename P::native;
        auto a = at(0), b = at(1);
        return {P(both{a[0], b[0]}), P(both{a[1], b[1]}), P(both{a[2], b[2]}), P(both{a[3], b[3]})};
    } else if constexpr (W == 4) {
        using quad = typename P::native;
        quad a = at(0).v, b = at(1).v, c = at(2).v, d = at(3).v;
        quad ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
        quad cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
        quad r0 = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5), r1 = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
        quad r2 = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7), r3 = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
        return {P(r0), P(r1), P(r2), P(r3)};
    } else if constexpr (sizeof(T) == 4 && W == 8) {
        using full = typename P::native;
        auto two = [&](int k) { return detail::join<full>(at(k).v, at(k + 4).v); };
        full a = two(0), b = two(1), c = two(2), d = two(3);
        full ab0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
        full ab1 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
        full cd0 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
        full cd1 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
        return {P(full(__builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13))),
                P(full(__builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15))),
                P(full(__builtin_shufflevector(ab1, cd1, 0, 1, 8, 9, 4, 5, 12, 13))),
                P(full(__builtin_shufflevector(ab1, cd1, 2, 3, 10, 11, 6, 7, 14, 15)))};
    } else if constexpr (sizeof(T) == 4 && W == 16) {
        using half = typename pack<T, 8>::native;
        using full = typename P::native;
        auto two = [&](int k) { return detail::join<half>(at(k).v, at(k + 4).v); };
        auto four = [&](int k) { return detail::join<full>(two(k), two(k + 8)); };
        full a = four(0), b = four(1), c = four(2), d = four(3);
        full ab0 = __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        full ab1 = __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
        full cd0 = __builtin_shufflevector(c, d, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        full cd1 = __builtin_shufflevector(c, d, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
        return {P(full(__builtin_shufflevector(ab0, cd0, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29))),
                P(full(__builtin_shufflevector(ab0, cd0, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31))),
                P(full(__builtin_shufflevector(ab1, cd1, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29))),
                P(full(__builtin_shufflevector(ab1, cd1, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)))};
    } else {
        std::array<P, 4> r{};
        for (int k = 0; k < W; ++k) {
            auto one = at(k);
            for (int l = 0; l < 4; ++l) r[std::size_t(l)].v[k] = one[l];
        }
        return r;
    }
}

/// Transposes W entries of two records: result[l][k] is number l of entry k.
/// \param at callable `at.template operator()<N>(k, first)`: returns N numbers of entry k, starting at number `first`
template <class T, int W, class At>
std::array<pack<T, W>, 8> transpose_load2(At const& at) noexcept {
    using P = pack<T, W>;
    using full = typename P::native;
    if constexpr (sizeof(T) == 8 && W == 8) {
        auto row = [&](int k) { return at.template operator()<8>(k, 0).v; };
        auto even = [](full a, full b) { return full(__builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)); };
        auto odd = [](full a, full b) { return full(__builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)); };
        auto low = [](full a, full b) { return full(__builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13)); };
        auto high = [](full a, full b) { return full(__builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)); };
        full a = row(0), b = row(1), c = row(2), d = row(3), e = row(4), f = row(5), g = row(6), h = row(7);
        full ab = even(a, b), cd = even(c, d), ef = even(e, f), gh = even(g, h);
        full abcd = low(ab, cd), efgh = low(ef, gh), abcd2 = high(ab, cd), efgh2 = high(ef, gh);
        full ab1 = odd(a, b), cd1 = odd(c, d), ef1 = odd(e, f), gh1 = odd(g, h);
        full abcd1 = low(ab1, cd1), efgh1 = low(ef1, gh1), abcd3 = high(ab1, cd1), efgh3 = high(ef1, gh1);
        return {P(low(abcd, efgh)),   P(low(abcd1, efgh1)),   P(low(abcd2, efgh2)),  P(low(abcd3, efgh3)),
                P(high(abcd, efgh)), P(high(abcd1, efgh1)), P(high(abcd2, efgh2)), P(high(abcd3, efgh3))};
    } else if constexpr (sizeof(T) == 4 && W == 16) {
        // A register has two entries; its four parts of 128 bits are the four records of one column of the result.
        auto two = [&](int k) {
            return detail::join<full>(at.template operator()<8>(k, 0).v, at.template operator()<8>(k + 4, 0).v);
        };
        auto even = [](full a, full b) {
            return full(__builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29));
        };
        auto odd = [](full a, full b) {
            return full(__builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31));
        };
        auto low = [](full a, full b) {
            return full(__builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29));
        };
        auto high = [](full a, full b) {
            return full(__builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31));
        };
        auto first = [](full a, full b) {
            return P(full(__builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)));
        };
        auto second = [](full a, full b) {
            return P(full(__builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31)));
        };
        auto block = [&](int k) {
            full a = two(k), b = two(k + 1), c = two(k + 2), d = two(k + 3);
            full ab0 = even(a, b), ab1 = odd(a, b), cd0 = even(c, d), cd1 = odd(c, d);
            return std::array<full, 4>{low(ab0, cd0), high(ab0, cd0), low(ab1, cd1), high(ab1, cd1)};
        };
        auto front = block(0), back = block(8);
        return {first(front[0], back[0]),  first(front[1], back[1]),  first(front[2], back[2]),
                first(front[3], back[3]),  second(front[0], back[0]), second(front[1], back[1]),
                second(front[2], back[2]), second(front[3], back[3])};
    } else {
        auto first = transpose_load<T, W>([&](int k) { return at.template operator()<4>(k, 0); });
        auto second = transpose_load<T, W>([&](int k) { return at.template operator()<4>(k, 4); });
        return {first[0], first[1], first[2], first[3], second[0], second[1], second[2], second[3]};
    }
}

/// Writes W consecutive records: number l of record k is value[l][k].
template <class T, int W>
void transpose_store(T* to, std::array<pack<T, W>, 4> const& value) noexcept {
    if constexpr (sizeof(T) == 8 && W == 8) {
        using full = typename pack<T, W>::native;
        full p = value[0].v, q = value[1].v, r = value[2].v, s = value[3].v;
        full pq0 = __builtin_shufflevector(p, q, 0, 8, 2, 10, 4, 12, 6, 14);
        full pq1 = __builtin_shufflevector(p, q, 1, 9, 3, 11, 5, 13, 7, 15);
        full rs0 = __builtin_shufflevector(r, s, 0, 8, 2, 10, 4, 12, 6, 14);
        full rs1 = __builtin_shufflevector(r, s, 1, 9, 3, 11, 5, 13, 7, 15);
        auto put = [&](int first, full two) {
            pack<T, 4>(__builtin_shufflevector(two, two, 0, 1, 2, 3)).store(to + 4 * first);
            pack<T, 4>(__builtin_shufflevector(two, two, 4, 5, 6, 7)).store(to + 4 * (first + 2));
        };
        put(0, __builtin_shufflevector(pq0, rs0, 0, 1, 8, 9, 2, 3, 10, 11));
        put(1, __builtin_shufflevector(pq1, rs1, 0, 1, 8, 9, 2, 3, 10, 11));
        put(4, __builtin_shufflevector(pq0, rs0, 4, 5, 12, 13, 6, 7, 14, 15));
        put(5, __builtin_shufflevector(pq1, rs1, 4, 5, 12, 13, 6, 7, 14, 15));
    } else if constexpr (W == 4) {
        using quad = typename pack<T, W>::native;
        quad p = value[0].v, q = value[1].v, r = value[2].v, s = value[3].v;
        quad pq0 = __builtin_shufflevector(p, q, 0, 4, 2, 6), pq1 = __builtin_shufflevector(p, q, 1, 5, 3, 7);
        quad rs0 = __builtin_shufflevector(r, s, 0, 4, 2, 6), rs1 = __builtin_shufflevector(r, s, 1, 5, 3, 7);
        auto put = [&](int k, quad one) { pack<T, W>(one).store(to + 4 * k); };
        put(0, __builtin_shufflevector(pq0, rs0, 0, 1, 4, 5));
        put(1, __builtin_shufflevector(pq1, rs1, 0, 1, 4, 5));
        put(2, __builtin_shufflevector(pq0, rs0, 2, 3, 6, 7));
        put(3, __builtin_shufflevector(pq1, rs1, 2, 3, 6, 7));
    } else if constexpr (sizeof(T) == 4 && W == 8) {
        using full = typename pack<T, W>::native;
        full p = value[0].v, q = value[1].v, r = value[2].v, s = value[3].v;
        full pq0 = __builtin_shufflevector(p, q, 0, 8, 1, 9, 4, 12, 5, 13);
        full pq1 = __builtin_shufflevector(p, q, 2, 10, 3, 11, 6, 14, 7, 15);
        full rs0 = __builtin_shufflevector(r, s, 0, 8, 1, 9, 4, 12, 5, 13);
        full rs1 = __builtin_shufflevector(r, s, 2, 10, 3, 11, 6, 14, 7, 15);
        auto put = [&](int k, full two) {
            pack<T, 4>(__builtin_shufflevector(two, two, 0, 1, 2, 3)).store(to + 4 * k);
            pack<T, 4>(__builtin_shufflevector(two, two, 4, 5, 6, 7)).store(to + 4 * (k + 4));
        };
        put(0, __builtin_shufflevector(pq0, rs0, 0, 1, 8, 9, 4, 5, 12, 13));
        put(1, __builtin_shufflevector(pq0, rs0, 2, 3, 10, 11, 6, 7, 14, 15));
        put(2, __builtin_shufflevector(pq1, rs1, 0, 1, 8, 9, 4, 5, 12, 13));
        put(3, __builtin_shufflevector(pq1, rs1, 2, 3, 10, 11, 6, 7, 14, 15));
    } else if constexpr (sizeof(T) == 4 && W == 16) {
        using full = typename pack<T, W>::native;
        full p = value[0].v, q = value[1].v, r = value[2].v, s = value[3].v;
        full pq0 = __builtin_shufflevector(p, q, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        full pq1 = __builtin_shufflevector(p, q, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
        full rs0 = __builtin_shufflevector(r, s, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        full rs1 = __builtin_shufflevector(r, s, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
        auto put = [&](int k, full four) {
            pack<T, 4>(__builtin_shufflevector(four, four, 0, 1, 2, 3)).store(to + 4 * k);
            pack<T, 4>(__builtin_shufflevector(four, four, 4, 5, 6, 7)).store(to + 4 * (k + 4));
            pack<T, 4>(__builtin_shufflevector(four, four, 8, 9, 10, 11)).store(to + 4 * (k + 8));
            pack<T, 4>(__builtin_shufflevector(four, four, 12, 13, 14, 15)).store(to + 4 * (k + 12));
        };
        put(0, __builtin_shufflevector(pq0, rs0, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29));
        put(1, __builtin_shufflevector(pq0, rs0, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31));
        put(2, __builtin_shufflevector(pq1, rs1, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29));
        put(3, __builtin_shufflevector(pq1, rs1, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31));
    } else {
        for (int k = 0; k < W; ++k)
            for (int l = 0; l < 4; ++l) to[4 * k + l] = value[std::size_t(l)].v[k];
    }
}

} // namespace lacuna
