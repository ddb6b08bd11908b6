// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cartilage/study/study_result.hpp"

/// A study with invented results, for tests of the report: it has all parts of the data, loads that scatter about round
/// numbers, some invalid runs and some packings that hold. \param seeds packings per zone
cartilage::study_result synthetic_study(int seeds);
