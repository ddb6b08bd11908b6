// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#if __has_include(<cxxabi.h>)
#include <cxxabi.h>
#endif

#include <lacuna/observe/checkpoint_file.hpp>
#include <lacuna/observe/observer.hpp>
#include <lacuna/observe/state_archive.hpp>
#include <lacuna/simulation.hpp>

/// \file
/// Checkpoints: the complete state of a simulation and of observers in a file, and back to the same bits.
///
/// To resume, build the simulation as it was built before (packing, parameters, pores), then load_checkpoint().

namespace lacuna {

namespace detail {

template <class T>
std::string type_text() {
    std::string name = typeid(T).name();
#if __has_include(<cxxabi.h>)
    if (char* plain = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, nullptr)) {
        name = plain;
        std::free(plain);
    }
#endif
    return name;
}

/// All that was given to a simulation and never changes: its settings but for those without effect on results, its
/// particles' numbering and properties, the shape of its pores. With remeshing that shape is part of the state.
template <class Model>
std::uint64_t settings_hash(simulation<Model> const& sim) {
    state_writer bytes;
    auto settings = sim.settings();
    settings.threads = 1;
    settings.keep_pair_forces = true;
    settings.guards = {};
    bytes(settings);
    auto const& store = sim.particles();
    for (std::size_t k = 0; k < store.size(); ++k)
        bytes(store.id(k), store.radius(k), store.mass(k), store.moment_of_inertia(k), store.material(k));
    for (auto const& bond : sim.pairs().bond_records()) bytes(bond.particles);
    if constexpr (has_fluid<Model>)
        if (sim.filled() && settings.remeshing.rule == remesh_rule::never) archive_shape(bytes, sim.flow().network());
    return checksum_of(bytes.bytes());
}

template <class Model>
std::string model_text() {
    using real = typename Model::real;
    return "dim " + std::to_string(Model::dim) + ", " + type_text<real>() + ", " +
           type_text<typename Model::contact_law>() + ", " + type_text<typename Model::bond_law>() + ", " +
           type_text<typename Model::damping>() + ", " + type_text<typename Model::flow>() + ", " +
           type_text<typename Model::integrator>() + ", packs of " + std::to_string(native_width<real>);
}

template <class Model, class... Observers>
checkpoint_content checkpoint_of(simulation<Model> const& sim, Observers const&... observers) {
    state_writer state;
    state(sim);
    std::vector<std::string> accumulated;
    [[maybe_unused]] auto const keep = [&](auto const& observer) {
        state_writer own;
        own(observer);
        accumulated.push_back(own.bytes());
    };
    (keep(observers), ...);
    state(accumulated);
    return {model_text<Model>(), settings_hash(sim), state.bytes()};
}

/// \throws checkpoint_error
template <class Model, class... Observers>
void resume_from(checkpoint_content const& content, std::string const& name, simulation<Model>& sim,
                 Observers&... observers) {
    auto const refuse_file = [&](std::string const& why) { throw checkpoint_error("checkpoint " + name + ": " + why); };
    if (content.model != model_text<Model>())
        refuse_file("it is of another model: " + content.model + "; this is " + model_text<Model>());
    if (content.settings != settings_hash(sim)) refuse_file("it was made with other settings, particles or pores");
    // Read into copies: whatever is wrong with the file, nothing has changed.
    auto copy = std::make_unique<simulation<Model>>(sim);
    std::tuple<Observers...> copies(observers...);
    try {
        state_reader state(content.state);
        state(*copy);
        std::vector<std::string> accumulated;
        state(accumulated);
        require_state(state.left() == 0, "it is longer than it should be");
        require_state(accumulated.size() == sizeof...(Observers), "it was made with another number of observers");
        std::size_t next = 0;
        [[maybe_unused]] auto const take = [&](auto& observer) {
            state_reader own(accumulated[next++]);
            own(observer);
            require_state(own.left() == 0, "an observer's part is longer than it should be");
        };
        std::apply([&](auto&... each) { (take(each), ...); }, copies);
    } catch (checkpoint_error const&) {
        throw;
    } catch (std::exception const& e) {
        refuse_file(e.what());
    }
    sim = std::move(*copy);
    std::tie(observers...) = std::move(copies);
}

} // namespace detail

/// Writes the complete state between two steps: particles, bonds, contacts and their histories, pores, loads, energies.
/// \param observers whose accumulators belong to the run: copyable, with a `serialize` member, as crack_record has;
///        in the same order at load_checkpoint()
/// \throws std::runtime_error when the file cannot be written; the file that was there is untouched then
template <class Model, class... Observers>
void save_checkpoint(std::string const& path, simulation<Model> const& sim, Observers const&... observers) {
    write_checkpoint(path, detail::checkpoint_of(sim, observers...));
}

/// Puts a simulation that was built as the saved one was, and observers, into the saved state: what follows has the
/// bits that it would have had.
/// \throws checkpoint_error, and changes nothing, for a file that cannot be read, is no checkpoint, is truncated,
///         corrupted or of a newer version, or is of another model, other settings, or other observers
template <class Model, class... Observers>
void load_checkpoint(std::string const& path, simulation<Model>& sim, Observers&... observers) {
    detail::resume_from(read_checkpoint(path), path, sim, observers...);
}

/// Hash of the complete state: two simulations of one model and the same settings that have the same hash go on alike.
template <class Model>
std::uint64_t state_hash(simulation<Model> const& sim) {
    state_writer state;
    state(sim);
    return checksum_of(state.bytes());
}

/// Observer that writes a checkpoint after every `interval` steps, always to the same file. To be given to run() after
/// the observers that it keeps, so that these have seen the step.
template <class... Observers>
class checkpoint_every {
public:
    static constexpr stage stages = stage::step;

    /// \param observers see save_checkpoint(); they must live as long as this
    /// \throws std::invalid_argument for an interval below 1
    checkpoint_every(long long interval, std::string path, Observers const&... observers)
        : interval_(interval), path_(std::move(path)), observers_(observers...) {
        if (interval < 1) refuse("checkpoint_every.interval", double(interval), ">= 1");
    }

    template <class Simulation>
    void on_step(Simulation const& sim) const {
        if (sim.steps() % interval_ != 0) return;
        std::apply([&](auto const&... each) { save_checkpoint(path_, sim, each...); }, observers_);
    }

private:
    long long interval_;
    std::string path_;
    std::tuple<Observers const&...> observers_;
};

} // namespace lacuna
