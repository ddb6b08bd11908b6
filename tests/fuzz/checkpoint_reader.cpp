// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>

#include <lacuna/laws/hertz_mindlin.hpp>
#include <lacuna/laws/parallel_bond.hpp>
#include <lacuna/observe/crack_record.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "fuzz/corpus.hpp"

/// \file
/// The reader of checkpoints, for a wet model in the plane and one in space in single precision. The input is any bytes
/// as a file, or any bytes as the state, or as the constant input, in an otherwise sound checkpoint. Either they are
/// refused and change nothing, or the simulation can make steps. A state that is read and written again has the same
/// bytes, and two simulations that continue from it agree.

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

struct wet_plane : lacuna::default_model<2> {
    using damping = lacuna::viscous_damping;
    using flow = lacuna::explicit_flow;
};
struct space_of_floats : lacuna::default_model<3, float> {
    using contact_law = lacuna::hertz_mindlin;
    using bond_law = lacuna::parallel_bond;
    using damping = lacuna::combined_damping;
};

lacuna::simulation<wet_plane> make(wet_plane) {
    lacuna::packing<double, 2> discs;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 5; ++x) {
            auto const k = discs.add({0.98 * x, 0.99 * y}, 0.5);
            if (x > 0 && y == 0) discs.bonds.push_back({k - 1, k});
        }
    lacuna::simulation_parameters<wet_plane> p;
    p.materials[0] = {1000, {1e3, 1e3, 0.5}, {1e3, 1e3, 20, 20}};
    p.time_step = 0.01;
    p.flow.bulk_modulus = 1e3;
    p.flow.initial_pressure = 10;
    p.flow.aperture = {0.1, 10, 1};
    p.remeshing = {lacuna::remesh_rule::when_needed, 2, true};
    p.walls = {{{0, -0.49}, {0, 1}, p.materials[0].contact}};
    lacuna::simulation<wet_plane> run(discs, p);
    run.apply(3, {1, 1}, 0, 10);
    for (std::size_t k = 0; k < run.size(); ++k) run.set_velocity(k, {0.1 * double(k % 3), -0.1 * double(k % 2)});
    run.fill_pores([](auto points, double const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii);
    });
    return run;
}

lacuna::simulation<space_of_floats> make(space_of_floats) {
    lacuna::packing<float, 3> spheres;
    for (int k = 0; k < 8; ++k) {
        spheres.add({0.98f * float(k % 2), 0.99f * float(k / 2 % 2), 0.97f * float(k / 4)}, k == 7 ? 0.45f : 0.5f);
        if (k % 2 == 1) spheres.bonds.push_back({k - 1, k});
    }
    lacuna::simulation_parameters<space_of_floats> p;
    p.materials[0].density = 1000;
    p.materials[0].contact = {1e5, 0.25, 0.5, 1};
    p.materials[0].bond.normal_stiffness = p.materials[0].bond.shear_stiffness = 1e3;
    p.materials[0].bond.tensile_strength = p.materials[0].bond.shear_strength = 30;
    p.damping = {0.05, 0.1, 0.1};
    p.gravity = {0, 0, -1};
    p.walls = {{{0, 0, -0.49}, {0, 0, 1}, p.materials[0].contact}};
    lacuna::simulation<space_of_floats> run(spheres, p);
    run.apply(3, {1, 1, 0}, {0, 0, 0.1}, 10);
    run.prescribe_velocity(5, {0.5, 0, 0.2}, 1);
    run.move_wall(0, {0, 0, 0.01}, 0.5);
    for (std::size_t k = 0; k < 5; ++k) run.set_velocity(k, {0.1 * double(k % 3), -0.1 * double(k % 2), 0});
    run.set_spin(6, {1, 0, -2});
    return run;
}

template <class Model>
class reader {
    using simulation = lacuna::simulation<Model>;
    using record = lacuna::crack_record<lacuna::break_event<Model::dim>>;
    simulation const initial_ = make(Model{});
    std::uint64_t const before_ = lacuna::state_hash(initial_);
    lacuna::checkpoint_content const begun_ = sound(0);

