// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>

#include "catch.hpp"
#include "scenario/program.hpp"

#include "scenario.hpp"

using program::folder;

namespace {

/// A small, quick scenario with all sections.
std::string const whole = R"([simulation]
dimension = 2
real = "double"
thickness = 1.0
mass = "disc"
contact_law = "frictional_spring"
bond_law = "brittle_spring"
integrator = "symplectic_euler"
time_step = "auto"
safety = 0.2
allow_unstable_step = false
steps = 20
gravity = [0.0, 0.0]
threads = 1
damping = { local = 0.0, mass = 0.0, viscous = 0.0 }

[materials.matrix]
density = 1000.0
normal_stiffness = 1e6
shear_stiffness = 1e6
friction = 0.1
tensile_strength = 1e300
shear_strength = 1e300

[particles]
position = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.9]]
radius = 0.5
material = "matrix"
velocity = [[0.0, 0.0], [0.0, 0.0], [0.0, 0.0]]
spin = [0.0, 0.0, 0.0]
fix = [ { particles = [0], axes = "xyr" } ]

[bonds]
pairs = [[0, 1]]

[[walls]]
point = [0.0, -0.5]
normal = [0.0, 1.0]
normal_stiffness = 1e6
shear_stiffness = 1e6
friction = 0.1

[[loads]]
particles = [1]
force = [10.0, 0.0]
ramp_time = 0.0
[[loads]]
pressure = 10
margin_diameters = 0

[fluid]
bulk_modulus = 2.2e6
conductivity = 1e-9
aperture = { law = "contact_force", a0 = 1e-7, F0 = 1.0, gap_multiplier = 1.0 }
solver = "explicit"
time_step = "auto"
initial_pressure = 0.0
boundary = "sealed"
reservoirs = []
sources = [ { near = [0.5, 0.5], flow = 0.0 } ]
mechanical_coupling = true

[[probes]]
quantity = "position.x"
particle = 1
every = 10

[output]
directory = "out"
vtk_every = 0
picture_every = 0
checkpoint_every = 0
)";

/// The scenario with `old` replaced.
std::string with(std::string const& old, std::string const& replacement) {
    auto const at = whole.find(old);
    REQUIRE(at != std::string::npos);
    std::string text = whole;
    return text.replace(at, old.size(), replacement);
}

std::string refusal(std::string const& text) {
    try {
        lacuna_run::read_scenario(text, "case.toml", "");
    } catch (lacuna_run::refusal const& bad) {
        return bad.what();
    }
    return "accepted";
}

} // namespace

TEST_CASE("a scenario with all sections is accepted", "[refusal]") {
    REQUIRE(refusal(whole) == "accepted");
    auto const s = lacuna_run::read_scenario(whole, "case.toml", "");
    REQUIRE(s.particles.size() == 3);
    REQUIRE(s.bonds.pairs.size() == 1);
    REQUIRE(s.loads.size() == 2);
    REQUIRE(s.fluid->sources.size() == 1);
    REQUIRE(s.probes[0].column == "position.x[1]");
}

