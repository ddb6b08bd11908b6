// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include <lacuna/core/standard.hpp>

/// \file
/// How a class takes part in checkpoints. It has a member `template <class Archive> void serialize(Archive& ar)`. In
/// one call ar(a, b, ...), this names all members that change during a simulation, both for writing and for reading.
/// Archives are cereal's (observe/state_archive.hpp); this header and the classes do not include cereal.

namespace lacuna {

/// An array whose length the reader already knows: it refuses a state with another length.
template <class Array>
struct fixed_length {
    Array& array;
};
template <class Array>
fixed_length(Array&) -> fixed_length<Array>;

/// Checks that a state agrees with itself and with the object that it is read into. It has no effect while writing.
/// \param what the part that does not fit, for the message
/// \throws std::runtime_error if `holds` is false
inline void require_state(bool holds, char const* what) {
    if (!holds) throw std::runtime_error(std::string("its state does not fit: ") + what);
}

} // namespace lacuna
