// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <lacuna/core/prefetch.hpp>
#include <lacuna/interactions/storage/force_offsets.hpp>
#include <lacuna/interactions/storage/pair_forces.hpp>
#include <lacuna/interactions/kinematics.hpp>
#include <lacuna/interactions/storage/pair_table.hpp>
#include <lacuna/interactions/storage/prefetcher.hpp>
#include <lacuna/laws/damping.hpp>
#include <lacuna/laws/law_concepts.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Parameters of a law: one row per pair of materials, and one per bond with individual values.
template <class Law, class Real>
struct parameter_table {
    template <class T>
    using parameters_of = typename Law::template parameters<T>;
    static_assert(detail::consists_of<parameters_of<dual<Real, 2>>, dual<Real, 2>>(),
                  "a law's parameters must consist of T and vec<T, N>");
    std::vector<parameters_of<Real>> row;

    void add(parameters_of<double> const& p) {
        row.push_back(convert_fields<Real, double, parameters_of<Real>>(p, [](double x) { return Real(x); }));
    }
    /// Loads the parameters of the pairs of one pack.
    /// \param uniform row that all pairs share, or -1
    /// \param index row of each pair; read only if uniform is -1
    template <class Lanes>
    void load(parameters_of<Lanes>& to, std::int32_t uniform, std::int32_t const* index) const noexcept {
        constexpr std::size_t count = field_count<parameters_of, Real>;
        auto const* from = reinterpret_cast<Real const*>(row.data());
        if (uniform >= 0) {
            for (std::size_t f = 0; f < count; ++f)
                detail::field<Lanes>(to, f) = Lanes(from[std::size_t(uniform) * count + f]);
        } else {
            for (std::size_t f = 0; f < count; ++f)
                for (int k = 0; k < Lanes::width; ++k)
                    detail::field<Lanes>(to, f).v[k] = from[std::size_t(index[k]) * count + f];
        }
    }
};

/// Energies that one chunk of pairs adds to the ledger, J.
struct pair_energy {
    double stored = 0;     ///< present elastic energy
    double dissipated = 0; ///< dissipated by sliding and crushing in this step
    double damped = 0;     ///< taken out by dashpots in this step
    double in_bonds = 0;   ///< part of the elastic energy that bonds store

    void operator+=(pair_energy const& other) noexcept {
        stored += other.stored;
        dissipated += other.dissipated;
        damped += other.damped;
        in_bonds += other.in_bonds;
    }
};

/// Relative states of one pack of pairs.
///
/// Rotations are stored as surface speeds. Hence every value but the single radii is a difference or a sum of the
/// partners' records. One multiplication by a record of signs gives both at once, before the records are transposed.
/// \param i, j offsets of the partners' records, in reals
template <class Lanes, class Real, int Dim>
relative_state<Lanes, Dim> load_relative(particle_store<Real, Dim> const& store, std::uint32_t const* i,
                                         std::uint32_t const* j) noexcept {
    constexpr int W = Lanes::width;
    constexpr Real rolls = Dim == 2 ? 1 : -1;
    Real const* particles = store.particle_records().data();
    Real const signs[8] = {-1, -1, -1, 1, -1, -1, rolls, -1};
    auto joined = transpose_load2<Real, W>([&]<int N>(int k, int first) {
        using part = pack<Real, N>;
        return part::load(particles + j[k] + first) + part::load(particles + i[k] + first) * part::load(signs + first);
    });
    relative_state<Lanes, Dim> s;
    s.radii = joined[3];
    s.radius_i = (joined[3] - joined[7]) * Lanes(Real(0.5));
    s.radius_j = (joined[3] + joined[7]) * Lanes(Real(0.5));
    if constexpr (Dim == 2) {
        s.arm = {{joined[0], joined[1]}};
        s.velocity = {{joined[4], joined[5]}};
        s.rolling = {{joined[6]}};
    } else {
        using rec = record<Real>;
        Real const* speeds = store.surface_speeds().data();
        auto turning =
            transpose_load<Real, W>([&](int k) { return rec::load(speeds + j[k] / 2) + rec::load(speeds + i[k] / 2); });
        s.arm = {{joined[0], joined[1], joined[2]}};
        s.velocity = {{joined[4], joined[5], joined[6]}};
        s.rolling = {{turning[0], turning[1], turning[2]}};
    }
    return s;
}
/// Spin of one partner of each pair of a pack, rad/s.
template <class Lanes, class Real, int Dim>
vec<Lanes, rotation_dim<Dim>> load_spin(particle_store<Real, Dim> const& store, std::uint32_t const* who,
                                        Lanes const& radius) noexcept {
    Real const* speeds = Dim == 2 ? store.particle_records().data() + 4 : store.surface_speeds().data();
    constexpr std::uint32_t share = Dim == 2 ? 1 : 2;
    auto speed = transpose_load<Real, Lanes::width>([&](int k) { return record<Real>::load(speeds + who[k] / share); });
    if constexpr (Dim == 2)
        return {{speed[2] / radius}};
    else
        return {{speed[0] / radius, speed[1] / radius, speed[2] / radius}};
}
/// One particle of a store as a body of the kinematics.
template <class Real, int Dim>
body<Real, Dim> load_particle(particle_store<Real, Dim> const& store, std::size_t k) noexcept {
    return {store.position(k), store.velocity(k), store.spin(k), Real(store.particle_records().at(k, 3)),
            store.mass(k)};
}

