// SPDX-License-Identifier: BSD-3-Clause
// Runs a formula over every row of a reference table of tests/data/acoustics.
#pragma once

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/csv.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {

// The references carry 15 digits: 1e-12 leaves room for the order of operations, not for a wrong coefficient.
inline constexpr double kRelativeTolerance = 1e-12;
inline constexpr double kDecibelTolerance = 1e-10;

using RowFunction = std::function<double(const testing::CsvRow&)>;

// Expects column `column` of every row to equal function(row) to `relative` (absolute where the reference is
// 0).
inline void expect_column(const std::string& file, const std::string& column, const RowFunction& function,
                          double relative = kRelativeTolerance) {
  for (const testing::CsvRow& row : testing::read_reference_csv("acoustics/" + file)) {
    EXPECT_LE(testing::relative_error(function(row), row.number(column)), testing::tolerance(relative))
        << file << " line " << row.line() << ", " << column << ": " << function(row);
  }
}

// The same for a column in decibels, where the difference counts and not the ratio.
inline void expect_decibels(const std::string& file, const std::string& column, const RowFunction& function,
                            double decibels = kDecibelTolerance) {
  for (const testing::CsvRow& row : testing::read_reference_csv("acoustics/" + file)) {
    EXPECT_NEAR(function(row), row.number(column), testing::tolerance(decibels))
        << file << " line " << row.line() << ", " << column;
  }
}

}  // namespace halocline::acoustics