namespace {

struct bad_value {
    std::string old, replacement, message;
};

bad_value const bad_values[] = {
    // unknown keys, with the nearest known one
    {"density = 1000.0", "densty = 1000.0",
     "materials.matrix.densty = 1000: must be a known key (did you mean \"density\"?)"},
    {"safety = 0.2", "savety = 0.2", "simulation.savety = 0.2: must be a known key (did you mean \"safety\"?)"},
    {"[output]", "[outputs]", "outputs = {...}: must be a known key (did you mean \"output\"?)"},
    {"ramp_time = 0.0", "qqqqqq = 0.0", "loads[0].qqqqqq = 0: must be a known key"},
    {"quantity = \"position.x\"", "quantity = \"positon.x\"",
     "probes[0].quantity = \"positon.x\": must be a known quantity (did you mean \"position.x\"?)"},
    // missing keys
    {"density = 1000.0\n", "", "materials.matrix.density = (missing): must be given"},
    {"steps = 20\n", "", "simulation.steps = (missing): must be given"},
    {"radius = 0.5\n", "", "particles.radius = (missing): must be given"},
    {"bulk_modulus = 2.2e6\n", "", "fluid.bulk_modulus = (missing): must be given"},
    {"normal = [0.0, 1.0]\n", "", "walls[0].normal = (missing): must be given"},
    {"particle = 1\n", "", "probes[0].particle = (missing): must be given"},
    {"force = [10.0, 0.0]\n", "", "loads[0].force = (missing): must be given"},
    // wrong types
    {"density = 1000.0", "density = \"heavy\"", "materials.matrix.density = \"heavy\": must be a number"},
    {"steps = 20", "steps = 20.5", "simulation.steps = 20.5: must be a whole number"},
    {"allow_unstable_step = false", "allow_unstable_step = 0",
     "simulation.allow_unstable_step = 0: must be true or false"},
    {"pairs = [[0, 1]]", "pairs = 3", "bonds.pairs = 3: must be a list"},
    {"real = \"double\"", "real = 64", "simulation.real = 64: must be one of \"double\", \"float\""},
    {"spin = [0.0, 0.0, 0.0]", "spin = [[0.0], 0.0, 0.0]", "particles.spin[0] = [...]: must be a number"},
    {"damping = { local = 0.0, mass = 0.0, viscous = 0.0 }", "damping = 0.1",
     "simulation.damping = 0.1: must be a table"},
    {"directory = \"out\"", "directory = 1", "output.directory = 1: must be a string"},
    // out of range
    {"density = 1000.0", "density = -1", "materials.matrix.density = -1: must be > 0"},
    {"density = 1000.0", "density = nan", "materials.matrix.density = nan: must be finite"},
    {"density = 1000.0", "density = inf", "materials.matrix.density = inf: must be finite"},
    {"friction = 0.1", "friction = -0.1", "materials.matrix.friction = -0.1: must be >= 0"},
    {"dimension = 2", "dimension = 4", "simulation.dimension = 4: must be 2 or 3"},
    {"dimension = 2", "dimension = -1e308", "simulation.dimension = -1e+308: must be a whole number"},
    {"density = 1000.0", "density = 5e-324", "materials.matrix.density = 4.94066e-324: must be at least 1e-300"},
    {"thickness = 1.0", "thickness = 0.0", "simulation.thickness = 0: must be > 0"},
    {"time_step = \"auto\"", "time_step = \"fast\"",
     "simulation.time_step = \"fast\": must be \"auto\" or a number of seconds"},
    {"time_step = \"auto\"", "time_step = -1", "simulation.time_step = -1: must be > 0"},
    {"safety = 0.2", "safety = 1.5", "simulation.safety = 1.5: must be > 0 and <= 1"},
    {"threads = 1", "threads = 0", "simulation.threads = 0: must be from 1 to 1024"},
    {"local = 0.0", "local = 1.5", "simulation.damping.local = 1.5: must be from 0 to 1"},
    {"steps = 20", "steps = 20\nend_time = 1.0", "simulation.end_time = 1: must be left out: steps is given"},
    {"contact_law = \"frictional_spring\"", "contact_law = \"sticky\"",
     "simulation.contact_law = \"sticky\": must be one of \"none\", \"frictional_spring\", \"hertz_mindlin\""},
    {"gravity = [0.0, 0.0]", "gravity = [0.0, -1.0]\nfluid_density = -1",
     "simulation.fluid_density = -1: must be >= 0"},
    {"gravity = [0.0, 0.0]", "gravity = [0.0]", "simulation.gravity = [...]: must be a list of 2 numbers"},
    {"radius = 0.5", "radius = [0.5, 0.5]", "particles.radius = [...]: must be one value or one per particle"},
    {"radius = 0.5", "radius = [0.5, 0.5, 0.0]", "particles.radius[2] = 0: must be > 0"},
    {"material = \"matrix\"", "material = \"matrx\"",
     "particles.material = \"matrx\": must be the name of a material (did you mean \"matrix\"?)"},
    {"axes = \"xyr\"", "axes = \"xq\"", "particles.fix[0].axes = \"xq\": must be some of the letters x, y, r"},
    {"axes = \"xyr\"", "axes = \"xx\"", "particles.fix[0].axes = \"xx\": must be"},
    {"normal = [0.0, 1.0]", "normal = [0.0, 0.0]", "walls[0].normal = [...]: must be a vector of finite length > 0"},
    {"aperture = { law = \"contact_force\", a0 = 1e-7, F0 = 1.0, gap_multiplier = 1.0 }",
     "aperture = { law = \"contact_force\", a0 = 1e-7, F0 = 0.0 }", "fluid.aperture.F0 = 0: must be > 0"},
    {"gap_multiplier = 1.0", "gap_multiplier = 2.0", "fluid.aperture.gap_multiplier = 2: must be from 0 to 1"},
    {"every = 10", "every = 0", "probes[0].every = 0: must be from 1 to 1e15 steps"},
    {"vtk_every = 0", "vtk_every = -1", "output.vtk_every = -1: must be from 0"},
    // indices
    {"pairs = [[0, 1]]", "pairs = [[0, 3]]", "bonds.pairs[0][1] = 3: must be from 0 to 2, the last of the particles"},
    {"pairs = [[0, 1]]", "pairs = [[0, -1]]", "bonds.pairs[0][1] = -1: must be from 0 to 2"},
    {"pairs = [[0, 1]]", "pairs = [[1, 1]]", "bonds.pairs[0] = [...]: must be two different particles"},
    {"pairs = [[0, 1]]", "pairs = [[0, 1], [1, 0]]",
     "bonds.pairs[1] = [...]: must be a pair that was not listed before"},
    {"particles = [1]", "particles = [7]", "loads[0].particles[0] = 7: must be from 0 to 2"},
    {"fix = [ { particles = [0]", "fix = [ { particles = [9]",
     "particles.fix[0].particles[0] = 9: must be from 0 to 2"},
    {"particle = 1\n", "particle = 3\n", "probes[0].particle = 3: must be from 0 to 2"},
    {"quantity = \"position.x\"\nparticle = 1", "quantity = \"bond.broken\"\nbond = 1",
     "probes[0].bond = 1: must be from 0 to 0, the last of the bonds"},
    {"quantity = \"position.x\"\nparticle = 1", "quantity = \"wall.force.x\"\nwall = 2",
     "probes[0].wall = 2: must be from 0 to 0"},
    // keys that exclude each other
    {"quantity = \"position.x\"\nparticle = 1", "quantity = \"energy.kinetic\"\nparticle = 1",
     "probes[0].particle = 1: must be left out"},
    {"quantity = \"position.x\"", "quantity = \"position.z\"",
     "probes[0].quantity = \"position.z\": must be a known quantity"},
    {"pairs = [[0, 1]]", "pairs = [[0, 1]]\nbending_stiffness = 1.0", "bonds.bending_stiffness = 1: must be left out"},
    {"pairs = [[0, 1]]", "pairs = [[0, 1]]\nshear_stiffness = [1.0, 2.0]",
     "bonds.shear_stiffness = [...]: must be one value or one per bond"},
    {"pairs = [[0, 1]]", "pairs = [[0, 1]]\ntensile_force = 1.0",
     "materials.matrix.tensile_strength = 1e+300: must be left out: no bond uses it"},
    {"time_step = \"auto\"", "time_step = 1e-9", "simulation.safety = 0.2: must be left out: time_step is given"},
    {"gravity = [0.0, 0.0]", "gravity = [0.0, 0.0]\nfluid_density = 1.0",
     "simulation.fluid_density = 1: must be left out: there is no gravity"},
    {"mechanical_coupling = true", "mechanical_coupling = false",
     "must be left out: fluid.mechanical_coupling is false: particles do not move"},
    {"solver = \"explicit\"", "solver = \"implicit\"\nminimum_pressure = 0.0",
     "fluid.minimum_pressure = 0: must be left out: solver is \"implicit\""},
    {"solver = \"explicit\"", "minimum_pressure = 1.0", "fluid.minimum_pressure = 1: must be <= 0"},
    {"initial_pressure = 0.0", "initial_pressure = -5.0\nminimum_pressure = -1.0",
     "fluid.initial_pressure = -5: must be >= fluid.minimum_pressure, -1"},
    {"force = [10.0, 0.0]", "velocity = [10.0, 0.0]\n[[loads]]\nparticles = [0]\nvelocity = [1.0, 0.0]",
     "particles.fix[0].axes = particle 0: must be \"r\" or left out: loads[1].velocity moves it"},
    {"pairs = [[0, 1]]", "touching = true", "bonds.gap = (missing): must be given"},
    {"bond_law = \"brittle_spring\"", "bond_law = \"none\"", "bonds = {...}: must be left out: bond_law is \"none\""},
    {"contact_law = \"frictional_spring\"", "contact_law = \"none\"",
     "walls[0] = {...}: must be left out: contact_law is \"none\""},
    {"density = 1000.0", "density = 1000.0\nyoung_modulus = 1e9",
     "materials.matrix.young_modulus = 1e+09: must be left out"},
    {"boundary = \"sealed\"", "boundary = \"sealed\"\nboundary_pressure = 1.0",
     "fluid.boundary_pressure = 1: must be left out"},
    {"force = [10.0, 0.0]", "force = [10.0, 0.0]\nvelocity = [1.0, 0.0]",
     "loads[0].force = [...]: must be left out: velocity is given"},
};

} // namespace

