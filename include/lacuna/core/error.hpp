// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// A simulation has become unstable, so that its results are meaningless. The causes are not-a-number, runaway energy,
/// an overlap beyond a radius, or a particle that moves more than a tenth of its radius in a step.
class unstable_run : public std::runtime_error {
public:
    /// \param what the complete message
    /// \param step number of the time step in which it was found
    /// \param particle id of the particle concerned, -1 if there is none
    unstable_run(std::string const& what, long long step, long long particle)
        : std::runtime_error(what), step_(step), particle_(particle) {}
    long long step() const noexcept { return step_; }
    long long particle() const noexcept { return particle_; }

private:
    long long step_;
    long long particle_;
};

/// Decimal form with the fewest significant digits, but at least six, that reads back to the same value. It ignores the
/// locale.
inline std::string to_text(double value) {
    char buffer[32];
    char* end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
    // Fewer digits than the shortest form never suffice; the nearest decimal with as many digits almost always does.
    int const least =
        int(std::count_if(buffer, std::find(buffer, end, 'e'), [](char c) { return c >= '0' && c <= '9'; }));
    for (int digits = std::max(6, least); digits <= 17; ++digits) {
        end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr;
        double back = 0;
        if (!std::isfinite(value) || (std::from_chars(buffer, end, back).ptr == end && back == value)) break;
    }
    return {buffer, end};
}

/// Throws std::invalid_argument "field = value: must be rule".
[[noreturn]] inline void refuse(std::string_view field, std::string_view value, std::string_view rule) {
    throw std::invalid_argument(std::string(field) + " = " + std::string(value) + ": must be " + std::string(rule));
}
[[noreturn]] inline void refuse(std::string_view field, double value, std::string_view rule) {
    refuse(field, std::string_view(to_text(value)), rule);
}

/// \name Checks of one value; each throws std::invalid_argument that names the field, the value and the rule.
/// \{
inline void require_finite(std::string_view field, double value) {
    if (!std::isfinite(value)) refuse(field, value, "finite");
}
inline void require_positive(std::string_view field, double value) {
    if (!(value > 0) || !std::isfinite(value)) refuse(field, value, "> 0 and finite");
    // Other values are divided by it.
    if (!std::isfinite(1 / value)) refuse(field, value, "at least 1e-300");
}
inline void require_not_negative(std::string_view field, double value) {
    if (!(value >= 0) || !std::isfinite(value)) refuse(field, value, ">= 0 and finite");
}
/// A limit: not negative; infinity is allowed and means "never".
inline void require_limit(std::string_view field, double value) {
    if (!(value >= 0)) refuse(field, value, ">= 0");
}
inline void require_in(std::string_view field, double value, double low, double high) {
    if (!(value >= low && value <= high))
        refuse(field, value, "from " + to_text(low) + " to " + to_text(high));
}
/// \}

} // namespace lacuna
