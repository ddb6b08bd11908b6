// SPDX-License-Identifier: BSD-3-Clause

#include <cstdio>
#include <fstream>
#include <string>

#include <lacuna/packings/lammps_data.hpp>
#include <lacuna/packings/particle_csv.hpp>

#include "catch.hpp"

namespace {

template <class Read>
std::string why(Read const& read) {
    try {
        read();
    } catch (std::invalid_argument const& e) {
        return e.what();
    }
    return "accepted";
}

/// Two bonded spheres and a third, as written by LAMMPS's write_data; lines are not in the order of ids.
std::string const spheres = "LAMMPS data file via write_data, version 23 Jun 2022, timestep = 0\n"
                            "\n"
                            "3 atoms\n"
                            "1 bonds\n"
                            "2 atom types\n"
                            "1 bond types\n"
                            "\n"
                            "-1.5 2.5 xlo xhi\n"
                            "-1 1 ylo yhi\n"
                            "-1e0 1.0e+00 zlo zhi\n"
                            "\n"
                            "Bond Coeffs # bpm/rotational\n"
                            "\n"
                            "1 1.0 0.2 0.02 0.02 0.2 0.04 0.002 0.002\n"
                            "\n"
                            "Atoms # bpm/sphere\n"
                            "\n"
                            "7 1 2 0.5 2600 1.25 0.5 -0.125 0 0 0\n"
                            "2 1 1 1.0 1000 0 0 0 0 0 0\n"
                            "3 1 1 1.5 1000.5 1.25 0 0\n"
                            "\n"
                            "Velocities\n"
                            "\n"
                            "3 0.1 0.2 0.3 4 5 6\n"
                            "\n"
                            "Bonds\n"
                            "\n"
                            "1 1 3 2\n";

std::string changed(std::string text, std::string const& from, std::string const& to) {
    auto const at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

} // namespace

TEST_CASE("particles of a CSV file written by hand", "[files]") {
    auto const list = lacuna::parse_particle_csv<2>("material, radius,position.y,position.x,velocity.y\r\n"
                                                    "1,0.5,2,1,-3\r\n\n0,0.25, 0 ,1e-1,0\n", "f");
    REQUIRE(list.size() == 2);
    REQUIRE(list.packing.position[0][0] == 1);
    REQUIRE(list.packing.position[0][1] == 2);
    REQUIRE(list.packing.position[1][0] == 0.1);
    REQUIRE(list.packing.radius == std::vector<double>{0.5, 0.25});
    REQUIRE(list.packing.material == std::vector<int>{1, 0});
    REQUIRE(list.velocity[0][0] == 0);
    REQUIRE(list.velocity[0][1] == -3);
    REQUIRE(list.spin[1][0] == 0);
    REQUIRE(list.density.empty());

    std::string const head = "radius,material,position.x,position.y,position.z,spin.z\n";
    auto const space = lacuna::parse_particle_csv<3>(head + "1,bone,1,2,3,4\n", "f", {"fibre", "bone"});
    REQUIRE(space.packing.material == std::vector<int>{1});
    REQUIRE(space.packing.position[0][2] == 3);
    REQUIRE(space.spin[0][2] == 4);
}

TEST_CASE("particles written to CSV come back with the same bits", "[files]") {
    lacuna::particle_list<3> list;
    for (int k = 0; k < 50; ++k) {
        auto const odd = [k](int n) { return std::sin(12.9898 * k + 78.233 * n) / 3; };
        list.add({odd(0), 1e-9 * odd(1), 1e6 * odd(2)}, 1e-6 * (1.5 + odd(3)), k % 3);
        list.velocity.back() = {odd(4), 0.0, odd(5)};
        list.spin.back() = {odd(6), odd(7), odd(8)};
    }
    auto const back = lacuna::parse_particle_csv<3>(lacuna::particle_csv(list), "f");
    REQUIRE(back.size() == list.size());
    REQUIRE(back.packing.radius == list.packing.radius);
    REQUIRE(back.packing.material == list.packing.material);
    for (std::size_t k = 0; k < list.size(); ++k)
        for (int axis = 0; axis < 3; ++axis) {
            REQUIRE(back.packing.position[k][axis] == list.packing.position[k][axis]);
            REQUIRE(back.velocity[k][axis] == list.velocity[k][axis]);
            REQUIRE(back.spin[k][axis] == list.spin[k][axis]);
        }
}

TEST_CASE("bad lines of a CSV file are refused by file, line, column, value and rule", "[files]") {
    std::string const head = "radius,material,position.x,position.y\n";
    for (auto const& [text, message] : {
             std::pair<std::string, std::string>{"", "f = (empty): must be a heading that names the columns, and rows"},
             {"radius,material,position.x\n", "f:1: position.y = (missing): must be given"},
             {"radius,materiel,position.x,position.y\n",
              "f:1 = \"materiel\": must be a known column (did you mean \"material\"?)"},
             {"radius,radius,position.x,position.y\n", "f:1 = \"radius\": must be a column that is given once"},
             {head + "1,0,0\n", "f:2 = 3 cells: must be as many as the heading has, 4"},
             {head + "1,0,0,0\n\n1,0,1,x\n", "f:4: position.y = \"x\": must be a number"},
             {head + "1,0,0,1e999\n", "f:2: position.y = 1e999: must be finite"},
             {head + "1,0,,0\n", "f:2: position.x = \"\": must be a number"},
             {head + "0,0,0,0\n", "f:2: radius = 0: must be > 0"},
             {head + "1,-1,0,0\n", "f:2: material = -1: must be a whole number from 0 on"},
             {head + "1,0.5,0,0\n", "f:2: material = 0.5: must be a whole number from 0 on"}})
        REQUIRE(why([&, &text = text] { lacuna::parse_particle_csv<2>(text, "f"); }) == message);
    REQUIRE(why([&] { lacuna::parse_particle_csv<2>(head + "1,0,0,0\n", "f", {"bone"}); }) ==
            "f:2: material = \"0\": must be the name of a material");
    REQUIRE(why([] { lacuna::read_particle_csv<2>("no/such/file.csv"); }) ==
            "particle file = \"no/such/file.csv\": must be a file that can be read");
    REQUIRE(why([] { lacuna::read_particle_csv<2>("/"); }) == "particle file = \"/\": must be a file that can be read");
}

TEST_CASE("spheres of a LAMMPS data file", "[files]") {
    std::string const path = "particle_files_spheres.data";
    std::ofstream(path) << spheres;
    auto const list = lacuna::read_lammps_data<3>(path);
    std::remove(path.c_str());
    REQUIRE(list.size() == 3); // ids 2, 3, 7
    REQUIRE(list.packing.radius == std::vector<double>{0.5, 0.75, 0.25});
    REQUIRE(list.packing.material == std::vector<int>{0, 0, 1});
    REQUIRE(list.density == std::vector<double>{1000, 1000.5, 2600});
    REQUIRE(list.packing.position[2][2] == -0.125);
    REQUIRE(list.packing.position[1][0] == 1.25);
    REQUIRE(list.velocity[1][2] == 0.3);
    REQUIRE(list.spin[1][0] == 4);
    REQUIRE(list.velocity[0][0] == 0);
    REQUIRE(list.packing.bonds == std::vector<std::array<std::int32_t, 2>>{{1, 0}});

    auto const flat =
        lacuna::parse_lammps_data<2>("discs\n\n1 atoms\n\nAtoms # sphere\n\n1 1 2 1000 3 4 0\n\nVelocities\n\n"
                                     "1 5 6 0 0 0 7\n",
                                     "f");
    REQUIRE(flat.packing.position[0][1] == 4);
    REQUIRE(flat.velocity[0][1] == 6);
    REQUIRE(flat.spin[0][0] == 7);
}

TEST_CASE("bad lines of a LAMMPS data file are refused by file, line, field, value and rule", "[files]") {
    for (auto const& [from, to, message] :
         {std::array<std::string, 3>{"2 1 1 1.0 1000", "2 1 1 -1.0 1000",
                                     "f:19: diameter = -1.0: must be > 0: particles cannot be points"},
          {"2 1 1 1.0 1000", "2 1 1 1.0 0", "f:19: density = 0: must be > 0"},
          {"2 1 1 1.0", "2 1 0 1.0", "f:19: atom type = 0: must be a whole number from 1 to 2"},
          {"2 1 1 1.0", "7 1 1 1.0", "f:19: id = 7: must be given once"},
          {"1000 0 0 0 0 0 0", "1000 0 0 0 0 1 0",
           "f:19: image flag = 1: must be 0: the box is read as non-periodic along y; reading it as periodic unwraps "
           "positions"},
          {"1000.5 1.25 0 0", "1000.5 1.25 0", "f:20: Atoms = 7 words: must be 8 or 11"},
          {"1000.5 1.25 0 0", "1000.5 1.25 zero 0", "f:20: position = \"zero\": must be a number"},
          {"3 0.1 0.2", "4 0.1 0.2", "f:24: id = 4: must be an atom of the section Atoms above"},
          {"1 1 3 2", "1 1 3 9", "f:28: atom = 9: must be an atom of the section Atoms above"},
          {"1 1 3 2", "1 1 3 3", "f:28: atom = 3: must be another atom than the first"},
          {"1 bonds", "2 bonds", "f: bonds = 1: must be as many as the header says, 2"},
          {"3 atoms", "4 atoms", "f: atoms = 3: must be as many as the header says, 4"},
          {"# bpm/sphere", "# atomic",
           "f:16: Atoms = \"atomic\": must be followed by \"# sphere\" or \"# bpm/sphere\""},
          {"Velocities", "Velocites",
           "f:22 = \"Velocites\": must be a section of spheres (did you mean \"Velocities\"?)"}})
        REQUIRE(why([&, &from = from, &to = to] { lacuna::parse_lammps_data<3>(changed(spheres, from, to), "f"); }) ==
                message);
    REQUIRE(why([] { lacuna::parse_lammps_data<2>(spheres, "f"); }) == "f:18: z = -0.125: must be 0 in the plane");
    REQUIRE(why([] { lacuna::parse_lammps_data<3>("a title\n", "f"); }) ==
            "f: atoms = 0: must be announced in the header");
}
