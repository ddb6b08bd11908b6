// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Solves A x = b for a matrix that is nearly one that can be factorised, by the generalised minimal residual method of
/// Saad and Schultz (1986, SIAM J. Sci. Stat. Comput. 7, 856), preconditioned from the left.
/// \param product callable x -> A x
/// \param precondition callable x -> approximately A^-1 x
/// \param tolerance of the preconditioned residual over that of b
/// \param most largest number of iterations
/// \return the best x found
template <class Product, class Precondition>
Eigen::VectorXd solve_coupled(Eigen::VectorXd const& b, Product const& product, Precondition const& precondition,
                              double tolerance, int most) {
    Eigen::VectorXd const first = precondition(b);
    double const size = first.norm();
    if (!(size > 0) || most < 1) return first;
    std::vector<Eigen::VectorXd> basis{first / size};
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(most + 1, most);
    Eigen::VectorXd best;
    for (int k = 0; k < most; ++k) {
        Eigen::VectorXd next = precondition(product(basis[std::size_t(k)]));
        for (int pass = 0; pass < 2; ++pass)
            for (int j = 0; j <= k; ++j) {
                double const part = basis[std::size_t(j)].dot(next);
                h(j, k) += part;
                next -= part * basis[std::size_t(j)];
            }
        h(k + 1, k) = next.norm();
        Eigen::VectorXd right = Eigen::VectorXd::Zero(k + 2);
        right[0] = size;
        auto const square = h.topLeftCorner(k + 2, k + 1);
        best = square.householderQr().solve(right);
        double const residual = (square * best - right).norm();
        if (residual <= tolerance * size || k + 1 == most || !(h(k + 1, k) > 0)) break;
        basis.push_back(next / h(k + 1, k));
    }
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    for (Eigen::Index j = 0; j < best.size(); ++j) x += best[j] * basis[std::size_t(j)];
    return x;
}

} // namespace lacuna
