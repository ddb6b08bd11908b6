// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// Kinds of calls to a simulation before its first step.
enum class set_up : std::uint8_t { loads, fixed_axes, velocities, plates, walls, fluid };
inline constexpr std::size_t set_up_kinds = 6;
/// Names of these kinds in messages.
inline constexpr char const* set_up_names[set_up_kinds] = {
    "loads", "fixed axes", "velocities", "rigid plates", "motions of walls", "pressures and sources of the fluid"};

/// Hash of a sequence of numbers. Both zeros, +0 and -0, have the same hash.
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

    /// Hash of some numbers. It is never 0.
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

/// Hashes of a simulation's input before its first step. They depend on the results of the calls, not on their order.
struct set_up_record {
    std::uint64_t positions = 0;                      ///< of the particles in the packing
    std::uint64_t pores = 0;                          ///< shape of the pores when they were filled
    std::uint64_t fluid = 0;                          ///< pressures and sources when the pores were filled
    std::uint8_t called = 0;                          ///< one bit per kind: whether there was a call
    std::array<std::uint64_t, set_up_kinds> result{}; ///< by kind; 0 without a call

    void call(set_up kind) noexcept { called = std::uint8_t(called | (1u << unsigned(kind))); }
    bool was_called(set_up kind) const noexcept { return called >> unsigned(kind) & 1; }
};

/// Hash of the shape of a pore network.
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

/// Hash of the fluid in a pore network: pressures and sources.
template <class Network>
std::uint64_t hash_of_fluid(Network const& net) noexcept {
    set_up_hash h;
    for (std::size_t p = 0; p < net.pores(); ++p) h.add(net.pressure[p]);
    for (auto const pressure : net.drained_pressure) h.add(pressure);
    for (auto const& source : net.sources) h.add(source.value);
    return h.value();
}

} // namespace lacuna
