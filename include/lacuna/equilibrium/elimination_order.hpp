// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <lacuna/core/eigen_sparse.hpp>

namespace lacuna {

/// Which nodes of a mesh share an entry of a matrix: the neighbours of node k are neighbour[begin[k]] to
/// neighbour[begin[k + 1] - 1], in rising order.
struct node_graph {
    std::vector<int> begin{0}, neighbour;
    int size() const noexcept { return int(begin.size()) - 1; }
    std::span<int const> of(int node) const noexcept {
        return std::span(neighbour).subspan(std::size_t(begin[std::size_t(node)]),
                                            std::size_t(begin[std::size_t(node) + 1] - begin[std::size_t(node)]));
    }
};

/// Order of elimination by approximate minimum degree.
/// \return nodes in the order in which they are eliminated
inline std::vector<int> minimum_degree_order(node_graph const& graph) {
    using pattern = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
    std::vector<double> const ones(graph.neighbour.size(), 1.0);
    pattern const matrix = Eigen::Map<pattern const>(graph.size(), graph.size(), Eigen::Index(ones.size()),
                                                     graph.begin.data(), graph.neighbour.data(), ones.data());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(matrix, order);
    return {order.indices().data(), order.indices().data() + graph.size()};
}

/// Order of elimination by nested dissection (George 1973, SIAM J. Numer. Anal. 10, 345): the body is cut across its
/// longest extent, the nodes along the cut are eliminated last, and both halves are cut again. Nodes without a finite
/// place, such as those of a wall, come last of all.
class nested_dissection {
public:
    using place = std::array<double, 3>;

    nested_dissection(node_graph const& graph, std::vector<place> const& places)
        : graph_(graph), places_(places), side_(places.size(), none) {
        add_nodes(true);
        std::size_t const end = order_.size();
        add_nodes(false);
        cut(0, end);
    }
    /// Nodes in the order in which they are eliminated.
    std::vector<int> const& order() const noexcept { return order_; }

private:
    static constexpr char none = 0, left = 1, right = 2, across = 3;
    static constexpr std::size_t smallest = 8;

    void add_nodes(bool with_place) {
        for (std::size_t k = 0; k < places_.size(); ++k)
            if (std::isfinite(places_[k][0]) == with_place) order_.push_back(int(k));
    }
    void cut(std::size_t begin, std::size_t end) {
        if (end - begin <= smallest) return;
        auto const axis = std::size_t(longest_axis(begin, end));
        std::size_t const middle = begin + (end - begin) / 2;
        std::nth_element(at(begin), at(middle), at(end), [&](int a, int b) {
            double const x = places_[std::size_t(a)][axis], y = places_[std::size_t(b)][axis];
            return x != y ? x < y : a < b;
        });
        for (std::size_t k = begin; k < end; ++k) side(k) = k < middle ? left : right;
        auto const touches = [&](std::size_t k, char other) {
            auto const near = graph_.of(order_[k]);
            return std::any_of(near.begin(), near.end(), [&](int n) { return side_[std::size_t(n)] == other; });
        };
        std::vector<std::size_t> first, second;
        for (std::size_t k = begin; k < middle; ++k)
            if (touches(k, right)) first.push_back(k);
        for (std::size_t k = middle; k < end; ++k)
            if (touches(k, left)) second.push_back(k);
        for (auto const k : first.size() <= second.size() ? first : second) side(k) = across;
        std::vector<int> parts[4];
        for (std::size_t k = begin; k < end; ++k) {
            parts[int(side(k))].push_back(order_[k]);
            side(k) = none;
        }
        auto to = at(begin);
        for (char const part : {left, right, across}) {
            std::sort(parts[int(part)].begin(), parts[int(part)].end());
            to = std::copy(parts[int(part)].begin(), parts[int(part)].end(), to);
        }
        cut(begin, begin + parts[int(left)].size());
        cut(begin + parts[int(left)].size(), begin + parts[int(left)].size() + parts[int(right)].size());
    }
    int longest_axis(std::size_t begin, std::size_t end) const {
        int longest = 0;
        double most = -1;
        for (int axis = 0; axis < 3; ++axis) {
            auto const [low, high] = std::minmax_element(at(begin), at(end), [&](int a, int b) {
                return places_[std::size_t(a)][std::size_t(axis)] < places_[std::size_t(b)][std::size_t(axis)];
            });
            double const extent = places_[std::size_t(*high)][std::size_t(axis)] -
                                  places_[std::size_t(*low)][std::size_t(axis)];
            if (extent > most) {
                most = extent;
                longest = axis;
            }
        }
        return longest;
    }
    std::vector<int>::iterator at(std::size_t k) noexcept { return order_.begin() + std::ptrdiff_t(k); }
    std::vector<int>::const_iterator at(std::size_t k) const noexcept { return order_.begin() + std::ptrdiff_t(k); }
    char& side(std::size_t k) noexcept { return side_[std::size_t(order_[k])]; }

    node_graph const& graph_;
    std::vector<place> const& places_;
    std::vector<int> order_;
    std::vector<char> side_;
};

} // namespace lacuna
