// SPDX-License-Identifier: BSD-3-Clause
//
// 5. Your own observer: it measures and stops the run.
//
// Two bonded discs oscillate. The observer records when their distance passes the rest length on the way out. Two such
// instants are a period apart, 2 pi sqrt(m_eff / k). A hook that is misspelt, or whose stage is not declared, does not
// compile.

#include <cmath>
#include <cstdio>
#include <numbers>

#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/simulation.hpp>

#include "check.hpp"

struct model : lacuna::default_model<2> {};

class swing_counter {
public:
    static constexpr lacuna::stage stages = lacuna::stage::step | lacuna::stage::end;

    template <class Simulation>
    lacuna::run_control on_step(Simulation const& sim) {
        double const stretch = norm(sim.position(1) - sim.position(0)) - 1;
        if (before_ < 0 && stretch >= 0) {
            last_ = sim.time() - sim.time_step() * stretch / (stretch - before_); // interpolated
            if (passed_++ == 0) first_ = last_;
        }
        before_ = stretch;
        return passed_ == 11 ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }
    template <class Simulation>
    void on_end(Simulation const& sim) {
        std::printf("ten swings within %lld steps\n", sim.steps());
    }
    double period() const { return (last_ - first_) / (passed_ - 1); }

private:
    double before_ = 0, first_ = 0, last_ = 0;
    int passed_ = 0;
};

int main() {
    auto const discs = lacuna::chain<double, 2>(2, 0.5);
    lacuna::simulation_parameters<model> p;
    p.materials[0].density = 4 / std::numbers::pi; // 1 kg
    p.materials[0].bond.normal_stiffness = p.materials[0].bond.shear_stiffness = 1000; // N/m
    p.safety = 0.05;

    lacuna::simulation<model> sim(discs, p);
    sim.set_velocity(0, {-0.001, 0.0});
    sim.set_velocity(1, {+0.001, 0.0});

    swing_counter counter;
    sim.run(1000000, counter); // any number of observers may follow
    return tutorial::check("period, s", counter.period(), 2 * std::numbers::pi * std::sqrt(0.5 / 1000), 1e-3);
}
