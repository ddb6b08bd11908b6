// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <lacuna/packings/lammps_data.hpp>
#include <lacuna/packings/particle_csv.hpp>

#include "catch.hpp"

/// \file
/// Files as other programs and people write them (tests/packings/files). Each is read correctly, or refused with
/// line, value and rule.

using lacuna::parse_lammps_data;
using lacuna::parse_particle_csv;

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

std::string file(std::string const& name) {
    std::string const cases = LACUNA_REFERENCE_FILE; // tests/reference/cases.json
    return lacuna::read_file(cases.substr(0, cases.rfind("reference")) + "packings/files/" + name, name);
}

std::string replaced(std::string text, std::string const& from, std::string const& to) {
    auto const at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// Three spheres of radius 0.5 at x = 0.5, 1.5, 2.5.
template <int Dim>
void check_three(lacuna::particle_list<Dim> const& list, std::size_t bonds) {
    REQUIRE(list.size() == 3);
    REQUIRE(list.packing.radius == std::vector<double>{0.5, 0.5, 0.5});
    REQUIRE(list.packing.material == std::vector<int>{0, 0, 0});
    REQUIRE(list.packing.density == std::vector<double>{2500, 2500, 2500});
    REQUIRE(list.density == list.packing.density);
    for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(list.packing.position[k][0] == 0.5 + double(k));
        for (int axis = 1; axis < Dim; ++axis) REQUIRE(list.packing.position[k][axis] == 0);
    }
    REQUIRE(list.packing.bonds.size() == bonds);
    REQUIRE(list.packing.bond_type == std::vector<int>(bonds, 0));
    for (std::size_t b = 0; b < bonds; ++b)
        REQUIRE(list.packing.bonds[b] == std::array<std::int32_t, 2>{std::int32_t(b), std::int32_t(b + 1)});
}

/// A LAMMPS data file of the sections given.
std::string data_file(std::string const& title, std::string const& header, std::string const& atoms,
                      std::string const& more = "") {
    return title + "\n\n" + header + "\nAtoms # sphere\n\n" + atoms + more;
}

/// A ring of three spheres through the sides of a box of length 3.
std::string ring(std::string const& images) {
    return data_file("ring", "3 atoms\n3 bonds\n0 3 xlo xhi\n-1 1 ylo yhi\n-1 1 zlo zhi\n",
                     "1 1 1 2500 0.5 0 0\n2 1 1 2500 1.5 0 0\n3 1 1 2500 2.5 0 0" + images + "\n",
                     "\nBonds\n\n1 1 1 2\n2 1 2 3\n3 1 3 1\n");
}

} // namespace

