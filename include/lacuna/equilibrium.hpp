// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include <lacuna/equilibrium/interior_point.hpp>
#include <lacuna/equilibrium/parameters.hpp>
#include <lacuna/equilibrium/system.hpp>
#include <lacuna/simulation.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// Static equilibrium of a simulation: the state in which loads, pairs, walls and pressures balance, whatever the time
/// that it takes. It works on the particles, bonds, contacts, pores and loads of the simulation: one may go from steps
/// to an equilibrium and back at any time, and a checkpoint of the simulation holds both.
///
/// Loads and pressures are those that act at the time of the simulation, which does not advance. Velocities are set to
/// zero. A bond that is too strongly loaded in the equilibrium fails.
template <class Model>
class equilibrium {
public:
    static_assert(std::is_same_v<typename Model::real, double>, "equilibrium: the model's real must be double");
    static constexpr int dim = Model::dim;
    using simulation_type = simulation<Model>;
    using point = vec<double, dim>;
    using event_type = break_event<dim>;

    /// \param sim must outlive this object
    /// \throws std::invalid_argument for a parameter out of range
    explicit equilibrium(simulation_type& sim, equilibrium_parameters const& p = {})
        : sim_(sim), s_(sim.state_), parameters_(p), system_(sim.state_) {
        p.validate("equilibrium");
    }

    equilibrium_parameters const& settings() const noexcept { return parameters_; }

    /// Displaces a particle in the next solve(), along axes along which it is fixed. A particle of a rigid plate takes
    /// the plate with it.
    /// \param displacement m
    /// \throws std::invalid_argument for a displacement along an axis that is free
    void move(std::size_t id, point const& displacement) {
        auto const k = sim_.internal(id);
        given_.resize(s_.store.size() * std::size_t(per_particle), 0.0);
        unknowns<dim> const numbers(s_.store, s_.plates);
        for (int axis = 0; axis < dim; ++axis) {
            require_finite("displacement of particle " + std::to_string(id), displacement[axis]);
            if (displacement[axis] == 0) continue;
            if (numbers.of(k, axis) >= 0)
                refuse("displacement of particle " + std::to_string(id), displacement[axis],
                       "0 along an axis along which it is not fixed");
            set_given(k, axis, displacement[axis]);
        }
    }
    /// Turns a particle whose rotation is fixed in the next solve().
    /// \param angle rotation vector, in the plane an angle, rad
    /// \throws std::invalid_argument for a particle whose rotation is free
    void turn(std::size_t id, vec<double, rotation_dim<dim>> const& angle) {
        auto const k = sim_.internal(id);
        given_.resize(s_.store.size() * std::size_t(per_particle), 0.0);
        for (int r = 0; r < rotation_dim<dim>; ++r) {
            require_finite("rotation of particle " + std::to_string(id), angle[r]);
            if (angle[r] != 0 && s_.store.mobility(k, dim) > 0)
                refuse("rotation of particle " + std::to_string(id), angle[r], "0 where rotation is not fixed");
            given_[k * std::size_t(per_particle) + std::size_t(dim + r)] = angle[r] * s_.store.radius(k);
        }
    }
    /// Displaces a wall in the next solve(). A wall that a servo moves goes where the stress on it is the servo's.
    /// \param displacement m
    /// \throws std::invalid_argument for a wall that does not exist, and for one that a servo moves
    void move_wall(std::size_t w, point const& displacement) {
        if (w >= s_.walls.size())
            refuse("wall", double(w), "below the number of walls, " + std::to_string(s_.walls.size()));
        for (int axis = 0; axis < dim; ++axis)
            require_finite("displacement of wall " + std::to_string(w), displacement[axis]);
        if (s_.wall_motions.has_servo(w))
            refuse("wall " + std::to_string(w), "moved by a servo", "free of it to be moved");
        wall_given_.resize(s_.walls.size());
        wall_given_[w] = displacement;
    }

