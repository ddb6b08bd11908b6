// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/interactions/pair_loop.hpp>
#include <lacuna/interactions/wall.hpp>

namespace lacuna {

/// Contacts of particles with walls, by the model's contact law. For the law a wall is a body of radius 0 at the foot
/// point of the particle: the lever arm is the particle's distance from the plane. Walls stand still unless
/// set_velocity() moves them. They do not rotate.
template <class ContactLaw, class Damping, class Real, int Dim>
class wall_contacts {
public:
    using wall_type = wall<ContactLaw, Dim>;
    template <class T>
    using history_of = typename ContactLaw::template history<T, Dim>;
    /// Number of particles in a block; add_path() counts one path per block.
    static constexpr std::size_t block_particles = 128;

    wall_contacts() = default;
    /// \param thickness of a 2D packing, m
    /// \throws std::invalid_argument as wall::validate()
    wall_contacts(std::span<wall_type const> walls, std::span<typename ContactLaw::material const> materials,
                  double thickness)
        : walls_(walls.begin(), walls.end()), materials_(materials.size()), motion_(walls.size()), force_(walls.size()),
          stiffness_(walls.size()) {
        for (std::size_t w = 0; w < walls_.size(); ++w) {
            walls_[w].validate("wall " + std::to_string(w));
            walls_[w].normal = walls_[w].normal / norm(walls_[w].normal);
            motion_[w].point = walls_[w].point;
            for (auto const& m : materials) parameters_.add(ContactLaw::combine(m, walls_[w].material, thickness));
        }
    }

    bool empty() const noexcept { return walls_.empty(); }
    /// Adds the largest displacement of a block's particles in a step, m. Call it after each step for each block.
    void add_path(std::size_t block, Real path) noexcept {
        if (block < path_.size()) path_[block] += path;
    }
    /// Whether particles or walls may have moved so far since update() that the list lacks a contact. If the path of a
    /// block does not decide this, the function checks the positions of its particles. Thus one fast particle makes it
    /// check one block only.
    bool outdated(particle_store<Real, Dim> const& store) {
        if (empty()) return false;
        if (reach_ < 0) return true;
        for (std::size_t b = 0; b < path_.size(); ++b) {
            if (path_[b] + walls_path_ <= room_[b]) continue;
            Real const clearance = clearance_of(store, b);
            if (!(clearance > reach_ / 4)) return true;
            path_[b] = 0;
            room_[b] = clearance + walls_path_;
        }
        return false;
    }

    /// Lists the particles that may touch a wall before they have moved by `reach`. Listed contacts keep their
    /// histories.
    /// \param reach m
    /// \param tolerance only for the first list, 1: particles whose gap or overlap is at most this fraction of their
    ///        radius start as touching, with zero force at that distance
    void update(particle_store<Real, Dim> const& store, Real reach, Real tolerance = 0) {
        bool const first = reach_ < 0;
        reach_ = reach;
        walls_path_ = 0;
        std::vector<near_wall> listed;
        std::size_t old = 0;
        for (std::size_t w = 0; w < walls_.size(); ++w)
            for (std::size_t k = 0; k < store.size(); ++k) {
                Real const r = store.radius(k);
                Real const distance = height(store.position(k), w);
                bool const close = distance <= r + std::max(reach, tolerance * r);
                while (old < near_.size() && near_[old].before(w, k)) ++old;
                bool const known = old < near_.size() && near_[old].plane == w && near_[old].particle == k;
                if (!close) continue;
                bool const touches = first && std::abs(distance - r) <= tolerance * r;
                Real const start = touches ? distance : r;
                listed.push_back(known ? near_[old]
                                       : near_wall{w, k, ContactLaw::template initial<Real, Dim>(start, r)});
            }
        near_ = std::move(listed);
        std::size_t const blocks = (store.size() + block_particles - 1) / block_particles;
        path_.assign(blocks, Real(0));
        room_.resize(blocks);
        for (std::size_t b = 0; b < blocks; ++b) room_[b] = clearance_of(store, b);
    }

