// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// \file
/// Eigen's sparse matrices and their factorisation. To be included instead of Eigen's own headers, for one reason: g++ 12
/// takes the registers of Eigen's AVX-512 code for uninitialized.

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
