// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/core/eigen_sparse.hpp>
#include <lacuna/equilibrium/elimination_order.hpp>
#include <lacuna/equilibrium/elimination_tree.hpp>

namespace lacuna {

/// Factorisation L D L^T of a symmetric sparse matrix by the multifrontal method of Duff and Reid (1983, ACM Trans.
/// Math. Softw. 9, 302), without pivoting: for matrices that are positive definite or quasi-definite.
///
/// Unknowns at the same place, those of one particle, are eliminated together. Of two orders, minimum degree and nested
/// dissection, the one with fewer operations is taken.
class multifrontal_factor {
public:
    using vector = Eigen::VectorXd;
    using sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
    using place = nested_dissection::place;

    /// Finds order and structure.
    /// \param lower lower triangle, all diagonal entries among it
    /// \param places of the unknowns, m; without a finite one: of an unknown that belongs to no place
    void analyse(sparse const& lower, std::vector<place> const& places) {
        auto const [nodes, node_places] = find_nodes(places);
        node_graph const graph = find_graph(lower, nodes);
        auto const unknowns = [&](int node) { return first_[std::size_t(node) + 1] - first_[std::size_t(node)]; };
        elimination_tree const tree(graph, minimum_degree_order(graph), unknowns);
        elimination_tree const other(graph, nested_dissection(graph, node_places).order(), unknowns);
        lay_out(other.operations() < tree.operations() ? other : tree);
        find_addresses(lower);
    }
    /// \return whether the factors exist
    bool factorise(sparse const& lower) {
        std::fill(values_.begin(), values_.end(), 0.0);
        for (std::size_t e = 0; e < address_.size(); ++e) values_[address_[e]] = lower.valuePtr()[e];
        pivots_.resize(lower.rows());
        for (auto& f : fronts_)
            if (!factorise(f)) return false;
        return true;
    }
    vector solve(vector const& right) const {
        vector x(right.size()), part;
        for (Eigen::Index k = 0; k < x.size(); ++k) x[position_[std::size_t(k)]] = right[k];
        for (auto const& f : fronts_) {
            const_panel_map const panel(values_.data() + f.values, f.width + f.height, f.width);
            auto own = x.segment(f.first, f.width);
            panel.topRows(f.width).template triangularView<Eigen::UnitLower>().solveInPlace(own);
            part.noalias() = panel.bottomRows(f.height) * own;
            for (int r = 0; r < f.height; ++r) x[rows_[f.rows + std::size_t(r)]] -= part[r];
        }
        x.array() /= pivots_.array();
        for (auto f = fronts_.rbegin(); f != fronts_.rend(); ++f) {
            const_panel_map const panel(values_.data() + f->values, f->width + f->height, f->width);
            auto own = x.segment(f->first, f->width);
            part.resize(f->height);
            for (int r = 0; r < f->height; ++r) part[r] = x[rows_[f->rows + std::size_t(r)]];
            own.noalias() -= panel.bottomRows(f->height).transpose() * part;
            panel.topRows(f->width).template triangularView<Eigen::UnitLower>().transpose().solveInPlace(own);
        }
        vector y(x.size());
        for (Eigen::Index k = 0; k < x.size(); ++k) y[k] = x[position_[std::size_t(k)]];
        return y;
    }
    /// Numbers in the factors.
    std::size_t fill() const noexcept { return values_.size(); }

private:
    using panel_map = Eigen::Map<Eigen::MatrixXd>;
    using const_panel_map = Eigen::Map<Eigen::MatrixXd const>;