    /// Searches for the equilibrium under the present loads, from the present state, and moves the simulation there.
    ///
    /// Bonds fail on the way, one after the other: each increment ends where the first bond fails, and the next one
    /// begins from there at the same loads. See events().
    /// \throws std::logic_error for a model with fluid whose pores are not filled
    /// \throws std::invalid_argument for a contact law whose force does not grow with the overlap, and for parts of a
    ///         simulation that no equilibrium knows: merged pores
    equilibrium_result solve() {
        begin();
        equilibrium_result result;
        double const radius = median_radius(s_.store.radii());
        double regularisation = parameters_.regularisation;
        int const factorised = system_.matrix().factorisations();
        resistance_ = 0;
        tightness_ = 1;
        reversals_ = 0;
        before_ = {};
        for (idle_ = 0; idle_ < parameters_.solves && regularisation < 1e6; ++idle_) {
            ++result.solves;
            if (!make_increment(regularisation, 0.25 * radius, result)) {
                regularisation *= 8;
                continue;
            }
            if (last_.failures > 0) idle_ = 0;
            if (last_.failures > 0 || given_remains()) continue;
            if (check_balance(result) && last_.whole) break;
            if (last_.whole) tightness_ = std::max(tightness_ / 3, 1e-4);
            if (result.displacement > parameters_.largest_motion * radius) {
                result.outcome = equilibrium_outcome::mechanism;
                break;
            }
            regularisation = next_regularisation(regularisation, result.trials.back().displacement);
        }
        result.factorisations = system_.matrix().factorisations() - factorised;
        result.broken = events_.size();
        end();
        return result;
    }

    /// Bonds that failed in the last solve(), in order.
    std::span<event_type const> events() const noexcept { return events_; }

private:
    static constexpr int per_particle = unknowns<dim>::per_particle;

    void set_given(std::size_t k, int axis, double value) {
        given_[k * std::size_t(per_particle) + std::size_t(axis)] = value;
        for (std::size_t g = 0; g < s_.plates.size(); ++g) {
            auto const members = s_.plates.members(g);
            if (s_.plates.axis(g) != axis || !std::binary_search(members.begin(), members.end(), std::uint32_t(k)))
                continue;
            for (auto const m : members) given_[m * std::size_t(per_particle) + std::size_t(axis)] = value;
        }
    }

    /// Refuses what no equilibrium knows. Brings histories and lists up to date with the positions of the last step,
    /// and the particles to rest.
    void begin() {
        if constexpr (has_fluid<Model>) {
            if (!s_.filled())
                throw std::logic_error("equilibrium: the model has a fluid but fill_pores() was not called");
            if (double const merged = s_.fluid.get()->settings().merge_conductance; std::isfinite(merged))
                refuse("flow.merge_conductance", merged, "infinite for an equilibrium");
        }
        // Before anything changes: it refuses laws.
        system_.begin({}, {}, parameters_.pores == pore_condition::drained, sim_.clock_.time());
        events_.clear();
        remember_prescribed();
        double const last = sim_.clock_.step() > 0 ? sim_.clock_.previous_step() : 0.0;
        s_.pairs.set_force_retention(s_.store, false, s_.settings.threads);
        evaluate_laws(last);
        take_failures();
        stop_particles();
        update_lists(true);
    }
    /// Gives held particles and walls their prescribed velocities back.
    void end() {
        system_.restore();
        given_.clear();
        wall_given_.clear();
        for (std::size_t k = 0; k < s_.store.size(); ++k) {
            point v{};
            for (int axis = 0; axis < dim; ++axis)
                if (s_.store.held(k, axis)) v[axis] = velocity_[k][axis];
            s_.store.set_velocity(k, v);
            if (s_.store.mobility(k, dim) == 0) s_.store.set_spin(k, spin_[k]);
        }
        for (std::size_t w = 0; w < s_.walls.size(); ++w) s_.walls.set_velocity(w, wall_velocity_[w]);
        s_.changes.clear();
        s_.ledger.close();
        sim_.clock_.state_changed();
    }
    void remember_prescribed() {
        velocity_.clear();
        spin_.clear();
        wall_velocity_.clear();
        for (std::size_t k = 0; k < s_.store.size(); ++k) {
            velocity_.push_back(s_.store.velocity(k));
            spin_.push_back(s_.store.spin(k));
        }
        for (std::size_t w = 0; w < s_.walls.size(); ++w) wall_velocity_.push_back(s_.walls.next_velocity(w));
    }

