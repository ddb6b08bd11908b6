// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/particles/domain.hpp>
#include <lacuna/particles/packing.hpp>

namespace lacuna {

/// How a particle's mass follows from its radius.
enum class mass_model {
    disc,  ///< cylinder of the model's thickness: rho pi r^2 t, I = m r^2 / 2 (2D)
    sphere ///< rho 4/3 pi r^3, I = 2/5 m r^2
};

/// The prescribed components of a particle's velocity: forces never change them.
struct fixed_axes {
    bool x = false, y = false, z = false, rotation = false;
    static constexpr fixed_axes all() { return {true, true, true, true}; }
};

/// The particles, in the layout that the time step reads and writes.
///
/// Each particle has records of four numbers, position and velocity side by side:
///   - 2D: position {x, y, arc, radius}, velocity {v_x, v_y, surface speed, radius};
///   - 3D: position {x, y, z, radius}, velocity {v_x, v_y, v_z, radius}, surface speed {r w_x, r w_y, r w_z, 0}.
///
/// Rotations are stored as motions of the surface: arc = radius times angle, surface speed = radius times spin. So the
/// relative motion of a pair is a sum and a difference of records, and torques are divided by the radius. The library
/// chooses the order of storage (`internal` index). A particle's `id` is its index in the given packing. In 2D the arc
/// gives the unit vector of the paper's eq. 8, (cos angle, sin angle): this integrates eq. 8 exactly and has unit
/// length by construction.
template <class Real, int Dim>
class particle_store {
public:
    using rec = record<Real>;
    using point = vec<Real, Dim>;
    using rotation = vec<Real, rotation_dim<Dim>>;

    particle_store() = default;

    /// \param packing the particles, in the order of their ids
    /// \param order a permutation, order[internal] = id; see spatial_order()
    /// \param density of each material, kg/m^3; used if the packing has no densities
    /// \param thickness of the discs, m; used by mass_model::disc
    /// \throws std::invalid_argument naming the particle and the value
    particle_store(packing<Real, Dim> const& packing, std::span<std::int32_t const> order,
                   std::span<double const> density, mass_model masses, double thickness)
        : id_(order.begin(), order.end()), internal_(order.size()) {
        std::size_t const n = packing.position.size();
        packing.require_one_each();
        record_.resize(n + padding_particles);
        if constexpr (Dim == 3) {
            surface_speed_.resize(n + padding_particles);
            quaternion_.assign(n, unit_quaternion());
        }
        loads_at_.assign(n / load_block + 1, -1);
        free_.assign(n, 0);
        inverse_mass_.resize(n);
        Real const surface = Real(1) / (masses == mass_model::disc && Dim == 2 ? Real(0.5) : Real(0.4));
        for (unsigned bits = 0; bits < free_patterns; ++bits)
            for (int axis = 0; axis < Dim; ++axis) {
                moving_.at(bits, axis) = bits >> axis & 1 ? Real(1) : Real(0);
                rotating_.at(bits, axis) = bits & rotation_bit ? surface : Real(0);
                if (Dim == 2) moving_.at(bits, 2) = rotating_.at(bits, 0);
            }
        radius_.resize(n);
        mass_.resize(n + padding_particles, Real(1));
        material_.resize(n);
        for (std::size_t k = 0; k < n; ++k) {
            auto const id = std::size_t(id_[k]);
            internal_[id] = std::int32_t(k);
            std::string const name = "particle " + std::to_string(id);
            for (int axis = 0; axis < Dim; ++axis)
                require_finite(name + ".position", double(packing.position[id][axis]));
            double const r = double(packing.radius[id]);
            require_positive(name + ".radius", r);
            int const material = packing.material[id];
            require_in(name + ".material", material, 0, double(density.size()) - 1);
            double const rho = packing.density.empty() ? density[std::size_t(material)] : packing.density[id];
            require_positive(name + ".density", rho);
            bool const disc = masses == mass_model::disc && Dim == 2;
            double const mass =
                disc ? rho * std::numbers::pi * r * r * thickness : rho * 4 / 3 * std::numbers::pi * r * r * r;
            inertia_share_ = disc ? 0.5 : 0.4;
            double const inertia = inertia_share_ * mass * r * r;
            if (!(mass >= min_normal()) || !(inertia >= min_normal()))
                refuse(name + ".mass", mass, "representable in the model's precision with its moment of inertia");
            radius_[k] = Real(r);
            material_[k] = material;
            for (int axis = 0; axis < Dim; ++axis) record_.at(k, axis) = packing.position[id][axis];
            record_.at(k, 3) = record_.at(k, motion + 3) = Real(r);
            mass_[k] = Real(mass);
            inverse_mass_[k] = Real(1) / mass_[k];
            fix(k, {});
        }
        // The padding particles: pairs of them fill the last pack of a row of pairs.
        for (std::size_t g = 0; g < padding_particles; ++g) {
            record_.at(n + g, 0) = Real(g);
            record_.at(n + g, 3) = record_.at(n + g, motion + 3) = Real(0.25);
        }
    }

