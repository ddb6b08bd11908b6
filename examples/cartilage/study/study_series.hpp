// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/vec.hpp>

#include "cartilage/study/study_result.hpp"

/// \file
/// Series and numbers for the plots of a study. Invalid runs are left out everywhere.

namespace cartilage {

using series = std::vector<lacuna::vec<double, 2>>;

/// The packings of one zone.
std::vector<packing_result const*> packings_of(study_result const& study, lacuna::cartilage_zone zone);

/// Broken bonds over bonds (%) against load (MPa), one series per packing, in order of load. Only runs to the end
/// count.
std::vector<series> damage_series(std::vector<packing_result const*> const& packings);

/// The median of the series at each x that at least half of them cover. Between points they are interpolated in the
/// logarithm of x.
series median_series(std::vector<series> const& all);

/// Times of the first crack in all runs of a zone.
struct first_crack_times {
    static constexpr double elastic_until = 2e-9; ///< s; elastic waves have crossed the specimen a few times by then

    series elastic; ///< load (MPa), time (ns), up to elastic_until
    series slow;    ///< the same for later first cracks
    /// d(log t) / d(log P) of the slow ones within a packing, by least squares; -0.5 if t sqrt(P) is constant.
    std::optional<double> slope;
    /// First quartile, median and third quartile of t sqrt(P) of the slow ones, ns sqrt(MPa).
    double product_low = 0, product = 0, product_high = 0;
    double longest_run = 0; ///< duration of the longest run, ns

    std::size_t count() const { return elastic.size() + slow.size(); }
};
first_crack_times first_crack_times_of(std::vector<packing_result const*> const& packings);

/// The run that represents how a packing fails: the run at its capacity or, if that is unknown, the run with most
/// cracks. Null if no run has cracks.
load_run const* representative_run(packing_result const& packing);

/// Moments at which layers fail.
struct layer_order {
    struct layer {
        std::string name;
        std::vector<double> times; ///< one per packing in which it failed: a time, ns, or a load, MPa
        int first = 0;             ///< packings in which no other layer was earlier
    };
    std::vector<layer> layers; ///< in the order of the runs
    int packings = 0;          ///< packings with at least one such layer

    /// Adds a packing: names of its layers, each with its moment; none: it did not fail.
    void add(std::vector<std::pair<std::string, std::optional<double>>> const& moments);
};
/// Times at which half of each layer's bonds were broken, ns. Each packing gives the run with most such layers.
layer_order layer_order_of(std::vector<packing_result const*> const& packings);

} // namespace cartilage