TEST_CASE("LAMMPS data files by other authors", "[files]") {
    for (auto const& [name, refusal] : {
             std::pair<std::string, std::string>{"tabs.data", ""},
             {"crlf.data", ""},
             {"cr.data", ""},
             {"sci.data", ""},
             {"inline.data", ""},
             {"image.data", ":16: image flag = 1: must be 0: the box is read as non-periodic along x; reading it as "
                            "periodic unwraps positions"},
             {"bare.data", ":12: Atoms = \"\": must be followed by \"# sphere\" or \"# bpm/sphere\""},
             {"hybrid.data",
              ":12: Atoms = \"hybrid sphere bond\": must be followed by \"# sphere\" or \"# bpm/sphere\""},
             {"triclinic.data", ":11: xy xz yz = 0.5: must be 0: boxes here have right angles"},
             {"units_lj.data", ":1: units = \"lj\": must be si, cgs, micro or nano: lj units have no dimensions"},
             {"twice.data", ":21: Bonds = 2 1: must be a pair that has no bond yet"},
             {"typelabels.data", ""},
             {"bom.data", ""},
             {"fortran.data", ":14: density = \"2.5D+03\": must be a number with \"e\" before its exponent, not \"d\""},
             {"noeol.data", ""},
             {"spheretwocols.data", ":14: Atoms = 8 words: must be 7 or 10"},
             {"bpmwithsphere.data", ":14: Atoms = 7 words: must be 8 or 11"},
             {"notitle.data",
              ":1: title = \"3 atoms\": must be a title: the first line of a data file is not part of its header"},
             {"capsules.data", ":18 = \"Capsules\": must be a section of spheres"},
             {"extra.data", ""},
             {"coeffs.data", ""},
             {"hex.data", ":14: position = \"0x10\": must be a decimal number, not a hexadecimal one"},
             {"spaces_comment.data", ""},
             {"sphere_image_ambiguous.data", ":13: Atoms = 8 words: must be 7 or 10"},
             {"inf.data", ":14: position = inf: must be finite"},
             {"bondtype.data", ":20: bond type = 7: must be a whole number from 1 to 1"},
             {"bigid.data", ""},
             {"atomsbondsoneline.data", ":3 = \"atoms 2 bonds\": must be a line of a header, such as \"12 atoms\""},
             {"nonascii_id.data", ":14: id = \"\xEF\xBC\x91\": must be a number; it has the character U+FF11"},
             {"typegap.data", ":15: atom type = 9: must be a whole number from 1 to 1"},
             {"outsidebox.data", ":16: position = 99.5: must be within the box, from 0 to 4 along x"},
             {"hybrid_bpm_first.data",
              ":12: Atoms = \"bpm/sphere dipole\": must be followed by \"# sphere\" or \"# bpm/sphere\""},
             {"commenttitle.data", ""},
             {"nul.data", ":14 = a NUL byte: must be text"}}) {
        INFO(name);
        std::string const text = file(name);
        if (refusal.empty()) {
            std::size_t const bonds = name == "commenttitle.data" ? 0 : 2;
            check_three(parse_lammps_data<2>(text, name), bonds);
            check_three(parse_lammps_data<3>(text, name), bonds);
        } else {
            REQUIRE(why([&, &n = name] { parse_lammps_data<2>(text, n); }) == name + refusal);
            REQUIRE(why([&, &n = name] { parse_lammps_data<3>(text, n); }) == name + refusal);
        }
    }
}

TEST_CASE("CSV files of other programs", "[files]") {
    std::string const many = ": radius, material, position.x, position.y, velocity.x, velocity.y, spin, density; "
                             "leave out all others, particles are numbered by rows";
    // Accepted files have one or two discs of radius 0.5 at x = 0 and 1.
    for (auto const& [name, rows, refusal] : {
             std::tuple<std::string, std::size_t, std::string>{"bom.csv", 2, ""},
             {"semi.csv", 2, ""},
             {"quoted.csv", 1, ""},
             {"yade.txt", 2, ""},
             {"xyzr.csv", 1, ""},
             {"trailing.csv", 1, ""},
             {"cr.csv", 2, ""},
             {"hash.csv", 2, ""},
             {"tabs.csv", 2, ""},
             {"caps.csv", 2, ""},
             {"unit.csv", 2, ""},
             {"quotedcomma.csv", 1, ""},
             {"nan.csv", 0, ":2: radius = nan: must be finite"},
             {"extra.csv", 0, ":1 = \"id\": must be a known column" + many},
             {"onlyhead.csv", 0, ": particles = 0: must be at least 1: there are no rows below the heading"},
             {"empty.csv", 0, " = (empty): must be a heading that names the columns, and rows"},
             {"nul.csv", 0, ":2 = a NUL byte: must be text"},
             {"mat_real.csv", 2, ""},
             {"hexradius.csv", 0, ":2: radius = \"0x1p-1\": must be a decimal number, not a hexadecimal one"},
             {"innerquote.csv", 0, ":2 = \"\"0\": must be a cell whose quotes are closed"},
             {"leadblank.csv", 2, ""},
             {"3din2d.csv", 1, ""},
             {"dup.csv", 0,
              ":4: position = that of line 3: must be another: two particles cannot have the same position"},
             {"nbsp.csv", 0, ":2: radius = \"0.5\xC2\xA0\": must be a number; it has a no-break space, U+00A0"},
             {"thousand.csv", 0, ":2: radius = \"1'000.5\": must be a number without marks between thousands"},
             {"minus.csv", 0,
              ":3: position.x = \"\xE2\x88\x92" "1\": must be a number; it has a minus sign that is no "
              "hyphen, U+2212"}}) {
        INFO(name);
        std::string const text = file(name);
        if (!refusal.empty()) {
            REQUIRE(why([&, &n = name] { parse_particle_csv<2>(text, n); }) == name + refusal);
            continue;
        }
        auto const list = parse_particle_csv<2>(text, name);
        REQUIRE(list.size() == rows);
        for (std::size_t k = 0; k < rows; ++k) {
            REQUIRE(list.packing.radius[k] == 0.5);
            REQUIRE(list.packing.material[k] == 0);
            REQUIRE(list.packing.position[k][0] == double(k));
            REQUIRE(list.packing.position[k][1] == 0);
        }
    }
}

