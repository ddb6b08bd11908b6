// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <type_traits>

#include <lacuna/laws/brittle_beam_bond.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/simulation.hpp>

#include "cartilage/common/options.hpp"
#include "cartilage/specimen/specimen.hpp"

/// \file
/// The models of the paper, put together from the library's parts.

namespace cartilage {

/// Bonded and frictional springs, damped where that is asked for; no fluid.
struct dry_model : lacuna::default_model<2> {
    using damping = lacuna::local_damping;
};
/// The same with water in the pores, by the paper's explicit scheme.
struct wet_model : dry_model {
    using flow = lacuna::explicit_flow;
};
/// Bonds with a moment.
struct dry_beam_model : dry_model {
    using bond_law = lacuna::brittle_beam_bond;
};
/// Bonds that may have a moment, and a fluid that may flow fast: solved implicitly.
struct wet_beam_model : dry_beam_model {
    using flow = lacuna::implicit_flow;
};

/// Calls visit(std::type_identity<Model>) with the model that the choices ask for.
template <class Visit>
decltype(auto) visit_model(choices const& open, bool dry, Visit const& visit) {
    if (dry)
        return open.bond_moment > 0 ? visit(std::type_identity<dry_beam_model>{})
                                    : visit(std::type_identity<dry_model>{});
    return open.bond_moment > 0 || flows_fast(open) ? visit(std::type_identity<wet_beam_model>{})
                                                    : visit(std::type_identity<wet_model>{});
}

/// A specimen of the model with its load on it, and water in its pores where the model has a fluid; at rest.
/// \param o load, choices and threads \throws std::invalid_argument when the model cannot be built
template <class Model>
std::unique_ptr<lacuna::simulation<Model>> load_specimen(specimen const& s, options const& o);

} // namespace cartilage

// The larger part of each model is compiled once, in models.cpp and models_beam.cpp.
#define CARTILAGE_INSTANTIATE(Model, as)                                                                                \
    as template std::unique_ptr<lacuna::simulation<cartilage::Model>> cartilage::load_specimen(                         \
        cartilage::specimen const&, cartilage::options const&);                                                        \
    as template void lacuna::explicit_stepper<cartilage::Model>::step<true>();                                          \
    as template void lacuna::step_clock<cartilage::Model>::resolve(lacuna::simulation_state<cartilage::Model>&);        \
    as template lacuna::time_step_limits lacuna::step_clock<cartilage::Model>::limits(                                  \
        lacuna::simulation_state<cartilage::Model> const&) const;
CARTILAGE_INSTANTIATE(dry_model, extern)
CARTILAGE_INSTANTIATE(wet_model, extern)
CARTILAGE_INSTANTIATE(dry_beam_model, extern)
CARTILAGE_INSTANTIATE(wet_beam_model, extern)
