// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <lacuna/observe/energy_ledger.hpp>

#include "journal.hpp"
#include "scenario.hpp"

namespace lacuna_run {

/// The final numbers of a run. SI units.
struct run_numbers {
    struct pore {
        std::optional<point> middle; ///< none in a bare network
        double volume, pressure;
    };
    struct source {
        std::string name;
        double volume, rate;
    };
    std::string ended, message;
    long long steps = 0;
    double time = 0, time_step = 0, critical = 0, kinetic = 0;
    lacuna::energy_ledger const* energy = nullptr;
    std::vector<pore> pores;
    std::vector<source> sources;
};

/// The text of summary.json.
std::string summary_text(scenario const& s, journal const& j, run_numbers const& n);

} // namespace lacuna_run
