// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// What can be said to a simulation before its first step, by kind.
enum class set_up : std::uint8_t { loads, fixed_axes, velocities, plates, walls, fluid };
inline constexpr std::size_t set_up_kinds = 6;
/// As messages tell them.
inline constexpr char const* set_up_names[set_up_kinds] = {
    "loads", "fixed axes", "velocities", "rigid plates", "motions of walls", "pressures and sources of the fluid"};

/// Hash of numbers, in their order. Both zeros count as one.
class set_up_hash {
public:
    template <class T>
    void add(T const& value) noexcept {
        if constexpr (std::is_floating_point_v<T>) {
            double const number = double(value) + 0.0;
            std::uint64_t bits;
            std::memcpy(&bits, &number, sizeof bits);
            mix(bits);
        } else {
            mix(std::uint64_t(value));
        }
    }
    template <class T, int N>
    void add(vec<T, N> const& value) noexcept {
        for (int k = 0; k < N; ++k) add(value[k]);
    }
    std::uint64_t value() const noexcept { return state_; }

    /// Of one set of numbers; never 0, so that a sum of hashes is 0 only of none.
    template <class... T>
    static std::uint64_t of(T const&... value) noexcept {
        set_up_hash h;
        (h.add(value), ...);
        return h.value() | 1;
    }

private:
    /// Finalizer of splitmix64 (Steele, Lea and Flood 2014, OOPSLA).
    void mix(std::uint64_t bits) noexcept {
        std::uint64_t x = state_ * 0x9e3779b97f4a7c15u + bits + 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        state_ = x ^ (x >> 31);
    }
    std::uint64_t state_ = 0x243f6a8885a308d3u;
};

/// What a simulation was given before its first step, as hashes: what came of the calls, not in which order they were made.
struct set_up_record {
    std::uint64_t places = 0;                          ///< of the particles in the packing
    std::uint64_t pores = 0;                           ///< as they were filled: shape
    std::uint64_t fluid = 0;                           ///< as they were filled: pressures, sources
    std::uint8_t called = 0;                           ///< bit by kind: there was a call
    std::array<std::uint64_t, set_up_kinds> result{}; ///< by kind; 0 without a call

    void call(set_up kind) noexcept { called = std::uint8_t(called | (1u << unsigned(kind))); }
    bool was_called(set_up kind) const noexcept { return called >> unsigned(kind) & 1; }
};

/// Of the shape of a pore network.
template <class Network>
std::uint64_t hash_of_shape(Network const& net) noexcept {
    set_up_hash h;
    auto const list = [&](auto const& column) {
        h.add(column.size());
        for (std::size_t k = 0; k < column.size(); ++k) h.add(column[k]);
    };
    for (auto const& column : net.corner) list(column);
    for (auto const& column : net.throat_particle) list(column);
    for (auto const& column : net.throat_pore) list(column);
    list(net.size);
    list(net.length);
    list(net.drained_source);
    h.add(net.interior_throats);
    h.add(net.drained_throats);
    h.add(net.sources.size());
    for (auto const& source : net.sources) {
        for (char const c : source.name) h.add(c);
        h.add(int(source.kind));
        list(source.pores);
        list(source.shares);
    }
    return h.value();
}

/// Of what is in a pore network.
template <class Network>
std::uint64_t hash_of_fluid(Network const& net) noexcept {
    set_up_hash h;
    for (std::size_t p = 0; p < net.pores(); ++p) h.add(net.pressure[p]);
    for (auto const pressure : net.drained_pressure) h.add(pressure);
    for (auto const& source : net.sources) h.add(source.value);
    return h.value();
}

} // namespace lacuna
