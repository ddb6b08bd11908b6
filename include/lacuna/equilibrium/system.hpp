// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/equilibrium/bond_response.hpp>
#include <lacuna/equilibrium/contact_formula.hpp>
#include <lacuna/equilibrium/frictional_contact.hpp>
#include <lacuna/equilibrium/pair_operator.hpp>
#include <lacuna/equilibrium/parameters.hpp>
#include <lacuna/equilibrium/slow_flow.hpp>
#include <lacuna/equilibrium/stiffness_matrix.hpp>
#include <lacuna/equilibrium/unknowns.hpp>
#include <lacuna/interactions/kinematics.hpp>
#include <lacuna/interactions/pair_loop.hpp>
#include <lacuna/pores/flow/sealed_pressure.hpp>
#include <lacuna/pores/mesh/geometry.hpp>
#include <lacuna/simulation/force_terms.hpp>
#include <lacuna/simulation/simulation_state.hpp>

namespace lacuna {

/// Forces of the exact laws on all freedoms, held ones too: per_particle numbers per particle, N.
template <int Dim>
struct exact_force_record {
    Eigen::VectorXd inner;                 ///< of bonds, contacts, walls and pressures
    Eigen::VectorXd load;                  ///< of loads, weight and the model's own forces
    std::vector<vec<double, Dim>> on_wall; ///< of the particles on each wall

    void clear(std::size_t freedoms, std::size_t walls) {
        inner.setZero(Eigen::Index(freedoms));
        load.setZero(Eigen::Index(freedoms));
        on_wall.assign(walls, {});
    }
    double sum(std::size_t k, int freedom) const {
        auto const at = Eigen::Index(k) * unknowns<Dim>::per_particle + freedom;
        return inner[at] + load[at];
    }
};

LACUNA_BEGIN_PACKS
/// The equations of equilibrium of a model: forces on all unknowns for an increment from the committed state, and their
/// stiffness. The unknowns are those of lacuna::unknowns; contacts have further ones, which Newton's step eliminates.
///
/// An increment is the motion in one step of one unit of time, so that the engine's own kinematics and laws apply.
template <class Model>
class equilibrium_system {
public:
    using state_type = simulation_state<Model>;
    static constexpr int dim = Model::dim;
    using matrices = pair_matrices<dim>;
    using vector = Eigen::VectorXd;
    using point = vec<double, dim>;
    using rotation = vec<double, rotation_dim<dim>>;
    static constexpr int per_particle = matrices::per_particle;

    using flow_type = slow_flow<typename Model::flow::template solver<double, dim>, dim>;

    explicit equilibrium_system(state_type& state) : s_(state) {}

    /// From the next begin() on fluid flows for dt [s] in each increment, and pressures are unknowns too; 0: no flow.
    void set_flow_time(double dt) noexcept { flow_time_ = dt; }

    /// Reads the committed state: its unknowns, pairs, pores and histories. Nothing that is held moves until give().
    /// \param drained pressures stay
    /// \param time at which the model's own forces act, s
    void begin(bool drained, double time) {
        time_ = time;
        std::vector<char> free_walls;
        for (std::size_t w = 0; w < s_.walls.size(); ++w) free_walls.push_back(s_.wall_motions.has_servo(w));
        numbers_ = unknowns<dim>(s_.store, s_.plates, free_walls);
        drained_ = drained;
        give({}, {});
        start_.resize(s_.store.size());
        for (std::size_t k = 0; k < s_.store.size(); ++k) start_[k] = s_.store.position(k);
        find_pressures();
        matrix().begin(find_places());
        list_bonds();
        list_contacts();
        list_pores();
        own_elements_.clear();
        if (own_force_term::active(s_))
            for (std::size_t k = 0; k < s_.store.size(); ++k)
                own_elements_.push_back(matrix().add_element(numbers_.of(k).first(dim)));
        matrix().finish();
    }

    /// Sets the displacements of what is held.
    /// \param given displacement of every freedom that is held: per_particle numbers per particle, m; may be empty
    /// \param wall_motion displacement of every wall, m; may be empty
    void give(std::span<double const> given, std::span<point const> wall_motion) {
        given_.assign(given.begin(), given.end());
        given_.resize(s_.store.size() * std::size_t(per_particle), 0.0);
        motion_.assign(given_.size(), 0.0);
        wall_motion_.assign(wall_motion.begin(), wall_motion.end());
        wall_motion_.resize(s_.walls.size(), point{});
        wall_now_ = wall_motion_;
    }

