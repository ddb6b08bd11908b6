// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>

#include <lacuna/interactions/break_event.hpp>
#include <lacuna/interactions/kinematics.hpp>
#include <lacuna/interactions/pair_loop.hpp>

namespace lacuna {

/// A bond that has just failed: its event, the contact that replaces it, and the changes of the energies.
template <class ContactEntry, int Dim>
struct bond_failure {
    break_event<Dim> event;
    ContactEntry contact;
    double released; ///< energy that the failure takes out of the springs, consistent with the integrator, J
    double stored;   ///< change of the elastic energy, J; negative
};

/// Checks one bond after the pair loop has evaluated its step. If the bond fails, hands the pair over to the contact
/// law.
///
/// After failure in tension the pair is a contact without force. Its force begins at the present distance or at
/// r_i + r_j, whichever is smaller. After failure in shear it is a frictional contact at once: it keeps the compressive
/// normal force, and Coulomb's limit clips the shear force.
/// \param row row of the contact's parameters
/// \param time_step of the step just evaluated, s
/// \param force force record of the pair; overwritten with the force of the contact if the bond fails
/// \param anyway true: the bond fails whatever its strength, in tension if it pulls, else in shear
/// \return the failure; none if the bond holds
template <class BondLaw, class ContactLaw, class Real, int Dim, class BondEntry, class BondParameters,
          class ContactParameters>
auto fail_bond(particle_store<Real, Dim> const& store, BondEntry const& bond, BondParameters const& bond_parameters,
               ContactParameters const& contact_parameters, std::int32_t row, Real time_step, Real* force,
               bool anyway = false)
    -> std::optional<bond_failure<typename pair_table<ContactLaw, Real, Dim>::entry, Dim>> {
    auto const i = load_particle(store, std::size_t(bond.i));
    auto j = load_particle(store, std::size_t(bond.j));
    if (store.period().any()) j.position = i.position + store.nearest(j.position - i.position);
    auto frame = relative_motion(i, j, time_step);
    // The loop has already added the slip of this step to the history.
    auto const slip = frame.motion.slip;
    frame.motion.slip = {};
    auto const answer = [&] {
        if constexpr (carries_moment<BondLaw>)
            return BondLaw::evaluate(bond_parameters, frame.motion, frame.relative_rotation(i.spin, i.spin, time_step),
                                     bond.state);
        else
            return BondLaw::evaluate(bond_parameters, frame.motion, bond.state);
    }();
    if (!answer.broken && !anyway) return {};
    bool const in_tension = answer.broken ? bool(answer.broken_in_tension) : answer.normal_force > Real(0);

    Real const touching = frame.motion.touching_distance();
    auto state = ContactLaw::template initial<Real, Dim>(std::min(frame.motion.distance, touching), touching);
    if (!in_tension)
        state = ContactLaw::hand_over(contact_parameters, frame.motion, answer.normal_force, answer.shear_force);
    auto const contact = ContactLaw::evaluate(contact_parameters, frame.motion, state);
    store_pair_force<Real, Dim>(force, frame.force(contact.normal_force, contact.shear_force),
                                frame.torque_per_radius(contact.shear_force), contact.normal_force);

    bond_failure<typename pair_table<ContactLaw, Real, Dim>::entry, Dim> failure{};
    auto& event = failure.event;
    event.bond = bond.label;
    event.particles = {store.id(std::size_t(bond.i)), store.id(std::size_t(bond.j))};
    event.mode = in_tension ? bond_state::broken_in_tension : bond_state::broken_in_shear;
    for (int axis = 0; axis < Dim; ++axis)
        event.position[axis] = double(i.position[axis] + frame.normal[axis] * (frame.lever * i.radius));
    event.normal_force = double(answer.normal_force);
    event.shear_force = Dim == 2 ? double(answer.shear_force[0]) : double(norm(answer.shear_force));
    event.energy = stored_energy_of(answer);
    failure.stored = stored_energy_of(contact) - stored_energy_of(answer);
    // The integrator uses the mean of old and new force over the step. Hence the springs lose the stored energy less
    // the work that the missing force would have done.
    failure.released =
        -failure.stored -
        0.5 * double((answer.normal_force - contact.normal_force) * frame.motion.normal_rate * time_step) -
        0.5 * double(dot(answer.shear_force - contact.shear_force, slip));
    if constexpr (carries_moment<BondLaw>) {
        auto const rotation = frame.relative_rotation(i.spin, j.spin, time_step);
        failure.released -=
            0.5 * double(dot(answer.bending_moment, rotation.bend) + answer.twisting_moment * rotation.twist);
    }
    failure.contact = {bond.i, bond.j, row, -1, contact.history};
    return failure;
}

} // namespace lacuna
