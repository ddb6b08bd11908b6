// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#if defined(__AVX512F__) || defined(__AVX__) || defined(__SSE2__)
#include <immintrin.h>
#endif

#include <lacuna/core/scalar.hpp>

/// \file
/// A row of W numbers that one instruction handles, for loops over pairs and particles. Only this header has
/// processor-specific code.

// Compilers warn about the calling convention of packs wider than the target's registers (records of four doubles
// without AVX). The warning does not apply: they are never part of an interface between separately compiled objects.
#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wpsabi"
#elif defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace lacuna {

namespace detail {
template <class T, std::size_t Bytes>
struct native_vector {
    typedef T type __attribute__((vector_size(Bytes)));
};
template <std::size_t Bytes>
struct lane_integer;
template <>
struct lane_integer<4> {
    using type = std::int32_t;
};
template <>
struct lane_integer<8> {
    using type = std::int64_t;
};
} // namespace detail

template <class T, int W>
struct pack;

/// The result of comparing two packs: all bits of a lane set where the comparison holds.
template <class T, int W>
struct pack_mask {
    using lane_type = typename detail::lane_integer<sizeof(T)>::type;
    using native = typename detail::native_vector<lane_type, sizeof(T) * W>::type;
    native bits;

    /// Refuses `if (a < b)`, as lanes may differ.
    template <std::same_as<bool> Bool>
    explicit operator Bool() const noexcept {
        static_assert(!std::same_as<Bool, bool>,
                      "a formula decides lane by lane: select(condition, a, b), max and min stand for if and ?:");
        return false;
    }
    bool operator[](int lane) const noexcept { return bits[lane] != 0; }
    friend pack_mask operator&(pack_mask const& a, pack_mask const& b) noexcept { return {a.bits & b.bits}; }
    friend pack_mask operator|(pack_mask const& a, pack_mask const& b) noexcept { return {a.bits | b.bits}; }
    friend pack_mask operator&&(pack_mask const& a, pack_mask const& b) noexcept { return {a.bits & b.bits}; }
    friend pack_mask operator||(pack_mask const& a, pack_mask const& b) noexcept { return {a.bits | b.bits}; }
    friend pack_mask operator!(pack_mask const& a) noexcept { return {~a.bits}; }
};

/// W numbers of type T, computed together; the same operations as for T, lane by lane.
template <class T, int W>
struct pack {
    static_assert(std::is_floating_point_v<T> && (W & (W - 1)) == 0);
    static constexpr int width = W;
    using native = typename detail::native_vector<T, sizeof(T) * W>::type;
    native v;

    pack() = default;
    pack(native const& x) noexcept : v(x) {} // NOLINT: the register type is the pack
    pack(T x) noexcept {              // NOLINT: a plain number converts to a pack with this value in all lanes
        v = x - native{}; // the compiler folds x - 0 to x, but not 0 + x, which differs for x = -0
    }
    /// Loads W consecutive numbers; the address may have any alignment.
    static pack load(T const* from) noexcept {
        pack r;
        __builtin_memcpy(&r.v, from, sizeof(native));
        return r;
    }
    void store(T* to) const noexcept { __builtin_memcpy(to, &v, sizeof(native)); }
    /// Loads base[index[0]], base[index[1]], ...
    template <class Index>
    static pack gather(T const* base, Index const* index) noexcept {
        pack r;
        for (int k = 0; k < W; ++k) r.v[k] = base[index[k]];
        return r;
    }
    T operator[](int lane) const noexcept { return v[lane]; }

    friend pack operator+(pack const& a, pack const& b) noexcept { return pack(native(a.v + b.v)); }
    friend pack operator-(pack const& a, pack const& b) noexcept { return pack(native(a.v - b.v)); }
    friend pack operator*(pack const& a, pack const& b) noexcept { return pack(native(a.v * b.v)); }
    friend pack operator/(pack const& a, pack const& b) noexcept { return pack(native(a.v / b.v)); }
    friend pack operator-(pack const& a) noexcept { return pack(native(-a.v)); }
    pack& operator+=(pack const& b) noexcept { return *this = *this + b; }
    pack& operator-=(pack const& b) noexcept { return *this = *this - b; }
    pack& operator*=(pack const& b) noexcept { return *this = *this * b; }
    friend pack_mask<T, W> operator<(pack const& a, pack const& b) noexcept { return {a.v < b.v}; }
    friend pack_mask<T, W> operator>(pack const& a, pack const& b) noexcept { return {a.v > b.v}; }
    friend pack_mask<T, W> operator<=(pack const& a, pack const& b) noexcept { return {a.v <= b.v}; }
    friend pack_mask<T, W> operator>=(pack const& a, pack const& b) noexcept { return {a.v >= b.v}; }
};

template <class T, int W>
struct mask_of<pack<T, W>> {
    using type = pack_mask<T, W>;
};
template <class T, int W>
struct value_of<pack<T, W>> {
    using type = T;
};

