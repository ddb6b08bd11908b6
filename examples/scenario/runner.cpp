// SPDX-License-Identifier: BSD-3-Clause
#include "checkpoints.hpp"
#include "runner.hpp"

#include <stdexcept>
#include <string>

#include <lacuna/laws/frictional_spring.hpp>
#include <lacuna/laws/hertz_mindlin.hpp>

namespace lacuna_run {

namespace {

template <int Dim, class Real>
std::unique_ptr<runner> make(scenario const& s) {
    if (s.simulation.contact == contact_law::hertz_mindlin)
        return make_particle_runner<Dim, Real, lacuna::hertz_mindlin>(s);
    return make_particle_runner<Dim, Real, lacuna::frictional_spring>(s);
}

std::unique_ptr<runner> build_runner(scenario const& s) {
#ifndef LACUNA_HAS_PICTURES
    if (s.output.picture_every > 0)
        refuse("output.picture_every", std::to_string(s.output.picture_every),
               "0: this program was built without pictures");
#endif
#ifndef LACUNA_RUN_CHECKPOINTS
    if (s.output.checkpoint_every > 0)
        refuse("output.checkpoint_every", std::to_string(s.output.checkpoint_every),
               "0: this program was built without checkpoints");
#endif
    if (s.flow_alone()) return make_network_runner(s);
    bool const single = s.simulation.single_precision;
    if (s.simulation.dimension == 3) return single ? make<3, float>(s) : make<3, double>(s);
    return single ? make<2, float>(s) : make<2, double>(s);
}

/// Replaces the library's names by keys of the scenario: the library's flow is [fluid].
std::string with_scenario_keys(std::string const& message) {
    if (message.rfind("flow.", 0) == 0) return "fluid." + message.substr(5);
    bool const of_pores = message.rfind("number of pores", 0) == 0 || message.rfind("size of the pore", 0) == 0;
    return of_pores ? "fluid: " + message : message;
}

} // namespace

std::unique_ptr<runner> make_runner(scenario const& s) {
    // No file is written here, so every error is an error of the scenario.
    try {
        return build_runner(s);
    } catch (refusal const&) {
        throw;
    } catch (std::invalid_argument const& bad) {
        throw refusal(with_scenario_keys(bad.what()));
    } catch (std::runtime_error const& bad) {
        throw refusal((s.fluid ? "fluid: no pores between the particles of particles.position: " : "") +
                      std::string(bad.what()));
    }
}

} // namespace lacuna_run