    unknowns<dim> const& numbers() const noexcept { return numbers_; }
    /// Number of unknowns: displacements, then pressures where fluid flows.
    int count() const noexcept { return displacements() + pressures_; }
    int displacements() const noexcept { return numbers_.count(); }
    /// The fluid of a step in slow time.
    flow_type& flow() noexcept { return flow_; }
    /// Largest error of the equations of the fluid, as a force, N.
    double flow_error() const noexcept {
        if constexpr (has_fluid<Model>)
            if (pressures_ > 0) return flow_.error(rounding_);
        return 0;
    }
    /// Largest stiffness of a closed pore against the motion of one of its particles, N/m.
    double stiffest_pore() const {
        double most = 0;
        if constexpr (has_fluid<Model>)
            for (auto const& p : pores_) {
                auto const& flow = *s_.fluid.get();
                auto const now = flow.pore_geometry(p.pore, s_.store.positions(), s_.store.radii().data());
                for (auto const& t : now.traction)
                    most = std::max(most, flow.settings().bulk_modulus / now.volume * dot(t, t));
            }
        return most;
    }
    /// Scales the pressures' unknowns. \param stiffness of a pair, N/m
    void scale_pressures([[maybe_unused]] double stiffness) {
        if constexpr (has_fluid<Model>)
            if (pressures_ > 0) flow_.set_scale(stiffness, s_.store.positions(), s_.store.radii().data());
    }
    std::size_t contacts() const noexcept { return contacts_.size(); }
    /// The stiffness; where fluid flows another one, which keeps its own pattern.
    stiffness_matrix& matrix() noexcept { return matrix_[pressures_ > 0]; }
    int factorisations() const noexcept { return matrix_[0].factorisations() + matrix_[1].factorisations(); }

    /// Largest force of a load, a pair or a pressure, N, at the last evaluation.
    double largest_force() const noexcept { return largest_; }
    /// Sum of the loads' sizes, N.
    double total_load() const {
        double sum = 0;
        for (std::size_t k = 0; k < s_.store.size(); ++k) sum += norm(s_.store.applied_force(k));
        for (std::size_t w = 0; w < s_.walls.size(); ++w)
            if (s_.wall_motions.has_servo(w)) sum += s_.wall_motions.servo_force(s_.walls, w);
        return sum;
    }
    /// Largest displacement that is given, m.
    double largest_given() const noexcept {
        double most = 0;
        for (double const g : given_) most = std::max(most, std::fabs(g));
        for (auto const& w : wall_motion_) most = std::max(most, norm(w));
        return most;
    }

    /// Puts all contacts on the central path of the barrier, near the committed state.
    void start_contacts(double barrier) {
        place(vector::Zero(count()));
        for (auto& c : contacts_) {
            auto const frame = c.at_wall() ? wall_frame(c) : pair_frame_of(c.i, c.j);
            typename frictional_contact<dim>::shear shear{};
            if constexpr (requires { c.state.shear_force; }) shear = c.state.shear_force;
            c.point.start(c.formula, c.formula.touching_distance() - frame.motion.distance, shear, barrier);
        }
    }
    /// Mean product of force and gap over the contacts, J.
    double mean_product() const noexcept {
        double sum = 0;
        for (auto const& c : contacts_) sum += c.point.product();
        return contacts_.empty() ? 0 : sum / double(contacts_.size());
    }
    double largest_product() const noexcept {
        double most = 0;
        for (auto const& c : contacts_) most = std::max(most, c.point.product());
        return most;
    }
    /// Largest error of the contacts' own equations, as a force, N.
    double contact_residual() const noexcept {
        double most = 0;
        for (auto const& c : contacts_) most = std::max(most, c.point.residual());
        return most;
    }