TEST_CASE("LAMMPS's units are converted to SI to the nearest numbers", "[files]") {
    struct unit {
        std::string name;
        double length, density, speed, spin;
    };
    // From LAMMPS's page on its command units: cm, g, s; micrometre, picogram, microsecond; nanometre, attogram,
    // nanosecond.
    for (unit const& u : {unit{"si", 3.5, 0.0011, 2.5, 0.75}, unit{"cgs", 3.5e-2, 1.1, 2.5e-2, 0.75},
                          unit{"micro", 3.5e-6, 1.1, 2.5, 0.75e6}, unit{"nano", 3.5e-9, 1100, 2.5, 0.75e9}})
        for (std::string const title :
             {"LAMMPS data file via write_data, version 29 Aug 2024, timestep = 100, units = ", "# Units: ",
              "grains (units "}) {
            auto const list =
                parse_lammps_data<3>(data_file(title + u.name, "1 atoms\n-10 10 xlo xhi\n",
                                               "1 1 7 0.0011 3.5 0 0 0 0 0\n", "\nVelocities\n\n1 2.5 0 0 0 0 0.75\n"),
                                     "f");
            REQUIRE(list.packing.position[0][0] == u.length);
            REQUIRE(list.packing.radius[0] == u.length);
            REQUIRE_THAT(list.packing.density[0], WithinRel(u.density, 1e-15));
            REQUIRE(list.velocity[0][0] == u.speed);
            REQUIRE(list.spin[0][2] == u.spin);
        }
    auto const with = [](std::string const& title) {
        return why([&] { parse_lammps_data<3>(data_file(title, "1 atoms\n", "1 1 1 1 0 0 0\n"), "f"); });
    };
    REQUIRE(with("in SI units") == "accepted");
    REQUIRE(with("a unit cell") == "accepted");
    for (std::string const bad : {"real", "metal", "electron", "mm"})
        REQUIRE(with("t, units = " + bad) == "f:1: units = \"" + bad + "\": must be si, cgs, micro or nano");
    REQUIRE(with("t, units = si\n# units = cgs") == "f:2: units = cgs: must be those named above, si");
}