    /// Adds the forces of the walls on the particles to `out`, and their energies to `energy`.
    /// \param time_step length of the last step, s
    /// \param out in 2D one record {F_x, F_y, torque over radius, 0} per particle; in 3D two records (force, torque
    ///        over radius); N
    /// \param energy overwritten
    /// \return internal index of a particle whose centre is beyond a wall, or -1
    std::int32_t evaluate(particle_store<Real, Dim> const& store, Real time_step,
                          typename Damping::parameters const& damping, record_column<Real>& out, pair_energy& energy) {
        std::int32_t beyond = -1;
        for (auto& f : force_) f = {};
        std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
        energy = {};
        for (auto& n : near_) {
            auto const i = load_particle(store, n.particle);
            Real const distance = height(i.position, n.plane);
            if (!(distance > 0)) beyond = std::int32_t(n.particle);
            auto frame = frame_at(n.plane, i, convert<Real>(motion_[n.plane].velocity), distance, time_step);
            rotate_history(n.state, frame, i.spin, time_step);
            auto const& law = row_of(store, n);
            if constexpr (stiffens<ContactLaw, Dim>)
                deepest_ =
                    std::max(deepest_, double((touching_distance_of(frame.motion, n.state) - distance) / i.radius));
            auto const answer = evaluate_law(law, frame, n.state, i.spin, time_step);
            Real normal_force = answer.normal_force;
            if (normal_force < 0)
                stiffness_[n.plane] += double(dashpot_stiffness<ContactLaw>(law, frame.motion, n.state));
            if constexpr (Damping::acts_on_pairs) {
                // A wall counts as infinitely heavy: the effective mass of the pair is the particle's mass.
                Real const drag =
                    Damping::pair_force(damping, dashpot_stiffness<ContactLaw>(law, frame.motion, n.state), 2 * i.mass,
                                        2 * i.mass, frame.motion.normal_rate);
                if (normal_force < 0)
                    normal_force =
                        dashpot_pulls<Damping> ? normal_force + drag : std::min(normal_force + drag, Real(0));
                energy.damped += double((normal_force - answer.normal_force) * frame.motion.normal_rate * time_step);
            }
            n.state = answer.history;
            energy.stored += stored_energy_of(answer);
            if constexpr (states_energies<ContactLaw, Dim>) energy.dissipated += double(answer.dissipated_energy);
            auto const force = frame.force(normal_force, answer.shear_force);
            auto const torque = frame.torque_per_radius(answer.shear_force);
            std::size_t const row = n.particle * pair_forces<Real, Dim>::records_per_pair;
            for (int axis = 0; axis < Dim; ++axis) {
                out.at(row, axis) += force[axis];
                force_[n.plane][axis] -= double(force[axis]);
            }
            for (int axis = 0; axis < rotation_dim<Dim>; ++axis)
                out.at(Dim == 2 ? row : row + 1, Dim == 2 ? 2 : axis) += torque[axis];
            if constexpr (carries_moment<ContactLaw>) {
                auto const moment = frame.moment(answer);
                for (int axis = 0; axis < rotation_dim<Dim>; ++axis)
                    out.at(Dim == 2 ? row : row + 1, Dim == 2 ? 2 : axis) += moment[axis] / i.radius;
            }
        }
        return beyond;
    }

    /// Calls visit(number of the wall, internal index, history) for the listed particles: those that touch a wall or
    /// may soon.
    template <class Visit>
    void for_each_listed(Visit const& visit) const {
        for (auto const& n : near_) visit(n.plane, n.particle, n.state);
    }
    /// Frame of a particle and a wall that has moved further than its present position says.
    /// \param moved displacement of the wall, m
    /// \param velocity of the wall, m/s
    pair_frame<Real, Dim> frame(std::size_t w, body<Real, Dim> const& particle, vec<double, Dim> const& moved,
                                vec<double, Dim> const& velocity, Real time_step) const {
        Real const distance = height(particle.position, w) - Real(dot(moved, walls_[w].normal));
        auto found = frame_at(w, particle, convert<Real>(velocity), distance, time_step);
        turn_frame(found, particle.spin, time_step);
        return found;
    }

