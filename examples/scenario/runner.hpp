// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "results.hpp"
#include "scenario.hpp"

namespace lacuna_run {

/// A scenario that is ready to run. Hides the type of the simulation. Single steps make no virtual call.
class runner {
public:
    virtual ~runner() = default;
    /// Continues from a checkpoint of the same scenario. \throws refusal for another file or another scenario
    virtual void restore(std::string const& path) = 0;
    /// Runs to the end, or until a signal arrives, and writes rows and frames to `out`. After a signal it writes a
    /// checkpoint.
    /// \return whether the end was reached
    /// \throws lacuna::unstable_run, std::runtime_error for a file that cannot be written
    virtual bool run(results& out) = 0;
    /// The cracks so far, and how far the files were written.
    virtual journal const& log() const = 0;
    virtual long long steps() const = 0;
    /// The text of summary.json.
    /// \param ended "steps", "end_time", "unstable" or "stopped by SIGNAL"
    /// \param message the error, or empty
    virtual std::string summary(std::string const& ended, std::string const& message) const = 0;
};

/// \throws refusal, also for errors that the library finds while it builds the simulation
std::unique_ptr<runner> make_runner(scenario const& s);

/// Makes a runner for one dimension, precision and contact law. Each combination is one source file in kinds/.
template <int Dim, class Real, class ContactLaw>
std::unique_ptr<runner> make_particle_runner(scenario const& s);
std::unique_ptr<runner> make_network_runner(scenario const& s);

} // namespace lacuna_run