TEST_CASE("a periodic LAMMPS box: image flags, bonds through its sides, its period", "[files]") {
    std::string const through =
        "f:19: Bonds = 3 1: must be a pair that is nearest within the box: through its sides they are 1 m apart, "
        "within it 2 m; such a box is periodic, but is read as non-periodic";
    REQUIRE(why([&] { parse_lammps_data<3>(ring(""), "f"); }) == through);
    REQUIRE(why([&] { parse_lammps_data<2>(ring(" 0 0 0"), "f"); }) == through);
    auto const closed = parse_lammps_data<2>(ring(""), "f", {true, false});
    REQUIRE(closed.packing.period[0] == 3);
    REQUIRE(closed.packing.period[1] == 0);
    REQUIRE(closed.packing.bonds.size() == 3);
    REQUIRE(parse_lammps_data<3>(ring(" -2 0 0"), "f", {true, false, false}).packing.position[2][0] == -3.5);
    auto const micro = parse_lammps_data<2>(replaced(ring(" 1 0 0"), "ring", "units = micro"), "f", {true, false});
    REQUIRE(micro.packing.period[0] == 3e-6);
    REQUIRE(micro.packing.position[2][0] == 5.5e-6);
    REQUIRE(why([] { parse_lammps_data<2>(replaced(ring(""), "0 3 xlo xhi\n", ""), "f", {true, false}); }) ==
            "f:10: xlo xhi = (missing): must be given in the header: along this axis the box is periodic");
    REQUIRE(why([] {
                parse_lammps_data<2>(ring(" 0 1 0"), "f", {true, false});
            }) == "f:13: image flag = 1: must be 0: the box is read as non-periodic along y; reading it as periodic "
                  "unwraps positions");
    REQUIRE(why([] {
                parse_lammps_data<2>(ring(" 0 0 1"), "f", {true, true});
            }) == "f:13: image flag = 1: must be 0 in the plane");

    // In a box just large enough for the centres of two touching spheres, a bond does not cross its sides.
    std::string const tight = data_file("tight", "2 atoms\n1 bonds\n0 1 xlo xhi\n0 0.1 ylo yhi\n0 0.1 zlo zhi\n",
                                        "1 1 1 1 0 0 0\n2 1 1 1 1 0 0\n", "\nBonds\n\n1 1 1 2\n");
    REQUIRE(parse_lammps_data<3>(tight, "f").packing.bonds.size() == 1);
    // Bounds may have fewer digits than positions.
    REQUIRE(parse_lammps_data<3>(replaced(tight, "2 1 1 1 1 0", "2 1 1 1 1.000001 0"), "f").size() == 2);
    REQUIRE(why([&] { parse_lammps_data<3>(replaced(tight, "2 1 1 1 1 0", "2 1 1 1 1.001 0"), "f"); }) ==
            "f:12: position = 1.001: must be within the box, from 0 to 1 along x");
}

TEST_CASE("types of bonds are read, and give each bond the values of its type", "[files]") {
    std::string const text = data_file("t", "3 atoms\n2 bonds\n1 atom types\n4 bond types\n",
                                       "1 1 1 1 0 0 0\n2 1 1 1 1 0 0\n3 1 1 1 2 0 0\n",
                                       "\nBond Type Labels\n\n4 glue\n\nBonds\n\n1 glue 3 2\n2 2 1 2\n");
    auto const list = parse_lammps_data<2>(text, "f");
    REQUIRE(list.packing.bond_type == std::vector<int>{3, 1});
    REQUIRE(lacuna::by_bond_type(list.packing, std::vector<char>{'a', 'b', 'c', 'd'}) == std::vector<char>{'d', 'b'});
    REQUIRE(why([&] {
                lacuna::by_bond_type(list.packing, std::vector<char>{'a', 'b'});
            }) == "packing.bond_type = 3: must be from 0 to 1");
    REQUIRE(why([&] { parse_lammps_data<2>(replaced(text, "2 2 1 2", "1 2 1 2"), "f"); }) ==
            "f:21: id = 1: must be given once");
}