    /// Force of the particles on a wall in the last evaluation, N.
    vec<double, Dim> force(std::size_t w) const noexcept { return force_[w]; }
    /// Sum of the normal stiffnesses of the contacts that a wall had in the last evaluation, N/m.
    double stiffness(std::size_t w) const noexcept { return stiffness_[w]; }

    /// \name Motion
    /// \{
    vec<double, Dim> point(std::size_t w) const noexcept { return motion_[w].point; }
    vec<double, Dim> normal(std::size_t w) const noexcept { return walls_[w].normal; }
    /// Velocity in the last step, m/s.
    vec<double, Dim> velocity(std::size_t w) const noexcept { return motion_[w].velocity; }
    /// Velocity in the next step, m/s.
    vec<double, Dim> next_velocity(std::size_t w) const noexcept { return motion_[w].next; }
    void set_velocity(std::size_t w, vec<double, Dim> const& v) noexcept { motion_[w].next = v; }
    /// Moves the walls by one step.
    /// \return power of the walls against the forces of the last evaluation, W: with the velocities of the last step,
    ///         and with those of this step
    std::array<double, 2> advance(double time_step) noexcept {
        std::array<double, 2> power{};
        double farthest = 0;
        for (std::size_t w = 0; w < motion_.size(); ++w) {
            auto& m = motion_[w];
            power[0] -= dot(force_[w], m.velocity);
            m.velocity = m.next;
            power[1] -= dot(force_[w], m.velocity);
            auto const displacement = m.velocity * time_step;
            m.point += displacement;
            farthest = std::max(farthest, norm(displacement));
        }
        walls_path_ += Real(farthest);
        return power;
    }
    /// Largest speed of a wall in the next step, m/s.
    double fastest_next() const noexcept {
        double most = 0;
        for (auto const& m : motion_) most = std::max(most, norm(m.next));
        return most;
    }
    /// Largest speed of a wall in the last step, m/s.
    double fastest() const noexcept {
        double most = 0;
        for (auto const& m : motion_) most = std::max(most, norm(m.velocity));
        return most;
    }
    /// \}

    /// Distance by which particles and walls may still approach before a contact arises that is not listed, m.
    double remaining() const noexcept {
        Real least = std::numeric_limits<Real>::infinity();
        for (std::size_t b = 0; b < path_.size(); ++b) least = std::min(least, room_[b] - path_[b]);
        return std::max(double(least) - double(walls_path_), 0.0);
    }
    /// Largest overlap in the evaluations since the last call, as a share of the radius, 1. Only for laws that stiffen.
    /// Resets the record.
    double take_deepest() noexcept { return std::exchange(deepest_, 0.0); }

