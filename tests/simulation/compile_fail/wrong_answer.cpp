// SPDX-License-Identifier: BSD-3-Clause
// refused: on_step must return void or run_control

#include <lacuna/simulation.hpp>

struct watcher {
    static constexpr lacuna::stage stages = lacuna::stage::step;
    template <class Simulation>
#ifdef LACUNA_GOOD
    lacuna::run_control on_step(Simulation const&) {
        return lacuna::run_control::go_on;
    }
#else
    bool on_step(Simulation const&) {
        return true;
    }
#endif
};

void use(lacuna::simulation<lacuna::default_model<2>>& run) { run.run(1, watcher{}); }