    /// Linearises everything at an increment: the forces of pairs, pores and loads on the unknowns, N, and their
    /// stiffness.
    /// \param u pressures that are held are set
    void linearise(vector& u, vector& forces) {
        place(u);
        if constexpr (has_fluid<Model>)
            if (pressures_ > 0) flow_.update(u, s_.store.positions(), s_.store.radii().data());
        carried_.assign(start_.size(), 0.0);
        matrix().set_zero();
        forces.setZero(count());
        largest_ = 0;
        auto const to_unknown = [&](std::size_t k, int f, double force) {
            if (int const n = numbers_.of(k, f); n >= 0) forces[n] += force;
        };
        add_loads(to_unknown);
        for (std::size_t w = 0; w < s_.walls.size(); ++w)
            if (int const n = numbers_.of_wall(w); n >= 0) forces[n] += s_.wall_motions.servo_force(s_.walls, w);
        add_own_forces(to_unknown);
        add_own_stiffness();
        for (auto& b : bonds_) add_bond(b, forces);
        for (auto& c : contacts_) add_contact(c, forces);
        if constexpr (has_fluid<Model>)
            for (auto& p : pores_) add_pore(p, to_unknown);
        if constexpr (has_fluid<Model>)
            if (pressures_ > 0) flow_.linearise(forces, matrix());
    }
    /// Shortens the displacements of particles that carry no force, which are loose in their cages: nothing but the
    /// barrier moved them.
    /// \param least force that counts, N
    /// \param longest displacement of a freedom, m
    void hold_loose(vector& u, double least, double longest) const {
        for (std::size_t k = 0; k < carried_.size(); ++k) {
            if (carried_[k] > least) continue;
            double most = 0;
            for (int const n : numbers_.of(k))
                if (n >= 0) most = std::max(most, std::fabs(u[n]));
            if (!(most > longest)) continue;
            for (int const n : numbers_.of(k))
                if (n >= 0) u[n] *= longest / most;
        }
    }
    /// Aims all contacts at a barrier and adds the changes of force that they ask for, N.
    /// \param follows see frictional_contact::aim()
    void aim(double barrier, bool follows, vector& forces) {
        for (auto& c : contacts_) {
            c.point.aim(barrier, follows);
            scatter(c, matrices::force(c.frame, -c.point.push(), c.point.pull()), 1.0, forces);
        }
    }
    /// What the friction's limit, which follows the normal force, adds to matrix() times x; it is not symmetric.
    void add_coupling(vector const& x, vector& to) const {
        for (auto const& c : contacts_) {
            if (!c.point.rough()) continue;
            typename matrices::point const change =
                matrices::force(c.frame, 0, c.point.follow()) * (-c.point.weight() * normal_part(c, x));
            scatter(c, change, -1.0, to);
        }
    }
    /// Whether any contact has friction.
    bool rough() const noexcept {
        return std::any_of(contacts_.begin(), contacts_.end(), [](auto const& c) { return c.point.rough(); });
    }

    /// Finds the steps of all contacts from that of the unknowns.
    /// \return largest share of the step, at most 1, that keeps the contacts inside their limits
    double find_steps(vector const& du) {
        double share = 1;
        for (auto& c : contacts_) {
            auto const w = relative(c, du);
            c.point.find_step(matrices::to_eigen(c.frame.normal).dot(w), matrices::slip(c.frame, w));
            share = std::min(share, c.point.longest_step());
        }
        return share;
    }
    void advance_contacts(double share) {
        for (auto& c : contacts_) c.point.advance(c.formula, share);
    }

    /// Finds the forces of the exact laws, without barrier, at a share of an increment. See forces_now().
    void exact_forces(vector const& u, double share = 1) {
        place(u, share);
        carried_.assign(start_.size(), 0.0);
        largest_ = 0;
        now_.clear(start_.size() * std::size_t(per_particle), s_.walls.size());
        add_loads([&](std::size_t k, int f, double force) { now_.load[int(k) * per_particle + f] += force; });
        add_own_forces([&](std::size_t k, int f, double force) { now_.load[int(k) * per_particle + f] += force; });
        for (auto const& b : bonds_) {
            auto const f = evaluate(b);
            note(f.force.norm());
            add_to_pair(b.i, b.j, forces_of(b, f));
        }
        for (auto& c : contacts_) {
            update_frame(c);
            auto const answer =
                ContactLaw::evaluate(*c.row, c.frame.motion, detail::turned<ContactLaw, dim>(c.state, c.frame));
            typename matrices::point const f = matrices::force(c.frame, answer.normal_force, answer.shear_force);
            note(f.norm());
            Eigen::Matrix<double, matrices::freedoms, 1> const all = -(c.b.transpose() * f);
            add_to_pair(c.i, c.j, all, c.at_wall());
            if (c.at_wall()) now_.on_wall[std::size_t(c.wall)] -= matrices::to_vec(f);
        }
        if constexpr (has_fluid<Model>)
            for (auto& p : pores_)
                scatter_pore(p, measure(p), [&](std::size_t k, int axis, double force) {
                    now_.inner[int(k) * per_particle + axis] += force;
                });
    }
    /// The forces that exact_forces() found last.
    exact_force_record<dim> const& forces_now() const noexcept { return now_; }
    /// Their sum on each unknown, N.
    vector unbalanced() const {
        vector sum = vector::Zero(count());
        for (std::size_t k = 0; k < start_.size(); ++k)
            for (int f = 0; f < per_particle; ++f)
                if (int const n = numbers_.of(k, f); n >= 0) sum[n] += now_.sum(k, f);
        for (std::size_t w = 0; w < s_.walls.size(); ++w)
            if (int const n = numbers_.of_wall(w); n >= 0)
                sum[n] += s_.wall_motions.servo_force(s_.walls, w) + dot(s_.walls.normal(w), now_.on_wall[w]);
        return sum;
    }

