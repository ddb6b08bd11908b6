// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/load_specimen.hpp"

CARTILAGE_INSTANTIATE(dry_beam_model, )
CARTILAGE_INSTANTIATE(wet_beam_model, )
