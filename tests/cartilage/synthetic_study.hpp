// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cartilage/study/study_result.hpp"

/// A study that nobody ran, for tests of the report alone: every part of the data is there, loads scatter about round
/// numbers, some runs do not count, some packings hold. \param seeds packings per zone
cartilage::study_result synthetic_study(int seeds);
