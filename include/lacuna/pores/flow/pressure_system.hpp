// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/eigen_sparse.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/pores/network/padded_array.hpp>

namespace lacuna {

namespace detail {

/// Upper triangle of a symmetric matrix, and its factorisation. Unlike Eigen's factorisation it can be copied.
class factorised_matrix {
public:
    using matrix = Eigen::SparseMatrix<double>;

    factorised_matrix() = default;
    factorised_matrix(factorised_matrix const& o) { *this = o; }
    factorised_matrix& operator=(factorised_matrix const& o) {
        if (this == &o) return *this;
        values = o.values;
        if (values.size() > 0) analyse();
        if (o.ready_) factorise();
        return *this;
    }
    void analyse() {
        factor_.analyzePattern(values);
        ready_ = false;
    }
    void factorise() {
        factor_.factorize(values);
        ready_ = true;
    }
    /// Whether factorise() came after the last analyse().
    bool ready() const noexcept { return ready_; }
    void solve(Eigen::VectorXd const& wanted, Eigen::VectorXd& x) const { x = factor_.solve(wanted); }

    matrix values;

private:
    // The caller orders the unknowns: with an ordering of Eigen's, each solution would allocate memory.
    Eigen::SimplicialLDLT<matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor_;
    bool ready_ = false;
};

} // namespace detail

/// The linear system of one backward Euler step of the flow between pores,
///
///   (V_i / K_f) c_i + sum over throats (dt C_t) (c_i - c_j) = r_i,
///
/// solved by conjugate gradients with a factorisation (LDL^T) as preconditioner. Its symbolic part is computed once per
/// topology. Its numbers are factorised again when some V_i or dt C_t has changed by more than a tolerance.
///
/// If the factorised numbers are within 1 +- e of the present ones, so are the preconditioned eigenvalues. Each
/// iteration then reduces the error at least by the factor (1 - sqrt(1 - e^2)) / e. With exact numbers one iteration is
/// enough.
///
/// Runs on one thread and in double precision: results are the same bits for any number of threads.
class pressure_system {
public:
    /// Numbers of operations so far.
    struct counters {
        long long analyses = 0, factorisations = 0, iterations = 0;
    };

    /// Orders the unknowns (approximate minimum degree) and computes the symbolic factorisation.
    /// \param pores number of pores
    /// \param ends the two pores of each throat, the second -1 for a reservoir
    /// \param throats number of throats to use, from the first on
    void analyse(std::size_t pores, std::array<padded_array<std::int32_t>, 2> const& ends, std::size_t throats) {
        for (std::size_t side = 0; side < 2; ++side)
            end_[side].assign(ends[side].begin(), ends[side].begin() + std::ptrdiff_t(throats));
        auto const count = int(pores);
        using entry = Eigen::Triplet<double>;
        std::vector<entry> entries;
        for (int i = 0; i < count; ++i) entries.emplace_back(i, i, 1.0);
        for (std::size_t t = 0; t < throats; ++t)
            if (end_[1][t] >= 0) {
                entries.emplace_back(end_[0][t], end_[1][t], 1.0);
                entries.emplace_back(end_[1][t], end_[0][t], 1.0);
            }
        Eigen::SparseMatrix<double> pattern(count, count);
        pattern.setFromTriplets(entries.begin(), entries.end());
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
        Eigen::AMDOrdering<int>()(pattern, order);
        // Entry k of the ordering is the pore that comes k-th; unknown_ is the inverse.
        unknown_.resize(pores);
        for (int k = 0; k < count; ++k) unknown_[std::size_t(order.indices()[k])] = k;

        entries.clear();
        for (int i = 0; i < count; ++i) entries.emplace_back(i, i, 1.0);
        for (std::size_t t = 0; t < throats; ++t)
            if (end_[1][t] >= 0) {
                int const a = unknown(end_[0][t]), b = unknown(end_[1][t]);
                entries.emplace_back(std::min(a, b), std::max(a, b), 1.0);
            }
        matrix_.values.resize(count, count);
        matrix_.values.setFromTriplets(entries.begin(), entries.end());
        diagonal_.resize(pores);
        off_diagonal_.assign(throats, -1);
        for (std::size_t i = 0; i < pores; ++i) diagonal_[i] = value_index(unknown_[i], unknown_[i]);
        for (std::size_t t = 0; t < throats; ++t)
            if (end_[1][t] >= 0) {
                int const a = unknown(end_[0][t]), b = unknown(end_[1][t]);
                off_diagonal_[t] = value_index(std::min(a, b), std::max(a, b));
            }
        matrix_.analyse();
        ++counters_.analyses;
        content_.assign(pores, 1.0);
        held_.assign(pores, 0);
        leak_.assign(throats, 0.0);
        for (auto* v : {&residual_, &direction_, &image_, &ordered_, &solved_}) *v = Eigen::VectorXd::Zero(count);
    }

