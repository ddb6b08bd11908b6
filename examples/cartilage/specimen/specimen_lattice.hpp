// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "cartilage/specimen/specimen_types.hpp"

/// \file
/// The `lattice` cartilage specimen: equal discs on hexagonal lattices, symmetric about the centre line.

namespace lacuna::detail {

/// Lays one specimen. The surface and middle zones have a lattice of touching horizontal rows with n and n - 1 discs in
/// turn. Surface fibres are rows; middle fibres follow the two slanting directions. The deep zone has a lattice of
/// touching vertical columns, so that deep fibres are straight. Its bottom and top rows are the lowest and highest
/// discs of the columns; their heights differ by one radius from column to column.
class lattice_architect {
public:
    lattice_architect(cartilage_specimen_parameters const& p, cartilage_specimen<double>& s)
        : p_(p), s_(s), r_(p.diameter() / 2) {}

    void lay() {
        // The distance between lattice rows is sqrt(3)/2 diameters.
        stride_ = std::max(2, int(std::lround(p_.fibre_spacing * 2 / std::sqrt(3.0))));
        double base = r_;
        bool const whole = p_.zone == cartilage_zone::whole;
        if (whole || p_.zone == cartilage_zone::deep) base = columns(whole ? s_.deep_top : p_.height);
        if (p_.zone != cartilage_zone::deep) rows(base);
        s_.fibre.resize(s_.discs.size(), -1);
        s_.left = s_.length;
        s_.right = 0;
        for (auto const& x : s_.discs.position) {
            s_.left = std::min(s_.left, x[0] - r_);
            s_.right = std::max(s_.right, x[0] + r_);
        }
    }

private:
    void finish(std::vector<std::int32_t> const& particles, cartilage_zone zone, int layer, int order, int material) {
        cartilage_fibre f;
        f.zone = zone;
        f.layer = layer;
        f.order = order;
        f.particles = particles;
        s_.fibre.resize(s_.discs.size(), -1);
        for (std::size_t k = 0; k < particles.size(); ++k) {
            s_.fibre[std::size_t(particles[k])] = std::int32_t(s_.fibres.size());
            s_.discs.material[std::size_t(particles[k])] = material;
            if (k == 0) continue;
            f.bonds.push_back(std::int32_t(s_.discs.bonds.size()));
            s_.discs.bonds.push_back({particles[k - 1], particles[k]});
        }
        s_.fibres.push_back(std::move(f));
    }

    /// Lays the deep zone up to the height `top`. \return the height of the centres of a row that rests on it, m
    double columns(double top) {
        double const apart = std::sqrt(3.0) * r_, centre = p_.length / 2;
        int const each = int((centre - r_) / apart);
        int const high = std::max(2, int((top + 1e-9 * r_) / (2 * r_)));
        s_.deep_spacing = stride_ * apart;
        std::vector<vec<double, 2>> tips;
        for (int k = -each; k <= each; ++k) {
            int const odd = std::abs(k) % 2;
            std::vector<std::int32_t> column;
            for (int j = 0; j < high - odd; ++j)
                column.push_back(s_.discs.add({centre + k * apart, r_ * (2 * j + 1 + odd)}, r_, free_matrix));
            s_.fixed.push_back(column.front());
            if (p_.zone == cartilage_zone::deep) s_.top.push_back(column.back());
            tips.push_back(s_.discs.position.back());
            if (k % stride_ == 0 && laid(std::abs(k) / stride_))
                finish(column, cartilage_zone::deep, std::abs(k) / stride_, k / stride_, deep_collagen);
        }
        if (p_.zone == cartilage_zone::deep) return 0;
        double rest = 0;
        int const wide = row_count();
        for (int c = 0; c < wide; ++c)
            for (auto const& tip : tips) {
                double const dx = centre + r_ * (2 * c - wide + 1) - tip[0];
                if (std::fabs(dx) < 2 * r_) rest = std::max(rest, tip[1] + std::sqrt(4 * r_ * r_ - dx * dx));
            }
        return rest;
    }

    bool laid(int layer) const { return p_.fibre_layers == 0 || layer < p_.fibre_layers; }

    int row_count() const { return int((p_.length + 1e-9 * r_) / (2 * r_)); }