    /// Makes the space periodic. \param period m; 0 along open axes
    void set_period(vec<double, Dim> const& period) noexcept {
        periods_ = periods<Real, Dim>::of(period);
        for (int axis = 0; axis < Dim; ++axis)
            if (period[axis] > 0) padding_distance_ = std::min(padding_distance_, Real(period[axis] / 4));
        for (std::size_t g = 0; g < padding_particles; ++g) {
            record_.at(size() + g, 0) = Real(g) * padding_distance_;
            record_.at(size() + g, 3) = record_.at(size() + g, motion + 3) = padding_distance_ / 4;
        }
    }
    /// The periods of the space; 0 along open axes.
    periods<Real, Dim> const& period() const noexcept { return periods_; }
    /// The shortest vector from one particle to another or to an image of it, m.
    /// \param between the difference of their positions, m
    template <class T>
    vec<T, Dim> nearest(vec<T, Dim> const& between) const noexcept {
        return periods_.any() ? periods_.shortest(between) : between;
    }

    std::size_t size() const noexcept { return id_.size(); }
    std::int32_t id(std::size_t internal) const noexcept { return id_[internal]; }
    std::int32_t internal(std::size_t id) const noexcept { return internal_[id]; }

    /// \name One particle, by internal index
    /// \{
    point position(std::size_t k) const noexcept { return head(record_, k); }
    point velocity(std::size_t k) const noexcept { return head(record_, k, motion); }
    rotation spin(std::size_t k) const noexcept {
        if constexpr (Dim == 2)
            return {record_.at(k, motion + 2) / radius_[k]};
        else
            return head(surface_speed_, k) / radius_[k];
    }
    Real radius(std::size_t k) const noexcept { return radius_[k]; }
    Real mass(std::size_t k) const noexcept { return mass_[k]; }
    Real moment_of_inertia(std::size_t k) const noexcept {
        return Real(inertia_share_ * double(mass_[k]) * double(radius_[k]) * double(radius_[k]));
    }
    int material(std::size_t k) const noexcept { return material_[k]; }
    /// The unit vector e of the paper's eq. 8 (2D).
    vec<Real, 2> orientation(std::size_t k) const noexcept
        requires(Dim == 2)
    {
        Real const angle = record_.at(k, 2) / radius_[k];
        return {std::cos(angle), std::sin(angle)};
    }
    /// Unit quaternion {w, x, y, z} (3D).
    vec<Real, 4> orientation(std::size_t k) const noexcept
        requires(Dim == 3)
    {
        return {quaternion_.at(k, 0), quaternion_.at(k, 1), quaternion_.at(k, 2), quaternion_.at(k, 3)};
    }
    /// External force, N.
    point applied_force(std::size_t k) const noexcept {
        point r{};
        for (int axis = 0; axis < Dim; ++axis) r[axis] = load(k)[axis];
        return r;
    }