/// Writes the force record of one pair. Its fourth number is the normal force, on which the apertures of throats
/// depend; sums of forces do not read it.
template <class Real, int Dim>
void store_pair_force(Real* to, vec<Real, Dim> const& force, vec<Real, rotation_dim<Dim>> const& torque,
                      Real normal_force) noexcept {
    for (int axis = 0; axis < Dim; ++axis) to[axis] = force[axis];
    for (int axis = 0; axis < rotation_dim<Dim>; ++axis) to[Dim == 2 ? 2 : 4 + axis] = torque[axis];
    to[3] = normal_force;
}
/// Writes the force records of one pack of pairs.
template <class Real, int Dim, class Lanes>
void store_pair_forces(Real* to, vec<Lanes, Dim> const& force, vec<Lanes, rotation_dim<Dim>> const& torque,
                       Lanes const& normal_force) noexcept {
    if constexpr (Dim == 2) {
        transpose_store<Real, Lanes::width>(to, {force[0], force[1], torque[0], normal_force});
    } else {
        for (int k = 0; k < Lanes::width; ++k) {
            store_pair_force<Real, Dim>(to + 8 * k, {force[0][k], force[1][k], force[2][k]},
                                        {torque[0][k], torque[1][k], torque[2][k]}, normal_force[k]);
            to[8 * k + 7] = Real(0);
        }
    }
}

/// Writes the moments on the first particle of each pair of a pack; rotation_dim numbers per slot.
template <class Real, class Lanes, int N>
void store_moments(Real* to, std::size_t slot, vec<Lanes, N> const& moment) noexcept {
    for (int k = 0; k < Lanes::width; ++k)
        for (int axis = 0; axis < N; ++axis)
            to[(slot + std::size_t(k)) * std::size_t(N) + std::size_t(axis)] = moment[axis][k];
}

/// Evaluates a law for one pack of pairs. A law with moments also gets the relative rotation of the particles.
template <class Law, class Lanes, class Real, int Dim, class Parameters, class State>
auto evaluate_law(Parameters const& law, pair_frame<Lanes, Dim> const& frame, State const& state,
               [[maybe_unused]] relative_state<Lanes, Dim> const& pair,
               [[maybe_unused]] particle_store<Real, Dim> const& store, [[maybe_unused]] std::uint32_t const* i,
               [[maybe_unused]] std::uint32_t const* j, [[maybe_unused]] Lanes const& time_step) noexcept {
    if constexpr (carries_moment<Law>)
        return Law::evaluate(law, frame.motion,
                             frame.relative_rotation(load_spin<Lanes>(store, i, pair.radius_i),
                                                     load_spin<Lanes>(store, j, pair.radius_j), time_step),
                             state);
    else
        return Law::evaluate(law, frame.motion, state);
}

/// Relative state and frame of one pack of pairs.
template <class Lanes, int Dim>
struct pair_view {
    static constexpr int dim = Dim;
    relative_state<Lanes, Dim> pair;
    pair_frame<Lanes, Dim> frame;
};

