// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "cartilage/common/choices.hpp"
#include "cartilage/common/zone.hpp"

/// \file
/// What a person asks of the program on its command line.

namespace cartilage {

/// A request that cannot be met; the message is one line, the exit status 2.
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
    choices open; ///< what the paper leaves open: preset, file and single settings together
    double load_MPa = 0;
    std::uint64_t seed = 1;
    double length_um = 120;
    double height_um = 300;
    std::optional<double> duration_ns; ///< that of `open`; none: until quiet
    std::optional<double> time_step_ps; ///< none: a share of the rigorous bound
    bool allow_unstable_step = false;
    double step_share = 0.4;
    bool pair_forces = false; ///< the run's forces of single pairs will be asked for; no option
    int threads = 1;
    bool dry = false;
    std::string out;
    long long picture_every = 0; ///< steps between two damage pictures on the way, 0: none
    bool quiet = false;
    bool force = false;
};

} // namespace cartilage