    /// Neighbouring columns with the same rows below them.
    struct front {
        int first, width, height; // first column, number of columns, number of rows below them
        std::size_t rows;         // address of these rows
        std::size_t values;       // address of the columns
        std::size_t update;       // address of what the front adds to later columns
        int parity;               // where the update is kept: a front and its children use different stores
        int parent;
        std::vector<int> children;
    };
    std::pair<std::vector<int>, std::vector<place>> find_nodes(std::vector<place> const& places) {
        std::vector<int> node(places.size());
        std::vector<place> node_places;
        first_.clear();
        for (std::size_t k = 0; k < places.size(); ++k) {
            if (k == 0 || !(places[k] == places[k - 1])) {
                first_.push_back(int(k));
                node_places.push_back(places[k]);
            }
            node[k] = int(first_.size()) - 1;
        }
        first_.push_back(int(places.size()));
        return {std::move(node), std::move(node_places)};
    }
    node_graph find_graph(sparse const& lower, std::vector<int> const& node) const {
        std::vector<std::vector<int>> near(first_.size() - 1);
        for (int c = 0; c < int(lower.cols()); ++c)
            for (sparse::InnerIterator it(lower, c); it; ++it) {
                int const a = node[std::size_t(it.row())], b = node[std::size_t(c)];
                if (a == b) continue;
                if (auto& list = near[std::size_t(a)]; list.empty() || list.back() != b) list.push_back(b);
                if (auto& list = near[std::size_t(b)]; list.empty() || list.back() != a) list.push_back(a);
            }
        node_graph graph;
        for (auto& list : near) {
            std::sort(list.begin(), list.end());
            list.erase(std::unique(list.begin(), list.end()), list.end());
            graph.neighbour.insert(graph.neighbour.end(), list.begin(), list.end());
            graph.begin.push_back(int(graph.neighbour.size()));
        }
        return graph;
    }

    /// Numbers the unknowns so that each front follows its children, and places all in memory.
    void lay_out(elimination_tree const& tree) {
        fronts_.clear();
        rows_.clear();
        position_.assign(std::size_t(first_.back()), 0);
        auto const each = [&](std::vector<int> const& nodes, auto const& visit) {
            for (int const node : nodes)
                for (int u = first_[std::size_t(node)]; u < first_[std::size_t(node) + 1]; ++u) visit(std::size_t(u));
        };
        std::vector<int> front_of(tree.steps().size(), -1);
        int column = 0;
        std::size_t values = 0;
        auto const steps = tree.children_first();
        for (int const k : steps) {
            auto const& s = tree.steps()[std::size_t(k)];
            front f{column, s.width, s.height, 0, values, 0, 0, -1, {}};
            each(s.nodes, [&](std::size_t u) { position_[u] = column++; });
            values += std::size_t(s.width) * std::size_t(s.width + s.height);
            front_of[std::size_t(k)] = int(fronts_.size());
            for (int const c : s.children) {
                f.children.push_back(front_of[std::size_t(c)]);
                fronts_[std::size_t(f.children.back())].parent = int(fronts_.size());
            }
            fronts_.push_back(std::move(f));
        }
        values_.resize(values);
        for (int const k : steps) {
            auto& f = fronts_[std::size_t(front_of[std::size_t(k)])];
            f.rows = rows_.size();
            each(tree.steps()[std::size_t(k)].rows, [&](std::size_t u) { rows_.push_back(position_[u]); });
            std::sort(rows_.begin() + std::ptrdiff_t(f.rows), rows_.end());
        }
        find_places_of_updates();
    }
    /// Where a row of a front stands among the rows of another one.
    int row_in(front const& f, int row) const {
        if (row < f.first + f.width) return row - f.first;
        auto const begin = rows_.begin() + std::ptrdiff_t(f.rows);
        return f.width + int(std::lower_bound(begin, begin + f.height, row) - begin);
    }
    void find_places_of_updates() {
        for (auto f = fronts_.rbegin(); f != fronts_.rend(); ++f)
            if (f->parent >= 0) f->parity = 1 - fronts_[std::size_t(f->parent)].parity;
        std::size_t used[2] = {0, 0}, most[2] = {0, 0};
        in_parent_.resize(rows_.size());
        for (auto& f : fronts_) {
            auto& of_children = used[1 - f.parity];
            for (int const c : f.children) of_children = std::min(of_children, fronts_[std::size_t(c)].update);
            f.update = used[f.parity];
            used[f.parity] += std::size_t(f.height) * std::size_t(f.height);
            most[f.parity] = std::max(most[f.parity], used[f.parity]);
            for (std::size_t r = f.rows; f.parent >= 0 && r < f.rows + std::size_t(f.height); ++r)
                in_parent_[r] = row_in(fronts_[std::size_t(f.parent)], rows_[r]);
        }
        for (int k = 0; k < 2; ++k) updates_[k].resize(most[k]);
    }
    void find_addresses(sparse const& lower) {
        std::vector<int> front_at(position_.size());
        for (std::size_t k = 0; k < fronts_.size(); ++k)
            std::fill_n(front_at.begin() + fronts_[k].first, fronts_[k].width, int(k));
        address_.clear();
        for (int c = 0; c < int(lower.cols()); ++c)
            for (sparse::InnerIterator it(lower, c); it; ++it) {
                auto const [column, row] = std::minmax(position_[std::size_t(c)], position_[std::size_t(it.row())]);
                auto const& f = fronts_[std::size_t(front_at[std::size_t(column)])];
                address_.push_back(f.values + std::size_t(column - f.first) * std::size_t(f.width + f.height) +
                                   std::size_t(row_in(f, row)));
            }
    }

