// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cartilage {

/// Strength of collagen in Pa (Table 1), indexed by lacuna::cartilage_material. The free matrix has strength 0.
inline constexpr double collagen_strength[] = {0, 2e8, 9e8, 1e9};

} // namespace cartilage
