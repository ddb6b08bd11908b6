// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include <lacuna/laws/frictional_spring.hpp>
#include <lacuna/laws/hertz_mindlin.hpp>

#include "facts.hpp"
#include "runner.hpp"

/// \file
/// The kinds of models that are not compiled into the target, to save compile time.

namespace lacuna_run {

template <>
std::unique_ptr<runner> make_particle_runner<2, double, lacuna::hertz_mindlin>(scenario const&) {
    throw fuzz::other_kind();
}
template <>
std::unique_ptr<runner> make_particle_runner<2, float, lacuna::hertz_mindlin>(scenario const&) {
    throw fuzz::other_kind();
}
template <>
std::unique_ptr<runner> make_particle_runner<3, double, lacuna::frictional_spring>(scenario const&) {
    throw fuzz::other_kind();
}
template <>
std::unique_ptr<runner> make_particle_runner<3, float, lacuna::frictional_spring>(scenario const&) {
    throw fuzz::other_kind();
}
template <>
std::unique_ptr<runner> make_particle_runner<3, float, lacuna::hertz_mindlin>(scenario const&) {
    throw fuzz::other_kind();
}

} // namespace lacuna_run
