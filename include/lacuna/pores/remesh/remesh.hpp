// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/pores/mesh/geometry.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// When a deforming packing gets a new mesh of pores.
enum class remesh_rule : std::uint8_t {
    never,      ///< keep the initial mesh: right for small strains
    when_needed ///< when mesh_watch finds that the mesh no longer fits the particles
};

/// Parameters of remeshing.
struct remesh_parameters {
    remesh_rule rule = remesh_rule::never;
    int interval = 100;          ///< steps between two checks of the mesh; >= 1
    bool on_broken_bond = false; ///< also remesh if a bond has failed since the last check

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name) const { require_in(name + ".interval", interval, 1, 1000000000); }
};

/// Finds out whether a mesh still fits its particles. It does not if
///   - a triangle is inverted, or has no area;
///   - the discs of a triangle now fill it (its pore is at its least volume);
///   - two discs of the mesh touch but share no edge.
/// The second and third fault may occur in a new mesh too: three discs may fill their triangle, a third disc may cover
/// a contact, or the boundary may be concave there. A fault of a new mesh counts only after it has vanished and
/// returned.
template <class Real>
class mesh_watch {
public:
    /// Records the faults of a new mesh, which do not count.
    /// \param points centres, m; \param radii m; \param thickness m
    /// \param minimum_share least pore volume as a share of the pore's triangle, see flow_parameters
    /// \param for_each_pair callable: for_each_pair(visit) calls visit(i, j) for all pairs that may touch
    template <class ForEachPair>
    void accept(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
                Real minimum_share, ForEachPair const& for_each_pair) {
        reset(net, points.size());
        check(net, points, radii, thickness, minimum_share, for_each_pair);
    }

    /// Whether a new mesh is needed; parameters as in accept().
    template <class ForEachPair>
    bool unfit(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
               Real minimum_share, ForEachPair const& for_each_pair) {
        return check(net, points, radii, thickness, minimum_share, for_each_pair);
    }

    /// Writes or reads the faults found so far, for a mesh of `particles` particles.
    template <class Archive>
    void archive(Archive& ar, pore_network<Real, 2> const& net, std::size_t particles) {
        if constexpr (Archive::is_loading::value) reset(net, particles);
        ar(fixed_length{filled_}, touching_);
        require_state(std::is_sorted(touching_.begin(), touching_.end()), "the contacts of its mesh are not sorted");
    }

private:
    using pair = std::array<std::int32_t, 2>;

    static pair sorted(std::int32_t i, std::int32_t j) noexcept { return {std::min(i, j), std::max(i, j)}; }

    /// Takes over the edges and corners of a mesh, and clears the faults.
    void reset(pore_network<Real, 2> const& net, std::size_t particles) {
        filled_.assign(net.pores(), 0);
        touching_.clear();
        corner_.assign(particles, 0);
        for (auto const& corner : net.corner)
            for (auto const i : corner) corner_[std::size_t(i)] = 1;
        auto const edge = [&](std::size_t t) { return sorted(net.throat_particle[0][t], net.throat_particle[1][t]); };
        first_edge_.assign(particles + 1, 0);
        for (std::size_t t = 0; t < net.throats(); ++t) ++first_edge_[std::size_t(edge(t)[0])];
        for (std::size_t i = 0; i < particles; ++i) first_edge_[i + 1] += first_edge_[i];
        edge_.resize(net.throats());
        for (std::size_t t = 0; t < net.throats(); ++t)
            edge_[std::size_t(--first_edge_[std::size_t(edge(t)[0])])] = edge(t)[1];
    }
    bool is_edge(pair const& p) const noexcept {
        auto const at = [&](std::int32_t i) { return edge_.begin() + first_edge_[std::size_t(i)]; };
        return std::find(at(p[0]), at(p[0] + 1), p[1]) != at(p[0] + 1);
    }

    /// Checks the mesh, and stores its faults. \return whether there is a fault that the last check did not find, or an
    /// inverted triangle
    template <class ForEachPair>
    bool check(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
              Real minimum_share, ForEachPair const& for_each_pair) {
        bool found = false;
        for (std::size_t p = 0; p < net.pores(); ++p) {
            auto const at = [&](std::size_t c) { return points[std::size_t(net.corner[c][p])]; };
            bool const full = net.volume[p] <= Real(1.0001) * minimum_share * thickness * net.size[p];
            found = found || (full && !filled_[p]) || !(triangle_area(at(0), at(1), at(2)) > Real(0));
            filled_[p] = full;
        }
        std::vector<pair> now;
        for_each_pair([&](std::int32_t i, std::int32_t j) {
            if (!corner_[std::size_t(i)] || !corner_[std::size_t(j)]) return;
            auto const apart = points[std::size_t(j)] - points[std::size_t(i)];
            Real const reach = radii[i] + radii[j];
            if (squared_norm(apart) > reach * reach) return;
            if (auto const both = sorted(i, j); !is_edge(both)) now.push_back(both);
        });
        std::sort(now.begin(), now.end());
        found = found || !std::includes(touching_.begin(), touching_.end(), now.begin(), now.end());
        touching_.swap(now);
        return found;
    }

    // Edges of the mesh, by their lower-numbered particle: its range in edge_, which holds the other particles.
    std::vector<std::int32_t> first_edge_, edge_;
    std::vector<std::uint8_t> corner_; // per particle: whether it is in the mesh
    std::vector<std::uint8_t> filled_; // per pore: whether its particles filled it at the last check
    std::vector<pair> touching_;       // pairs that touched at the last check without sharing an edge
};

} // namespace lacuna
