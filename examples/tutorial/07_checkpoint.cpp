// SPDX-License-Identifier: BSD-3-Clause
//
// 7. A checkpoint. Stop, save, and continue elsewhere as if the run had never been stopped.
//
// A disc hits a bonded row of discs and breaks it. One run goes through. Another one is saved while bonds break, built
// again and restored. The two ends have the same bits: they differ by zero, not by a small number.

#include <cmath>
#include <cstdio>

#include <lacuna/observe/crack_record.hpp>
#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "check.hpp"

struct model : lacuna::default_model<2> {};

// To continue, build the simulation as it was built before. The file holds the state; it also holds settings, particles
// and bonds, and load_checkpoint() refuses in one line what differs. Calls after load_checkpoint(), such as a new load,
// hold from there on.
lacuna::simulation<model> build() {
    auto discs = lacuna::chain<double, 2>(9, 0.5);
    discs.add({4.2, 1.001}, 0.5);
    lacuna::simulation_parameters<model> p;
    p.materials[0].bond.tensile_strength = p.materials[0].bond.shear_strength = 5e3; // Pa
    p.materials[0].contact.friction = 0.4;
    lacuna::simulation<model> sim(discs, p);
    sim.set_velocity(9, {0.0, -1.0});
    return sim;
}

int main() {
    using cracks = lacuna::crack_record<lacuna::break_event<2>>;
    char const* const file = "07_checkpoint.lacuna";
    long long const saved_at = 20, end = 800; // steps

    auto whole = build();
    cracks whole_cracks;
    whole.run(end, whole_cracks);

    auto first = build();
    cracks first_cracks;
    first.run(saved_at, first_cracks);
    lacuna::save_checkpoint(file, first, first_cracks); // the events so far belong to the run

    auto second = build();
    cracks second_cracks;
    lacuna::load_checkpoint(file, second, second_cracks);
    second.run(end - saved_at, second_cracks);
    std::remove(file);

    double difference = 0;
    for (std::size_t k = 0; k < whole.size(); ++k)
        difference += norm(whole.position(k) - second.position(k)) + norm(whole.velocity(k) - second.velocity(k));
    std::printf("%zu bonds broke before the checkpoint, %zu in all, %zu in the run that went through\n",
                first_cracks.events().size(), second_cracks.events().size(), whole_cracks.events().size());
    if (whole_cracks.events().empty()) return 1; // no bond broke: the comparison would prove little
    return tutorial::check("difference of all positions and velocities", difference, 0, 0);
}
