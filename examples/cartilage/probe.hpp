// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "options.hpp"
#include "question.hpp"
#include "specimen.hpp"
#include "study_result.hpp"

/// \file
/// One packing under one load, followed only as far as a question needs.

namespace cartilage {

/// A run that waits where its last answer became certain: asked further, it goes on from there.
class probe_run {
public:
    virtual ~probe_run() = default;
    /// Goes on until the answer is certain. Where the run turns out not to count, `invalid` of the result says why.
    /// \throws interruption when a signal asks to stop
    virtual probe ask(question q) = 0;
};

/// Loads a specimen, at rest until it is asked. \param s has to outlive the run \param o load, model and duration
/// \throws std::invalid_argument when the model cannot be built
std::unique_ptr<probe_run> start_probe(specimen const& s, options const& o);

} // namespace cartilage
