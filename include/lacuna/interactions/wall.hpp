// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>

namespace lacuna {

/// A rigid, infinite plane. Particles are on the side into which its normal points.
template <class ContactLaw, int Dim>
struct wall {
    vec<double, Dim> point{};  ///< any point of the plane, m
    vec<double, Dim> normal{}; ///< of any finite length > 0
    typename ContactLaw::material material{};

    void validate(std::string const& name) const {
        for (int axis = 0; axis < Dim; ++axis) require_finite(name + ".point", point[axis]);
        double const length = norm(normal);
        if (!(length > 0) || !std::isfinite(length)) refuse(name + ".normal", length, "a vector of finite length > 0");
        material.validate(name + ".material");
    }
};

} // namespace lacuna
