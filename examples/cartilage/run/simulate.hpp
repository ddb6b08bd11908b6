// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>

#include <lacuna/draw/picture_scene.hpp>
#include <lacuna/observe/run_directory.hpp>

#include "cartilage/common/options.hpp"
#include "cartilage/run/results.hpp"
#include "cartilage/specimen/specimen.hpp"

namespace cartilage {

/// Loads the specimen and runs it to its end. During the run cracks.csv grows in `out`, with the requested pictures
/// beside it. A signal ends the run after the present step.
/// \param progress output of the progress; null: none \param damage receives the scene at the end
/// \throws std::invalid_argument before the first step, if the model cannot be built
/// \throws lacuna::unstable_run if the run becomes unstable
run_result simulate(specimen const& s, options const& o, lacuna::run_directory& out, std::FILE* progress,
                    lacuna::scene& damage);

} // namespace cartilage
