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

/// When the pores of a body that deforms are triangulated anew.
enum class remesh_rule : std::uint8_t {
    never,      ///< the mesh of the beginning: right for small strains
    when_needed ///< when mesh_watch finds that it does not fit any more
};

/// Parameters of remeshing.
struct remesh_parameters {
    remesh_rule rule = remesh_rule::never;
    int interval = 100;         ///< steps between two looks at the mesh; >= 1
    bool on_broken_bond = false; ///< also when a bond has failed since the last look

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name) const { require_in(name + ".interval", interval, 1, 1000000000); }
};

/// Finds out whether a mesh still fits its particles:
///   - a triangle has turned over, or has no area left;
///   - the discs of a triangle have come to fill it (its pore is at its least volume);
///   - two discs of the mesh touch that share no edge.
/// The second and third may be there in a fresh mesh too (three discs may fill their triangle, a third disc may lie
/// over a contact, the boundary of the body is not convex): what a fresh mesh has does not count until it has gone.
template <class Real>
class mesh_watch {
public:
    /// Takes the present state of a fresh mesh as fitting.
    /// \param for_each_pair callable: for_each_pair(visit) calls visit(i, j) for all pairs that may touch
    template <class ForEachPair>
    void accept(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
                Real minimum_share, ForEachPair const& for_each_pair) {
        learn(net, points.size());
        look(net, points, radii, thickness, minimum_share, for_each_pair);
    }

    /// Whether the mesh needs to be made anew; parameters as in accept().
    template <class ForEachPair>
    bool unfit(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
               Real minimum_share, ForEachPair const& for_each_pair) {
        return look(net, points, radii, thickness, minimum_share, for_each_pair);
    }

    /// Writes, or reads for a mesh of `particles` particles, what a run has found so far.
    template <class Archive>
    void archive(Archive& ar, pore_network<Real, 2> const& net, std::size_t particles) {
        if constexpr (Archive::is_loading::value) learn(net, particles);
        ar(fixed_length{filled_}, touching_);
        require_state(std::is_sorted(touching_.begin(), touching_.end()), "what is known of its mesh");
    }

private:
    using pair = std::array<std::int32_t, 2>;

    static pair sorted(std::int32_t i, std::int32_t j) noexcept { return {std::min(i, j), std::max(i, j)}; }

    /// Edges and corners of a mesh, of which nothing is known yet.
    void learn(pore_network<Real, 2> const& net, std::size_t particles) {
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

    /// Looks at the mesh, and remembers its faults. \return whether there is one that was not there the last time, or a
    /// triangle has turned over
    template <class ForEachPair>
    bool look(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
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

    // Of the mesh: the particles to which an edge leads from each, from the lower-numbered one; and which are in it.
    std::vector<std::int32_t> first_edge_, edge_;
    std::vector<std::uint8_t> corner_;
    std::vector<std::uint8_t> filled_; // of pores, at the last look: the particles fill it
    std::vector<pair> touching_;       // at the last look, without sharing an edge
};

} // namespace lacuna
