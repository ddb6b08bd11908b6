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
/// The models of the paper, as choices of the library's laws and solvers.

namespace cartilage {

/// Springs as bonds and contacts, with friction and local damping; no fluid.
struct dry_model : lacuna::default_model<2> {
    using damping = lacuna::local_damping;
};
/// The same with water in the pores, solved by the paper's explicit scheme.
struct wet_model : dry_model {
    using flow = lacuna::explicit_flow;
};
/// Bonds that carry a moment; no fluid.
struct dry_beam_model : dry_model {
    using bond_law = lacuna::brittle_beam_bond;
};
/// Bonds that may carry a moment, and a fluid that may flow fast, solved implicitly.
struct wet_beam_model : dry_beam_model {
    using flow = lacuna::implicit_flow;
};

/// Calls visit(std::type_identity<Model>) with the model for these choices.
template <class Visit>
decltype(auto) visit_model(choices const& c, bool dry, Visit const& visit) {
    if (dry)
        return c.bond_moment > 0 ? visit(std::type_identity<dry_beam_model>{})
                                    : visit(std::type_identity<dry_model>{});
    return c.bond_moment > 0 || flows_fast(c) ? visit(std::type_identity<wet_beam_model>{})
                                                    : visit(std::type_identity<wet_model>{});
}

/// Builds the simulation of a loaded specimen at rest, with water in the pores if the model has a fluid.
/// \param o load, choices and threads \throws std::invalid_argument if the model cannot be built
template <class Model>
std::unique_ptr<lacuna::simulation<Model>> load_specimen(specimen const& s, options const& o);

} // namespace cartilage

// The larger part of each model is compiled only once, in models.cpp and models_beam.cpp.
#define CARTILAGE_INSTANTIATE(Model, as)                                                                               \
    as template std::unique_ptr<lacuna::simulation<cartilage::Model>> cartilage::load_specimen(                        \
        cartilage::specimen const&, cartilage::options const&);                                                        \
    as template void lacuna::explicit_stepper<cartilage::Model>::step<true>();                                         \
    as template void lacuna::step_clock<cartilage::Model>::resolve(lacuna::simulation_state<cartilage::Model>&);       \
    as template lacuna::time_step_limits lacuna::step_clock<cartilage::Model>::limits(                                 \
        lacuna::simulation_state<cartilage::Model> const&) const;
CARTILAGE_INSTANTIATE(dry_model, extern)
CARTILAGE_INSTANTIATE(wet_model, extern)
CARTILAGE_INSTANTIATE(dry_beam_model, extern)
CARTILAGE_INSTANTIATE(wet_beam_model, extern)