    /// \name Coefficients of the step, to be set by the caller
    /// \{
    std::vector<double>& content() noexcept { return content_; } ///< V_i / K_f, m^3/Pa
    std::vector<double>& leak() noexcept { return leak_; }       ///< dt C_t, m^3/Pa; 0 for a skipped throat
    std::vector<char>& held() noexcept { return held_; }         ///< 1 for a pore whose pressure is held (c_i = 0)
    /// \}

    /// Factorises again if a coefficient differs from the factorised one by more than the share `tolerance`.
    void prepare(double tolerance) {
        if (matrix_.ready() && held_ == factorised_held_ && close(content_, factorised_content_, tolerance) &&
            close(leak_, factorised_leak_, tolerance))
            return;
        factorise();
    }
    /// Factorises the present coefficients.
    void factorise() {
        double* value = matrix_.values.valuePtr();
        std::fill(value, value + matrix_.values.nonZeros(), 0.0);
        for (std::size_t i = 0; i < content_.size(); ++i) value[diagonal_[i]] = content_[i];
        for (std::size_t t = 0; t < leak_.size(); ++t)
            for (std::size_t side = 0; side < 2; ++side) {
                auto const own = end_[side][t], other = end_[1 - side][t];
                if (own < 0 || held_[std::size_t(own)]) continue;
                value[diagonal_[std::size_t(own)]] += leak_[t];
                if (side == 0 && other >= 0 && !held_[std::size_t(other)]) value[off_diagonal_[t]] -= leak_[t];
            }
        matrix_.factorise();
        ++counters_.factorisations;
        factorised_content_ = content_;
        factorised_leak_ = leak_;
        factorised_held_ = held_;
    }

    /// Solves for the change c of the pressures.
    /// \param right_side r, m^3; 0 for held pores
    /// \param change receives c, Pa
    /// \param bound upper bound for the remaining |r_i| / (V_i / K_f), Pa
    void solve(std::vector<double> const& right_side, std::vector<double>& change, double bound) {
        std::size_t const count = right_side.size();
        std::fill(change.begin(), change.end(), 0.0);
        for (std::size_t i = 0; i < count; ++i) residual_[Eigen::Index(i)] = right_side[i];
        double left = largest(residual_), best = left, before = 0;
        // Three iterations in a row without gain mean that only rounding is left, long before the hundredth.
        for (int k = 0, stalled = 0; k < 100 && left > bound && stalled < 3; ++k) {
            precondition();
            double const gain = residual_.dot(solved_);
            if (k == 0)
                direction_ = solved_;
            else
                direction_ = solved_ + (gain / before) * direction_;
            before = gain;
            apply(direction_, image_);
            double const curvature = direction_.dot(image_);
            if (!(curvature > 0)) break;
            double const step = gain / curvature;
            for (std::size_t i = 0; i < count; ++i) change[i] += step * direction_[Eigen::Index(i)];
            residual_ -= step * image_;
            ++counters_.iterations;
            left = largest(residual_);
            stalled = left < 0.9 * best ? 0 : stalled + 1;
            best = std::min(best, left);
        }
    }

