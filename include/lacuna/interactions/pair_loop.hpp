// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <lacuna/interactions/kinematics.hpp>
#include <lacuna/interactions/pair_table.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Parameters of a law for every pair of materials, and for single bonds that have their own.
template <class Law, class Real>
struct parameter_table {
    template <class T>
    using parameters_of = typename Law::template parameters<T>;
    std::vector<parameters_of<Real>> row;

    void add(parameters_of<double> const& p) {
        row.push_back(convert_fields<Real, double, parameters_of<Real>>(p, [](double x) { return Real(x); }));
    }
    /// The parameters of the pairs of one pack.
    template <class Lanes>
    parameters_of<Lanes> lanes(std::int32_t uniform, std::int32_t const* index) const noexcept {
        constexpr std::size_t count = field_count<parameters_of, Real>;
        std::array<Lanes, count> fields;
        if (uniform >= 0) {
            auto const* from = reinterpret_cast<Real const*>(&row[std::size_t(uniform)]);
            for (std::size_t f = 0; f < count; ++f) fields[f] = Lanes(from[f]);
        } else {
            auto const* from = reinterpret_cast<Real const*>(row.data());
            for (std::size_t f = 0; f < count; ++f)
                for (int k = 0; k < Lanes::width; ++k) fields[f].v[k] = from[std::size_t(index[k]) * count + f];
        }
        parameters_of<Lanes> r;
        __builtin_memcpy(static_cast<void*>(&r), &fields, sizeof r);
        return r;
    }
};

/// Energies that one chunk of pairs adds to the ledger, J.
struct pair_energy {
    double stored = 0;     ///< elastic energy now
    double dissipated = 0; ///< by sliding and crushing in this step
    double damped = 0;     ///< taken out by dashpots in this step
};

/// Forces of pairs, one record (2D: F_x, F_y, torque per radius, 0) or two (3D: force; torque per radius) each.
template <class Real, int Dim>
struct pair_forces {
    static constexpr std::size_t records_per_pair = Dim == 2 ? 1 : 2;
    record_column<Real> column;
    Real* of(std::size_t slot) noexcept { return column.data() + 4 * records_per_pair * slot; }
    Real const* of(std::size_t slot) const noexcept { return column.data() + 4 * records_per_pair * slot; }
};

/// Bodies index[0..W) of a store, as packs.
template <class Lanes, class Real, int Dim>
body<Lanes, Dim> load_bodies(particle_store<Real, Dim> const& store, std::int32_t const* index) noexcept {
    constexpr int W = Lanes::width;
    auto const place = load_turned<Real, W>(store.place().data(), index);
    auto const motion = load_turned<Real, W>(store.velocities().data(), index);
    if constexpr (Dim == 2) {
        return {{place[0], place[1]}, {motion[0], motion[1]}, {motion[2]}, place[3], motion[3]};
    } else {
        auto const spin = load_turned<Real, W>(store.spins().data(), index);
        return {{place[0], place[1], place[2]}, {motion[0], motion[1], motion[2]}, {spin[0], spin[1], spin[2]},
                place[3], motion[3]};
    }
}
/// One body of a store, as plain numbers.
template <class Real, int Dim>
body<Real, Dim> load_body(particle_store<Real, Dim> const& store, std::size_t k) noexcept {
    return {store.position(k), store.velocity(k), store.spin(k), Real(store.place().at(k, 3)), store.mass(k)};
}

/// Writes the pair forces of one pack.
template <class Real, int Dim, class Lanes>
void store_pair_forces(Real* to, vec<Lanes, Dim> const& force, vec<Lanes, rotation_dim<Dim>> const& torque) noexcept {
    if constexpr (Dim == 2) {
        store_turned<Real, Lanes::width>(to, {force[0], force[1], torque[0], Lanes(Real(0))});
    } else {
        for (int k = 0; k < Lanes::width; ++k)
            for (int axis = 0; axis < 3; ++axis) {
                to[8 * k + axis] = force[axis][k];
                to[8 * k + 4 + axis] = torque[axis][k];
                to[8 * k + 3] = to[8 * k + 7] = Real(0);
            }
    }
}

/// How the pair loop treats one law.
enum class pair_kind { contact, bond };

/// Forces and new histories of one chunk of pairs: kinematics, law, history, forces.
///
/// The law's formula is instantiated with packs here; this loop is the only one over pairs in the step.
/// \tparam WithEnergy also sums up energies (the sums cost time, so they are only made when something asks)
/// \param on_event called as on_event(pack) after a pack in which a bond has failed, or two particles overlap by
///        more than a radius; rare
template <pair_kind Kind, bool WithEnergy, class Law, class Damping, class Real, int Dim, class OnEvent>
[[gnu::noinline]] void evaluate_chunk(pair_table<Law, Real, Dim>& table, int chunk,
                                      parameter_table<Law, Real> const& parameters,
                                      typename Damping::parameters const& damping,
                                      particle_store<Real, Dim> const& store, Real time_step, Real* forces,
                                      pair_energy& energy, OnEvent const& on_event) {
    using lanes = typename pair_table<Law, Real, Dim>::lanes;
    constexpr int W = lanes::width;
    constexpr std::size_t stride = 4 * pair_forces<Real, Dim>::records_per_pair;
    lanes const dt(time_step);
    lanes stored(Real(0)), dissipated(Real(0)), damped(Real(0));
    auto& states = table.states();
    for (std::size_t p = table.first_pack(chunk), end = table.end_pack(chunk); p < end; ++p) {
        std::size_t const slot = p * W;
        auto const i = load_bodies<lanes>(store, table.i() + slot);
        auto const j = load_bodies<lanes>(store, table.j() + slot);
        auto const frame = relative_motion(i, j, dt);
        auto state = states.load(p);
        if constexpr (Dim == 3) state.shear_force = frame.turned(state.shear_force);
        auto const law = parameters.template lanes<lanes>(table.uniform_parameter(p), table.parameter() + slot);
        auto const answer = Law::evaluate(law, frame.motion, state);
        auto normal = answer.normal_force;
        if constexpr (Damping::acts_on_pairs) {
            auto const drag =
                Damping::pair_force(damping, Law::stiffness(law), i.mass, j.mass, frame.motion.normal_rate);
            if constexpr (Kind == pair_kind::contact)
                normal = select(normal < lanes(Real(0)), min(normal + drag, lanes(Real(0))), normal);
            else
                normal = normal + drag;
            if constexpr (WithEnergy) damped += (normal - answer.normal_force) * frame.motion.normal_rate * dt;
        }
        states.store(p, answer.history);
        store_pair_forces<Real, Dim>(forces + stride * slot, frame.force(normal, answer.shear_force),
                                     frame.torque_per_radius(answer.shear_force));
        if constexpr (WithEnergy) {
            stored += answer.stored_energy;
            dissipated += answer.dissipated_energy;
        }
        if constexpr (Kind == pair_kind::bond) {
            if (any(answer.broken)) [[unlikely]]
                on_event(p);
        } else {
            if (any(frame.motion.distance < max(i.radius, j.radius))) [[unlikely]]
                on_event(p);
        }
    }
    if constexpr (WithEnergy) energy = {double(sum(stored)), double(sum(dissipated)), double(sum(damped))};
}

} // namespace lacuna