    void set_position(std::size_t k, point const& x) noexcept { set_head(record_, k, x); }
    void set_velocity(std::size_t k, point const& v) noexcept { set_head(record_, k, v, motion); }
    void set_spin(std::size_t k, rotation const& w) noexcept {
        if constexpr (Dim == 2)
            record_.at(k, motion + 2) = w[0] * radius_[k];
        else
            set_head(surface_speed_, k, w * radius_[k]);
    }
    /// Moves a particle as one step of one second at this velocity and spin would.
    void displace(std::size_t k, point const& shift, rotation const& turn) noexcept {
        set_velocity(k, shift);
        set_spin(k, turn);
        set_position(k, position(k) + shift);
        if constexpr (Dim == 2)
            record_.at(k, 2) += turn[0] * radius_[k];
        else
            rotate_orientation(k, turn);
    }
    void set_applied_force(std::size_t k, point const& force) { set_head(load_, load_index(k), force); }
    void set_applied_torque(std::size_t k, Real torque)
        requires(Dim == 2)
    {
        load_.at(load_index(k), 2) = torque / radius_[k];
    }
    /// Sets the external torque, N m.
    void set_applied_torque(std::size_t k, point const& torque)
        requires(Dim == 3)
    {
        if (torque_.size() == 0) torque_.resize(size());
        set_head(torque_, k, torque / radius_[k]);
    }
    /// Prescribes the velocity along the given axes: the particle keeps its current velocity, or one that is set later.
    void fix(std::size_t k, fixed_axes const& axes) noexcept {
        unsigned const held = (axes.x ? 1u : 0u) | (axes.y ? 2u : 0u) | (Dim == 3 && axes.z ? 4u : 0u) |
                              (axes.rotation ? rotation_bit : 0u);
        free_[k] = std::uint8_t(~held & (free_patterns - 1));
    }
    /// Inverse mass along `axis`, 1/kg; for axis == Dim the inverse moment of inertia, 1/(kg m^2). 0 where fixed.
    Real mobility(std::size_t k, int axis) const noexcept {
        bool const moves = axis < Dim ? free_[k] >> axis & 1 : (free_[k] & rotation_bit) != 0;
        return moves ? Real(1) / (axis < Dim ? mass_[k] : moment_of_inertia(k)) : Real(0);
    }
    bool held(std::size_t k, int axis) const noexcept { return !(free_[k] >> axis & 1); } ///< fixed along `axis`
    /// \}

    /// \name All particles
    /// \{
    points_view<Real, Dim> positions() const noexcept { return {record_.data(), size(), record_.stride}; }
    std::span<Real const> radii() const noexcept { return radius_; }
    particle_column<Real>& particle_records() noexcept { return record_; }
    particle_column<Real> const& particle_records() const noexcept { return record_; }
    record_column<Real>& surface_speeds() noexcept { return surface_speed_; }
    record_column<Real> const& surface_speeds() const noexcept { return surface_speed_; }
    record_column<Real>& quaternions() noexcept { return quaternion_; }
    /// The loads of the block of load_block particles that begins with `first`, one record each; nullptr if none of
    /// them has a load.
    Real const* loads_of(std::size_t first) const noexcept {
        auto const at = loads_at_[first / load_block];
        return at < 0 ? nullptr : load_.data() + load_.stride * load_block * std::size_t(at);
    }
    /// External force, N; in 2D the third number is the external torque over the radius.
    rec load(std::size_t k) const noexcept {
        Real const* loads = loads_of(k / load_block * load_block);
        return loads ? rec::load(loads + load_.stride * (k % load_block)) : rec(Real(0));
    }
    /// Factors from a force record to accelerations, 1/kg: 1/m along free axes, in 2D r^2 / I for the third number.
    rec inverse_mass(std::size_t k) const noexcept { return moving_[free_[k]] * rec(inverse_mass_[k]); }
    /// Inverse masses, also of fixed particles, 1/kg.
    Real const* inverse_masses() const noexcept { return inverse_mass_.data(); }
    /// 3D: factors from torque over radius to the acceleration of the surface, r^2 / I, 1/kg.
    rec inverse_rotary(std::size_t k) const noexcept { return rotating_[free_[k]] * rec(inverse_mass_[k]); }
    /// 3D: external torques over radius, N; empty if there are none. In 2D they are lane 2 of load().
    record_column<Real> const& torques() const noexcept { return torque_; }
    /// Masses, including those of the padding particles, kg.
    Real const* masses() const noexcept { return mass_.data(); }
    /// Internal index of a padding particle, `which` = 0 or 1. Pairs of them fill incomplete packs.
    std::int32_t padding_particle(int which) const noexcept { return std::int32_t(size()) + which; }
    /// Distance of the padding particles, m.
    Real padding_distance() const noexcept { return padding_distance_; }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(record_, surface_speed_, quaternion_, fixed_length{free_}, fixed_length{loads_at_});
        auto const blocks =
            std::int32_t(std::count_if(loads_at_.begin(), loads_at_.end(), [](auto at) { return at >= 0; }));
        for (auto const at : loads_at_) require_state(at >= -1 && at < blocks, "the index of a block of loads");
        load_.resize(load_block * std::size_t(blocks));
        ar(load_);
        bool has_torques = torque_.size() > 0;
        ar(has_torques);
        if (has_torques) {
            torque_.resize(size());
            ar(torque_);
        }
        for (auto const pattern : free_) require_state(pattern < free_patterns, "a particle's free axes");
    }
    /// \}

