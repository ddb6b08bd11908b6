// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartilage/specimen/specimen_types.hpp"
#include <lacuna/particles/packing_grid.hpp>
#include <lacuna/particles/touching.hpp>

namespace lacuna {

/// Appends bonds between particles that touch: first between particles of different fibres, then between fibre
/// particles and free particles. Each group is sorted by the particles' indices.
/// \param tolerance largest gap of a touching pair, relative to its smaller radius
/// \param fibres whether fibres are linked to each other
/// \param matrix whether fibres are linked to free particles
inline void link_fibres(cartilage_specimen<double>& s, double tolerance, bool fibres, bool matrix) {
    std::vector<std::array<std::int32_t, 2>> to_fibre, to_matrix;
    if (s.discs.size() == 0 || (!fibres && !matrix)) return;
    double const largest = *std::max_element(s.discs.radius.begin(), s.discs.radius.end());
    detail::disc_grid const grid(s.discs.position, 2 * largest);
    for (std::size_t i = 0; i < s.discs.size(); ++i) {
        double const r = s.discs.radius[i];
        grid.for_each_near(s.discs.position[i], (r + largest * (1 + tolerance)) * (1 + 1e-8), [&](std::size_t j) {
            bool const both = s.fibre[i] >= 0 && s.fibre[j] >= 0, one = (s.fibre[i] >= 0) != (s.fibre[j] >= 0);
            if (j <= i || !((fibres && both && s.fibre[i] != s.fibre[j]) || (matrix && one))) return;
            double const other = s.discs.radius[j];
            if (!touches(s.discs.position[i], r, s.discs.position[j], other, tolerance * std::min(r, other))) return;
            (both ? to_fibre : to_matrix).push_back({std::int32_t(i), std::int32_t(j)});
        });
    }
    std::sort(to_fibre.begin(), to_fibre.end());
    std::sort(to_matrix.begin(), to_matrix.end());
    s.discs.bonds.insert(s.discs.bonds.end(), to_fibre.begin(), to_fibre.end());
    s.discs.bonds.insert(s.discs.bonds.end(), to_matrix.begin(), to_matrix.end());
    s.fibre_links += to_fibre.size();
    s.matrix_links += to_matrix.size();
}

} // namespace lacuna
