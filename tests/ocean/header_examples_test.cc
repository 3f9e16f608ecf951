// SPDX-License-Identifier: BSD-3-Clause
// The examples of this folder's headers, as they stand there (tests/docs/check_examples).
#include <utility>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/units.h"
#include "ocean/cf_time.h"
#include "ocean/cf_units.h"
#include "ocean/ocean_field.h"

namespace halocline::ocean {
namespace {

TEST(HeaderExamples, TimesOfTwoDates) {
  const CfTimeAxis axis = CfTimeAxis::parse("hours since 2000-01-01", "standard");
  const double later_s = axis.seconds_at(24) - axis.seconds_of("2000-01-01T06:00:00Z");  // 64 800
  EXPECT_EQ(later_s, 64'800);
}

TEST(HeaderExamples, AUnitOfLength) {
  const auto unit = unit_in(QuantityKind::kLength, "km");  // {1000, 0}
  ASSERT_TRUE(unit);
  EXPECT_EQ((*unit)(2), 2000);
}

TEST(HeaderExamples, CurrentAtAPlace) {
  const OceanGrid grid{{0}, {0}, {to_radians(39), to_radians(41)}, {to_radians(-51), to_radians(-49)}};
  OceanValues values;
  values.east_mps = values.north_mps = {0.5F, 0.5F, 0.5F, 0.5F};
  const OceanField field(grid, std::move(values), {to_radians(40), to_radians(-50)});
  const Vec3 current = field.current_ned_mps({1000, 2000, 50}, 3600);
  EXPECT_NEAR(current.norm(), 0.7071067811865476, 1e-9);
}

}  // namespace
}  // namespace halocline::ocean