TEST_CASE("lines of a LAMMPS header that are wrong, or have no meaning for spheres", "[files]") {
    auto const with = [](std::string const& line) {
        return why([&] { parse_lammps_data<3>(data_file("t", "1 atoms\n" + line + "\n", "1 1 1 1 0 0 0\n"), "f"); });
    };
    for (std::string const line :
         {"0 bonds", "0 angles", "3 angle types", "0 0 0 xy xz yz", "1 atom types # grains", "", "# one"})
        REQUIRE(with(line) == "accepted");
    REQUIRE(with("2 atoms") == "f:4 = \"atoms\": must be given once");
    REQUIRE(with("2 angles") == "f:4: angles = 2: must be 0: particles here are spheres with bonds");
    REQUIRE(with("2 bodies") == "f:4: bodies = 2: must be 0: particles here are spheres with bonds");
    REQUIRE(with("2 atom type") ==
            "f:4 = \"atom type\": must be a line of a header, such as \"12 atoms\" (did you mean \"atom types\"?)");
    REQUIRE(with("1 0 0 avec") == "f:4 = \"avec\": must be xlo xhi and so on: boxes here have right angles");
    REQUIRE(with("1 -1 xlo xhi") == "f:4: xlo xhi = 1 -1: must be a lower and a higher bound");
    REQUIRE(with("1 xlo xhi") == "f:4: xlo xhi = 1 numbers: must be 2");
    REQUIRE(with("1 x xlo xhi") == "f:4 = \"x xlo xhi\": must be a line of a header, such as \"12 atoms\"");
    REQUIRE(why([] { parse_lammps_data<3>("t\n\n0 atoms\n", "f"); }) == "f: atoms = 0: must be at least 1");
    REQUIRE(why([] { parse_lammps_data<3>(data_file("t", "2 atoms\n", "1 1 1 1 0 0 0\n2 1 2 1 0 0 0\n"), "f"); }) ==
            "f:8: position = that of line 7: must be another: two particles cannot have the same position");
    REQUIRE(why([] {
                parse_lammps_data<3>(data_file("t", "1 atoms\n", "1 1 1 1 0 0 0\n", "\nMasses\n\n1 0\n"), "f");
            }) == "f:11: mass = 0: must be > 0");
}

TEST_CASE("columns of other programs, by any of their usual names", "[files]") {
    auto const check = [](lacuna::particle_list<3> const& list) {
        REQUIRE(list.size() == 1);
        for (int axis = 0; axis < 3; ++axis) {
            REQUIRE(list.packing.position[0][axis] == axis + 1);
            REQUIRE(list.velocity[0][axis] == axis + 4);
            REQUIRE(list.spin[0][axis] == axis + 7);
        }
        REQUIRE(list.packing.radius[0] == 0.25);
        REQUIRE(list.packing.material[0] == 3);
        REQUIRE(list.packing.density == std::vector<double>{1200});
    };
    for (std::string const heading :
         {"x,y,z,vx,vy,vz,wx,wy,wz,r,matId,rho",
          "Points:0,Points:1,Points:2,velocity:0,velocity:1,velocity:2,spin:0,spin:1,spin:2,radius,material,density",
          "\"Points_0\",\"Points_1\",\"Points_2\",\"vel_x\",\"vel_y\",\"vel_z\",\"omega_0\",\"omega_1\",\"omega_2\","
          "\"Radius\",\"mat\",\"DENSITY\"",
          "pos x [m],pos y [m],pos z (m),v.x [m/s],v.y,v.z,spin.x [rad/s],spin.y,spin.z (1/s),rad (m),material "
          "[-],density [kg/m\u00b3]"}) {
        INFO(heading);
        check(parse_particle_csv<3>(heading + "\n1,2,3,4,5,6,7,8,9,0.25,3,1200\n", "f"));
        check(parse_particle_csv<3>(
            "# " + heading + "\r\n\r\n# more\r\n1,2,3,4,5,6,7,8,9,0.25,3,1200\r\n,,,,,,,,,,,\r\n", "f"));
    }
    check(parse_particle_csv<3>("x;y;z;vx;vy;vz;wx;wy;wz;d;mat;rho\n1;2;3;4;5;6;7;8;9;0,5;3;1200,0\n", "f"));
    REQUIRE(parse_particle_csv<3>("#format x_y_z_r_matId\n1\t2\t3\t0.5\t4\n", "f").packing.material[0] == 4);
    REQUIRE(parse_particle_csv<3>("# made by hand\n# x y z r\n1   2 3\t0.5\n", "f").packing.position[0][2] == 3);
    auto const plane = parse_particle_csv<2>("x,y,z,vz,spin.x,spin.z,r\n1,2,0,0,0,7,0.5\n", "f");
    REQUIRE(plane.spin[0][0] == 7);
    REQUIRE(why([] { parse_particle_csv<2>("x,y,z,r\n1,2,-3,1\n", "f"); }) ==
            "f:2: position.z = -3: must be 0 in the plane");
    REQUIRE(why([] { parse_particle_csv<2>("x,y,vz,r\n1,2,3,1\n", "f"); }) ==
            "f:2: velocity.z = 3: must be 0 in the plane");
    REQUIRE(parse_particle_csv<2>("x,y,r\n0,0,1\n", "f", {"bone"}).packing.material[0] == 0);
}