    panel_map panel_of(front const& f) { return {values_.data() + f.values, f.width + f.height, f.width}; }
    bool factorise(front const& f) {
        double* const update = updates_[f.parity].data() + f.update;
        for (int c = 0; c < f.height; ++c) std::fill_n(update + std::ptrdiff_t(c) * (f.height + 1), f.height - c, 0.0);
        for (int const c : f.children) add_update(fronts_[std::size_t(c)], f, update);
        auto panel = panel_of(f);
        if (!factorise(panel, f.first)) return false;
        if (f.height == 0) return true;
        auto const below = panel.bottomRows(f.height);
        scaled_.noalias() = pivots_.segment(f.first, f.width).asDiagonal() * below.transpose();
        panel_map rest(update, f.height, f.height);
        for (int c = 0; c < f.height; c += block) {
            int const count = std::min(block, f.height - c);
            subtract(rest.block(c, c, f.height - c, count), below.bottomRows(f.height - c),
                     scaled_.middleCols(c, count));
        }
        return true;
    }
    void add_update(front const& child, front const& to, double* update) {
        double const* from = updates_[child.parity].data() + child.update;
        int const* const at = in_parent_.data() + child.rows;
        for (int c = 0; c < child.height; ++c, from += child.height) {
            double* const column = at[c] < to.width ? panel_of(to).col(at[c]).data()
                                                    : update + std::ptrdiff_t(at[c] - to.width) * to.height - to.width;
            for (int r = c; r < child.height; ++r) column[at[r]] += from[r];
        }
    }
    /// Subtracts a product in slices. Eigen cuts deeper sums where the processor's caches end, and other processors
    /// would get other bits.
    template <class To, class A, class B>
    static void subtract(To&& to, A const& a, B const& b) {
        for (Eigen::Index k = 0; k < a.cols(); k += deep) {
            Eigen::Index const count = std::min<Eigen::Index>(deep, a.cols() - k);
            to.noalias() -= a.middleCols(k, count) * b.middleRows(k, count);
        }
    }
    /// Factorises columns, which begin with their diagonal, in halves.
    bool factorise(Eigen::Ref<Eigen::MatrixXd> panel, int first) {
        int const width = int(panel.cols()), rows = int(panel.rows());
        if (width <= narrow) return factorise_narrow(panel, first);
        int const half = (width / 2 + narrow - 1) / narrow * narrow, rest = width - half;
        if (!factorise(panel.leftCols(half), first)) return false;
        scaled_.noalias() = pivots_.segment(first, half).asDiagonal() * panel.block(half, 0, rest, half).transpose();
        subtract(panel.bottomRightCorner(rows - half, rest), panel.bottomLeftCorner(rows - half, half), scaled_);
        return factorise(panel.bottomRightCorner(rows - half, rest), first + half);
    }
    bool factorise_narrow(Eigen::Ref<Eigen::MatrixXd> panel, int first) {
        int const width = int(panel.cols()), rows = int(panel.rows());
        for (int k = 0; k < width; ++k) {
            double const pivot = panel(k, k);
            if (!(std::fabs(pivot) > 0) || !std::isfinite(pivot)) return false;
            pivots_[first + k] = pivot;
            auto column = panel.col(k).tail(rows - k - 1);
            for (int j = k + 1; j < width; ++j)
                panel.col(j).tail(rows - j) -= panel.col(k).tail(rows - j) * (panel(j, k) / pivot);
            column /= pivot;
        }
        return true;
    }

    static constexpr int narrow = 8, block = 64, deep = 120;
    std::vector<int> first_;    // first unknown of each node
    std::vector<int> position_; // column of each unknown
    std::vector<int> rows_, in_parent_;
    std::vector<std::size_t> address_; // of the matrix's entries
    std::vector<front> fronts_;
    std::vector<double> values_, updates_[2];
    vector pivots_;
    Eigen::MatrixXd scaled_;
};

} // namespace lacuna