    /// A bond that fails within an increment.
    struct failure {
        double share;       ///< share of the increment at which it fails
        std::int32_t label; ///< number of the bond in the input
    };
    /// The bonds that fail within a share of an increment, the first one first.
    /// \param only_first whether the others matter
    std::vector<failure> failures(vector const& u, double most, bool only_first) {
        place(u, most);
        std::vector<bond_element const*> failing;
        for (auto const& b : bonds_)
            if (evaluate(b).broken) failing.push_back(&b);
        std::vector<failure> found;
        while (!failing.empty()) {
            double low = 0, high = most;
            auto const fails = [&](auto const* b) { return evaluate(*b).broken; };
            auto first = failing.begin();
            for (int n = 0; n < 40; ++n) {
                double const middle = 0.5 * (low + high);
                place(u, middle);
                auto const one = std::find_if(failing.begin(), failing.end(), fails);
                if (one == failing.end()) {
                    low = middle;
                } else {
                    high = middle;
                    first = one;
                }
            }
            // A little further, so that rounding in another order does not save the bond.
            found.push_back({std::min(most, high * (1 + 1e-9)), (*first)->label});
            if (only_first) break;
            failing.erase(first);
        }
        return found;
    }
    /// Moves the simulation's particles to a share of an increment, as one step of one second would.
    void displace(vector const& u, double share) {
        place(u, share);
        restore();
        for (std::size_t k = 0; k < start_.size(); ++k)
            s_.store.displace(k, shift(k), surface(k) / s_.store.radius(k));
    }

    /// Puts the particles of the store back to their committed positions.
    void restore() {
        for (std::size_t k = 0; k < start_.size(); ++k) s_.store.set_position(k, start_[k]);
    }
    /// Largest displacement of a freedom in an increment, m, with given ones.
    double largest_motion(vector const& u) const {
        int const n = displacements();
        return std::max(n > 0 ? u.head(n).lpNorm<Eigen::Infinity>() : 0.0, largest_given());
    }
    /// Displacements and surface rotations at which the forces were found last, of all freedoms, m.
    std::vector<double> const& motion() const noexcept { return motion_; }
    /// Displacements of the walls at the increment at which the forces were found last, m.
    std::vector<point> const& wall_motion() const noexcept { return wall_now_; }

private:
    using ContactLaw = typename Model::contact_law;
    using BondLaw = typename Model::bond_law;
    static constexpr bool with_bonds = !is_absent<BondLaw>, with_contacts = !is_absent<ContactLaw>;

    struct bond_element {
        std::size_t i, j, element;
        std::int32_t label;
        typename BondLaw::template parameters<double> const* row;
        typename BondLaw::template history<double, dim> state;
    };
    struct contact_element {
        std::size_t i, j, element;
        int wall; // -1: a pair
        typename ContactLaw::template parameters<double> const* row;
        typename ContactLaw::template history<double, dim> state;
        contact_formula<ContactLaw, dim> formula;
        frictional_contact<dim> point{};
        pair_frame<double, dim> frame{};
        typename matrices::operators b = matrices::operators::Zero();
        bool at_wall() const noexcept { return wall >= 0; }
    };
    static constexpr std::size_t corners = std::size_t(dim) + 1;
    struct pore_element {
        std::size_t pore, element;
    };
    struct pore_state {
        double pressure, stiffness; // Pa, Pa/m^3
        std::array<point, corners> traction; // N per Pa
    };

    /// Places of the unknowns; walls and plates have none.
    std::vector<stiffness_matrix::place> find_places() const {
        constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
        std::vector<stiffness_matrix::place> places(std::size_t(count()), {nowhere, nowhere, nowhere});
        for (std::size_t k = 0; k < start_.size(); ++k)
            for (int f = 0; f < per_particle; ++f) {
                int const n = numbers_.of(k, f);
                if (n < 0 || numbers_.shared(n)) continue;
                places[std::size_t(n)] = {};
                for (int axis = 0; axis < dim; ++axis) places[std::size_t(n)][std::size_t(axis)] = start_[k][axis];
            }
        add_pore_places(places);
        return places;
    }
    /// Places of the pressures, in the middle of their pores.
    void add_pore_places([[maybe_unused]] std::vector<stiffness_matrix::place>& places) const {
        if constexpr (has_fluid<Model>) {
            if (pressures_ == 0 || s_.fluid.get()->network().bare()) return;
            auto const& net = s_.fluid.get()->network();
            for (std::size_t p = 0; p < net.pores(); ++p) {
                auto& place = places[std::size_t(displacements()) + p];
                auto const middle = pore_middle(net, p, s_.store.positions());
                place = {};
                for (int axis = 0; axis < dim; ++axis) place[std::size_t(axis)] = middle[axis];
            }
        }
    }

