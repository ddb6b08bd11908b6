// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <lacuna/observe/frame_series.hpp>
#include <lacuna/observe/vtk_scenes.hpp>

namespace lacuna {

/// Writes frames for ParaView: PREFIX-particles-STEP.vtp, -bonds- where there are bonds, -pores- where there is fluid
/// (.vtu in space), and a series in time of each, PREFIX-particles.pvd and so on. Each file appears whole or not at all.
/// \tparam Storage vtk_raw or vtk_zlib
template <class Storage = vtk_raw>
class vtk_frames {
public:
    template <class Simulation>
    void write(Simulation const& sim, std::string const& prefix, std::string const& number) {
        auto const save = [&](char const* what, vtk_surface const& scene, auto& frames) {
            std::string const name = prefix + "-" + what;
            save_vtk(name + "-" + number + scene.ending(), scene, Storage{});
            auto const slash = name.find_last_of('/');
            frames.emplace_back(sim.time(), name.substr(slash == std::string::npos ? 0 : slash + 1) + "-" + number + scene.ending());
            save_vtk_series(name + ".pvd", frames);
        };
        save("particles", vtk_particles(sim), particles_);
        if (!sim.pairs().bond_records().empty()) save("bonds", vtk_bonds(sim), bonds_);
        if constexpr (requires { sim.flow().network(); })
            if (sim.filled()) save("pores", vtk_pores(sim), pores_);
    }

private:
    using series = std::vector<std::pair<double, std::string>>;
    series particles_, bonds_, pores_;
};

/// Observer that writes VTK files of a run.
template <class Storage = vtk_raw>
using vtk_series = frame_series<vtk_frames<Storage>>;

} // namespace lacuna
