// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/frequency_band.h"

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

TEST(BandShare, IsThePartOfABandWithinAnother) {
  EXPECT_NEAR(band_share({20, 30}, {25, 40}), 0.5, tolerance(1e-15));
  EXPECT_NEAR(band_share({20, 30}, {0, 100}), 1, tolerance(1e-15));
  EXPECT_NEAR(band_share({0, 100}, {20, 30}), 0.1, tolerance(1e-15));
  EXPECT_EQ(band_share({20, 30}, {30, 40}), 0);
}

}  // namespace
}  // namespace halocline::acoustics
