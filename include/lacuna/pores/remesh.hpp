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
#include <lacuna/pores/geometry.hpp>
#include <lacuna/pores/pore_network.hpp>

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
        known_.swap(found_);
    }

    /// Whether the mesh needs to be made anew; parameters as in accept().
    template <class ForEachPair>
    bool unfit(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
               Real minimum_share, ForEachPair const& for_each_pair) {
        bool const turned = look(net, points, radii, thickness, minimum_share, for_each_pair);
        bool const more = !std::includes(known_.begin(), known_.end(), found_.begin(), found_.end());
        known_.swap(found_);
        return turned || more;
    }

    /// Writes, or reads for a mesh of `particles` particles, what a run has found so far.
    template <class Archive>
    void archive(Archive& ar, pore_network<Real, 2> const& net, std::size_t particles) {
        ar(known_);
        require_state(std::is_sorted(known_.begin(), known_.end()), "what is known of its mesh");
        if constexpr (Archive::is_loading::value) learn(net, particles);
    }

private:
    /// Three corners of a pore that is filled, or two particles that touch, and -1.
    using fault = std::array<std::int32_t, 3>;

    static std::array<std::int32_t, 2> sorted(std::int32_t i, std::int32_t j) noexcept {
        return {std::min(i, j), std::max(i, j)};
    }

    /// Edges and corners of a mesh.
    void learn(pore_network<Real, 2> const& net, std::size_t particles) {
        edges_.clear();
        edges_.reserve(net.throats());
        corner_.assign(particles, 0);
        for (std::size_t t = 0; t < net.throats(); ++t)
            edges_.push_back(sorted(net.throat_particle[0][t], net.throat_particle[1][t]));
        std::sort(edges_.begin(), edges_.end());
        for (auto const& corner : net.corner)
            for (auto const i : corner) corner_[std::size_t(i)] = 1;
    }

    /// Leaves the faults in found_. \return whether a triangle has turned over
    template <class ForEachPair>
    bool look(pore_network<Real, 2> const& net, points_view<Real, 2> points, Real const* radii, Real thickness,
              Real minimum_share, ForEachPair const& for_each_pair) {
        found_.clear();
        bool turned = false;
        for (std::size_t p = 0; p < net.pores(); ++p) {
            fault const f{net.corner[0][p], net.corner[1][p], net.corner[2][p]};
            turned = turned || !(triangle_area(points[std::size_t(f[0])], points[std::size_t(f[1])],
                                               points[std::size_t(f[2])]) > Real(0));
            if (net.volume[p] <= Real(1.0001) * minimum_share * thickness * net.size[p]) found_.push_back(f);
        }
        for_each_pair([&](std::int32_t i, std::int32_t j) {
            if (!corner_[std::size_t(i)] || !corner_[std::size_t(j)]) return;
            auto const apart = points[std::size_t(j)] - points[std::size_t(i)];
            Real const reach = radii[i] + radii[j];
            if (squared_norm(apart) > reach * reach) return;
            auto const edge = sorted(i, j);
            if (!std::binary_search(edges_.begin(), edges_.end(), edge)) found_.push_back({edge[0], edge[1], -1});
        });
        std::sort(found_.begin(), found_.end());
        return turned;
    }

    std::vector<std::array<std::int32_t, 2>> edges_;
    std::vector<std::uint8_t> corner_; // of particles: in the mesh
    std::vector<fault> known_, found_;
};

} // namespace lacuna