/// \def LACUNA_BEGIN_PACKS
/// Opens an inline namespace of lacuna that is named after the width of packs; LACUNA_END_PACKS closes it. It contains
/// the classes whose layout depends on native_width. Objects that are compiled for different registers (-march) and
/// share such a class do not link, because its names differ. Still compile a whole program with one -march: functions
/// that do not depend on the width have the same names in all objects.
#if defined(__AVX512F__)
#define LACUNA_BEGIN_PACKS inline namespace packs_of_64_bytes {
#elif defined(__AVX__)
#define LACUNA_BEGIN_PACKS inline namespace packs_of_32_bytes {
#else
#define LACUNA_BEGIN_PACKS inline namespace packs_of_16_bytes {
#endif
#define LACUNA_END_PACKS }

/// Number of values of type T that fit into the widest register of the target.
template <class T>
inline constexpr int native_width =
#if defined(__AVX512F__)
    int(64 / sizeof(T));
#elif defined(__AVX__)
    int(32 / sizeof(T));
#else
    int(16 / sizeof(T));
#endif

template <class T, int W>
pack<T, W> select(pack_mask<T, W> const& condition, pack<T, W> const& a, pack<T, W> const& b) noexcept {
    return pack<T, W>(typename pack<T, W>::native(condition.bits ? a.v : b.v));
}
template <class T, int W>
pack<T, W> min(pack<T, W> const& a, pack<T, W> const& b) noexcept {
    return pack<T, W>(typename pack<T, W>::native(b.v < a.v ? b.v : a.v));
}
template <class T, int W>
pack<T, W> max(pack<T, W> const& a, pack<T, W> const& b) noexcept {
    return pack<T, W>(typename pack<T, W>::native(a.v < b.v ? b.v : a.v));
}
template <class T, int W>
pack<T, W> abs(pack<T, W> const& a) noexcept {
    return max(a, -a);
}

template <class T, int W>
pack<T, W> sqrt(pack<T, W> const& a) noexcept {
    // A loop over std::sqrt would test errno for each lane, unless the program is built with -fno-math-errno.
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, double> && W == 8)
        return pack<T, W>(typename pack<T, W>::native(_mm512_maskz_sqrt_pd(__mmask8(-1), a.v)));
    if constexpr (std::is_same_v<T, float> && W == 16)
        return pack<T, W>(typename pack<T, W>::native(_mm512_maskz_sqrt_ps(__mmask16(-1), a.v)));
#endif
#if defined(__AVX__)
    if constexpr (std::is_same_v<T, double> && W == 4)
        return pack<T, W>(typename pack<T, W>::native(_mm256_sqrt_pd(a.v)));
    if constexpr (std::is_same_v<T, float> && W == 8)
        return pack<T, W>(typename pack<T, W>::native(_mm256_sqrt_ps(a.v)));
#endif
#if defined(__SSE2__)
    if constexpr (std::is_same_v<T, double> && W == 2) return pack<T, W>(typename pack<T, W>::native(_mm_sqrt_pd(a.v)));
    if constexpr (std::is_same_v<T, float> && W == 4) return pack<T, W>(typename pack<T, W>::native(_mm_sqrt_ps(a.v)));
#endif
    pack<T, W> r;
    for (int k = 0; k < W; ++k) r.v[k] = std::sqrt(a.v[k]);
    return r;
}

/// Calls the standard library lane by lane, so that the bits are those of a plain number.
template <class T, int W>
pack<T, W> exp(pack<T, W> const& a) noexcept {
    pack<T, W> r;
    for (int k = 0; k < W; ++k) r.v[k] = std::exp(a.v[k]);
    return r;
}

template <class T, int W>
bool any(pack_mask<T, W> const& m) noexcept {
#if defined(__AVX512DQ__) && defined(__AVX512F__)
    if constexpr (sizeof(T) == 8 && W == 8) return _mm512_movepi64_mask((__m512i)m.bits) != 0;
    if constexpr (sizeof(T) == 4 && W == 16) return _mm512_movepi32_mask((__m512i)m.bits) != 0;
#endif
#if defined(__AVX__)
    if constexpr (sizeof(T) * W == 32) return !_mm256_testz_si256((__m256i)m.bits, (__m256i)m.bits);
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(T) * W == 16) return _mm_movemask_epi8((__m128i)m.bits) != 0;
#endif
    bool r = false;
    for (int k = 0; k < W; ++k) r = r || m.bits[k] != 0;
    return r;
}
template <class T, int W>
bool all(pack_mask<T, W> const& m) noexcept {
    return !any(!m);
}

/// Sum of the lanes, in a fixed order.
template <class T, int W>
T sum(pack<T, W> const& a) noexcept {
    T total = a.v[0];
    for (int k = 1; k < W; ++k) total += a.v[k];
    return total;
}
template <std::floating_point T>
constexpr T sum(T a) noexcept {
    return a;
}

} // namespace lacuna

#if defined(__clang__)
#pragma clang diagnostic pop
#elif defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
