// SPDX-License-Identifier: BSD-3-Clause

#include <cstdio>

#include <lacuna/core/vec.hpp>
#include <lacuna/core/version.hpp>
#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/simulation.hpp>

// Includes every installed header: one that includes a header missing from the installation fails here.
#include "every_header.hpp"

struct model : lacuna::default_model<2> {};

int main() {
    lacuna::simulation<model> sim(lacuna::chain<double, 2>(3, 0.5, true));
    sim.run(2);
    lacuna::vec<double, 2> const a{3.0, 4.0};
    std::printf("lacuna %d.%d.%d\n", LACUNA_VERSION_MAJOR, LACUNA_VERSION_MINOR, LACUNA_VERSION_PATCH);
    return lacuna::norm(a) == 5.0 && sim.steps() == 2 ? 0 : 1;
}