    void list_bonds() {
        bonds_.clear();
        if constexpr (with_bonds) {
            auto const& table = s_.pairs.bonds();
            for (std::size_t slot = 0; slot < table.slots(); ++slot) {
                if (table.is_padding(slot, s_.store.size())) continue;
                auto const entry = table.get(slot);
                bonds_.push_back({std::size_t(entry.i), std::size_t(entry.j),
                                  add_pair(std::size_t(entry.i), std::size_t(entry.j)), entry.label,
                                  &s_.pairs.bond_parameters().row[std::size_t(entry.parameter)], entry.state});
            }
        }
    }
    void list_contacts() {
        contacts_.clear();
        if constexpr (with_contacts) {
            static_assert(!carries_moment<ContactLaw>, "equilibrium: a contact law with moments is not supported yet");
            auto const& table = s_.pairs.contacts();
            for (int c = 0; c < table.chunks(); ++c)
                for (std::size_t slot = table.first_slot(c), end = slot + table.chunk_size(c); slot < end; ++slot) {
                    auto const entry = table.get(slot);
                    auto const i = std::size_t(entry.i), j = std::size_t(entry.j);
                    add_contact_element(i, j, -1, s_.pairs.contact_parameters().row[std::size_t(entry.parameter)],
                                        entry.state, s_.store.radius(j));
                }
            s_.walls.for_each_listed([&](std::size_t w, std::size_t k, auto const& state) {
                add_contact_element(k, k, int(w), s_.walls.parameters(w, std::size_t(s_.store.material(k))), state, 0);
            });
        }
    }
    template <class Row, class History>
    void add_contact_element(std::size_t i, std::size_t j, int wall, Row const& row, History const& state,
                             double radius_j) {
        std::size_t const element = wall >= 0 ? add_at_wall(i, std::size_t(wall)) : add_pair(i, j);
        contacts_.push_back({i, j, element, wall, &row, state,
                             contact_formula<ContactLaw, dim>(row, state, s_.store.radius(i), radius_j)});
    }
    std::size_t add_at_wall(std::size_t i, std::size_t w) {
        std::array<int, std::size_t(2 * per_particle)> n{};
        n.fill(-1);
        std::copy_n(numbers_.of(i).begin(), per_particle, n.begin());
        n[std::size_t(per_particle)] = numbers_.of_wall(w);
        return matrix().add_element(n);
    }
    std::size_t add_pair(std::size_t i, std::size_t j) {
        std::array<int, std::size_t(2 * per_particle)> n{};
        std::copy_n(numbers_.of(i).begin(), per_particle, n.begin());
        std::copy_n(numbers_.of(j).begin(), per_particle, n.begin() + per_particle);
        return matrix().add_element(n);
    }
    void find_pressures() {
        pressures_ = 0;
        if constexpr (has_fluid<Model>)
            if (flow_time_ > 0 && s_.filled()) pressures_ = int(s_.fluid.get()->network().pores());
        double extent = 0;
        for (auto const& x : start_)
            for (int axis = 0; axis < dim; ++axis) extent = std::max(extent, std::fabs(x[axis]));
        rounding_ = 4 * std::numeric_limits<double>::epsilon() * extent;
    }
    void list_pores() {
        pores_.clear();
        if constexpr (has_fluid<Model>) {
            if (!s_.filled()) return;
            auto const& net = s_.fluid.get()->network();
            if (pressures_ > 0) flow_.begin(*s_.fluid.get(), flow_time_, numbers_, matrix());
            if (net.bare()) return;
            for (std::size_t p = 0; p < net.pores(); ++p) {
                std::array<int, corners * std::size_t(dim)> n{};
                for (std::size_t c = 0; c < corners; ++c)
                    for (int axis = 0; axis < dim; ++axis)
                        n[c * std::size_t(dim) + std::size_t(axis)] = numbers_.of(std::size_t(net.corner[c][p]), axis);
                pores_.push_back({p, matrix().add_element(n)});
            }
        }
    }

