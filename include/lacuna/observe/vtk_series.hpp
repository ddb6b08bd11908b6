// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/observe/frame_series.hpp>
#include <lacuna/observe/vtk_collection.hpp>
#include <lacuna/observe/vtk_scenes.hpp>

namespace lacuna {

/// Writes frames for ParaView: PREFIX-particles-STEP.vtp, -bonds- if there are bonds, -pores- if there is fluid (.vtu
/// in space). A series in time of each, PREFIX-particles.pvd and so on, grows with each frame. Each file appears
/// complete or not at all. A simulation at step 0 starts new series. A resumed one continues the series and keeps the
/// entries up to its current time.
/// \tparam Storage vtk_raw or vtk_zlib
template <class Storage = vtk_raw>
class vtk_frames {
public:
    template <class Simulation>
    void write(Simulation const& sim, std::string const& prefix, std::string const& number) {
        auto const save = [&](char const* what, vtk_surface const& scene, growing_file& series) {
            std::string const name = prefix + "-" + what;
            save_vtk(name + "-" + number + scene.ending(), scene, Storage{});
            if (!series.has_begun()) {
                series = vtk_collection(name + ".pvd");
                series.begin();
            }
            auto const slash = name.find_last_of('/');
            auto const file = name.substr(slash == std::string::npos ? 0 : slash + 1) + "-" + number + scene.ending();
            series.add(vtk_collection_entry(sim.time(), file));
            series.flush();
        };
        save("particles", vtk_particles(sim), particles_);
        if (!sim.pairs().bond_records().empty()) save("bonds", vtk_bonds(sim), bonds_);
        if constexpr (requires { sim.flow().network(); })
            if (sim.filled()) save("pores", vtk_pores(sim), pores_);
    }
    /// Cuts existing series back to the current time.
    template <class Simulation>
    series_part resume(Simulation const& sim, std::string const& prefix) {
        auto const cut = [&](char const* what, growing_file& series) {
            std::string const path = prefix + "-" + what + ".pvd";
            auto const [mark, last] = vtk_collection_until(path, sim.time());
            series = {};
            if (mark.bytes == 0) return series_part{};
            series = vtk_collection(path);
            series.resume(mark);
            return series_part{true, last == sim.time()};
        };
        auto const part = cut("particles", particles_);
        cut("bonds", bonds_);
        cut("pores", pores_);
        return part;
    }

private:
    growing_file particles_, bonds_, pores_;
};

/// Observer that writes VTK files of a run.
template <class Storage = vtk_raw>
using vtk_series = frame_series<vtk_frames<Storage>>;

} // namespace lacuna
