// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include <lacuna/core/standard.hpp>

/// \file
/// How a class takes part in checkpoints: by a member `template <class Archive> void serialize(Archive& ar)` that
/// names, in one call ar(a, b, ...), what a run changes, for writing and reading alike. Archives are cereal's
/// (observe/state_archive.hpp); this header and the classes need nothing of it.

namespace lacuna {

/// An array whose length the reader already has: a state with another length is refused.
template <class Array>
struct fixed_length {
    Array& array;
};
template <class Array>
fixed_length(Array&) -> fixed_length<Array>;

/// Refuses a state that contradicts itself or what it is read into. Without effect on what is written.
/// \throws std::runtime_error
inline void require_state(bool holds, char const* what) {
    if (!holds) throw std::runtime_error(std::string("its state does not fit: ") + what);
}

} // namespace lacuna