/// Normal force of one pack of pairs, the force of their dashpots included.
template <pair_kind Kind, class Law, class Damping, class Lanes, class Real, int Dim, class Parameters, class State>
Lanes with_dashpots(Lanes const& normal, typename Damping::parameters const& damping, Parameters const& law,
                    pair_frame<Lanes, Dim> const& frame, State const& state, pair_table<Law, Real, Dim> const& table,
                    particle_store<Real, Dim> const& store, std::size_t slot) noexcept {
    Lanes mass_i, mass_j, none(value_t<Lanes>(0));
    for (int k = 0; k < Lanes::width; ++k) {
        mass_i.v[k] = store.masses()[table.i(slot + std::size_t(k))];
        mass_j.v[k] = store.masses()[table.j(slot + std::size_t(k))];
    }
    auto drag = Damping::pair_force(damping, dashpot_stiffness<Law>(law, frame.motion, state), mass_i, mass_j,
                                    frame.motion.normal_rate);
    if constexpr (Kind == pair_kind::contact && dashpot_pulls<Damping>)
        return select(normal < none, normal + drag, normal);
    else if constexpr (Kind == pair_kind::contact)
        return select(normal < none, min(normal + drag, none), normal);
    else
        return normal + drag;
}

/// Prefetches the pairs that come `ahead` packs later and, in 3D, the second particles of pairs half as far ahead.
/// \param pack_after callable: skips the spare packs of the chunk and returns the pack to read in place of pack p
template <class Law, class Real, int Dim, class After>
void prefetch_pairs(pair_table<Law, Real, Dim> const& table, particle_store<Real, Dim> const& store, std::size_t p,
                    std::size_t ahead, After const& pack_after) noexcept {
    constexpr int W = native_width<Real>;
    table.prefetch(pack_after(p + ahead));
    if constexpr (Dim == 3)
        if (std::size_t const q = pack_after(p + ahead / 2); q < table.packs()) {
            std::uint32_t const* seconds = table.j_records() + q * W;
            prefetch_records<W>(store.particle_records().data(), seconds);
            for (int k = 0; k < W; ++k) __builtin_prefetch(store.surface_speeds().data() + seconds[k] / 2);
        }
}

/// Output arrays of the pair loop for one chunk.
template <class Real>
struct chunk_output {
    Real* forces;               ///< first force record of the chunk
    force_offsets::row offsets; ///< offsets of the packs' forces from there; only `window` and `first` are read
    Real* normals;              ///< normal forces, by slot; nullptr: not written
    Real* moments;              ///< moments on the first particles, rotation_dim numbers a slot; laws with moments only
};

/// Overlaps beyond which the pair loop reports a contact, over the smaller radius, 1.
template <class Real>
struct overlap_limits {
    Real deepest = 1; ///< largest overlap that a run allows
    Real watched = 1; ///< laws that stiffen: largest overlap for which the time step was chosen
};

/// Whether a bond of a pack has failed, or a contact of the pack exceeds a limit.
template <pair_kind Kind, class Law, class Answer, class View, class State, class Real>
bool has_event([[maybe_unused]] Answer const& answer, [[maybe_unused]] View const& view,
               [[maybe_unused]] State const& state, [[maybe_unused]] overlap_limits<Real> const& limits) noexcept {
    if constexpr (Kind == pair_kind::bond) {
        return any(answer.broken);
    } else {
        using lanes = std::remove_cvref_t<decltype(view.pair.radii)>;
        auto const& motion = view.frame.motion;
        auto smaller = min(view.pair.radius_i, view.pair.radius_j);
        auto deep = motion.distance + smaller * lanes(limits.deepest) < view.pair.radii;
        if constexpr (stiffens<Law, View::dim>)
            return any(deep || motion.distance + smaller * lanes(limits.watched) < touching_distance_of(motion, state));
        else
            return any(deep);
    }
}

/// Evaluates one chunk of pairs: kinematics, law, history, forces.
///
/// The law's formula is instantiated with packs here. This is the only loop over pairs in the step.
/// \tparam WithEnergy whether energies are summed up too
/// \tparam Commit true: stores the new histories and reports events; false: forces alone, for a trial
/// \param ahead prefetches data that the next chunks read
/// \param on_event called as on_event(pack) after a pack in which a bond has failed or a contact exceeds a limit; rare
template <pair_kind Kind, bool WithEnergy, bool Commit, class Law, class Damping, class Domain, class Real, int Dim,
          class OnEvent>