    static constexpr std::size_t load_block = 128;

private:
    /// 3D: turns a particle's orientation by a rotation vector, rad.
    void rotate_orientation(std::size_t k, rotation const& turn) noexcept {
        Real const angle = norm(turn), half = angle / 2;
        Real const scale = angle > Real(0) ? std::sin(half) / angle : Real(0.5);
        vec<Real, 4> const q = orientation(k), r{std::cos(half), turn[0] * scale, turn[1] * scale, turn[2] * scale};
        quaternion_.at(k, 0) = r[0] * q[0] - r[1] * q[1] - r[2] * q[2] - r[3] * q[3];
        quaternion_.at(k, 1) = r[0] * q[1] + r[1] * q[0] + r[2] * q[3] - r[3] * q[2];
        quaternion_.at(k, 2) = r[0] * q[2] - r[1] * q[3] + r[2] * q[0] + r[3] * q[1];
        quaternion_.at(k, 3) = r[0] * q[3] + r[1] * q[2] - r[2] * q[1] + r[3] * q[0];
    }
    static constexpr std::size_t padding_particles = 2;
    /// Bits of free_: the axes, then the rotation.
    static constexpr unsigned rotation_bit = 1u << Dim, free_patterns = 2u << Dim;
    static constexpr double min_normal() { return double(std::numeric_limits<Real>::min()); }
    static rec unit_quaternion() { return rec(typename rec::native{Real(1), Real(0), Real(0), Real(0)}); }
    /// Index in load_ of a particle's load; makes room for it first.
    std::size_t load_index(std::size_t k) {
        auto& at = loads_at_[k / load_block];
        if (at < 0) {
            at = std::int32_t(load_.size() / load_block);
            load_.resize(load_.size() + load_block);
        }
        return load_block * std::size_t(at) + k % load_block;
    }
    /// Index of the first velocity component in an entry of record_.
    static constexpr int motion = 4;
    template <class Column>
    static point head(Column const& column, std::size_t k, int first = 0) noexcept {
        point r{};
        for (int axis = 0; axis < Dim; ++axis) r[axis] = column.at(k, first + axis);
        return r;
    }
    template <class Column>
    static void set_head(Column& column, std::size_t k, point const& value, int first = 0) noexcept {
        for (int axis = 0; axis < Dim; ++axis) column.at(k, first + axis) = value[axis];
    }

    periods<Real, Dim> periods_;
    Real padding_distance_ = 1;
    std::vector<std::int32_t> id_, internal_;
    std::vector<int> material_;
    std::vector<Real> radius_, mass_, inverse_mass_;
    double inertia_share_ = 0.4; // moment of inertia over mass times radius squared
    std::vector<std::uint8_t> free_;
    std::vector<std::int32_t> loads_at_; // for each block of load_block particles its block of load_; -1: none
    /// For each pattern of free_ the components of a force, and of a torque over radius, that move a particle.
    record_column<Real> moving_ = record_column<Real>(free_patterns), rotating_ = record_column<Real>(free_patterns);
    particle_column<Real> record_; // positions and velocities
    record_column<Real> surface_speed_, quaternion_, load_, torque_;
};

} // namespace lacuna