    counters const& done() const noexcept { return counters_; }

    /// Archives the factorised coefficients: the last bits of later solutions depend on them.
    template <class Archive>
    void serialize(Archive& ar) {
        bool ready = matrix_.ready();
        ar(ready, factorised_content_, factorised_leak_, factorised_held_);
        if constexpr (Archive::is_loading::value) take_factorised(ready);
        ar(counters_);
    }

private:
    void take_factorised(bool ready) {
        if (!ready) return matrix_.analyse();
        require_state(factorised_content_.size() == content_.size() && factorised_leak_.size() == leak_.size(),
                      "its system of flow equations has another size");
        require_state(factorised_held_ == held_, "other pores are held at a given pressure");
        content_ = factorised_content_;
        leak_ = factorised_leak_;
        factorise();
    }
    int unknown(std::int32_t pore) const noexcept { return unknown_[std::size_t(pore)]; }
    /// Index of entry (row, column) of the upper triangle among the stored values.
    int value_index(int row, int column) const {
        auto const& m = matrix_.values;
        auto const* first = m.innerIndexPtr() + m.outerIndexPtr()[column];
        auto const* end = m.innerIndexPtr() + m.outerIndexPtr()[column + 1];
        return int(std::lower_bound(first, end, row) - m.innerIndexPtr());
    }
    static bool close(std::vector<double> const& now, std::vector<double> const& then, double tolerance) noexcept {
        for (std::size_t k = 0; k < now.size(); ++k)
            if (!(std::fabs(now[k] - then[k]) <= tolerance * std::fabs(then[k]))) return false;
        return true;
    }
    /// Largest |r_i| / (V_i / K_f), Pa.
    double largest(Eigen::VectorXd const& r) const noexcept {
        double most = 0;
        for (std::size_t i = 0; i < content_.size(); ++i)
            most = std::max(most, std::fabs(r[Eigen::Index(i)]) / content_[i]);
        return most;
    }
    void precondition() {
        for (std::size_t i = 0; i < unknown_.size(); ++i) ordered_[unknown_[i]] = residual_[Eigen::Index(i)];
        matrix_.solve(ordered_, image_);
        for (std::size_t i = 0; i < unknown_.size(); ++i)
            solved_[Eigen::Index(i)] = held_[i] ? 0.0 : image_[unknown_[i]];
    }
    void apply(Eigen::VectorXd const& c, Eigen::VectorXd& r) const noexcept {
        for (std::size_t i = 0; i < content_.size(); ++i) r[Eigen::Index(i)] = content_[i] * c[Eigen::Index(i)];
        for (std::size_t t = 0; t < leak_.size(); ++t) {
            auto const a = Eigen::Index(end_[0][t]), b = Eigen::Index(end_[1][t]);
            double const moved = leak_[t] * (c[a] - (b >= 0 ? c[b] : 0.0));
            r[a] += moved;
            if (b >= 0) r[b] -= moved;
        }
        for (std::size_t i = 0; i < held_.size(); ++i)
            if (held_[i]) r[Eigen::Index(i)] = 0;
    }

    std::array<std::vector<std::int32_t>, 2> end_;
    std::vector<int> unknown_;      // per pore: number of its unknown
    std::vector<int> diagonal_;     // per pore: index of its diagonal value
    std::vector<int> off_diagonal_; // per throat: index of its off-diagonal value, -1 for a reservoir
    detail::factorised_matrix matrix_;
    std::vector<double> content_, leak_, factorised_content_, factorised_leak_;
    std::vector<char> held_, factorised_held_;
    Eigen::VectorXd residual_, direction_, image_, ordered_, solved_;
    counters counters_;
};

} // namespace lacuna