[[gnu::noinline, gnu::flatten]] void
evaluate_chunk(pair_table<Law, Real, Dim>& table, int chunk, parameter_table<Law, Real> const& parameters,
               typename Damping::parameters const& damping, particle_store<Real, Dim> const& store, Real time_step,
               chunk_output<Real> const& out, prefetcher::plan& ahead, pair_energy& energy,
               [[maybe_unused]] overlap_limits<Real> const& limits, [[maybe_unused]] OnEvent const& on_event) {
    using lanes = typename pair_table<Law, Real, Dim>::lanes;
    constexpr int W = lanes::width;
    constexpr std::size_t stride = 4 * pair_forces<Real, Dim>::records_per_pair;
    lanes const dt(time_step);
    lanes stored(Real(0)), dissipated(Real(0)), damped(Real(0));
    auto& states = table.states();
    Real* const forces = out.forces;
    std::size_t offset = out.offsets.first, window = out.offsets.window;
    typename Law::template parameters<lanes> law{};
    std::int32_t loaded = -2; // row of parameters
    auto const load_pair = [&](std::size_t p) {
        auto pair = load_relative<lanes>(store, table.i_records() + p * W, table.j_records() + p * W);
        if constexpr (Domain::periodic) pair.arm = store.period().shortest(pair.arm);
        return pair_view<lanes, Dim>{pair, relative_motion(pair, dt)};
    };
    // The kinematics of the next pack comes before the law of this one. A pack is one long chain of dependent
    // operations, and the processor does not look far enough ahead to start the next chain by itself. In 3D there are
    // not enough registers for two packs.
    constexpr bool looks_ahead = Dim == 2;
    pair_view<lanes, Dim> next{};
    std::size_t const first = table.first_pack(chunk), end = table.end_pack(chunk);
    // The packs of the next chunk follow the spare packs of this one.
    std::size_t const spare = table.first_pack(chunk + 1) - end;
    auto const pack_after = [end, spare](std::size_t p) { return p < end ? p : p + spare; };
    if (looks_ahead && first < end) next = load_pair(first);
    for (std::size_t p = first; p < end; ++p) {
        std::size_t const slot = p * W;
        if (ahead.any) {
            ahead.prefetch();
            prefetch_pairs(table, store, p, 16, pack_after);
        }
        auto const view = looks_ahead ? next : load_pair(p);
        auto const& frame = view.frame;
        if constexpr (looks_ahead) next = load_pair(p + 1 < end ? p + 1 : p);
        auto state = states.load(p);
        if constexpr (Dim == 3) rotate_history<Law>(state, frame);
        if (std::int32_t const row = table.uniform_parameter(p); row != loaded || row < 0) {
            parameters.template load<lanes>(law, row, table.parameter() + slot);
            loaded = row;
        }
        auto answer = evaluate_law<Law>(law, frame, state, view.pair, store, table.i_records() + slot,
                                        table.j_records() + slot, dt);
        auto normal = answer.normal_force;
        if constexpr (Damping::acts_on_pairs) {
            normal = with_dashpots<Kind, Law, Damping>(normal, damping, law, frame, state, table, store, slot);
            if constexpr (WithEnergy) damped += (normal - answer.normal_force) * frame.motion.normal_rate * dt;
        }
        if constexpr (Commit) states.store(p, answer.history);
        store_pair_forces<Real, Dim>(forces + stride * W * offset, frame.force(normal, answer.shear_force),
                                     frame.torque_per_radius(answer.shear_force), normal);
        if (++offset == window) offset = 0;
        if (out.normals) normal.store(out.normals + slot);
        if constexpr (carries_moment<Law>) store_moments(out.moments, slot, frame.moment(answer));
        if constexpr (WithEnergy && states_energies<Law, Dim>)
            stored += answer.stored_energy, dissipated += answer.dissipated_energy;
        if constexpr (Commit)
            if (has_event<Kind, Law>(answer, view, state, limits)) [[unlikely]] on_event(p);
    }
    if constexpr (WithEnergy) energy = {double(sum(stored)), double(sum(dissipated)), double(sum(damped)), 0};
}

} // namespace lacuna
