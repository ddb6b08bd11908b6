// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "cartilage/common/choices.hpp"
#include "cartilage/common/zone.hpp"

/// \file
/// The request on the command line, after it was checked.

namespace cartilage {

/// A request that cannot be met. The message is one line; the exit status is 2.
class usage_error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

enum class command { run, pack };

/// The command line, checked, in the units of the command line.
struct options {
    command what = command::run;
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    std::string preset = "literal";
    cartilage::choices choices; ///< from preset, file and single settings
    double load_MPa = 0;
    std::uint64_t seed = 1;
    double length_um = 120;
    double height_um = 300;
    std::optional<double> duration_ns; ///< that of `choices`; none: until quiet
    std::optional<double> time_step_ps; ///< none: step_share of the rigorous bound
    bool allow_unstable_step = false;
    double step_share = 0.4;  ///< time step over its rigorous bound
    bool pair_forces = false; ///< the run stores the force of each pair; not a command-line option
    int threads = 1;
    bool dry = false;
    std::string out;
    long long picture_every = 0; ///< steps between two damage pictures during the run; 0: none
    bool quiet = false;
    bool force = false;
};

} // namespace cartilage
