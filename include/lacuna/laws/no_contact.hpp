// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// No interaction: for models without contacts, or without bonds. The engine builds no pairs for it.
struct no_interaction {
    static constexpr bool absent = true;
    struct material {
        void validate(std::string const&) const {}
    };
    template <class T>
    struct parameters {
        T unused;
    };
    template <class T, int Dim>
    struct history {
        vec<T, shear_dim<Dim>> shear_force;
    };
    static parameters<double> combine(material const&, material const&, double) { return {0}; }
    template <class T, int Dim>
    static history<T, Dim> initial(T, T) {
        return {};
    }
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const&, pair_motion<T, Dim> const&, T,
                                     vec<T, shear_dim<Dim>> const&) {
        return {};
    }
    template <class T, int Dim>
    static bond_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const&, pair_motion<T, Dim> const& m,
                                                           history<T, Dim> const& h) {
        auto const never = m.distance < T(0);
        return {{T(0), {}, h, T(0), T(0)}, never, never};
    }
    template <class T>
    static T stiffness(parameters<T> const&) {
        return T(0);
    }
};

/// Particles pass through each other.
using no_contact = no_interaction;
/// No bonds.
using no_bond = no_interaction;

/// True if a law never acts, so that the engine skips it.
template <class Law>
inline constexpr bool is_absent = requires { requires Law::absent; };

} // namespace lacuna
