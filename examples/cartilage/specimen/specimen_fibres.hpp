// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cartilage/specimen/specimen_types.hpp"
#include <lacuna/packings/dense.hpp>
#include <lacuna/particles/packing_grid.hpp>

/// \file
/// The rows and fibres of the `literal` cartilage specimen. Free particles are added later.

namespace lacuna::detail {

/// Position and radius of a disc in a row whose position is given.
struct pinned_disc {
    double x, r;
};

/// Lays the fibres of one specimen.
class fibre_architect {
public:
    fibre_architect(cartilage_specimen_parameters const& p, cartilage_specimen<double>& s, random_source& random)
        : p_(p), s_(s), random_(random) {}

    void lay() {
        bool const whole = p_.zone == cartilage_zone::whole;
        double const bottom = p_.r_max, top = p_.height - p_.r_max;
        std::vector<pinned_disc> feet, heads;
        if (whole || p_.zone == cartilage_zone::deep) {
            for (double x : deep_fibre_positions()) {
                feet.push_back({x, draw()});
                heads.push_back({x, draw()});
            }
        }
        s_.fixed = row(bottom, feet);
        std::vector<std::int32_t> const pinned_feet = pinned_;
        if (whole || p_.zone == cartilage_zone::surface)
            surface(bottom, top);
        else
            s_.top = row(top, heads);
        if (whole || p_.zone == cartilage_zone::deep) deep(pinned_feet, feet, heads, top);
        if (whole)
            middle(s_.deep_top, s_.middle_top);
        else if (p_.zone == cartilage_zone::middle)
            middle(bottom, top);
    }

private:
    double draw() { return radius_range{p_.r_min, p_.r_max}.draw(random_); }

    /// Lays a row of unbonded discs over the whole length. They touch where the length between pinned discs allows it.
    /// \return the particles from left to right
    std::vector<std::int32_t> row(double y, std::vector<pinned_disc> const& pins) {
        std::vector<std::int32_t> ids;
        pinned_.clear();
        double from = 0;
        for (std::size_t k = 0; k <= pins.size(); ++k) {
            double const to = k < pins.size() ? pins[k].x - pins[k].r : p_.length;
            auto const fit = fit_radii(to - from, p_.r_min, p_.r_max, random_);
            double at = k == 0 && !pins.empty() ? from + fit.rest : from;
            for (double r : fit.radius) {
                ids.push_back(s_.discs.add({at + r, y}, r, free_matrix));
                at += 2 * r;
            }
            if (k == pins.size()) break;
            ids.push_back(s_.discs.add({pins[k].x, y}, pins[k].r, free_matrix));
            pinned_.push_back(ids.back());
            from = pins[k].x + pins[k].r;
        }
        return ids;
    }

    void finish(cartilage_fibre fibre, cartilage_zone zone, int layer, int order, int material) {
        fibre.zone = zone;
        fibre.layer = layer;
        fibre.order = order;
        s_.fibre.resize(s_.discs.size(), -1);
        for (auto i : fibre.particles) {
            s_.fibre[std::size_t(i)] = std::int32_t(s_.fibres.size());
            s_.discs.material[std::size_t(i)] = material;
        }
        s_.fibres.push_back(std::move(fibre));
    }

    void surface(double bottom, double top) {
        double const wanted = p_.fibre_spacing * p_.diameter();
        double spacing = wanted;
        int count = 0;
        if (p_.zone == cartilage_zone::surface) {
            count = std::max(1, int(std::lround((top - bottom) / wanted)));
            spacing = (top - bottom) / count;
        } else {
            count = int(std::floor((top - s_.middle_top) / wanted + 0.75));
        }
        s_.surface_spacing = spacing;
        if (p_.fibre_layers > 0) count = std::min(count, p_.fibre_layers);
        for (int k = 0; k < count; ++k) {
            cartilage_fibre f;
            lay_radii<double, 2>(s_.discs, f, {0, top - k * spacing}, {1, 0},
                                 fit_radii(p_.length, p_.r_min, p_.r_max, random_).radius, surface_collagen);
            if (k == 0) s_.top = f.particles;
            finish(std::move(f), cartilage_zone::surface, k, k, surface_collagen);
        }
    }