    /// Lays the surface and middle zones. \param base height of the first row's centres, m
    void rows(double base) {
        int const wide = row_count();
        double const apart = std::sqrt(3.0) * r_;
        int count = std::max(2, int((p_.height - r_ - base + 1e-9 * r_) / apart) + 1);
        if (count % 2 == 0) --count; // rows at bottom and top have n discs
        // site[row][h]: disc at x = centre + r (h - (wide - 1)), h even in even rows, odd in odd rows.
        std::vector<std::map<int, std::int32_t>> site(static_cast<std::size_t>(count));
        std::vector<double> y(static_cast<std::size_t>(count));
        for (int j = 0; j < count; ++j) {
            y[std::size_t(j)] = base + j * apart;
            for (int h = j % 2; h <= 2 * wide - 2 - j % 2; h += 2)
                site[std::size_t(j)][h] =
                    s_.discs.add({p_.length / 2 + r_ * (h - wide + 1), y[std::size_t(j)]}, r_, free_matrix);
        }
        auto const ids = [&](int j) {
            std::vector<std::int32_t> all;
            for (auto const& entry : site[std::size_t(j)]) all.push_back(entry.second);
            return all;
        };
        if (p_.zone != cartilage_zone::whole) s_.fixed = ids(0);
        s_.top = ids(count - 1);
        int above = count - 1; // the highest row for the network of the middle zone
        if (p_.zone != cartilage_zone::middle) {
            s_.surface_spacing = stride_ * apart;
            double const least = p_.zone == cartilage_zone::whole ? s_.middle_top : base + stride_ * apart / 2;
            for (int k = 0; k * stride_ < count && laid(k); ++k) {
                int const j = count - 1 - k * stride_;
                if (y[std::size_t(j)] < least) break;
                finish(ids(j), cartilage_zone::surface, k, k, surface_collagen);
                above = j - 1;
            }
        }
        if (p_.zone == cartilage_zone::surface) return;
        network(site, y, p_.zone == cartilage_zone::whole ? 0 : 1,
                p_.zone == cartilage_zone::whole ? above - stride_ / 2 : count - 2, wide);
    }

    /// Lays fibres along the two slanting directions. Where two cross in the left half, the fibre that leans to the
    /// right takes the site; in the right half the other one does; on the centre line neither. So the network is
    /// symmetric.
    void network(std::vector<std::map<int, std::int32_t>> const& site, std::vector<double> const& y, int low, int high,
                 int wide) {
        int const period = 4 * stride_; // in radii along a row; two families share the length per area
        int const centre = wide - 1;
        auto const wraps = [&](int a) { return (a % period + period) % period == 0; };
        // Lines of the two families meet on the centre line in row `low`.
        auto const right = [&](int h, int j) { return wraps((h - centre) - (j - low) + (centre + low) % 2); };
        auto const left = [&](int h, int j) { return wraps((centre - h) - (j - low) + (centre + low) % 2); };
        double const bottom = y[std::size_t(low)], top = y[std::size_t(std::max(low, high))];
        int const lowest = p_.fibre_layers > 0 ? std::max(low, high + 1 - p_.fibre_layers * stride_) : low;
        for (int lean : {1, -1})
            for (int start = -2 * int(y.size()); start <= 2 * wide + 2 * int(y.size()); ++start) {
                std::vector<std::int32_t> piece;
                auto const flush = [&] {
                    if (int(piece.size()) >= p_.minimum_fibre_particles) {
                        double mean = 0;
                        for (auto i : piece) mean += s_.discs.position[std::size_t(i)][1];
                        mean /= double(piece.size());
                        int const layer = std::clamp(int(5 * (top - mean) / std::max(top - bottom, r_)), 0, 4);
                        finish(piece, cartilage_zone::middle, layer, layer, middle_collagen);
                    }
                    piece.clear();
                };
                for (int j = lowest; j <= high; ++j) {
                    int const h = start + lean * (j - low);
                    auto const found = site[std::size_t(j)].find(h);
                    bool const there = found != site[std::size_t(j)].end();
                    bool const mine = lean > 0 ? right(h, j) : left(h, j);
                    bool const shared = right(h, j) && left(h, j);
                    bool const owned = !shared || (lean > 0 ? h < centre : h > centre);
                    if (there && mine && owned)
                        piece.push_back(found->second);
                    else
                        flush();
                }
                flush();
            }
    }

    cartilage_specimen_parameters const& p_;
    cartilage_specimen<double>& s_;
    double r_;
    int stride_ = 5;
};

} // namespace lacuna::detail
