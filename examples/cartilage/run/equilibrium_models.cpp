// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/load_program.hpp"

namespace cartilage {

template equilibrium_run find_strength_of<dry_model>(specimen const&, equilibrium_request const&,
                                                    lacuna::run_directory*, std::FILE*, lacuna::scene*);
template equilibrium_run find_strength_of<wet_model>(specimen const&, equilibrium_request const&,
                                                    lacuna::run_directory*, std::FILE*, lacuna::scene*);

} // namespace cartilage