    /// The x coordinates of the deep fibres, m. One fibre lies on the centre line, the others at equal spacing on both
    /// sides. A whole number of diameters fits between the outer fibres and the sides of the specimen. Of all such
    /// spacings the one nearest to fibre_spacing is taken.
    std::vector<double> deep_fibre_positions() {
        double const d = p_.diameter(), half = p_.length / 2, wanted = p_.fibre_spacing * d;
        double best = -1, spacing = 0;
        int each = 0;
        for (int gap = 1; gap <= int(p_.fibre_spacing + 0.5); ++gap) {
            double const span = half - (gap + 0.5) * d;
            int const n = std::max(1, int(std::lround(span / wanted)));
            double const s = span / n, miss = std::fabs(s - wanted);
            if (s >= 2 * d && (best < 0 || miss < best)) {
                best = miss;
                spacing = s;
                each = n;
            }
        }
        s_.deep_spacing = spacing;
        if (p_.fibre_layers > 0) each = std::min(each, p_.fibre_layers - 1);
        std::vector<double> x;
        for (int k = -each; k <= each; ++k) x.push_back(half + k * spacing);
        return x;
    }

    void deep(std::vector<std::int32_t> const& feet, std::vector<pinned_disc> const& foot,
              std::vector<pinned_disc> const& heads, double top) {
        int const each = int(feet.size()) / 2;
        for (int k = -each; k <= each; ++k) {
            std::size_t const n = std::size_t(k + each);
            double const from = s_.discs.position[std::size_t(feet[n])][1] + foot[n].r;
            double const to = p_.zone == cartilage_zone::whole ? s_.deep_top : top - heads[n].r;
            cartilage_fibre f;
            f.particles.push_back(feet[n]);
            lay_radii<double, 2>(s_.discs, f, {foot[n].x, from}, {0, 1},
                                 fit_radii(to - from, p_.r_min, p_.r_max, random_).radius, deep_collagen);
            finish(std::move(f), cartilage_zone::deep, std::abs(k), k, deep_collagen);
        }
    }

    struct line {
        vec<double, 2> centre, along;
    };

    /// Mean distance of a line from the particles laid so far, m. A distance above `reach` counts as `reach`.
    double distance_of(line const& l, disc_grid const& grid, double reach) const {
        double sum = 0;
        int samples = 0;
        for (double t = -p_.middle_fibre_length / 2; t <= p_.middle_fibre_length / 2; t += p_.diameter()) {
            vec<double, 2> const x = l.centre + l.along * t;
            double nearest = reach;
            grid.for_each_near(x, reach, [&](std::size_t j) {
                nearest = std::min(nearest, norm(s_.discs.position[j] - x));
            });
            sum += nearest;
            ++samples;
        }
        return sum / samples;
    }

    /// A network of straight fibres with random positions and directions between two heights. Its length per area is
    /// that of parallel fibres at fibre_spacing. A fibre that meets another ends there and touches it; beyond it, it
    /// continues as a new fibre.
    void middle(double bottom, double high) {
        double const spacing = p_.fibre_spacing * p_.diameter();
        double const low = p_.fibre_layers > 0 ? std::max(bottom, high - p_.fibre_layers * spacing) : bottom;
        double const wanted = p_.length * (high - low) / spacing;
        std::size_t const first = s_.fibres.size();
        double laid = 0;
        int const patience = 200 + 40 * int(wanted / p_.middle_fibre_length);
        for (int attempt = 0; attempt < patience && laid < wanted; ++attempt) {
            disc_grid const grid(s_.discs.position, 2 * p_.r_max);
            line best{};
            double score = -1;
            for (int candidate = 0; candidate < 12; ++candidate) {
                line l{{random_.uniform(0, p_.length), random_.uniform(low, high)}, {}};
                double const angle = random_.uniform(0, pi);
                l.along = {std::cos(angle), std::sin(angle)};
                double const here = distance_of(l, grid, spacing);
                if (here > score) {
                    score = here;
                    best = l;
                }
            }
            laid += lay_line(best, grid, low, high);
        }
        for (std::size_t f = first; f < s_.fibres.size(); ++f) {
            double y = 0;
            for (auto i : s_.fibres[f].particles) y += s_.discs.position[std::size_t(i)][1];
            y /= double(s_.fibres[f].particles.size());
            s_.fibres[f].layer = std::clamp(int(5 * (high - y) / (high - bottom)), 0, 4);
            s_.fibres[f].order = s_.fibres[f].layer;
        }
    }

