// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// A material of a model: its density and its values for the contact law and the bond law.
template <class ContactLaw, class BondLaw>
struct material_of {
    double density = 1000; ///< kg/m^3; for particles without their own density, see packing::density
    typename ContactLaw::material contact{};
    typename BondLaw::material bond{};

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name) const {
        require_positive(name + ".density", density);
        contact.validate(name + ".contact");
        bond.validate(name + ".bond");
    }
};

} // namespace lacuna
