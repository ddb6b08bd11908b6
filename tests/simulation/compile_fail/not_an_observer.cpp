// SPDX-License-Identifier: BSD-3-Clause
// refused: observer

#include <lacuna/simulation.hpp>

struct watcher {
#ifdef LACUNA_GOOD
    static constexpr lacuna::stage stages = lacuna::stage::end;
#endif
    template <class Simulation>
    void on_end(Simulation const&) {}
};

void use(lacuna::simulation<lacuna::default_model<2>>& run) { run.run(1, watcher{}); }