    /// Moves the particles of the store to a share of an increment.
    void place(vector const& u, double share = 1) {
        for (std::size_t k = 0; k < start_.size(); ++k) {
            for (int f = 0; f < per_particle; ++f) {
                auto const at = k * std::size_t(per_particle) + std::size_t(f);
                int const n = numbers_.of(k, f);
                motion_[at] = share * (n >= 0 ? u[n] : given_[at]);
            }
            point x = start_[k];
            for (int axis = 0; axis < dim; ++axis) x[axis] += motion(k, axis);
            s_.store.set_position(k, x);
        }
        for (std::size_t w = 0; w < wall_motion_.size(); ++w) {
            int const n = numbers_.of_wall(w);
            wall_now_[w] = (n >= 0 ? s_.walls.normal(w) * u[n] : wall_motion_[w]) * share;
        }
    }
    /// Displacement or surface rotation of a freedom at which the forces were found last, m.
    double motion(std::size_t k, int freedom) const noexcept {
        return motion_[k * std::size_t(per_particle) + std::size_t(freedom)];
    }
    point shift(std::size_t k) const noexcept {
        point v{};
        for (int axis = 0; axis < dim; ++axis) v[axis] = motion(k, axis);
        return v;
    }
    rotation surface(std::size_t k) const noexcept {
        rotation v{};
        for (int r = 0; r < rotation_dim<dim>; ++r) v[r] = motion(k, dim + r);
        return v;
    }
    pair_frame<double, dim> pair_frame_of(std::size_t i, std::size_t j) const {
        double const ri = s_.store.radius(i), rj = s_.store.radius(j);
        return relative_motion(
            relative_state<double, dim>{s_.store.nearest(s_.store.position(j) - s_.store.position(i)),
                                        shift(j) - shift(i), surface(i) + surface(j), ri + rj, ri, rj},
            1.0);
    }
    pair_frame<double, dim> wall_frame(contact_element const& c) const {
        double const r = s_.store.radius(c.i);
        body<double, dim> const particle{s_.store.position(c.i), shift(c.i), surface(c.i) / r, r, s_.store.mass(c.i)};
        auto const& moved = wall_now_[std::size_t(c.wall)];
        return s_.walls.frame(std::size_t(c.wall), particle, moved, moved, 1.0);
    }
    pair_rotation<double, dim> rotation_of(bond_element const& b, pair_frame<double, dim> const& frame) const {
        return frame.relative_rotation(surface(b.i) / s_.store.radius(b.i), surface(b.j) / s_.store.radius(b.j), 1.0);
    }

    double load(std::size_t k, int freedom) const {
        if (freedom < dim) return s_.store.load(k)[freedom];
        if constexpr (dim == 2) return s_.store.load(k)[2];
        return s_.store.torques().size() > 0 ? s_.store.torques().at(k, freedom - dim) : 0.0;
    }
    /// Adds the model's own forces at the present positions: to(particle, freedom, force).
    template <class To>
    void add_own_forces(To const& to) {
        if (!own_force_term::active(s_)) return;
        auto& forces = s_.other_forces;
        std::fill(forces.data(), forces.data() + 4 * forces.size(), 0.0);
        force_step<double> step{moment{0, time_}, 0, false};
        own_force_term::add_forces<false>(s_, step);
        for (std::size_t k = 0; k < s_.store.size(); ++k)
            for (int f = 0; f < per_particle; ++f) {
                std::size_t const record = dim == 2 ? k : f < dim ? 2 * k : 2 * k + 1;
                add_load(k, f, forces.at(record, dim == 3 && f >= dim ? f - dim : f), to);
            }
    }
    /// Takes the stiffness of the model's own forces as bounds of the time step do: only the part that is symmetric and
    /// has no negative direction.
    struct own_stiffness {
        equilibrium_system* system; // nullptr: derivatives by the velocity, which no equilibrium has
        template <class Matrix>
        void add_matrix(std::size_t k, Matrix const& m) {
            if (!system) return;
            typename matrices::tensor stiffness;
            for (int a = 0; a < dim; ++a)
                for (int b = 0; b < dim; ++b) stiffness(a, b) = 0.5 * (m[std::size_t(a)][b] + m[std::size_t(b)][a]);
            system->matrix().add(system->own_elements_[k], without_negative_directions(stiffness));
        }
    };
    void add_own_stiffness() {
        if (own_elements_.empty()) return;
        own_stiffness stiff{this}, viscous{nullptr};
        if constexpr (requires { s_.own_forces.add_stiffness(s_.store, time_, stiff, viscous); })
            s_.own_forces.add_stiffness(s_.store, time_, stiff, viscous);
    }
    template <class To>
    void add_loads(To const& to) {
        for (std::size_t k = 0; k < s_.store.size(); ++k)
            for (int f = 0; f < per_particle; ++f) add_load(k, f, load(k, f), to);
    }
    template <class To>
    void add_load(std::size_t k, int f, double force, To const& to) {
        if (numbers_.of(k, f) >= 0) {
            note(std::fabs(force));
            carried_[k] += std::fabs(force);
        }
        to(k, f, force);
    }
    void note(double force) noexcept { largest_ = std::max(largest_, force); }

