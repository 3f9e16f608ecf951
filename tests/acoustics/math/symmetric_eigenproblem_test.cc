// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/symmetric_eigenproblem.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

// The second difference of n points with fixed ends: values 2 - 2 cos(pi k / (n + 1)).
TEST(SymmetricEigenproblem, FindsTheValuesOfTheSecondDifference) {
  const std::size_t n = 48;
  std::vector<double> matrix(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    matrix[i * n + i] = 2;
    if (i > 0) matrix[i * n + i - 1] = matrix[(i - 1) * n + i] = -1;
  }
  std::vector<double> values = symmetric_eigenpairs(matrix, n).values;
  std::sort(values.begin(), values.end());
  for (std::size_t k = 0; k < n; ++k)
    EXPECT_NEAR(values[k], 2 - 2 * std::cos(std::numbers::pi * static_cast<double>(k + 1) / (n + 1)),
                tolerance(1e-13));
}

TEST(SymmetricEigenproblem, LeavesNoResidualInGradedMatrices) {
  for (const std::size_t n : {1u, 2u, 3u, 7u, 48u, 96u}) {
    std::vector<double> matrix(n * n);
    std::uint32_t seed = 7;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        seed = seed * 1664525u + 1013904223u;
        matrix[i * n + j] = matrix[j * n + i] =
            (seed / 4294967296.0 - 0.5) * std::exp(-0.1 * static_cast<double>(i + j));
      }
    }
    const EigenPairs pairs = symmetric_eigenpairs(matrix, n);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        double product = 0;
        for (std::size_t j = 0; j < n; ++j) product += matrix[i * n + j] * pairs.vectors[k * n + j];
        EXPECT_NEAR(product, pairs.values[k] * pairs.vectors[k * n + i], tolerance(1e-13));
      }
    }
  }
}

TEST(SymmetricEigenproblem, RefusesAMatrixThatIsNotSquare) {
  EXPECT_THROW(symmetric_eigenpairs({1, 2, 3}, 2), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