    lacuna::checkpoint_content sound(long long steps) const {
        auto run = initial_;
        record cracks;
        run.run(steps, cracks);
        return lacuna::checkpoint_of(run, cracks);
    }
    /// Makes some steps. Returns the hash of the state after them, 0 if the simulation stops before.
    static std::uint64_t go_on(simulation& run) {
        try {
            for (int n = 0; n < 3; ++n) run.step_with_energy();
            return lacuna::state_hash(run);
        } catch (lacuna::unstable_run const&) {
        } catch (std::invalid_argument const&) {
        }
        return 0;
    }

public:
    void write_seeds(int argc, char** argv, std::string const& name, char first) const {
        for (long long const steps : {0, 1, 40}) {
            auto const content = sound(steps);
            auto const seed = [&](char const* part, int kind, std::string const& bytes) {
                fuzz::write_seed(argc, argv, name + part + std::to_string(steps), char(first + kind) + bytes);
            };
            seed("file", 0, lacuna::pack_checkpoint(content));
            seed("state", 1, content.state);
            seed("given", 2, content.given);
        }
    }

    void try_one(int kind, std::string_view bytes) const {
        simulation run = initial_;
        record cracks;
        lacuna::checkpoint_content content = begun_;
        try {
            if (kind == 0) content = lacuna::unpack_checkpoint(bytes, "bytes");
            if (kind == 1) content.state = bytes;
            if (kind == 2) content.given = bytes;
            lacuna::resume_from(content, "bytes", run, cracks);
        } catch (lacuna::checkpoint_error const& bad) {
            fuzz::expect(lacuna::state_hash(run) == before_, "a refused file changes nothing");
            fuzz::expect(std::string_view(bad.what()).find('\n') == std::string_view::npos, "a refusal has one line");
            return;
        }
        // At step 0 the constant input follows from the state, which a bad file may contradict.
        if (run.steps() == 0) {
            go_on(run);
            return;
        }
        auto const again = lacuna::checkpoint_of(run, cracks);
        simulation other = initial_;
        record others;
        lacuna::resume_from(again, "written again", other, others);
        auto const twice = lacuna::checkpoint_of(other, others);
        fuzz::expect(twice.state == again.state && twice.given == again.given,
                     "a state that is read is written with the same bytes");
        fuzz::expect(go_on(run) == go_on(other), "a simulation and its copy continue alike");
    }
};

template <class Model>
reader<Model> const& reader_of() {
    static reader<Model> const one;
    return one;
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    reader_of<wet_plane>().write_seeds(*argc, *argv, "plane_", '0');
    reader_of<space_of_floats>().write_seeds(*argc, *argv, "space_", '4');
    return 0;
}

/// Half of the mutations replace a number, which random changes of bytes rarely do.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    std::minstd_rand random(seed);
    if (size < 10 || random() % 2 == 0) return LLVMFuzzerMutate(data, size, most);
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN(),
                     never = std::numeric_limits<double>::infinity();
    static constexpr double reals[] = {nothing, never, -never, 0.0,    -0.0, -1.0,
                                       1.0,     1e308, -1e308, 5e-324, 1e15, 1e-15};
    static constexpr float singles[] = {float(nothing), float(never), 0.0f, -1.0f, 1e38f, 1e-45f};
    static constexpr std::int64_t wholes[] = {0,   1,       -1,         2,          8,
                                              255, 1 << 20, 2147483647, 2147483648, std::int64_t(1) << 62};
    for (unsigned k = 1 + unsigned(random() % 3); k > 0; --k) {
        auto const put = [&](auto const& list) {
            auto const value = list[random() % std::size(list)];
            // After the byte for the kind, the state consists of numbers of eight and of four bytes.
            std::size_t const at = 1 + random() % ((size - 1 - sizeof value) / 4 + 1) * 4;
            std::memcpy(data + at, &value, sizeof value);
        };
        switch (random() % 3) {
        case 0: put(reals); break;
        case 1: put(singles); break;
        default: put(wholes);
        }
    }
    return size;
}

/// The first byte chooses the model and the kind of the other bytes.
extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size == 0) return 0;
    std::string_view const bytes(reinterpret_cast<char const*>(data + 1), size - 1);
    int const kind = data[0] % 4 % 3;
    if (data[0] & 4)
        reader_of<space_of_floats>().try_one(kind, bytes);
    else
        reader_of<wet_plane>().try_one(kind, bytes);
    return 0;
}