    bond_forces<BondLaw, dim> evaluate(bond_element const& b) const {
        auto const frame = pair_frame_of(b.i, b.j);
        return evaluate_bond<BondLaw, dim>(*b.row, frame, rotation_of(b, frame),
                                           detail::turned<BondLaw, dim>(b.state, frame));
    }
    void add_bond(bond_element const& b, vector& forces) {
        auto const frame = pair_frame_of(b.i, b.j);
        auto const turn = rotation_of(b, frame);
        auto const state = detail::turned<BondLaw, dim>(b.state, frame);
        auto const f = evaluate_bond<BondLaw, dim>(*b.row, frame, turn, state);
        auto const k = bond_tangent<BondLaw, dim>(*b.row, frame, turn, state);
        note(f.force.norm());
        carried_[b.i] += f.force.norm();
        carried_[b.j] += f.force.norm();
        scatter_pair(b.i, b.j, forces_of(b, f), forces);
        using forces_type = bond_forces<BondLaw, dim>;
        Eigen::Matrix<double, forces_type::strains, matrices::freedoms> op;
        op.template topRows<dim>() = matrices::relative_displacement(frame);
        if constexpr (forces_type::bends)
            op.template bottomRows<rotation_dim<dim>>() =
                matrices::relative_rotation(s_.store.radius(b.i), s_.store.radius(b.j));
        typename matrices::element stiffness = op.transpose() * k * op;
        if (f.normal_force > 0) {
            // A taut bond resists a turn of its normal.
            auto const centres = matrices::relative_centres();
            auto const n = matrices::to_eigen(frame.normal);
            typename matrices::tensor const across =
                (matrices::tensor::Identity() - n * n.transpose()) * (f.normal_force / frame.motion.distance);
            stiffness += centres.transpose() * across * centres;
        }
        matrix().add(b.element, stiffness);
    }
    /// Forces of a bond on the freedoms of its particles, N.
    Eigen::Matrix<double, matrices::freedoms, 1> forces_of(bond_element const& b,
                                                           bond_forces<BondLaw, dim> const& f) const {
        auto const frame = pair_frame_of(b.i, b.j);
        Eigen::Matrix<double, matrices::freedoms, 1> all =
            -(matrices::relative_displacement(frame).transpose() * f.force);
        if constexpr (bond_forces<BondLaw, dim>::bends)
            all -= matrices::relative_rotation(s_.store.radius(b.i), s_.store.radius(b.j)).transpose() * f.moment;
        return all;
    }
    template <class All>
    void add_to_pair(std::size_t i, std::size_t j, All const& all, bool only_first = false) {
        for (int f = 0; f < per_particle; ++f) {
            now_.inner[int(i) * per_particle + f] += all[f];
            if (!only_first) now_.inner[int(j) * per_particle + f] += all[per_particle + f];
        }
    }
    template <class All>
    void scatter_pair(std::size_t i, std::size_t j, All const& all, vector& to) const {
        for (int f = 0; f < per_particle; ++f) {
            if (int const n = numbers_.of(i, f); n >= 0) to[n] += all[f];
            if (int const n = numbers_.of(j, f); n >= 0) to[n] += all[per_particle + f];
        }
    }