    /// Calls visit(particle, normal, normal_stiffness, shear_stiffness, lever) for each particle that touches a wall or
    /// may touch one under the assumption; N/m, m.
    template <class Visit>
    void for_each_stiffness(particle_store<Real, Dim> const& store, contact_assumption const& assumed,
                            Visit const& visit) const {
        visit_near(store, assumed, [&](near_wall const& n, double r, double distance, double overlap) {
            auto const k = contact_stiffness<ContactLaw, Dim>(row_of(store, n), overlap, r, 0.0, assumed);
            visit(n.particle, walls_[n.plane].normal, k.normal, k.shear, std::max(distance, 0.0));
        });
    }
    /// Calls visit(contact_seen, pair_stiffness) for the same contacts.
    template <class Visit>
    void for_each_depth(particle_store<Real, Dim> const& store, contact_assumption const& assumed,
                        Visit const& visit) const {
        visit_near(store, assumed, [&](near_wall const& n, double r, double, double overlap) {
            auto const approach = motion_[n.plane].next - convert<double>(store.velocity(n.particle));
            visit(contact_seen{overlap, r, double(store.mass(n.particle)), dot(approach, walls_[n.plane].normal)},
                  contact_stiffness<ContactLaw, Dim>(row_of(store, n), overlap, r, 0.0, assumed));
        });
    }
    /// Calls visit(particle, normal, moment_stiffness) for the same contacts. Only for laws with moments.
    template <class Visit>
    void for_each_moment_stiffness([[maybe_unused]] particle_store<Real, Dim> const& store,
                                   [[maybe_unused]] contact_assumption const& assumed,
                                   [[maybe_unused]] Visit const& visit) const {
        if constexpr (carries_moment<ContactLaw>)
            visit_near(store, assumed, [&](near_wall const& n, double r, double, double) {
                auto const k =
                    ContactLaw::template rotational_stiffness<Dim>(row_of(store, n), Real(r), Real(0), Real(r));
                visit(n.particle, walls_[n.plane].normal,
                      moment_stiffness<double>{double(k.bending), double(k.twisting)});
            });
    }
    std::size_t size() const noexcept { return walls_.size(); }
    /// Parameters of the contact law between a wall and a material of the particles.
    auto const& parameters(std::size_t w, std::size_t material) const noexcept {
        return parameters_.row[w * materials_ + material];
    }
    /// Writes the state that a run changes to an archive, or reads it from one.
    template <class Archive>
    void archive(Archive& ar, particle_store<Real, Dim> const& store) {
        ar(near_, fixed_length{force_}, fixed_length{motion_}, reach_, fixed_length{path_}, fixed_length{room_},
           walls_path_);
        for (auto const& n : near_)
            require_state(n.plane < walls_.size() && n.particle < store.size(),
                          "a contact of a wall or particle that does not exist");
    }

private:
    struct near_wall {
        std::size_t plane, particle;
        history_of<Real> state;
        bool before(std::size_t w, std::size_t k) const noexcept { return plane < w || (plane == w && particle < k); }
    };

