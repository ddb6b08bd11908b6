// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/equilibrium/energy_account.hpp>
#include <lacuna/equilibrium/event.hpp>
#include <lacuna/equilibrium/interior_point.hpp>
#include <lacuna/equilibrium/parameters.hpp>
#include <lacuna/equilibrium/slow_time.hpp>
#include <lacuna/equilibrium/system.hpp>
#include <lacuna/simulation/simulation_state.hpp>
#include <lacuna/simulation/step_clock.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// Brings the state of a simulation to equilibrium in increments: each one is solved for, taken as far as lists and
/// bonds allow, and committed by the engine's own laws. The parts of lacuna::equilibrium are made of these.
template <class Model>
class equilibrium_stepper {
public:
    static constexpr int dim = Model::dim;
    using point = vec<double, dim>;
    using event_type = equilibrium_event<dim>;
    using vector = Eigen::VectorXd;

    equilibrium_stepper(simulation_state<Model>& state, step_clock<Model>& clock, equilibrium_parameters const& p)
        : s_(state), clock_(clock), parameters_(p), drained_(p.pores == pore_condition::drained), system_(state),
          account_(state, system_) {}

    equilibrium_parameters const& settings() const noexcept { return parameters_; }

    /// Displaces a held freedom in the next increments.
    /// \param value displacement, or angle times radius, m
    void give(std::size_t k, int freedom, double value) {
        given_.resize(s_.store.size() * std::size_t(per_particle), 0.0);
        given_[k * std::size_t(per_particle) + std::size_t(freedom)] = value;
        if (freedom >= dim) return;
        for (std::size_t g = 0; g < s_.plates.size(); ++g) {
            auto const members = s_.plates.members(g);
            if (s_.plates.axis(g) != freedom || !std::binary_search(members.begin(), members.end(), std::uint32_t(k)))
                continue;
            for (auto const m : members) given_[m * std::size_t(per_particle) + std::size_t(freedom)] = value;
        }
    }
    void give_wall(std::size_t w, point const& displacement) {
        wall_given_.resize(s_.walls.size());
        wall_given_[w] = displacement;
    }
    void drop_given() noexcept {
        given_.clear();
        wall_given_.clear();
    }
    /// Share of what is given that one increment takes.
    double given_share() const noexcept {
        double const most = largest_given(), longest = 0.2 * longest_motion();
        // A share that rounding leaves just below 1 would be asked for again, without end.
        return most > longest * (1 + 1e-9) ? longest / most : 1.0;
    }

    /// \param group_of group of each bond; negative: its own
    void group_bonds(std::vector<int> group_of) { group_of_ = std::move(group_of); }

    /// Refuses what no equilibrium knows. Brings histories and lists up to date with the positions of the last step,
    /// and the particles to rest.
    /// \param flowing whether apertures and throats are needed
    void begin(bool flowing = false) {
        if constexpr (has_fluid<Model>) {
            if (!s_.filled())
                throw std::logic_error("equilibrium: the model has a fluid but fill_pores() was not called");
            if (double const merged = s_.fluid.get()->settings().merge_conductance; std::isfinite(merged))
                refuse("flow.merge_conductance", merged, "infinite for an equilibrium");
        }
        bool const grouped = group_of_.size() == s_.pairs.bond_records().size();
        if (parameters_.failures == failure_choice::worst_of_groups && !grouped)
            refuse("equilibrium.failures", "worst_of_groups", "first until group_bonds() has given each bond a group");
        list(); // before anything changes: it refuses laws
        remember_prescribed();
        // Prescribed velocities that came back after an equilibrium have moved nothing since.
        double const last = clock_.step() > 0 && !rests_.continues(clock_.now()) ? clock_.previous_step() : 0.0;
        s_.pairs.set_force_retention(s_.store, false, s_.settings.threads);
        evaluate_laws(last);
        if (flowing) open_throats();
        take_failures();
        stop_particles();
        update_lists(true);
        list();
        account_.begin(clock_.step());
    }
    /// Gives held particles and walls their prescribed velocities back.
    void end() {
        system_.restore();
        drop_given();
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
        clock_.state_changed();
        rests_.close(clock_.now());
    }

