// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>

#include <lacuna/draw/picture_scene.hpp>
#include <lacuna/observe/run_directory.hpp>

#include "cartilage/common/options.hpp"
#include "cartilage/run/results.hpp"
#include "cartilage/specimen/specimen.hpp"

namespace cartilage {

/// Loads the specimen and follows it to the end, with progress on `progress` (null: silent) and pictures on the way
/// into `out`, as the command line asks, where cracks.csv grows. `damage` receives the scene at the end, which is after the
/// present step once a signal has come.
/// \throws std::invalid_argument before the first step when the model cannot be built
/// \throws lacuna::unstable_run
run_result simulate(specimen const& s, options const& o, lacuna::run_directory& out, std::FILE* progress,
                    lacuna::scene& damage);

} // namespace cartilage
