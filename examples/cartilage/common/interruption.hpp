// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace cartilage {

/// Thrown when a signal (lacuna::stop_signal()) ends work before it has a result.
class interruption : public std::runtime_error {
public:
    interruption() : std::runtime_error("interrupted") {}
};

} // namespace cartilage
