// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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

#include <lacuna/core/difference.hpp>
#include <lacuna/observe/checkpoint_file.hpp>
#include <lacuna/observe/observer.hpp>
#include <lacuna/observe/state_archive.hpp>
#include <lacuna/simulation.hpp>

/// \file
/// Checkpoints: save the complete state of a simulation and of observers to a file, and restore it bit by bit.
///
/// To resume, build the simulation as before (packing, parameters, pores), then call load_checkpoint(). It compares
/// settings, particles, bonds and pores with those of the checkpoint. It also compares the calls before the first step:
/// velocities, fixed axes, loads, rigid plates, motions of walls, pressures and sources of the fluid. Each kind of call
/// is compared by its result. A kind of call that was not repeated is taken from the checkpoint.
///
/// Calls after load_checkpoint() take effect from there on: a load with a ramp starts at the load that acts then. A
/// simulation that has already stepped also changes to the saved state; calls since its first step are undone.

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

/// Input of a simulation that steps do not change.
template <class Model>
struct given_values {
    struct particle_list {
        std::vector<typename Model::real> radius, mass;
        std::vector<int> material;
    };
    simulation_parameters<Model> settings;
    particle_list particles; ///< by id
    std::vector<std::array<std::int32_t, 2>> bonds;
    std::uint64_t numbering = 0; ///< hash of the order in which particles are stored
    set_up_record set_up;

    given_values() = default;
    explicit given_values(simulation<Model> const& sim) : settings(sim.settings()), set_up(sim.set_up_so_far()) {
        // These have no effect on results.
        settings.threads = 1;
        settings.keep_pair_forces = true;
        settings.guards = {};
        // A resumed run may last longer than planned. The inactive throats, which depend on it, are part of the state.
        if constexpr (requires { settings.flow.duration; }) settings.flow.duration = 1;
        auto const& store = sim.particles();
        set_up_hash order;
        for (std::size_t id = 0; id < store.size(); ++id) {
            auto const k = std::size_t(store.internal(id));
            particles.radius.push_back(store.radius(k));
            particles.mass.push_back(store.mass(k));
            particles.material.push_back(store.material(k));
            order.add(k);
        }
        numbering = order.value();
        for (auto const& bond : sim.pairs().bond_records()) bonds.push_back({bond.particles[0], bond.particles[1]});
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(settings, particles, bonds, numbering, set_up);
    }

    /// Describes the first difference between the input of a checkpoint and this one; empty if there is none.
    std::string differs(given_values const& saved) const {
        auto const message = [](char const* what, difference const& d) {
            return "it was made with other " + std::string(what) + ": " + d.path + " = " + d.first + ", here " +
                   d.second;
        };
        if (auto const d = first_difference(saved.settings, settings, "")) return message("settings", *d);
        if (auto const d = first_difference(saved.particles, particles, "particles")) return message("particles", *d);
        if (auto const d = first_difference(saved.bonds, bonds, "bonds")) return message("bonds", *d);
        if (saved.set_up.positions != set_up.positions) return "it was made with particles at other positions";
        if (saved.numbering != numbering) return "it was written by a version that numbers particles in another way";
        if (saved.set_up.pores != set_up.pores) return "it was made with other pores";
        if (saved.set_up.fluid != set_up.fluid) return "its pores were filled with other pressures or sources";
        for (std::size_t kind = 0; kind < set_up_kinds; ++kind)
            if (set_up.was_called(lacuna::set_up(kind)) && saved.set_up.result[kind] != set_up.result[kind])
                return "it was made with other " + std::string(set_up_names[kind]) +
                       " than were given before load_checkpoint(): give them after it, they take effect from there on";
        return {};
    }
};

/// Names of the observers' types.
template <class... Observers>
std::vector<std::string> observer_texts() {
    return {type_text<Observers>()...};
}

template <class Model>
std::string model_text() {
    using real = typename Model::real;
    return "dim " + std::to_string(Model::dim) + ", " + type_text<real>() + ", " +
           type_text<typename Model::contact_law>() + ", " + type_text<typename Model::bond_law>() + ", " +
           type_text<typename Model::damping>() + ", " + type_text<typename Model::flow>() + ", " +
           (std::is_same_v<typename Model::forces, no_forces> ? "" : type_text<typename Model::forces>() + ", ") +
           type_text<typename Model::integrator>() + ", packs of " + std::to_string(native_width<real>);
}

} // namespace detail

