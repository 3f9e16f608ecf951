// SPDX-License-Identifier: BSD-3-Clause
#include "core/check.h"

#include <limits>

#include <gmock/gmock.h>

namespace halocline {
namespace {

using ::testing::HasSubstr;

TEST(Check, RequireThrowsWithItsMessage) {
  EXPECT_NO_THROW(require(true, "unused"));
  try {
    require(false, "the sea is dry");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "the sea is dry");
  }
}

TEST(Check, RangeErrorNamesWhatWasGivenAndWhatIsAllowed) {
  EXPECT_EQ(require_in_range(5, 0, 10, "wind", "m/s"), 5);
  try {
    require_in_range(-1, 0, 60, "wind", "m/s");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("wind is -1 m/s; allowed is 0 to 60 m/s"));
  }
}

TEST(Check, NotANumberIsOutsideEveryRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(require_in_range(nan, 0, 1, "x"), InvalidArgument);
  EXPECT_THROW(require_finite(nan, "x"), InvalidArgument);
  EXPECT_THROW(require_finite(std::numeric_limits<double>::infinity(), "x"), InvalidArgument);
}

TEST(CheckDeathTest, EnsureStopsTheProgramAndNamesThePlace) {
  EXPECT_DEATH(ensure(false, "lost a packet"), "check_test.cc:.*lost a packet");
}

}  // namespace
}  // namespace halocline
