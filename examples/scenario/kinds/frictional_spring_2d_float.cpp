// SPDX-License-Identifier: BSD-3-Clause
#include "../make_particle_runner.hpp"

namespace lacuna_run {

template std::unique_ptr<runner> make_particle_runner<2, float, lacuna::frictional_spring>(scenario const&);

} // namespace lacuna_run