    /// Falls by ten, but not so far that a mechanism, which moves as 1 / regularisation, would leave the lists. If
    /// solves lead back and forth, around a state that snaps, it stays above what the turning of the pairs' forces can
    /// take from the stiffness.
    double next_regularisation(double now, double displacement) const {
        double const least =
            reversals_ > 3 ? std::max(parameters_.regularisation, turning_) : parameters_.regularisation;
        return std::max({now / 10, least, std::min(now, now * 2 * displacement / longest_motion())});
    }
    /// Counts the increments that lead back.
    void count_reversal() {
        double const size = increment_.norm() * before_.norm();
        reversals_ += before_.size() == increment_.size() && increment_.dot(before_) < -0.5 * size;
        before_ = increment_;
    }
    bool given_remains() const noexcept { return !given_.empty() || !wall_given_.empty(); }
    /// Solves for one increment and moves the simulation by the share of it that its lists and bonds allow.
    /// \param longest displacement in one iteration, m
    /// \return whether the solve converged
    bool make_increment(double regularisation, double longest, equilibrium_result& result) {
        double const share = begin_increment(0.2 * longest_motion());
        auto const scales = find_scales(longest, regularisation);
        auto tighter = parameters_;
        tighter.tolerance *= tightness_;
        if (!interior_point(system_, scales, tighter).solve(increment_)) {
            system_.restore();
            return false;
        }
        system_.hold_loose(increment_, parameters_.tolerance * system_.largest_force(), 0.5 * longest_motion());
        double const moved = system_.largest_motion(increment_);
        double part = moved > longest_motion() ? longest_motion() / moved : 1.0;
        part = system_.first_failure(increment_, part);
        if (result.trials.empty()) result.first_failure = share * part;
        bool const least = result.trials.empty() || regularisation < result.regularisation;
        if (least) result.regularisation = regularisation;
        result.trials.push_back({regularisation, moved});
        result.displacement += part * moved;
        result.complementarity =
            system_.largest_product() * scales.stiffness / (system_.largest_force() * system_.largest_force());
        turning_ = system_.largest_force() / (2 * median_radius(s_.store.radii()) * scales.stiffness);
        count_reversal();
        last_ = {part == 1, commit(part)};
        if (result.trials.size() == 1 && last_.failures == 0) result.first_failure = 1;
        reduce_given(share * part);
        return true;
    }
    /// \return whether the committed state is in equilibrium by the exact laws
    bool check_balance(equilibrium_result& result) {
        begin_increment(0);
        Eigen::VectorXd forces;
        system_.exact_forces(Eigen::VectorXd::Zero(system_.count()), forces);
        result.unbalanced = forces.size() > 0 ? forces.lpNorm<Eigen::Infinity>() : 0.0;
        result.largest_force = system_.largest_force();
        bool const balanced =
            result.unbalanced <= std::max(parameters_.tolerance * result.largest_force, 4 * negligible_);
        if (balanced && last_.whole) result.outcome = equilibrium_outcome::reached;
        return balanced;
    }

    /// \return share of the given displacements that this increment takes
    double begin_increment(double longest) {
        double most = 0;
        for (double const g : given_) most = std::max(most, std::fabs(g));
        for (auto const& w : wall_given_) most = std::max(most, norm(w));
        double const share = most > longest ? longest / most : 1.0;
        std::vector<double> part(given_);
        std::vector<point> walls(wall_given_);
        for (auto& g : part) g *= share;
        for (auto& w : walls) w = w * share;
        system_.begin(part, walls, parameters_.pores == pore_condition::drained, sim_.clock_.time());
        return share;
    }
    void reduce_given(double share) {
        for (auto& g : given_) g *= 1 - share;
        for (auto& w : wall_given_) w = w * (1 - share);
        if (share >= 1) {
            given_.clear();
            wall_given_.clear();
        }
    }

    /// No two particles outside the candidates may meet within a solve.
    double longest_motion() const { return 0.49 * std::min(s_.pairs.remaining(), s_.walls.remaining()); }

    equilibrium_scales find_scales(double longest, double regularisation) {
        equilibrium_scales scales{1, 0, 0, longest, 0, 0};
        std::vector<double> stiffness;
        double squares = 0;
        std::size_t count = 0;
        contact_assumption const near{s_.pairs.neighbors().settings().skin, 1e-3};
        s_.pairs.for_each_pair_tangent(s_.store, near, [&](auto const& t) {
            stiffness.push_back(t.normal_stiffness);
            double const force = t.prestress * norm(s_.store.nearest(s_.store.position(t.j) - s_.store.position(t.i)));
            squares += force * force;
            count += force > 0;
        });
        s_.walls.for_each_stiffness(
            s_.store, near,
            [&](std::size_t, auto const&, double k, double, double) { stiffness.push_back(k); });
        if (!stiffness.empty()) {
            auto const middle = stiffness.begin() + std::ptrdiff_t(stiffness.size() / 2);
            std::nth_element(stiffness.begin(), middle, stiffness.end());
            scales.stiffness = *middle;
        }
        double const across = std::pow(double(s_.store.size()), dim == 2 ? 0.5 : 2.0 / 3);
        scales.force = std::max({system_.total_load() / across, count > 0 ? std::sqrt(squares / double(count)) : 0.0,
                                 0.1 * scales.stiffness * system_.largest_given()});
        double extent = 0;
        for (std::size_t k = 0; k < s_.store.size(); ++k)
            for (int axis = 0; axis < dim; ++axis) extent = std::max(extent, std::fabs(s_.store.position(k)[axis]));
        // Given displacements may end in a state without any force, of which no share can be a tolerance.
        if (!(system_.total_load() > 0))
            resistance_ = std::max(resistance_, 1e-2 * scales.stiffness * system_.largest_given());
        negligible_ = std::max(8 * std::numeric_limits<double>::epsilon() * extent * scales.stiffness,
                               0.1 * parameters_.tolerance * resistance_);
        scales.regularisation = regularisation * scales.stiffness;
        // Where nothing else resists, the forces are those of the regularisation: to solve further has no meaning.
        double const given = system_.largest_given();
        scales.negligible = std::max(negligible_, 4 * scales.regularisation * given);
        scales.barrier = 1e-4 * scales.regularisation * given * given;
        return scales;
    }