TEST_CASE("each bad value is refused by its path", "[refusal]") {
    for (auto const& c : bad_values) {
        INFO(c.old << " -> " << c.replacement);
        REQUIRE_THAT(refusal(with(c.old, c.replacement)), contains_text(c.message));
    }
    REQUIRE_THAT(refusal("simulation = [\n"), contains_text("case.toml:"));
    // Non-ASCII letters where a blank would be allowed.
    for (char const* letter : {"\u00e9", "\u0498", "\u3042"})
        for (char const* before : {"", "steps = 1", "steps ", "[simulation]", "a = [1, "})
            REQUIRE_THAT(refusal(std::string(before) + letter + " = 1\n"), contains_text("case.toml:1:"));
    REQUIRE_THAT(refusal(""), contains_text("simulation = (missing): must be given"));
    REQUIRE_THAT(refusal(with("dimension = 2", "dimension = 3")), contains_text("simulation.thickness"));
}

TEST_CASE("a refused scenario leaves one line, status 2 and no file", "[refusal][program]") {
    folder const here("refused");
    auto const refused = [&](std::string const& text, std::string const& message, std::string const& options = "") {
        here.write("case.toml", text);
        auto const ran = here.run(options + " case.toml");
        INFO(ran.err);
        REQUIRE(ran.status == 2);
        REQUIRE_THAT(ran.err, contains_text(message));
        REQUIRE(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
        REQUIRE(ran.out.empty());
        REQUIRE(here.files() == std::vector<std::string>{"case.toml"});
    };
    refused(with("density = 1000.0", "density = -1"), "materials.matrix.density = -1: must be > 0");
    refused(with("density = 1000.0", "density = -1"), "materials.matrix.density = -1: must be > 0", "--check");
    refused(with("time_step = \"auto\"\nsafety = 0.2", "time_step = 1.0"),
            "simulation.time_step = 1: must be at most the stable limit");
    refused(with("sources = [ { near = [0.5, 0.5], flow = 0.0 } ]", "sources = [ { pore = 7, flow = 0.0 } ]"),
            "fluid.sources[0].pore = 7: must be from 0 to 0, the last of the pores");
    refused(with("margin_diameters = 0", "margin_diameters = 9"), "loads[1].margin_diameters = 9: must be");
    refused(with("dimension = 2", "dimension = \"two\n"), "case.toml:2:");
    refused(with("directory = \"out\"", "directory = \"case.toml/out\""), "output.directory");
    auto const no_file = here.run("nothing.toml");
    REQUIRE(no_file.status == 2);
    REQUIRE_THAT(no_file.err, contains_text("nothing.toml: cannot be read"));
    REQUIRE(here.run("").status == 2);
    REQUIRE(here.run("--chek case.toml").status == 2);
    auto const help = here.run("--help");
    REQUIRE(help.status == 0);
    for (char const* word : {"merge_conductance", "--restart", "--check", "bond.normal_force", "margin_diameters"})
        REQUIRE_THAT(help.out, contains_text(word));
}

TEST_CASE("checking writes nothing, running writes three files", "[program]") {
    folder const here("whole");
    here.write("case.toml", whole);
    auto const check = here.run("--check case.toml");
    INFO(check.err);
    REQUIRE(check.status == 0);
    REQUIRE(here.files() == std::vector<std::string>{"case.toml"});
    auto const ran = here.run("case.toml");
    REQUIRE(ran.status == 0);
    REQUIRE(here.files() ==
            std::vector<std::string>{"case.toml", "out/events.csv", "out/probes.csv", "out/summary.json"});
    program::table const probes(here / "out/probes.csv");
    REQUIRE(probes.heading == std::vector<std::string>{"step", "time", "position.x[1]"});
    REQUIRE(probes.column("step") == std::vector<double>{0, 10, 20});
    auto const summary = nlohmann::json::parse(program::read_file(here / "out/summary.json"));
    REQUIRE(summary.at("steps") == 20);
    REQUIRE(summary.at("ended") == "steps");
    REQUIRE(summary.at("pores").size() == 1);
    REQUIRE(std::fabs(summary.at("energy").at("residual").get<double>()) < 1e-9);
}

TEST_CASE("particles from a file", "[program]") {
    folder const here("particle_file");
    std::string text = whole;
    auto const from = text.find("position = "), to = text.find("fix = ");
    text.replace(from, to - from, "file = \"particles.csv\"\n");
    here.write("case.toml", text);
    std::string const good =
        "radius,material,position.x,position.y,spin\n0.5,matrix,0,0,0\n0.5,matrix,1,0,0\n0.5,matrix,0.5,0.9,0\n";
    here.write("particles.csv", good);
    REQUIRE(here.run("--quiet case.toml").status == 0);
    program::table const probes(here / "out/probes.csv");
    folder const other("particle_list");
    other.write("case.toml", whole);
    REQUIRE(other.run("--quiet case.toml").status == 0);
    REQUIRE(probes.rows == program::table(other / "out/probes.csv").rows);
    // With decimal commas, as spreadsheets write them, and with densities that replace the materials'.
    auto const rows_of = [&](std::string const& name, std::string const& particles) {
        folder const there(name);
        there.write("case.toml", text);
        there.write("particles.csv", particles);
        REQUIRE(there.run("--quiet case.toml").status == 0);
        return program::table(there / "out/probes.csv").rows;
    };
    REQUIRE(rows_of("particle_file_commas",
                    "\xEF\xBB\xBFX;Y;R;material\r\n0,0;0;0,5;matrix\r\n1;0;0,5;matrix\r\n0,5;0,9;0,5;matrix\r\n") ==
            probes.rows);
    std::string const heavy =
        "x,y,r,material,density\n0,0,0.5,matrix,4000\n1,0,0.5,matrix,4000\n0.5,0.9,0.5,matrix,4000\n";
    auto const of_file = rows_of("particle_file_dense", heavy);
    REQUIRE(of_file != probes.rows);
    auto const density = text.find("density = 1000.0");
    REQUIRE(density != std::string::npos);
    text.replace(density, 16, "density = 4000.0");
    REQUIRE(rows_of("particle_file_heavy", good) == of_file);
    for (auto const& [bad, message] :
         {std::pair<std::string, std::string>{"radius,material,position.x\n",
                                              "particles.file:1: position.y = (missing): must be given"},
          {"radius,material,position.x,positon.y\n",
           "particles.file:1 = \"positon.y\": must be a known column (did you mean \"position.y\"?)"},
          {"radius,material,position.x,position.y\n0.5,matrix,0,zero\n",
           "particles.file:2: position.y = \"zero\": must be a number"},
          {"radius,material,position.x,position.y\n-1,matrix,0,0\n", "particles.file:2: radius = -1: must be > 0"},
          {"radius,material,position.x,position.y\n0.5,bone,0,0\n",
           "particles.file:2: material = \"bone\": must be the name of a material"},
          {"radius,material,position.x,position.y\n0.5,matrix,0\n",
           "particles.file:2 = 3 cells: must be as many as the heading has, 4"}}) {
        here.write("particles.csv", bad);
        auto const ran = here.run("--check case.toml");
        REQUIRE(ran.status == 2);
        REQUIRE_THAT(ran.err, contains_text(message));
    }
}