    void add_contact(contact_element& c, vector& forces) {
        update_frame(c);
        typename frictional_contact<dim>::shear before{}, normal{};
        if constexpr (requires { c.state.shear_force; })
            before = detail::turned<ContactLaw, dim>(c.state, c.frame).shear_force;
        if constexpr (dim == 3) normal = c.frame.normal;
        c.point.linearise(c.frame.motion.distance - c.formula.touching_distance(), c.frame.motion.slip, before, normal);
        typename matrices::point const now = matrices::force(c.frame, -c.point.force(), c.point.shear_force());
        note(now.norm());
        carried_[c.i] += now.norm();
        if (!c.at_wall()) carried_[c.j] += now.norm();
        scatter(c, now, 1.0, forces);
        auto const n = matrices::to_eigen(c.frame.normal);
        typename matrices::tensor k = n * n.transpose() * c.point.weight();
        if (c.point.rough()) {
            auto const axes = matrices::axes(c.frame);
            for (int t = 1; t < dim; ++t) {
                typename matrices::point const along = axes.col(t);
                k += matrices::force(c.frame, 0, c.point.soften(matrices::slip(c.frame, along))) * along.transpose();
            }
        }
        matrix().add(c.element, (c.b.transpose() * k * c.b).eval());
    }
    /// Frame of a contact at the present increment, and its relative displacement per freedom. In place of a second
    /// particle a wall has one freedom, along its normal.
    void update_frame(contact_element& c) {
        c.frame = c.at_wall() ? wall_frame(c) : pair_frame_of(c.i, c.j);
        c.b = matrices::relative_displacement(c.frame);
        if (!c.at_wall()) return;
        c.b.template rightCols<per_particle>().setZero();
        c.b.col(per_particle) = matrices::to_eigen(s_.walls.normal(std::size_t(c.wall)));
    }
    /// Number of the unknown of one of a contact's freedoms; -1: none.
    int number_of(contact_element const& c, int freedom) const noexcept {
        if (freedom < per_particle) return numbers_.of(c.i, freedom);
        if (!c.at_wall()) return numbers_.of(c.j, freedom - per_particle);
        return freedom == per_particle ? numbers_.of_wall(std::size_t(c.wall)) : -1;
    }
    /// Adds `sign` times the forces on the unknowns for a force on i.
    void scatter(contact_element const& c, typename matrices::point const& force, double sign, vector& to) const {
        Eigen::Matrix<double, matrices::freedoms, 1> const all = -sign * (c.b.transpose() * force);
        for (int f = 0; f < matrices::freedoms; ++f)
            if (int const n = number_of(c, f); n >= 0) to[n] += all[f];
    }
    /// Relative displacement at a contact for a change of the unknowns.
    typename matrices::point relative(contact_element const& c, vector const& du) const {
        Eigen::Matrix<double, matrices::freedoms, 1> local = Eigen::Matrix<double, matrices::freedoms, 1>::Zero();
        for (int f = 0; f < matrices::freedoms; ++f)
            if (int const n = number_of(c, f); n >= 0) local[f] = du[n];
        return c.b * local;
    }
    double normal_part(contact_element const& c, vector const& x) const {
        return matrices::to_eigen(c.frame.normal).dot(relative(c, x));
    }

    pore_state measure(pore_element const& p) const {
        if (pressures_ > 0) return {flow_.pressure(p.pore), 0, flow_.traction(p.pore)};
        auto const& flow = *s_.fluid.get();
        auto const& net = flow.network();
        auto const now = flow.pore_geometry(p.pore, s_.store.positions(), s_.store.radii().data());
        pore_state state{net.pressure[p.pore], 0, now.traction};
        if (!now.open) {
            state.pressure = 0;
        } else if (!drained_) {
            auto const sealed = sealed_pressure(flow.settings(), net.pressure[p.pore], net.old_volume[p.pore],
                                                net.vapour_of(p.pore), now.volume);
            state.pressure = sealed.pressure;
            state.stiffness = sealed.stiffness;
        }
        return state;
    }
    template <class To>
    void scatter_pore(pore_element const& p, pore_state const& state, To const& to) {
        auto const& net = s_.fluid.get()->network();
        for (std::size_t c = 0; c < corners; ++c) {
            double const force = norm(state.traction[c]) * std::fabs(state.pressure);
            note(force);
            auto const k = std::size_t(net.corner[c][p.pore]);
            carried_[k] += force;
            for (int axis = 0; axis < dim; ++axis) to(k, axis, state.traction[c][axis] * state.pressure);
        }
    }
    template <class To>
    void add_pore(pore_element const& p, To const& to) {
        auto const state = measure(p);
        scatter_pore(p, state, to);
        if (!(state.stiffness > 0)) return;
        Eigen::Matrix<double, int(corners) * dim, 1> g;
        for (std::size_t c = 0; c < corners; ++c)
            for (int axis = 0; axis < dim; ++axis) g[int(c) * dim + axis] = state.traction[c][axis];
        matrix().add(p.element, (g * g.transpose() * state.stiffness).eval());
    }

    state_type& s_;
    unknowns<dim> numbers_;
    std::array<stiffness_matrix, 2> matrix_; // without and with pressures
    bool drained_ = false;
    std::vector<double> given_, motion_; // of all freedoms, m
    exact_force_record<dim> now_;
    std::vector<double> carried_;        // sum of the sizes of the forces on each particle, N
    std::vector<point> wall_motion_, wall_now_, start_;
    std::vector<bond_element> bonds_;
    std::vector<contact_element> contacts_;
    std::vector<pore_element> pores_;
    std::vector<std::size_t> own_elements_; // of the model's own forces, by particle
    double largest_ = 0, time_ = 0;
    flow_type flow_;
    double flow_time_ = 0, rounding_ = 0; // s; of positions, m
    int pressures_ = 0;
};
LACUNA_END_PACKS

} // namespace lacuna
