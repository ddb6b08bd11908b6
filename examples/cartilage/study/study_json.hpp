// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cartilage/study/study_result.hpp"

/// \file
/// A study as JSON and back: the same values, bit for bit, and the same bytes for the same values.

namespace cartilage {

using json = nlohmann::ordered_json;

/// \name One part to JSON, and back. Reading throws nlohmann::json::exception or std::invalid_argument for anything
/// that such a part does not look like.
/// \{
json json_of(load_run const& p);
json json_of(packing_result const& r);
json json_of(snapshot const& s);
load_run load_run_from(json const& j);
packing_result packing_from(json const& j);
snapshot snapshot_from(json const& j);
/// \}

/// The text of study.json: a line for each packing and snapshot.
std::string text_of(study_result const& study);
/// \throws std::runtime_error saying what is wrong with the text
study_result study_from(std::string const& text);

} // namespace cartilage
