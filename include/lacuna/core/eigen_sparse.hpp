// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// \file
/// Eigen's sparse matrices and their factorisation. Include this file instead of Eigen's own headers: it suppresses a
/// false warning of g++ 12, which takes registers in Eigen's AVX-512 code for uninitialized.

#include <lacuna/core/standard.hpp>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
