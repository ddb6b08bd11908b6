// SPDX-License-Identifier: BSD-3-Clause
// refused with NO_VALIDATE: the law needs: struct material { ...; void validate(
// refused with NO_COMBINE: the law needs: static parameters<double> combine(
// refused with WRONG_COMBINE: the law needs: static parameters<double> combine(
// refused with NO_INITIAL: static history<T, Dim> initial<T, Dim>(
// refused with NO_EVALUATE: evaluate(parameters<T> const&, pair_motion<T, Dim> const&, history<T, Dim> const&)
// refused with WRONG_EVALUATE: evaluate(parameters<T> const&, pair_motion<T, Dim> const&, history<T, Dim> const&)
// refused with NUMBERS_ONLY: evaluate() must take every scalar type T
// refused with NO_HAND_OVER: the contact law needs: static history<T, Dim> hand_over(
// refused with NO_STIFFNESS: static T stiffness(parameters<T> const&)
// refused with BRANCH: a formula decides lane by lane
// refused with COUNTER: counter
// refused with PLAIN_NUMBER: each member of a law's parameters and history must be T or vec<T, N>
// refused with KIND: kind
// refused with CONSTRUCTOR: must be plain aggregates

#include <concepts>
#include <string>

#include <lacuna/simulation.hpp>

using lacuna::max, lacuna::min;

struct my_law {
    struct material {
        double stiffness = 1e6;
#ifndef NO_VALIDATE
        void validate(std::string const& name) const { lacuna::require_positive(name + ".stiffness", stiffness); }
#endif
    };
    template <class T>
    struct parameters {
        T stiffness;
#ifdef KIND
        int kind = 0;
#endif
    };
    template <class T, int Dim>
    struct history {
        T touching_distance, deepest;
#ifdef COUNTER
        int counter = 0;
#endif
#ifdef PLAIN_NUMBER
        double longest = 0;
#endif
#ifdef CONSTRUCTOR
        history(T distance = T(0), T overlap = T(0)) : touching_distance(distance), deepest(overlap) {}
#endif
    };
#if defined(WRONG_COMBINE)
    static parameters<float> combine(material const&, material const&, double) { return {1e6f}; }
#elif !defined(NO_COMBINE)
    static parameters<double> combine(material const& a, material const& b, double) {
        return {min(a.stiffness, b.stiffness)};
    }
#endif
#ifndef NO_INITIAL
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T) {
        return {distance, T(0)};
    }
#endif
#ifndef NO_HAND_OVER
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const&, lacuna::pair_motion<T, Dim> const& m, T,
                                     lacuna::vec<T, lacuna::shear_dim<Dim>> const&) {
        return {m.distance, T(0)};
    }
#endif
#ifdef WRONG_EVALUATE
    template <class T, int Dim>
    static T evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const&) {
        return p.stiffness * m.distance;
    }
#elif !defined(NO_EVALUATE)
    template <class T, int Dim>
#ifdef NUMBERS_ONLY
        requires std::floating_point<T>
#endif
    static lacuna::pair_response<T, Dim, history<T, Dim>>
    evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        T overlap = max(h.touching_distance - m.distance, T(0));
#ifdef BRANCH
        T deepest = h.deepest;
        if (deepest < overlap) deepest = overlap;
#else
        T deepest = max(h.deepest, overlap);
#endif
        return {-(p.stiffness * overlap),
                {},
                {h.touching_distance, deepest},
                T(0.5) * p.stiffness * overlap * overlap,
                T(0)};
    }
#endif
#ifndef NO_STIFFNESS
    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.stiffness;
    }
#endif
};

struct my_model : lacuna::default_model<2> {
    using contact_law = my_law;
};

void use(lacuna::packing<double, 2> const& discs) {
    lacuna::simulation_parameters<my_model> p;
    lacuna::simulation<my_model> run(discs, p);
    run.fix(0);
    run.run(1);
}
