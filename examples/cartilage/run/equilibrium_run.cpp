// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/equilibrium_run.hpp"

#include <array>
#include <string_view>
#include <type_traits>

#include <lacuna/core/text.hpp>

#include "cartilage/run/cartilage_model.hpp"

namespace cartilage {

namespace {

/// A choice without meaning in equilibrium, and why.
struct meaningless {
    std::string_view name, why;
};
constexpr std::string_view no_time = "equilibrium knows no time", no_inertia = "nothing moves in equilibrium",
                           no_flow = "no fluid flows in equilibrium";
constexpr std::array<meaningless, 13> without_meaning{{{"mass", no_inertia},
                                                       {"local_damping", no_inertia},
                                                       {"ramp_time", no_time},
                                                       {"duration", no_time},
                                                       {"longest", no_time},
                                                       {"quiet_fraction", no_inertia},
                                                       {"quiet_time", no_time},
                                                       {"conductivity", no_flow},
                                                       {"aperture", no_flow},
                                                       {"half_force", no_flow},
                                                       {"gap_factor", no_flow},
                                                       {"merge_conductance", "equilibrium knows no merged pores"},
                                                       {"drainage", no_flow}}};

} // namespace

no_convergence::no_convergence(equilibrium_run const& r)
    : std::runtime_error("equilibrium: does not converge at " + lacuna::formatted("%.4g MPa", r.load_MPa) +
                         ": the largest unbalanced force is " + lacuna::formatted("%.3g", r.unbalanced) +
                         " of the largest force") {}

void validate(equilibrium_request const& r) {
    choices const plain;
    for (meaningless const& m : without_meaning) {
        choice_field const& f = find_choice(m.name);
        if (f.get(r.model.choices) != f.get(plain))
            throw usage_error(f.text(r.model.choices).insert(0, std::string(f.name) + " = ") + ": must be " +
                              f.text(plain) + ": " + std::string(m.why));
    }
    if (r.model.dry && r.drained) throw usage_error("--drained: must not be given with --dry, which has no fluid");
}

equilibrium_run find_strength(specimen const& s, equilibrium_request const& r, lacuna::run_directory* out,
                              std::FILE* progress, lacuna::scene* damage) {
    return visit_model(r.model.choices, r.model.dry, [&]<class Model>(std::type_identity<Model>) {
        return find_strength_of<Model>(s, r, out, progress, damage);
    });
}

} // namespace cartilage
