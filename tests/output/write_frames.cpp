// SPDX-License-Identifier: BSD-3-Clause
//
// write_frames FOLDER: writes frames of two small runs, and the values of the runs' accessors (expected.json).
// read_vtk.py and read_dump.py read the frames back with other programs.

#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <lacuna/observe/lammps_dump.hpp>
#include <lacuna/observe/vtk_series.hpp>
#include <lacuna/observe/vtk_zlib.hpp>
#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation.hpp>

namespace {

struct wet : lacuna::default_model<2> {
    using flow = lacuna::explicit_flow;
};
struct space : lacuna::default_model<3> {
    using flow = lacuna::explicit_flow;
};

template <class Vector>
std::vector<double> numbers(Vector const& v) {
    std::vector<double> list;
    for (int axis = 0; axis < v.size(); ++axis) list.push_back(v[axis]);
    return list;
}

template <class Simulation>
nlohmann::json particles_of(Simulation const& sim) {
    nlohmann::json all = nlohmann::json::array();
    for (std::size_t k = 0; k < sim.size(); ++k)
        all.push_back({{"position", numbers(sim.position(k))},
                       {"velocity", numbers(sim.velocity(k))},
                       {"spin", numbers(sim.spin(k))},
                       {"orientation", numbers(sim.orientation(k))},
                       {"radius", sim.radius(k)},
                       {"mass", sim.mass(k)},
                       {"material", sim.material(k)}});
    return {{"step", sim.steps()}, {"time", sim.time()}, {"particles", all}};
}

template <class Simulation>
nlohmann::json pores_of(Simulation const& sim) {
    nlohmann::json all = nlohmann::json::array();
    auto const& net = sim.flow().network();
    for (std::size_t k = 0; k < net.pores(); ++k) {
        nlohmann::json corners;
        for (auto const& corner : net.corner) corners.push_back(sim.particles().id(std::size_t(corner[k])));
        all.push_back({corners, net.pressure[k], net.volume[k]});
    }
    return all;
}

template <class Simulation>
void fill(Simulation& sim) {
    sim.fill_pores([](auto positions, double const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(positions, radii), positions, radii);
    });
}

/// A bonded sheet, 12 by 10, that is torn apart at its ends: some bonds break, pores open.
nlohmann::json write_sheet(std::string const& folder) {
    auto const discs = lacuna::hexagonal_rows<double>(12, 10, 0.5, true);
    lacuna::simulation_parameters<wet> p;
    p.materials[0].bond.tensile_strength = p.materials[0].bond.shear_strength = 1e4;
    p.flow.bulk_modulus = 1e6;
    lacuna::simulation<wet> sim(discs, p);
    fill(sim);
    for (std::size_t k = 0; k < sim.size(); ++k)
        if (k % 12 == 0 || k % 12 == 11) sim.prescribe_velocity(k, {k % 12 == 0 ? -2.0 : 2.0, 0.1 * double(k % 5)});
    lacuna::vtk_series<> raw(folder + "/raw", 40);
    lacuna::vtk_series<lacuna::vtk_zlib> packed(folder + "/packed", 40);
    lacuna::lammps_dump dump(folder + "/sheet", 40);
    sim.run(100, raw, packed, dump);

    auto said = particles_of(sim);
    for (auto const& bond : sim.pairs().bond_records())
        said["bonds"].push_back({bond.particles[0], bond.particles[1], int(bond.state)});
    said["pores"] = pores_of(sim);
    said["names"] = {"000000000000", "000000000040", "000000000080", "000000000100"};
    said["times"] = {0.0, 40 * sim.time_step(), 80 * sim.time_step(), sim.time()};
    return said;
}

/// Five spheres around two pores, all in motion.
nlohmann::json write_spheres(std::string const& folder) {
    lacuna::packing<double, 3> spheres;
    spheres.add({0.0, 0.0, 0.0}, 0.5);
    spheres.add({1.0, 0.0, 0.0}, 0.5);
    spheres.add({0.5, 0.875, 0.0}, 0.5);
    spheres.add({0.5, 0.25, 0.75}, 0.4);
    spheres.add({0.5, 0.25, -0.8125}, 0.45);
    lacuna::simulation_parameters<space> p;
    p.materials[0].contact.friction = 0.5;
    p.flow.bulk_modulus = 1e6;
    lacuna::simulation<space> sim(spheres, p);
    fill(sim);
    sim.set_velocity(3, {0.1, 0.2, -1.0});
    sim.set_spin(1, {10.0, 20.0, 30.0});
    lacuna::vtk_series<lacuna::vtk_zlib> packed(folder + "/space", 1000);
    lacuna::lammps_dump dump(folder + "/space", 1000);
    sim.run(20, packed, dump);
    auto said = particles_of(sim);
    said["pores"] = pores_of(sim);
    return said;
}

/// Arrays of no block, of one and of several blocks, full and partial ones; and a tetrahedron.
void write_odd_sizes(std::string const& folder) {
    for (std::size_t const count :
         {std::size_t(0), std::size_t(1), lacuna::vtk_zlib::block / 8, lacuna::vtk_zlib::block / 4 + 1}) {
        lacuna::vtk_surface s;
        s.point_data = {{"number", 1, {}}};
        for (std::size_t k = 0; k < count; ++k) {
            s.coordinates.insert(s.coordinates.end(), {double(k), 0.5 * double(k), -1.0});
            s.point_data[0].values.push_back(double(k * k));
        }
        lacuna::save_vtk(folder + "/points-" + std::to_string(count) + ".vtp", s, lacuna::vtk_zlib{});
    }
    lacuna::vtk_surface solid;
    solid.kind = lacuna::vtk_surface::cells::tetrahedra;
    solid.coordinates = {0, 0, 0, 3, 0, 0, 0, 2, 0, 0, 0, 1};
    solid.add_cell({0, 1, 2, 3});
    solid.cell_data = {{"pressure", 1, {7}}};
    lacuna::save_vtk(folder + "/solid.vtu", solid, lacuna::vtk_zlib{});
}

} // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: write_frames FOLDER\n");
        return 2;
    }
    std::string const folder = arguments[1];
    nlohmann::json const said = {{"sheet", write_sheet(folder)}, {"space", write_spheres(folder)}};
    write_odd_sizes(folder);
    lacuna::whole_file file(folder + "/expected.json");
    file.write(said.dump());
    file.commit();
}
