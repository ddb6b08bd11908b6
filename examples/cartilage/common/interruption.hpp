// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace cartilage {

/// Work that was ended by a signal (lacuna::stop_signal()) before it had a result.
class interruption : public std::runtime_error {
public:
    interruption() : std::runtime_error("interrupted") {}
};

} // namespace cartilage
