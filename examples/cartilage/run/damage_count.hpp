// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cartilage/run/load_run.hpp"
#include "cartilage/specimen/specimen.hpp"

namespace cartilage {

/// Counts the damage of fibres and layers break by break. A break comes at a moment: in a run a time, s; on the way
/// from equilibrium to equilibrium a load, MPa.
class damage_count {
public:
    explicit damage_count(specimen const& s) : cut_(s.fibres.size(), 0), layer_of_(s.fibres.size()) {
        std::map<std::pair<int, int>, load_run::layer_damage> by_layer;
        for (auto const& fibre : s.fibres) {
            load_run::layer_damage& layer = by_layer[{int(fibre.zone), fibre.layer}];
            layer.zone = lacuna::to_string(fibre.zone);
            layer.layer = fibre.layer;
            layer.bonds += int(fibre.bonds.size());
            bonds_ += int(fibre.bonds.size());
        }
        for (std::size_t f = 0; f < s.fibres.size(); ++f) {
            auto const found = by_layer.find({int(s.fibres[f].zone), s.fibres[f].layer});
            layer_of_[f] = std::size_t(std::distance(by_layer.begin(), found));
        }
        for (auto const& [key, layer] : by_layer) layers_.push_back(layer);
        layer_cut_.resize(layers_.size());
    }

    /// Adds a break. Breaks of cross links do not count. \param fibre of the bond; -1: a cross link
    void add(int fibre, double moment) {
        if (fibre < 0) return;
        ++broken_;
        cut_count_ += cut_[std::size_t(fibre)] == 0;
        cut_[std::size_t(fibre)] = 1;
        std::size_t const l = layer_of_[std::size_t(fibre)];
        load_run::layer_damage& layer = layers_[l];
        ++layer.broken;
        if (!layer.half_broken_time && 2 * layer.broken >= layer.bonds) layer.half_broken_time = moment;
        if (!layer_cut_[l]) layer_cut_[l] = moment;
        if (!first_crack) first_crack = moment;
        if (!first_layer_and_another && layer_cut_.front() && cut_count_ >= 2) first_layer_and_another = moment;
        if (!complete && 10 * cut_count_ >= 9 * cut_.size()) complete = moment;
    }

    std::vector<load_run::layer_damage> const& layers() const { return layers_; }
    /// The moment of the first break in each layer, in the order of layers(); none: it is whole.
    std::vector<std::optional<double>> const& layers_cut() const { return layer_cut_; }
    /// The first layer of the zone nearest to the surface; null: there is no fibre.
    load_run::layer_damage const* first_layer() const { return layers_.empty() ? nullptr : &layers_.front(); }
    double broken_fraction() const { return bonds_ == 0 ? 0.0 : double(broken_) / double(bonds_); }
    double cut_fraction() const { return cut_.empty() ? 0.0 : double(cut_count_) / double(cut_.size()); }
    std::size_t fibres_cut() const { return cut_count_; }

    /// Moments: of the first break, at which 90 % of the fibres are cut, and at which a fibre of the first layer and
    /// any other fibre are.
    std::optional<double> first_crack, complete, first_layer_and_another;

private:
    std::vector<char> cut_;
    std::size_t cut_count_ = 0;
    std::vector<std::size_t> layer_of_;
    std::vector<load_run::layer_damage> layers_;
    std::vector<std::optional<double>> layer_cut_;
    int bonds_ = 0, broken_ = 0;
};

} // namespace cartilage
