// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/load_specimen.hpp"

CARTILAGE_INSTANTIATE(dry_model, )
CARTILAGE_INSTANTIATE(wet_model, )
