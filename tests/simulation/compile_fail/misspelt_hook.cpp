// SPDX-License-Identifier: BSD-3-Clause
// refused: observer declares stage::step but on_step(simulation const&) cannot be called

#include <lacuna/simulation.hpp>

struct watcher {
    static constexpr lacuna::stage stages = lacuna::stage::step;
#ifdef LACUNA_GOOD
    void on_step(lacuna::simulation<lacuna::default_model<2>> const&) {}
#else
    void on_stpe(lacuna::simulation<lacuna::default_model<2>> const&) {}
#endif
};

void use(lacuna::simulation<lacuna::default_model<2>>& run) { run.run(1, watcher{}); }