    /// Smallest gap between a wall and a particle of a block whose contact is not listed, m.
    Real clearance_of(particle_store<Real, Dim> const& store, std::size_t block) const noexcept {
        Real clearance = std::numeric_limits<Real>::infinity();
        std::size_t const first = block * block_particles, last = std::min(first + block_particles, store.size());
        for (std::size_t w = 0; w < walls_.size(); ++w) {
            auto listed = std::partition_point(near_.begin(), near_.end(),
                                               [&](near_wall const& n) { return n.before(w, first); });
            for (std::size_t k = first; k < last; ++k) {
                if (listed != near_.end() && listed->plane == w && listed->particle == k) {
                    ++listed;
                    continue;
                }
                Real const gap = height(store.position(k), w) - store.radius(k);
                clearance = gap >= clearance ? clearance : gap; // a NaN position must make the clearance NaN
            }
        }
        return clearance;
    }
    auto const& row_of(particle_store<Real, Dim> const& store, near_wall const& n) const noexcept {
        return parameters(n.plane, std::size_t(store.material(n.particle)));
    }
    /// Calls use(entry, radius, distance, overlap) for the particles that touch a wall or may under the assumption; m.
    template <class Use>
    void visit_near(particle_store<Real, Dim> const& store, contact_assumption const& assumed, Use const& use) const {
        for (auto const& n : near_) {
            pair_motion<Real, Dim> const still{Real(0), store.radius(n.particle), Real(0), {}, Real(0)};
            double const distance = double(height(store.position(n.particle), n.plane));
            double const overlap = double(touching_distance_of(still, n.state)) - distance;
            if (-overlap <= assumed.gap) use(n, double(still.radius_i), distance, overlap);
        }
    }
    /// Frame of a particle and its foot point on a wall. The foot point follows the particle along the wall, so the
    /// pair never rotates: the slip is the motion of the particle relative to the plane.
    pair_frame<Real, Dim> frame_at(std::size_t w, body<Real, Dim> const& i, vec<Real, Dim> const& wall_velocity,
                                   Real distance, Real time_step) const {
        vec<Real, Dim> normal{};
        for (int axis = 0; axis < Dim; ++axis) normal[axis] = Real(walls_[w].normal[axis]);
        auto const velocity = i.velocity - wall_velocity;
        body<Real, Dim> const j{i.position - normal * distance, wall_velocity, {}, Real(0), i.mass};
        auto frame = relative_motion(i, j, time_step);
        frame.normal = -normal;
        frame.motion.distance = distance;
        frame.motion.normal_rate = dot(normal, velocity);
        frame.motion.slip = slip(velocity, i.spin, normal, distance, time_step);
        return frame;
    }
    /// The turn of a frame in 3D about its normal: the mean spin of particle and wall. The wall has no spin, and the
    /// normal does not change.
    static void turn_frame([[maybe_unused]] pair_frame<Real, Dim>& frame,
                           [[maybe_unused]] vec<Real, rotation_dim<Dim>> const& spin, [[maybe_unused]] Real time_step) {
        if constexpr (Dim == 3) {
            frame.previous_normal = frame.normal;
            frame.twist = Real(0.5) * dot(spin, frame.normal) * time_step;
        }
    }
    /// Rotates the history of a contact in 3D with its frame.
    static void rotate_history([[maybe_unused]] history_of<Real>& state, [[maybe_unused]] pair_frame<Real, Dim>& frame,
                               [[maybe_unused]] vec<Real, rotation_dim<Dim>> const& spin,
                               [[maybe_unused]] Real time_step) {
        if constexpr (Dim == 3) {
            turn_frame(frame, spin, time_step);
            lacuna::rotate_history<ContactLaw>(state, frame);
        }
    }
    template <class Parameters>
    static auto evaluate_law(Parameters const& law, pair_frame<Real, Dim> const& frame, history_of<Real> const& state,
                          [[maybe_unused]] vec<Real, rotation_dim<Dim>> const& spin, [[maybe_unused]] Real time_step) {
        if constexpr (carries_moment<ContactLaw>)
            return ContactLaw::evaluate(law, frame.motion, frame.relative_rotation(spin, {}, time_step), state);
        else
            return ContactLaw::evaluate(law, frame.motion, state);
    }
    Real height(vec<Real, Dim> const& x, std::size_t w) const noexcept {
        double h = 0;
        for (int axis = 0; axis < Dim; ++axis)
            h += (double(x[axis]) - motion_[w].point[axis]) * walls_[w].normal[axis];
        return Real(h);
    }
    /// Slip of a step, m.
    /// \param velocity of the particle relative to the wall, m/s
    static vec<Real, shear_dim<Dim>> slip(vec<Real, Dim> const& velocity, vec<Real, rotation_dim<Dim>> const& spin,
                                          vec<Real, Dim> const& normal, Real distance, Real time_step) {
        if constexpr (Dim == 2) {
            return {(-dot(perpendicular(-normal), velocity) - distance * spin[0]) * time_step};
        } else {
            auto const along = velocity - normal * dot(normal, velocity);
            return (-along - cross(spin, -normal) * distance) * time_step;
        }
    }

    std::vector<wall_type> walls_;
    std::size_t materials_ = 0;
    parameter_table<ContactLaw, Real> parameters_;
    std::vector<near_wall> near_;
    /// Position of a wall and its velocities in the last and in the next step; m, m/s.
    struct wall_motion {
        vec<double, Dim> point{}, velocity{}, next{};
    };
    std::vector<wall_motion> motion_;
    std::vector<vec<double, Dim>> force_;
    std::vector<double> stiffness_;
    double deepest_ = 0;
    Real reach_ = -1; // of the list; negative: there is no list yet
    std::vector<Real> path_, room_; // by block: path of the particles since the last check, and its limit
    Real walls_path_ = 0;           // path of the fastest wall since update()
};

} // namespace lacuna
