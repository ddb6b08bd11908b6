// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/equilibrium/elimination_order.hpp>

namespace lacuna {

/// What the elimination of a graph's nodes in a given order changes: the steps of a factorisation.
///
/// Steps that change almost the same rows become one, although zeros are stored then: dense arithmetic on a few larger
/// steps is faster (Ashcraft and Grimes 1989, ACM Trans. Math. Softw. 15, 291).
class elimination_tree {
public:
    struct step {
        std::vector<int> nodes;       ///< eliminated here; empty: part of another step
        std::vector<int> rows;        ///< nodes that this changes
        int width = 0, height = 0;    ///< numbers of unknowns of both
        double zeros = 0;             ///< stored in the columns of the nodes
        std::vector<int> children;    ///< steps that come before, since they change this one
    };

    /// \param order nodes in the order in which they are eliminated
    /// \param unknowns callable node -> number of its unknowns
    template <class Unknowns>
    elimination_tree(node_graph const& graph, std::vector<int> const& order, Unknowns const& unknowns)
        : steps_(order.size()) {
        std::vector<int> at(order.size());
        for (std::size_t k = 0; k < order.size(); ++k) at[std::size_t(order[k])] = int(k);
        std::vector<std::vector<int>> waiting(order.size()); // steps whose first row is this node's
        for (std::size_t k = 0; k < order.size(); ++k) {
            step& s = steps_[k];
            for (int const n : graph.of(order[k]))
                if (at[std::size_t(n)] > int(k)) s.rows.push_back(n);
            for (int const c : waiting[k]) {
                auto const& rows = steps_[std::size_t(c)].rows;
                s.rows.insert(s.rows.end(), rows.begin() + 1, rows.end());
            }
            std::sort(s.rows.begin(), s.rows.end(),
                      [&](int a, int b) { return at[std::size_t(a)] < at[std::size_t(b)]; });
            s.rows.erase(std::unique(s.rows.begin(), s.rows.end()), s.rows.end());
            s.width = unknowns(order[k]);
            for (int const n : s.rows) s.height += unknowns(n);
            for (int const c : waiting[k]) adopt(int(k), c);
            s.nodes.push_back(order[k]);
            if (!s.rows.empty()) waiting[std::size_t(at[std::size_t(s.rows.front())])].push_back(int(k));
        }
    }

    std::vector<step> const& steps() const noexcept { return steps_; }
    /// About the number of multiplications and additions.
    double operations() const {
        double sum = 0;
        for (auto const& s : steps_) sum += s.width * std::pow(s.height + 0.5 * s.width, 2);
        return sum;
    }
    /// Steps in an order in which each follows its children.
    std::vector<int> children_first() const {
        std::vector<int> found, next;
        for (std::size_t k = steps_.size(); k-- > 0;)
            if (!steps_[k].nodes.empty() && steps_[k].rows.empty()) next.push_back(int(k));
        while (!next.empty()) {
            int const k = next.back();
            next.pop_back();
            found.push_back(k);
            next.insert(next.end(), steps_[std::size_t(k)].children.begin(), steps_[std::size_t(k)].children.end());
        }
        std::reverse(found.begin(), found.end());
        return found;
    }

private:
    /// Makes a step a child of another one, or a part of it.
    void adopt(int parent, int child) {
        step &s = steps_[std::size_t(parent)], &c = steps_[std::size_t(child)];
        int const width = s.width + c.width;
        double const zeros = s.zeros + c.zeros + double(c.width) * (s.width + s.height - c.height);
        double const share = zeros / (width * (0.5 * width + s.height));
        if (share > (width <= 16 ? 0.5 : width <= 48 ? 0.2 : 0.05)) {
            s.children.push_back(child);
            return;
        }
        s.width = width;
        s.zeros = zeros;
        s.nodes.insert(s.nodes.end(), c.nodes.begin(), c.nodes.end());
        s.children.insert(s.children.end(), c.children.begin(), c.children.end());
        c = {};
    }

    std::vector<step> steps_;
};

} // namespace lacuna