TEST_CASE("ambiguous CSV files are refused", "[files]") {
    for (auto const& [text, message] :
         {std::pair<std::string, std::string>{"radius [mm],x,y\n1,0,0\n", "f:1 = \"radius [mm]\": must be in m"},
          {"radius,x,y,vx (km/h)\n1,0,0,1\n", "f:1 = \"vx (km/h)\": must be in m/s"},
          {"r;x;y\n1,000;0;0\n",
           "f:2 = \"1,000\": must be a number without a comma, which may be a decimal comma or separate thousands"},
          {"r;x;y\n1,5;0.5;0\n", "f:2: radius = \"1,5\": must be a number with a decimal point, without commas"},
          {"r;x;y\n1.000,5;0;0\n", "f:2: radius = \"1.000,5\": must be a number with a decimal point, without commas"},
          {"r;x;y\n1,5;1,000,000;0\n",
           "f:2: position.x = \"1,000,000\": must be a number with a decimal point, without commas"},
          {"r,x,y\n0,5,1,5,2,5\n",
           "f:2 = 6 cells: must be as many as the heading has, 3; decimal commas need cells in quotes"},
          {"r,x,y\n1;0;0\n", "f:2 = 1 cells: must be as many as the heading has, 3, separated by commas as there"},
          {"0,0,0,1\n", "f:1 = \"0,0,0,1\": must be a heading that names the columns, such as \"x,y,z,r\""},
          {"# my packing\n0 0 1\n", "f:2 = \"0 0 1\": must be a heading that names the columns, such as \"x,y,z,r\""},
          {"r,d,x,y\n1,2,0,0\n", "f:1 = \"d\": must be a column that is given once"},
          {"x,position.x,y,r\n1,1,0,1\n", "f:1 = \"position.x\": must be a column that is given once"},
          {"r,x,y\n1,\"0\"5,0\n", "f:2 = \"\"0\"5,0\": must be a cell that ends with its quotes"},
          {"r,x,y,rho\n1,0,0,0\n", "f:2: density = 0: must be > 0"},
          {"r,x,y,material\n1,0,0,0\n2,0,0,0\n",
           "f:3: position = that of line 2: must be another: two particles cannot have the same position"}})
        REQUIRE(why([&, &text = text] { parse_particle_csv<2>(text, "f"); }) == message);
    REQUIRE(why([] { parse_particle_csv<2>("r,x,y\n1,0,0\n", "f", {"bone", "gut"}); }) ==
            "f:1: material = (missing): must be given: there are 2 materials");
    REQUIRE(parse_particle_csv<2>("r;x;y\n1,000;0,5;0\n", "f").packing.radius[0] == 1); // the second cell decides
}

TEST_CASE("densities are written to CSV and come back", "[files]") {
    lacuna::particle_list<2> list;
    list.add({0.1, 0.2}, 0.3, 1);
    list.packing.density = {1 / 3.0};
    auto const back = parse_particle_csv<2>(lacuna::particle_csv(list), "f");
    REQUIRE(back.packing.density == list.packing.density);
    REQUIRE(back.density == list.packing.density);
}
