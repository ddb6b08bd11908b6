// SPDX-License-Identifier: BSD-3-Clause
// refused: aperture_law

#include <lacuna/pores/flow/flow_parameters.hpp>

/// Takes the gap only, but an aperture law also gets the normal force.
struct gap_aperture {
    struct parameters {
        void validate(std::string const&) const {}
    };
    template <class T>
#ifdef LACUNA_GOOD
    static T aperture(parameters const&, T, T gap) {
#else
    static T aperture(parameters const&, T gap) {
#endif
        return gap;
    }
};

lacuna::flow_parameters<gap_aperture> parameters;
