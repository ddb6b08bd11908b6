// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cartilage/study/study_result.hpp"

/// \file
/// Writes studies as JSON and reads them. Values are read back bit for bit; equal values give equal bytes.

namespace cartilage {

using json = nlohmann::ordered_json;

/// \name Parts of a study to JSON and back. Reading throws nlohmann::json::exception or std::invalid_argument if a
/// value has
/// the wrong type or range.
/// \{
json json_of(load_run const& p);
json json_of(packing_result const& r);
json json_of(snapshot const& s);
load_run load_run_from(json const& j);
packing_result packing_from(json const& j);
snapshot snapshot_from(json const& j);
/// \}

/// The text of study.json, with one line for each packing and snapshot.
std::string text_of(study_result const& study);
/// Reads the text of study.json. \throws std::runtime_error that names the error
study_result study_from(std::string const& text);

} // namespace cartilage
