// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/equilibrium_command.hpp"

#include <cstdio>
#include <string>
#include <vector>

#include <lacuna/draw/picture.hpp>
#include <lacuna/observe/run_directory.hpp>

#include "cartilage/common/print_paths.hpp"
#include "cartilage/common/write_whole.hpp"
#include "cartilage/run/equilibrium_output.hpp"
#include "cartilage/run/run_output.hpp"
#include "cartilage/specimen/specimen.hpp"

namespace cartilage {

bool equilibrium(equilibrium_options const& o) {
    auto names = run_results();
    for (std::string const& name : equilibrium_results()) names.push_back(name);
    lacuna::run_directory out(o.model.out, "--out", names,
                              o.model.force ? lacuna::earlier_results::replace : lacuna::earlier_results::refuse);
    specimen const s = build_specimen(o.model);
    lacuna::scene damage;
    equilibrium_run const found = find_strength(s, o, &out, o.model.quiet ? nullptr : stderr, &damage);
    out.keep();
    write_whole(out.file("cracks.csv"), equilibrium_cracks(found));
    if (found.ended == "not_converged") throw no_convergence(found);
    lacuna::save_packing(out.file("packing"), scene_of(s, o.model));
    lacuna::save_damage(out.file("damage"), damage);
    draw_layers(out.file("layers"), o, s, found);
    // Last, because its presence means that the run is finished.
    write_whole(out.file("summary.json"), equilibrium_json(o, found, true));
    if (o.json) {
        std::fputs(equilibrium_json(o, found, false).c_str(), stdout);
    } else if (!o.model.quiet) {
        print_equilibrium(stdout, o, s, found);
        print_paths(out, {"packing.png", "packing.svg", "damage.png", "damage.svg", "layers.png", "layers.svg",
                          "cracks.csv", "summary.json"});
    }
    return found.ended != "interrupted";
}

} // namespace cartilage
