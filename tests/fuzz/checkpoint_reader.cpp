// SPDX-License-Identifier: BSD-3-Clause

#include <stdexcept>
#include <string>
#include <string_view>

#include <lacuna/observe/crack_record.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "fuzz/corpus.hpp"

/// \file
/// The reader of checkpoints: any bytes as a file, and any bytes as the state in a sound envelope. They are refused, or
/// make a simulation that can be stepped; refused, they change nothing.

namespace {

struct model : lacuna::default_model<2> {
    using damping = lacuna::viscous_damping;
    using flow = lacuna::explicit_flow;
};
using record = lacuna::crack_record<lacuna::break_event<2>>;

lacuna::simulation<model> make() {
    lacuna::packing<double, 2> discs;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 5; ++x) {
            auto const k = discs.add({0.98 * x, 0.99 * y}, 0.5);
            if (x > 0 && y == 0) discs.bonds.push_back({k - 1, k});
        }
    lacuna::simulation_parameters<model> p;
    p.materials[0] = {1000, {1e3, 1e3, 0.5}, {1e3, 1e3, 20, 20}};
    p.time_step = 0.01;
    p.flow.bulk_modulus = 1e3;
    p.flow.initial_pressure = 10;
    p.flow.aperture = {0.1, 10, 1};
    p.remeshing = {lacuna::remesh_rule::when_needed, 2, true};
    p.walls = {{{0, -0.49}, {0, 1}, p.materials[0].contact}};
    lacuna::simulation<model> run(discs, p);
    run.apply(3, {1, 1}, 0, 10);
    for (std::size_t k = 0; k < run.size(); ++k) run.set_velocity(k, {0.1 * double(k % 3), -0.1 * double(k % 2)});
    run.fill_pores([](auto points, double const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii);
    });
    return run;
}

lacuna::checkpoint_content const& sound(long long steps) {
    static lacuna::checkpoint_content content;
    auto run = make();
    record cracks;
    run.run(steps, cracks);
    return content = lacuna::checkpoint_of(run, cracks);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    for (long long const steps : {0, 1, 40}) {
        auto const content = sound(steps);
        fuzz::write_seed(*argc, *argv, "file" + std::to_string(steps), "f" + lacuna::pack_checkpoint(content));
        fuzz::write_seed(*argc, *argv, "state" + std::to_string(steps), "s" + content.state);
        fuzz::write_seed(*argc, *argv, "given" + std::to_string(steps), "e" + content.given);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size == 0) return 0;
    std::string_view const bytes(reinterpret_cast<char const*>(data + 1), size - 1);
    static auto const fresh = make();
    static auto const before = lacuna::state_hash(fresh);
    static auto const content = sound(0);
    auto run = fresh;
    record cracks;
    try {
        if (data[0] % 3 == 0)
            lacuna::resume_from(lacuna::unpack_checkpoint(bytes, "bytes"), "bytes", run, cracks);
        else if (data[0] % 3 == 2)
            lacuna::resume_from({content.model, std::string(bytes), content.state}, "bytes", run, cracks);
        else
            lacuna::resume_from({content.model, content.given, std::string(bytes)}, "bytes", run, cracks);
    } catch (lacuna::checkpoint_error const&) {
        fuzz::expect(lacuna::state_hash(run) == before);
        return 0;
    }
    try {
        for (int n = 0; n < 3; ++n) run.step_with_energy();
    } catch (lacuna::unstable_run const&) {
    } catch (std::invalid_argument const&) {
    }
    return 0;
}