    /// Moves the simulation by a share of the increment, by the exact laws.
    /// \return number of bonds that failed
    std::size_t commit(double share) {
        system_.displace(increment_, share);
        double most = 0;
        for (std::size_t k = 0; k < s_.store.size(); ++k) most = std::max(most, norm(s_.store.velocity(k)));
        for (std::size_t w = 0; w < s_.walls.size(); ++w) s_.walls.set_velocity(w, system_.wall_motion()[w]);
        if (s_.walls.size() > 0) s_.walls.advance(1.0);
        for (int c = 0; c < s_.pairs.chunks(); ++c) s_.pairs.add_path(c, most);
        for (std::size_t b = 0; b * s_.walls.block_particles < s_.store.size(); ++b) s_.walls.add_path(b, most);
        evaluate_laws(1.0);
        if constexpr (has_fluid<Model>)
            s_.fluid.get()->settle_pores(s_.store.positions(), s_.store.radii().data(),
                                         parameters_.pores == pore_condition::sealed);
        std::size_t const failures = take_failures();
        stop_particles();
        update_lists(failures > 0);
        return failures;
    }
    /// Commits the histories of pairs and walls at the present positions.
    void evaluate_laws(double time_step) {
        for (int c = 0; c < s_.pairs.chunks(); ++c) s_.pairs.template evaluate<true>(s_.store, c, time_step);
        s_.walls.evaluate(s_.store, time_step, s_.settings.damping, s_.other_forces, s_.wall_energy);
    }
    std::size_t take_failures() {
        auto const found = s_.pairs.collect_events();
        for (auto e : found) {
            e.step = sim_.clock_.step();
            e.time = sim_.clock_.time();
            events_.push_back(e);
        }
        return found.size();
    }
    void stop_particles() {
        for (std::size_t k = 0; k < s_.store.size(); ++k) {
            s_.store.set_velocity(k, {});
            s_.store.set_spin(k, {});
        }
        for (std::size_t w = 0; w < s_.walls.size(); ++w) s_.walls.set_velocity(w, {});
        if (s_.walls.size() > 0) s_.walls.advance(0.0);
    }
    void update_lists(bool changed) {
        if (s_.pairs.remaining() < 0.7 * s_.pairs.neighbors().settings().skin) {
            s_.pairs.search_again(s_.store);
            changed = true;
        } else if (changed) {
            s_.pairs.update(s_.store);
        }
        if (s_.walls.remaining() < 0.7 * s_.pairs.neighbors().settings().skin) s_.update_walls();
        if (changed) s_.fluid.map_throats(s_.pairs);
    }

    simulation_type& sim_;
    simulation_state<Model>& s_;
    equilibrium_parameters parameters_;
    equilibrium_system<Model> system_;
    std::vector<double> given_; // displacements still to be made, of all freedoms, m
    std::vector<point> wall_given_;
    std::vector<event_type> events_;
    Eigen::VectorXd increment_, before_;
    int reversals_ = 0;
    double negligible_ = 0, resistance_ = 0; // forces, N
    double tightness_ = 1; // of a solve beside that of the result, which is judged by the exact laws
    double turning_ = 0; // largest force over the distance of the particles and the stiffness, 1
    int idle_ = 0;       // solves since the last bond failed
    struct {
        bool whole; // whether the simulation moved by the whole increment
        std::size_t failures;
    } last_{};
    std::vector<point> velocity_, wall_velocity_; // of the simulation, prescribed
    std::vector<vec<double, rotation_dim<dim>>> spin_;
};
LACUNA_END_PACKS

} // namespace lacuna
