// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/core/eigen_sparse.hpp>
#include <lacuna/equilibrium/multifrontal_factor.hpp>

namespace lacuna {

/// A symmetric sparse matrix that is the sum of small dense matrices of elements, and its factorisation L D L^T. Its
/// pattern, the addresses of the elements' entries and the symbolic factorisation stay until the elements change.
class stiffness_matrix {
public:
    using vector = Eigen::VectorXd;
    using place = multifrontal_factor::place;

    /// Begins a new list of elements.
    /// \param places of the unknowns, m, by which the order of elimination is found; neighbours at the same place are
    ///        eliminated together; without a finite one: of an unknown that acts in many places
    void begin(std::vector<place> places) {
        wanted_.clear();
        wanted_end_.clear();
        places_ = std::move(places);
    }
    /// Adds an element.
    /// \param numbers of its unknowns; -1: held
    /// \return its number for add()
    std::size_t add_element(std::span<int const> numbers) {
        wanted_.insert(wanted_.end(), numbers.begin(), numbers.end());
        wanted_end_.push_back(wanted_.size());
        return wanted_end_.size() - 1;
    }
    /// Ends the list. Finds the pattern and the addresses, unless the elements are the same as before.
    void finish() {
        if (int(places_.size()) == rows() && wanted_ == numbers_ && wanted_end_ == end_) return;
        numbers_ = wanted_;
        end_ = wanted_end_;
        sparse const before = std::exchange(matrix_, sparse());
        find_pattern(int(places_.size()));
        find_addresses();
        analysed_ = analysed_ && same_pattern(before, matrix_);
    }

    void set_zero() { std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0); }
    /// Adds a symmetric matrix of an element.
    template <class Matrix>
    void add(std::size_t element, Matrix const& k) {
        std::size_t slot = first_slot_[element];
        for (Eigen::Index a = 0; a < k.rows(); ++a)
            for (Eigen::Index b = 0; b <= a; ++b, ++slot)
                if (slot_[slot] >= 0) matrix_.valuePtr()[slot_[slot]] += same(element, a, b) ? 2 * k(a, b) : k(a, b);
    }
    /// Adds a number to the first entries of the diagonal.
    void add_diagonal(double value, int entries) {
        for (int k = 0; k < entries; ++k) matrix_.valuePtr()[diagonal_[std::size_t(k)]] += value;
    }

    /// \return whether the factorisation exists
    bool factorise() {
        if (!analysed_) factor_.analyse(matrix_, places_);
        analysed_ = true;
        ++factorisations_;
        return factor_.factorise(matrix_);
    }
    vector solve(vector const& right) const { return factor_.solve(right); }
    vector product(vector const& x) const { return matrix_.selfadjointView<Eigen::Lower>() * x; }
    int rows() const noexcept { return int(matrix_.rows()); }
    int factorisations() const noexcept { return factorisations_; }
    /// Numbers in the factors.
    std::size_t fill() const noexcept { return factor_.fill(); }

private:
    using sparse = multifrontal_factor::sparse;

    static bool same_pattern(sparse const& a, sparse const& b) {
        auto const equal = [](int const* x, int const* y, Eigen::Index count) { return std::equal(x, x + count, y); };
        return a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
               equal(a.outerIndexPtr(), b.outerIndexPtr(), a.cols() + 1) &&
               equal(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros());
    }
    /// Whether two different freedoms of an element are the same unknown: both entries of the element's matrix add up.
    bool same(std::size_t element, Eigen::Index a, Eigen::Index b) const noexcept {
        int const* at = numbers_.data() + begin_of(element);
        return a != b && at[a] == at[b];
    }
    std::size_t begin_of(std::size_t element) const noexcept { return element == 0 ? 0 : end_[element - 1]; }
    /// Calls visit(row, column) for the lower triangle of an element; {-1, -1} where a freedom is held.
    template <class Visit>
    void for_each_entry(std::size_t element, Visit const& visit) const {
        std::size_t const begin = begin_of(element), count = end_[element] - begin;
        for (std::size_t a = 0; a < count; ++a)
            for (std::size_t b = 0; b <= a; ++b) {
                int const one = numbers_[begin + a], other = numbers_[begin + b];
                bool const free = one >= 0 && other >= 0;
                visit(free ? std::max(one, other) : -1, free ? std::min(one, other) : -1);
            }
    }
    void find_pattern(int rows) {
        std::vector<std::vector<int>> column(static_cast<std::size_t>(rows));
        for (int k = 0; k < rows; ++k) column[std::size_t(k)].push_back(k);
        for (std::size_t e = 0; e < end_.size(); ++e)
            for_each_entry(e, [&](int row, int col) {
                if (row > col && col >= 0) column[std::size_t(col)].push_back(row);
            });
        std::size_t entries = 0;
        for (auto& rows_of : column) {
            std::sort(rows_of.begin(), rows_of.end());
            rows_of.erase(std::unique(rows_of.begin(), rows_of.end()), rows_of.end());
            entries += rows_of.size();
        }
        matrix_.resize(rows, rows);
        matrix_.resizeNonZeros(Eigen::Index(entries));
        int at = 0;
        diagonal_.resize(std::size_t(rows));
        for (int c = 0; c < rows; ++c) {
            matrix_.outerIndexPtr()[c] = diagonal_[std::size_t(c)] = at;
            for (int const row : column[std::size_t(c)]) matrix_.innerIndexPtr()[at++] = row;
        }
        matrix_.outerIndexPtr()[rows] = at;
        set_zero();
    }
    void find_addresses() {
        slot_.clear();
        first_slot_.resize(end_.size());
        for (std::size_t e = 0; e < end_.size(); ++e) {
            first_slot_[e] = slot_.size();
            for_each_entry(e, [&](int row, int col) {
                if (row < 0) return slot_.push_back(-1);
                int const* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[col];
                int const* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[col + 1];
                slot_.push_back(int(std::lower_bound(begin, end, row) - matrix_.innerIndexPtr()));
            });
        }
    }

    std::vector<int> wanted_, numbers_;         // numbers of the elements' unknowns
    std::vector<std::size_t> wanted_end_, end_; // end of each element's numbers
    std::vector<place> places_;
    std::vector<int> slot_, diagonal_;          // addresses of entries in the matrix; -1: held
    std::vector<std::size_t> first_slot_;
    sparse matrix_; // the lower triangle
    multifrontal_factor factor_;
    bool analysed_ = false;
    int factorisations_ = 0;
};

} // namespace lacuna