    double lay_line(line const& l, disc_grid const& grid, double low, double high) {
        double const end = draw(), half = p_.middle_fibre_length / 2;
        // The rectangle for the centres of end discs: away from the sides, the rows and the zone boundaries.
        vec<double, 2> const from{end, low + (low > p_.r_max ? end : 0.0)};
        vec<double, 2> const to{p_.length - end, high - end};
        double const ahead = std::min(half - end, length_inside(l.centre, l.along, from, to));
        double const behind = std::min(half - end, length_inside(l.centre, -l.along, from, to));
        if (!(ahead + behind > 2 * end)) return 0;
        std::vector<std::pair<double, double>> blocked{{ahead, ahead}};
        grid.for_each_near(l.centre, half + 2 * p_.r_max, [&](std::size_t j) {
            vec<double, 2> const d = s_.discs.position[j] - l.centre;
            double const t = dot(d, l.along), off = cross(l.along, d), reach = end + s_.discs.radius[j];
            if (std::fabs(off) >= p_.r_max + s_.discs.radius[j]) return;
            // The end discs of the pieces before and after must not overlap each other either.
            double const width = std::max(end, std::sqrt(std::max(0.0, reach * reach - off * off)));
            if (t + width > -behind && t - width < ahead) blocked.push_back({t - width, t + width});
        });
        std::sort(blocked.begin(), blocked.end());
        double laid = 0, at = -behind;
        for (auto const& [begin, finish_at] : blocked) {
            if (begin > at) laid += lay_piece(l, at, begin, end, grid);
            at = std::max(at, finish_at);
        }
        return laid;
    }

    /// Lays a fibre along a line, between two positions of its end discs' centres. \return its length, m; 0: none was
    /// laid
    double lay_piece(line const& l, double from, double to, double end, disc_grid const& grid) {
        double const inner = to - from - 2 * end;
        if (inner < 0) return 0;
        auto const fit = fit_radii(inner, p_.r_min, p_.r_max, random_);
        std::vector<double> radius{end};
        radius.insert(radius.end(), fit.radius.begin(), fit.radius.end());
        if (fit.rest == 0) radius.push_back(end);

        // Inner discs may be larger than the end discs. The fibre is the longest sequence of discs that overlap no
        // other.
        std::size_t begin = 0, length = 0, sequence = 0;
        std::vector<double> edge{from - end};
        for (std::size_t k = 0; k < radius.size(); ++k) {
            edge.push_back(edge[k] + 2 * radius[k]);
            vec<double, 2> const x = l.centre + l.along * (edge[k] + radius[k]);
            bool clear = true;
            grid.for_each_near(x, radius[k] + p_.r_max, [&](std::size_t j) {
                double const gap = norm(s_.discs.position[j] - x) - radius[k] - s_.discs.radius[j];
                clear = clear && gap > -1e-9 * p_.r_min;
            });
            sequence = clear ? sequence + 1 : 0;
            if (sequence > length) {
                length = sequence;
                begin = k + 1 - sequence;
            }
        }
        if (int(length) < p_.minimum_fibre_particles) return 0;
        auto const first = radius.begin() + std::ptrdiff_t(begin);
        cartilage_fibre f;
        lay_radii<double, 2>(s_.discs, f, l.centre + l.along * edge[begin], l.along,
                             {first, first + std::ptrdiff_t(length)}, middle_collagen);
        finish(std::move(f), cartilage_zone::middle, 0, 0, middle_collagen);
        return edge[begin + length] - edge[begin];
    }

    cartilage_specimen_parameters const& p_;
    cartilage_specimen<double>& s_;
    random_source& random_;
    std::vector<std::int32_t> pinned_;
};

} // namespace lacuna::detail
