// SPDX-License-Identifier: BSD-3-Clause
// refused: an observer needs one of on_start

#include <lacuna/simulation.hpp>

struct watcher {
    template <class Simulation>
#ifdef LACUNA_GOOD
    void on_end(Simulation const&) {}
#else
    void on_finish(Simulation const&) {}
#endif
};

void use(lacuna::simulation<lacuna::default_model<2>>& run) { run.run(1, watcher{}); }
