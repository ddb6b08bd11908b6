// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>

#include <lacuna/interactions/break_event.hpp>
#include <lacuna/interactions/kinematics.hpp>
#include <lacuna/interactions/pair_loop.hpp>

namespace lacuna {

/// A bond that has just failed: its event, the contact that takes over, and what it means for the energies.
template <class ContactEntry, int Dim>
struct bond_failure {
    break_event<Dim> event;
    ContactEntry contact;
    double released; ///< taken out of the springs by the failure, consistent with the integrator, J
    double stored;   ///< change of the elastic energy, J; negative
};

/// Looks at one bond whose step the pair loop has evaluated: if it fails, hands it over to the contact law.
///
/// In tension the pair becomes a contact without force that touches no earlier than now; in shear a frictional
/// contact at once, with the compressive normal force and the shear force clipped by Coulomb's limit.
/// \param row of the contact's parameters
/// \param force record of the pair: overwritten with the force of the contact
template <class BondLaw, class ContactLaw, class Real, int Dim, class BondEntry, class BondParameters,
          class ContactParameters>
auto fail_bond(particle_store<Real, Dim> const& store, BondEntry const& bond, BondParameters const& bond_parameters,
               ContactParameters const& contact_parameters, std::int32_t row, Real time_step, Real* force)
    -> std::optional<bond_failure<typename pair_table<ContactLaw, Real, Dim>::entry, Dim>> {
    auto const i = load_body(store, std::size_t(bond.i));
    auto j = load_body(store, std::size_t(bond.j));
    if (store.period().any()) j.position = i.position + store.nearest(j.position - i.position);
    auto frame = relative_motion(i, j, time_step);
    // The loop has already added the slip of this step to the history.
    auto const slip = frame.motion.slip;
    frame.motion.slip = {};
    auto const answer = [&] {
        if constexpr (carries_moment<BondLaw>)
            return BondLaw::evaluate(bond_parameters, frame.motion, frame.turn(i.spin, i.spin, time_step), bond.state);
        else
            return BondLaw::evaluate(bond_parameters, frame.motion, bond.state);
    }();
    if (!answer.broken) return {};

    Real const touching = frame.motion.touching_distance();
    auto state = ContactLaw::template initial<Real, Dim>(std::min(frame.motion.distance, touching), touching);
    if (!answer.broken_in_tension)
        state = ContactLaw::hand_over(contact_parameters, frame.motion, answer.normal_force, answer.shear_force);
    auto const contact = ContactLaw::evaluate(contact_parameters, frame.motion, state);
    store_pair_force<Real, Dim>(force, frame.force(contact.normal_force, contact.shear_force),
                                frame.torque_per_radius(contact.shear_force), contact.normal_force);

    bond_failure<typename pair_table<ContactLaw, Real, Dim>::entry, Dim> failure{};
    auto& event = failure.event;
    event.bond = bond.label;
    event.particles = {store.id(std::size_t(bond.i)), store.id(std::size_t(bond.j))};
    event.mode = answer.broken_in_tension ? bond_state::broken_in_tension : bond_state::broken_in_shear;
    for (int axis = 0; axis < Dim; ++axis)
        event.position[axis] = double(i.position[axis] + frame.normal[axis] * (frame.lever * i.radius));
    event.normal_force = double(answer.normal_force);
    event.shear_force = Dim == 2 ? double(answer.shear_force[0]) : double(norm(answer.shear_force));
    event.energy = stored_energy_of(answer);
    failure.stored = stored_energy_of(contact) - stored_energy_of(answer);
    // The integrator sees the mean of old and new force over the step: what the springs lose to the failure is the
    // stored energy less the work that the missing force would have done.
    failure.released =
        -failure.stored -
        0.5 * double((answer.normal_force - contact.normal_force) * frame.motion.normal_rate * time_step) -
        0.5 * double(dot(answer.shear_force - contact.shear_force, slip));
    if constexpr (carries_moment<BondLaw>) {
        auto const turn = frame.turn(i.spin, j.spin, time_step);
        failure.released -=
            0.5 * double(dot(answer.bending_moment, turn.bend) + answer.twisting_moment * turn.twist);
    }
    failure.contact = {bond.i, bond.j, row, -1, contact.history};
    return failure;
}

} // namespace lacuna
