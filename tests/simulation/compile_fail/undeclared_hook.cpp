// SPDX-License-Identifier: BSD-3-Clause
// refused: on_break is not among the stages

#include <lacuna/simulation.hpp>

struct watcher {
#ifdef LACUNA_GOOD
    static constexpr lacuna::stage stages = lacuna::stage::step | lacuna::stage::breakage;
#else
    static constexpr lacuna::stage stages = lacuna::stage::step;
#endif
    template <class Simulation>
    void on_step(Simulation const&) {}
    template <class Simulation>
    void on_break(lacuna::break_event<2> const&, Simulation const&) {}
};

void use(lacuna::simulation<lacuna::default_model<2>>& run) { run.run(1, watcher{}); }
