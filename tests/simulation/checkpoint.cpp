// SPDX-License-Identifier: BSD-3-Clause

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include <lacuna/observe/crack_record.hpp>
#include <lacuna/observe/vtk_series.hpp>
#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"
#include "simulation/specimens.hpp"

using namespace setups;

namespace {

using cracks_2d = lacuna::crack_record<lacuna::break_event<2>>;

struct energy_watch {
    static constexpr lacuna::stage stages = lacuna::stage::end;
    static constexpr bool needs_energy = true;
    template <class Simulation>
    void on_end(Simulation const&) {}
};
/// A file that is removed at the end of the test.
struct scratch_file {
    explicit scratch_file(std::string name) : path("checkpoint_" + std::move(name) + ".bin") {}
    ~scratch_file() { std::remove(path.c_str()); }
    std::string path;
};

std::string read_all(std::string const& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
void write_all(std::string const& path, std::string const& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

std::string why(auto const& load) {
    try {
        load();
    } catch (lacuna::checkpoint_error const& e) {
        return e.what();
    }
    return "accepted";
}

struct space_viscous_in_single : lacuna::default_model<3, float> {
    using damping = lacuna::viscous_damping;
};

/// Discs or spheres with random velocities between a rising floor and a ceiling under constant stress, half of them
/// bonded. Some loads still rise, one is constant.
template <class Model>
lacuna::simulation<Model> moving_crowd(int threads = 1) {
    constexpr int dim = Model::dim;
    using real = typename Model::real;
    lacuna::packing<real, dim> packing;
    auto const noise = [](std::size_t k, int salt) { return std::sin(12.9898 * double(k) + 78.233 * salt); };
    int const layers = dim == 3 ? 6 : 1;
    for (int z = 0; z < layers; ++z)
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 12; ++x) {
                auto const k = packing.size();
                lacuna::vec<real, dim> at{};
                int const cell[3] = {x, y, z};
                for (int axis = 0; axis < dim; ++axis) at[axis] = real(cell[axis] + 0.02 * noise(k, axis));
                packing.add(at, real(0.49 + 0.02 * noise(k, 3)));
                if (x > 0 && noise(k, 4) > -0.3) packing.bonds.push_back({std::int32_t(k) - 1, std::int32_t(k)});
            }
    auto p = springs<Model>(100, 70, 0.4, unit_density(dim), 1.0, 1.0);
    p.time_step = 5e-3;
    p.threads = threads;
    p.interactions.initial_contact_tolerance = 0.02;
    p.interactions.skin = 0.05;
    p.mass = dim == 2 ? lacuna::mass_model::disc : lacuna::mass_model::sphere;
    lacuna::vec<double, dim> floor{}, up{};
    floor[1] = -0.6;
    up[1] = 1;
    lacuna::vec<double, dim> ceiling{};
    ceiling[1] = 5.7;
    p.walls = {{floor, up, p.materials[0].contact}, {ceiling, -up, p.materials[0].contact}};
    p.gravity[1] = -0.5;
    lacuna::simulation<Model> run(packing, p);
    run.fix(7);
    run.move_wall(0, up * 0.1, 0.4);
    lacuna::wall_servo<dim> servo;
    servo.stress = 0.5;
    servo.area = 12;
    servo.max_speed = 0.2;
    run.servo_wall(1, servo);
    for (std::size_t k = 0; k < run.size(); ++k) {
        lacuna::vec<double, dim> v{};
        for (int axis = 0; axis < dim; ++axis) v[axis] = 0.4 * noise(k, 6 + axis);
        run.set_velocity(k, v);
        lacuna::vec<double, dim> push{};
        push[0] = 0.1;
        lacuna::vec<double, lacuna::rotation_dim<dim>> turn{};
        turn[0] = 0.01;
        if (k % 5 == 0) run.apply(k, push, turn, 0.4);
    }
    return run;
}

template <class Model>
void check_resumed() {
    constexpr int dim = Model::dim;
    using record = lacuna::crack_record<lacuna::break_event<dim>>;
    scratch_file const file("lively" + std::to_string(dim));
    auto whole = moving_crowd<Model>();
    record all;
    whole.run(120, all, energy_watch{});
    REQUIRE(all.events().size() > 5);
    REQUIRE(whole.pairs().neighbors().build_count() > 3);
    for (long long const at : {0, 1, 50, 119}) {
        auto first = moving_crowd<Model>();
        record seen;
        if (at > 0) first.run(120, seen, energy_watch{}, stop_after{at});
        if (at == 50) first.set_velocity(3, first.velocity(3)); // pending at the moment of saving
        lacuna::save_checkpoint(file.path, first, seen);
        auto second = moving_crowd<Model>(at == 1 && dim == 2 ? 2 : 1);
        record resumed;
        lacuna::load_checkpoint(file.path, second, resumed);
        REQUIRE(lacuna::state_hash(second) == lacuna::state_hash(first));
        REQUIRE(second.steps() == at);
        second.run(120 - at, resumed, energy_watch{});
        if (at == 50) {
            first.run(120 - at, seen, energy_watch{});
            REQUIRE(lacuna::state_hash(second) == lacuna::state_hash(first));
        } else {
            REQUIRE(lacuna::state_hash(second) == lacuna::state_hash(whole));
        }
        REQUIRE(resumed.events().size() == all.events().size());
        REQUIRE(second.energy().residual() == whole.energy().residual());
    }
}

} // namespace

TEST_CASE("a resumed run has the bits of the uninterrupted run", "[checkpoint]") {
    check_resumed<plane>();
    check_resumed<space>();
    check_resumed<space_viscous_in_single>();
}

namespace {

template <class Model>
void check_coupled(std::string const& name) {
    scratch_file const file(name);
    auto const s = specimens::small();
    auto whole = specimens::make<Model>(s);
    cracks_2d all;
    whole.run(1200, all, energy_watch{});
    REQUIRE(all.events().size() > 10);
    REQUIRE(whole.pairs().neighbors().build_count() > 3);
    double flowed = 0;
    for (double const q : whole.flow().network().flow) flowed = std::max(flowed, std::fabs(q));
    REQUIRE(flowed > 0);
    // Right after a bond broke and before its hand-over; right before it broke; in between; at the ends.
    auto const broke = all.events()[all.events().size() / 2].step + 1;
    for (long long const at : {1LL, broke - 1, broke, 900LL, 1199LL}) {
        auto first = specimens::make<Model>(s, at == 1 ? 2 : 1);
        cracks_2d seen;
        first.run(1200, seen, energy_watch{}, lacuna::checkpoint_every(at, file.path, seen), stop_after{at});
        auto second = specimens::make<Model>(s);
        cracks_2d resumed;
        lacuna::load_checkpoint(file.path, second, resumed);
        REQUIRE(second.steps() == at);
        second.run(1200 - at, resumed, energy_watch{});
        REQUIRE(lacuna::state_hash(second) == lacuna::state_hash(whole));
        REQUIRE(resumed.events().size() == all.events().size());
        REQUIRE(second.energy().residual() == whole.energy().residual());
    }
}

struct wet_implicitly : specimens::wet {
    using flow = lacuna::implicit_flow;
};

} // namespace

TEST_CASE("a resumed coupled run has the bits of the uninterrupted run", "[checkpoint][cartilage]") {
    check_coupled<specimens::wet>("coupled");
}

TEST_CASE("a resumed run with implicit flow has the same bits, though its factorisation is older than the checkpoint",
          "[checkpoint][cartilage]") {
    check_coupled<wet_implicitly>("implicit");
}

TEST_CASE("a damaged or foreign checkpoint is refused, and nothing changes", "[checkpoint]") {
    scratch_file const file("spoilt");
    auto p = springs<plane>(1, 1, 0.3, unit_density(2));
    p.time_step = 0.05;
    lacuna::simulation<plane> run(chain<2>(3), p);
    run.set_velocity(1, {0.01, 0.02});
    cracks_2d cracks;
    run.run(10, cracks);
    lacuna::save_checkpoint(file.path, run, cracks);
    std::string const sound = read_all(file.path);
    lacuna::simulation<plane> other(chain<2>(3), p);
    auto const before = lacuna::state_hash(other);
    auto const attempt = [&](std::string const& bytes) {
        write_all(file.path, bytes);
        std::string const message = why([&] { lacuna::load_checkpoint(file.path, other, cracks); });
        if (lacuna::state_hash(other) != before) return std::string("it has changed");
        return message;
    };
    SECTION("truncated anywhere") {
        for (std::size_t length = 0; length < sound.size(); ++length) {
            std::string const message = why([&] { (void)lacuna::unpack_checkpoint(sound.substr(0, length), "name"); });
            INFO(length);
            REQUIRE_THAT(message, contains_text("checkpoint name: "));
            REQUIRE_THAT(message, contains_text(length < 8 ? "not a checkpoint" : "truncated"));
        }
        REQUIRE_THAT(attempt(sound.substr(0, sound.size() / 2)),
                     contains_text(file.path) && contains_text("truncated"));
    }
    SECTION("with any byte flipped") {
        for (std::size_t k = 0; k < sound.size(); ++k) {
            std::string spoilt = sound;
            spoilt[k] = char(spoilt[k] ^ (1 << (k % 8)));
            INFO(k);
            REQUIRE(why([&] { (void)lacuna::unpack_checkpoint(spoilt, "name"); }) != "accepted");
        }
        std::string spoilt = sound;
        spoilt[sound.size() / 2] = char(spoilt[sound.size() / 2] + 1);
        REQUIRE_THAT(attempt(spoilt), contains_text("checksum") && contains_text("corrupted"));
    }
    SECTION("too long, foreign, missing") {
        REQUIRE_THAT(attempt(sound + "x"), contains_text("does not end as it should"));
        REQUIRE_THAT(attempt("\x7f" "ELF, a program"), contains_text("not a checkpoint of Lacuna"));
        REQUIRE_THAT(attempt(""), contains_text("not a checkpoint of Lacuna"));
        REQUIRE_THAT(why([&] { lacuna::load_checkpoint("no_such_file.bin", other); }),
                     contains_text("no_such_file.bin") && contains_text("cannot read"));
    }
    SECTION("from a newer version, or another machine") {
        std::string spoilt = sound;
        spoilt[12] = char(lacuna::detail::checkpoint_format + 1);
        REQUIRE_THAT(attempt(spoilt), contains_text("newer version"));
        spoilt = sound;
        spoilt[20] = char(LACUNA_VERSION_MINOR + 1);
        REQUIRE_THAT(attempt(spoilt), contains_text("newer version"));
        spoilt = sound;
        spoilt[12] = 0;
        REQUIRE_THAT(attempt(spoilt), contains_text("format 0 is unknown"));
        spoilt = sound;
        std::swap(spoilt[8], spoilt[11]);
        REQUIRE_THAT(attempt(spoilt), contains_text("byte order"));
    }
    SECTION("of another model, other settings, other particles, other observers") {
        write_all(file.path, sound);
        lacuna::simulation<plane_viscous> viscous(chain<2>(3));
        REQUIRE_THAT(why([&] { lacuna::load_checkpoint(file.path, viscous, cracks); }),
                     contains_text("another model") && contains_text("lacuna::no_damping") &&
                         contains_text("lacuna::viscous_damping"));
        auto q = p;
        q.materials[0].contact.friction = 0.31;
        lacuna::simulation<plane> rough(chain<2>(3), q);
        REQUIRE_THAT(why([&] { lacuna::load_checkpoint(file.path, rough, cracks); }),
                     contains_text("other settings: materials[0].contact.friction = 0.3, here 0.31"));
        lacuna::simulation<plane> longer(chain<2>(4), p);
        REQUIRE_THAT(why([&] { lacuna::load_checkpoint(file.path, longer, cracks); }),
                     contains_text("other particles: particles.radius = 3 entries, here 4 entries"));
        lacuna::simulation<plane> loose(chain<2>(3, false), p);
        REQUIRE_THAT(why([&] { lacuna::load_checkpoint(file.path, loose, cracks); }),
                     contains_text("other bonds: bonds = 2 entries, here 0 entries"));
        REQUIRE_THAT(why([&] { lacuna::load_checkpoint(file.path, other); }), contains_text("number of observers"));
        q = p;
        q.threads = 2;
        lacuna::simulation<plane> threaded(chain<2>(3), q);
        REQUIRE(why([&] { lacuna::load_checkpoint(file.path, threaded, cracks); }) == "accepted");
    }
    SECTION("with an inconsistent state in an undamaged file") {
        auto content = lacuna::read_checkpoint(file.path);
        auto const whole = content.state;
        for (std::size_t length : {std::size_t(0), std::size_t(1), whole.size() / 2, whole.size() - 1}) {
            content.state = whole.substr(0, length);
            REQUIRE_THAT(attempt(lacuna::pack_checkpoint(content)), contains_text("its state does not fit"));
        }
        content.state = whole + "x";
        REQUIRE_THAT(attempt(lacuna::pack_checkpoint(content)), contains_text("longer than it should be"));
    }
}

TEST_CASE("checkpoint_every refuses an interval below one", "[checkpoint][refusal]") {
    REQUIRE_THROWS_AS(lacuna::checkpoint_every(0, "name"), std::invalid_argument);
}

TEST_CASE("a series of frames is that of the uninterrupted run, whether the checkpoint saves it or not",
          "[checkpoint][vtk]") {
    namespace fs = std::filesystem;
    struct model : lacuna::default_model<2> {};
    auto const make = [] {
        lacuna::simulation<model> sim(lacuna::chain<double, 2>(5, 0.5, true), lacuna::simulation_parameters<model>{});
        sim.set_velocity(4, {0.1, 0.0});
        return sim;
    };
    struct folder {
        explicit folder(std::string name) : path("series_" + std::move(name)) {
            fs::remove_all(path);
            fs::create_directory(path);
        }
        ~folder() { fs::remove_all(path); }
        std::string path;
    };
    auto const files = [](std::string const& path) {
        std::map<std::string, std::string> all;
        for (auto const& entry : fs::directory_iterator(path))
            all[entry.path().filename().string()] = read_all(entry.path().string());
        return all;
    };
    auto const listed = [](std::string const& text) {
        std::size_t count = 0;
        for (auto at = text.find("<DataSet"); at != text.npos; at = text.find("<DataSet", at + 1)) ++count;
        return count;
    };
    folder const whole("whole"), parts("parts");
    {
        auto sim = make();
        lacuna::vtk_series<> frames(whole.path + "/run", 10);
        sim.run(100, frames);
    }
    auto const expected = files(whole.path);
    REQUIRE(listed(expected.at("run-particles.pvd")) == 11);
    REQUIRE(listed(expected.at("run-bonds.pvd")) == 11);
    scratch_file const file("series");
    for (bool const saved : {false, true})
        for (long long const at : {50, 53}) {
            // The first part continues for a while after its checkpoint, like a run that is killed.
            {
                auto sim = make();
                lacuna::vtk_series<> frames(parts.path + "/run", 10);
                auto const run = [&](auto const& checkpoints) { sim.run(70, frames, checkpoints); };
                if (saved)
                    run(lacuna::checkpoint_every(at, file.path, frames));
                else
                    run(lacuna::checkpoint_every(at, file.path));
            }
            auto sim = make();
            lacuna::vtk_series<> frames(parts.path + "/run", 10);
            if (saved)
                lacuna::load_checkpoint(file.path, sim, frames);
            else
                lacuna::load_checkpoint(file.path, sim);
            REQUIRE(sim.steps() == at);
            sim.run(100 - at, frames);
            REQUIRE(files(parts.path) == expected);
            // Back to the checkpoint in the same process.
            if (saved)
                lacuna::load_checkpoint(file.path, sim, frames);
            else
                lacuna::load_checkpoint(file.path, sim);
            sim.run(100 - at, frames);
            REQUIRE(files(parts.path) == expected);
        }
    // A new run from the start in the same directory lists its own frames only.
    auto sim = make();
    lacuna::vtk_series<> frames(parts.path + "/run", 10);
    sim.run(20, frames);
    REQUIRE(listed(read_all(parts.path + "/run-particles.pvd")) == 3);
}
