// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "results.hpp"
#include "scenario.hpp"

namespace lacuna_run {

/// A scenario made ready to run; what it is made of is known inside only. The step itself never passes through here.
class runner {
public:
    virtual ~runner() = default;
    /// Goes on from a checkpoint of the same scenario. \throws refusal for a file that is not one
    virtual void restore(std::string const& path) = 0;
    /// Runs to the end, or until a signal asks to stop, and tells in `out` what it does; then there is a checkpoint.
    /// \return whether the end was reached \throws lacuna::unstable_run
    virtual bool run(results& out) = 0;
    virtual journal const& told() const = 0;
    virtual long long steps() const = 0;
    /// summary.json: how the run ended, in numbers.
    /// \param ended "steps", "end_time", "unstable" or "stopped by" a signal; \param message what went wrong, empty if nothing
    virtual std::string summary(std::string const& ended, std::string const& message) const = 0;
};

/// \throws refusal; std::invalid_argument for what only the parts of the simulation can tell
std::unique_ptr<runner> make_runner(scenario const& s);

/// One kind of particles and contacts, each compiled on its own: see kinds/.
template <int Dim, class Real, class ContactLaw>
std::unique_ptr<runner> make_particle_runner(scenario const& s);
std::unique_ptr<runner> make_network_runner(scenario const& s);

} // namespace lacuna_run