    /// Goes on at constant loads, and through all failures of bonds, until the state is in equilibrium or has none.
    /// \param unless_balanced whether a state that is in equilibrium already stays as it is
    void settle(equilibrium_result& result, bool unless_balanced) {
        double const radius = median_radius(s_.store.radii());
        double regularisation = parameters_.regularisation;
        int const factorised = system_.factorisations();
        std::size_t const broken = events_.size();
        resistance_ = 0;
        tightness_ = 1;
        reversals_ = 0;
        before_ = {};
        last_ = {true, 0};
        result.outcome = equilibrium_outcome::not_converged;
        bool done = unless_balanced && !given_remains() && check_balance(result);
        for (idle_ = 0; !done && idle_ < parameters_.solves && regularisation < 1e6; ++idle_) {
            ++result.solves;
            if (!find_increment(regularisation)) {
                last_.failures = 0;
                regularisation *= 8;
                continue;
            }
            take_increment(regularisation, result);
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
        result.factorisations += system_.factorisations() - factorised;
        result.fill = system_.matrix().fill();
        result.broken += events_.size() - broken;
        result.energy += account_.take();
        account_.note_loads();
    }

    /// Solves for one increment, without moving the simulation.
    /// \return whether the solve converged
    bool find_increment(double regularisation) {
        share_ = begin_increment();
        scales_ = find_scales(0.25 * median_radius(s_.store.radii()), regularisation);
        auto tighter = parameters_;
        tighter.tolerance *= tightness_;
        if (!interior_point(system_, scales_, tighter).solve(increment_)) {
            system_.restore();
            return false;
        }
        system_.hold_loose(increment_, parameters_.tolerance * system_.largest_force(), 0.5 * longest_motion());
        moved_ = system_.largest_motion(increment_);
        part_ = moved_ > longest_motion() ? longest_motion() / moved_ : 1.0;
        bool const groups = parameters_.failures == failure_choice::worst_of_groups;
        failing_ = system_.failures(increment_, part_, !groups);
        if (!failing_.empty()) part_ = failing_.front().share;
        return true;
    }
    /// Share of the increment up to which lists and bonds allow to go.
    double part() const noexcept { return part_; }
    /// Unbalanced force, over the largest force, at that share of the increment under the present loads, 1.
    double unbalance_at_part() {
        system_.exact_forces(increment_, part_);
        auto const forces = system_.unbalanced();
        double const most = forces.size() > 0 ? forces.template lpNorm<Eigen::Infinity>() : 0.0;
        return most / std::max(system_.largest_force(), std::numeric_limits<double>::min());
    }
    /// Moves the simulation by that share.
    void take_increment(double regularisation, equilibrium_result& result) {
        if (result.trials.empty()) result.first_failure = share_ * part_;
        if (result.trials.empty() || regularisation < result.regularisation) result.regularisation = regularisation;
        result.trials.push_back({regularisation, moved_});
        result.displacement += part_ * moved_;
        result.complementarity =
            system_.largest_product() * scales_.stiffness / (system_.largest_force() * system_.largest_force());
        turning_ = system_.largest_force() / (2 * median_radius(s_.store.radii()) * scales_.stiffness);
        count_reversal();
        event_load_ = given_load_.value_or(result.trials.size() == 1 ? result.first_failure : 1.0);
        last_ = {part_ == 1, commit()};
        if (result.trials.size() == 1 && last_.failures == 0) result.first_failure = 1;
        reduce_given(share_ * part_);
    }
    /// Number of bonds that failed in the last increment.
    std::size_t failures() const noexcept { return last_.failures; }

    /// The bonds that failed since clear_events().
    std::span<event_type const> events() const noexcept { return events_; }
    void clear_events() noexcept { events_.clear(); }
    /// Sets the load that the next events get; none: the share of the increment.
    void set_event_load(std::optional<double> load) noexcept { given_load_ = load; }
    int factorisations() const noexcept { return system_.factorisations(); }
    equilibrium_energy take_energy() noexcept { return account_.take(); }

    /// \return whether the committed state is in equilibrium by the exact laws
    bool check_balance(equilibrium_result& result) {
        system_.give({}, {});
        find_scales(0, parameters_.regularisation);
        system_.exact_forces(vector::Zero(system_.count()));
        auto const forces = system_.unbalanced();
        result.unbalanced = forces.size() > 0 ? forces.template lpNorm<Eigen::Infinity>() : 0.0;
        result.largest_force = system_.largest_force();
        bool const balanced =
            result.unbalanced <= std::max(parameters_.tolerance * result.largest_force, 4 * negligible_);
        if (balanced && last_.whole) result.outcome = equilibrium_outcome::reached;
        return balanced;
    }

protected:
    static constexpr int per_particle = unknowns<dim>::per_particle;

    void list() {
        system_.set_flow_time(flow_time_);
        system_.begin(drained_, clock_.time() + flow_time_);
    }
    /// Brings apertures up to date with the present forces. In slow time fluid flows through all throats.
    void open_throats() {
        if constexpr (has_fluid<Model>) {
            s_.fluid.get()->refresh_apertures(s_.store.particle_records(), s_.pairs.normal_forces(),
                                              s_.settings.threads);
            s_.fluid.get()->activate_all_throats();
        }
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
    double largest_given() const noexcept {
        double most = 0;
        for (double const g : given_) most = std::max(most, std::fabs(g));
        for (auto const& w : wall_given_) most = std::max(most, norm(w));
        return most;
    }

    /// \return share of the given displacements that this increment takes
    double begin_increment() {
        double const share = given_share();
        std::vector<double> part(given_);
        std::vector<point> walls(wall_given_);
        for (auto& g : part) g *= share;
        for (auto& w : walls) w = w * share;
        system_.give(part, walls);
        return share;
    }
    void reduce_given(double share) {
        for (auto& g : given_) g *= 1 - share;
        for (auto& w : wall_given_) w = w * (1 - share);
        if (share >= 1) drop_given();
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
        // A bond that has failed leaves forces that are far from balance: a small barrier would shorten the first
        // steps.
        if (last_.failures > 0)
            if (auto const left = system_.unbalanced(); left.size() > 0)
                scales.force = std::max(scales.force, left.template lpNorm<Eigen::Infinity>());
        double extent = 0;
        for (std::size_t k = 0; k < s_.store.size(); ++k)
            for (int axis = 0; axis < dim; ++axis) extent = std::max(extent, std::fabs(s_.store.position(k)[axis]));
        // Given displacements may end in a state without any force, of which no share can be a tolerance.
        if (!(system_.total_load() > 0))
            resistance_ = std::max(resistance_, 1e-2 * scales.stiffness * system_.largest_given());
        // In slow time the stiffness of closed pores, which may be far above that of the pairs, counts too.
        double const stiffest = std::max(scales.stiffness, slow_ ? system_.stiffest_pore() : 0.0);
        negligible_ = std::max(8 * std::numeric_limits<double>::epsilon() * extent * stiffest,
                               0.1 * parameters_.tolerance * resistance_);
        scales.regularisation = regularisation * scales.stiffness;
        // Where nothing else resists, the forces are those of the regularisation: to solve further has no meaning.
        double const given = system_.largest_given();
        scales.negligible = std::max(negligible_, 4 * scales.regularisation * given);
        scales.barrier = 1e-4 * scales.regularisation * given * given;
        return scales;
    }

    /// Moves the simulation by the share of the increment, by the exact laws.
    /// \return number of bonds that failed
    std::size_t commit() {
        system_.exact_forces(increment_, part_);
        account_.book_work();
        system_.displace(increment_, part_);
        double most = 0;
        for (std::size_t k = 0; k < s_.store.size(); ++k) most = std::max(most, norm(s_.store.velocity(k)));
        for (std::size_t w = 0; w < s_.walls.size(); ++w) s_.walls.set_velocity(w, system_.wall_motion()[w]);
        if (s_.walls.size() > 0) s_.walls.advance(1.0);
        for (int c = 0; c < s_.pairs.chunks(); ++c) s_.pairs.add_path(c, most);
        for (std::size_t b = 0; b * s_.walls.block_particles < s_.store.size(); ++b) s_.walls.add_path(b, most);
        evaluate_laws(1.0);
        if (flow_time_ > 0) clock_.pass(flow_time_);
        std::size_t const failures = break_bonds();
        account_.book_laws();
        account_.remember_fluid();
        settle_fluid();
        stop_particles();
        update_lists(failures > 0);
        account_.book_fluid();
        list();
        account_.read();
        return failures;
    }
    /// Brings the fluid to the new positions of the particles. The time in which it flows has passed then.
    void settle_fluid() {
        double const dt = std::exchange(flow_time_, 0.0);
        if constexpr (has_fluid<Model>) {
            auto const points = s_.store.positions();
            auto const* radii = s_.store.radii().data();
            if (!(dt > 0)) return s_.fluid.get()->settle_pores(points, radii, !drained_);
            s_.fluid.get()->take_flow(system_.flow().finish(points, radii), points, radii, dt);
            s_.fluid.deactivate_slow_throats(s_.store, s_.pairs);
        }
    }
    /// Takes the bonds that failed by their laws, and in each other group the one that fails first.
    std::size_t break_bonds() {
        std::size_t failures = take_failures();
        if (failures == 0 && !failing_.empty()) {
            // Rounding saved the bond at which the increment ends. Without it the next one would end here again.
            s_.pairs.break_bond(s_.store, failing_.front().label, 1.0);
            failures = take_failures();
        }
        if (parameters_.failures == failure_choice::first || failures == 0) return failures;
        std::vector<int> groups;
        auto const is_new = [&](std::int32_t label) {
            int const group = group_of_[std::size_t(label)];
            if (group >= 0 && std::find(groups.begin(), groups.end(), group) != groups.end()) return false;
            groups.push_back(group);
            return true;
        };
        for (std::size_t e = events_.size() - failures; e < events_.size(); ++e) is_new(events_[e].bond);
        for (auto const& f : failing_) {
            if (s_.pairs.bond_records()[std::size_t(f.label)].state != bond_state::intact || !is_new(f.label)) continue;
            s_.pairs.break_bond(s_.store, f.label, 1.0);
            failures += take_failures();
        }
        return failures;
    }
    /// Commits the histories of pairs and walls at the present positions.
    void evaluate_laws(double time_step) {
        for (int c = 0; c < s_.pairs.chunks(); ++c) s_.pairs.template evaluate<true>(s_.store, c, time_step);
        s_.walls.evaluate(s_.store, time_step, s_.settings.damping, s_.other_forces, s_.wall_energy);
    }
    std::size_t take_failures() {
        auto const found = s_.pairs.collect_events();
        for (auto const& e : found) {
            events_.push_back({e, event_load_});
            events_.back().step = clock_.step();
            events_.back().time = clock_.time();
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

    simulation_state<Model>& s_;
    step_clock<Model>& clock_;
    equilibrium_parameters parameters_;
    bool drained_, slow_ = false;
    double flow_time_ = 0; // in which fluid flows in the next increment, s
    slow_history rests_;   // the end of the last equilibrium
    equilibrium_system<Model> system_;
    energy_account<Model> account_;
    std::vector<double> given_; // displacements still to be made, of all freedoms, m
    std::vector<point> wall_given_;
    std::vector<int> group_of_; // group of each bond
    std::vector<event_type> events_;
    std::optional<double> given_load_;
    double event_load_ = 1; // of the events to come
    // The increment that find_increment() found.
    vector increment_;
    equilibrium_scales scales_{};
    double share_ = 1, part_ = 1, moved_ = 0; // of the given; of the increment; its largest displacement, m
    std::vector<typename equilibrium_system<Model>::failure> failing_;
    vector before_; // the increment before
    int reversals_ = 0;
    double negligible_ = 0, resistance_ = 0; // forces, N
    double tightness_ = 1; // of a solve beside that of the result, which is judged by the exact laws
    double turning_ = 0; // largest force over the distance of the particles and the stiffness, 1
    int idle_ = 0;       // solves since the last bond failed
    struct {
        bool whole; // whether the simulation moved by the whole increment
        std::size_t failures;
    } last_{true, 0};
    std::vector<point> velocity_, wall_velocity_; // of the simulation, prescribed
    std::vector<vec<double, rotation_dim<dim>>> spin_;
};
LACUNA_END_PACKS

} // namespace lacuna