/// Content of the file of save_checkpoint().
template <class Model, class... Observers>
checkpoint_content checkpoint_of(simulation<Model> const& sim, Observers const&... observers) {
    state_writer given, state;
    given(detail::given_values<Model>(sim), detail::observer_texts<Observers...>());
    state(sim);
    std::vector<std::string> accumulated;
    [[maybe_unused]] auto const keep = [&](auto const& observer) {
        state_writer own;
        own(observer);
        accumulated.push_back(own.bytes());
    };
    (keep(observers), ...);
    state(accumulated);
    return {detail::model_text<Model>(), given.bytes(), state.bytes()};
}

/// Puts a simulation and observers into the state of a checkpoint that was read; see load_checkpoint().
/// \param name name of the file, for messages
/// \throws checkpoint_error as load_checkpoint()
template <class Model, class... Observers>
void resume_from(checkpoint_content const& content, std::string const& name, simulation<Model>& sim,
                 Observers&... observers) {
    auto const refuse_file = [&](std::string const& why) { throw checkpoint_error("checkpoint " + name + ": " + why); };
    if (content.model != detail::model_text<Model>())
        refuse_file("it is of another model: " + content.model + "; this is " + detail::model_text<Model>());
    detail::given_values<Model> const ours(sim);
    detail::given_values<Model> saved = ours;
    std::vector<std::string> watched;
    try {
        state_reader given(content.given);
        given(saved, watched);
        require_state(given.left() == 0, "it is longer than it should be");
    } catch (std::exception const& e) {
        refuse_file(e.what());
    }
    if (std::string const why = ours.differs(saved); !why.empty()) refuse_file(why);
    if (auto const d = first_difference(watched, detail::observer_texts<Observers...>(), ""))
        refuse_file(watched.size() == sizeof...(Observers)
                        ? "it was made with other observers: " + d->first + ", here " + d->second
                        : "it was made with another number of observers, " + std::to_string(watched.size()));
    // Reads into copies, so that an error in the file leaves everything unchanged.
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
    copy->take_set_up(saved.set_up);
    sim = std::move(*copy);
    std::tie(observers...) = std::move(copies);
}

/// Writes the complete state between two steps: particles, bonds, contacts and their histories, pores, loads, energies.
/// \param observers observers whose accumulated results are saved too. They must be copyable and have a `serialize`
///        member, like crack_record. load_checkpoint() needs them in the same order
/// \throws std::runtime_error if the file cannot be written; an earlier file of that name stays unchanged then
template <class Model, class... Observers>
void save_checkpoint(std::string const& path, simulation<Model> const& sim, Observers const&... observers) {
    write_checkpoint(path, checkpoint_of(sim, observers...));
}

/// Puts a simulation and observers into a saved state. The simulation must be built like the saved one. Its further
/// steps have the same bits as those of an uninterrupted run.
/// \throws checkpoint_error for a file that cannot be read, is no checkpoint, is truncated, corrupted or of a newer
///         version; that has another model, other settings, particles, pores or observers; or that was made with other
///         calls before the first step. The message names the difference. Nothing has changed then
template <class Model, class... Observers>
void load_checkpoint(std::string const& path, simulation<Model>& sim, Observers&... observers) {
    resume_from(read_checkpoint(path), path, sim, observers...);
}

/// Hash of the complete state. Two simulations with the same model, settings and hash continue in the same way.
template <class Model>
std::uint64_t state_hash(simulation<Model> const& sim) {
    state_writer state;
    state(sim);
    return checksum_of(state.bytes());
}

/// Observer that writes a checkpoint after every `interval` steps, always to the same file. Pass it to run() after the
/// observers that it saves, so that they have processed the step.
template <class... Observers>
class checkpoint_every {
public:
    static constexpr stage stages = stage::step;

    /// \param observers see save_checkpoint(); they must outlive this object
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
