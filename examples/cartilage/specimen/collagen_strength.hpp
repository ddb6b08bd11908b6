// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cartilage {

/// Strength of collagen by lacuna::cartilage_material, Pa (Table 1); the matrix has none.
inline constexpr double collagen_strength[] = {0, 2e8, 9e8, 1e9};

} // namespace cartilage
