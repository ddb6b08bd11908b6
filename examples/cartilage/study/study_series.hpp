// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <lacuna/core/vec.hpp>

#include "cartilage/study/study_result.hpp"

/// \file
/// What the plots of a study show: series and figures taken from its runs. Invalid runs are left out everywhere.

namespace cartilage {

using series = std::vector<lacuna::vec<double, 2>>;

/// The packings of one zone.
std::vector<packing_result const*> packings_of(study_result const& study, lacuna::cartilage_zone zone);

/// Broken bonds over bonds (%) against load (MPa), one series per packing, from runs that ran whole; upwards in load.
std::vector<series> damage_series(std::vector<packing_result const*> const& packings);

/// The median over series, read between their points along the logarithm of x, where at least half of them reach.
series median_series(std::vector<series> const& all);

/// When the first bond broke, over all runs of a zone.
struct first_crack_times {
    static constexpr double elastic_until = 2e-9; ///< s: an elastic wave has crossed the specimen a few times by then

    series elastic; ///< load (MPa), time (ns), of those not later than that
    series slow;    ///< of the later ones
    /// d(log t) / d(log P) among the slow ones of the same packing, least squares; -0.5 where t sqrt(P) is constant.
    std::optional<double> slope;
    /// Quartiles of t sqrt(P) of the slow ones, ns sqrt(MPa).
    double product_low = 0, product = 0, product_high = 0;
    double longest_run = 0; ///< ns

    std::size_t count() const { return elastic.size() + slow.size(); }
};
first_crack_times first_crack_times_of(std::vector<packing_result const*> const& packings);

/// The run of a packing whose cracks show how it fails: at its capacity; where that is not known, the one with most
/// cracks. Null where no run cracked.
load_run const* telling_run(packing_result const& packing);

/// When the layers of a zone had half of their bonds broken: in each packing's run with most such layers.
struct layer_order {
    struct layer {
        std::string name;
        std::vector<double> times; ///< ns, one per packing in which it came to this
        int first = 0;             ///< packings in which no other layer came earlier
    };
    std::vector<layer> layers; ///< as in the runs
    int packings = 0;          ///< with at least one such layer
};
layer_order layer_order_of(std::vector<packing_result const*> const& packings);

} // namespace cartilage
