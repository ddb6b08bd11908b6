// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// \file
/// Eigen's dense matrices and their factorisations. Include this file instead of Eigen's own headers: it suppresses a
/// false warning of g++ 12, as eigen_sparse.hpp does.

#include <lacuna/core/standard.hpp>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
