// SPDX-License-Identifier: BSD-3-Clause
#include "core/frames.h"

#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/tolerance.h"

namespace halocline {
namespace {

using testing::tolerance;

TEST(Frames, YawOfNinetyDegreesPointsTheBowEast) {
  const Quaternion q = to_quaternion({.yaw = std::numbers::pi / 2});
  EXPECT_NEAR((q * Vec3::UnitX() - Vec3::UnitY()).norm(), 0, tolerance(1e-15));
}

TEST(Frames, PositivePitchRaisesTheBow) {
  const Quaternion q = to_quaternion({.pitch = 0.1});
  EXPECT_NEAR((q * Vec3::UnitX()).z(), -std::sin(0.1), tolerance(1e-15));
}

TEST(Frames, PositiveRollLowersStarboard) {
  const Quaternion q = to_quaternion({.roll = 0.1});
  EXPECT_NEAR((q * Vec3::UnitY()).z(), std::sin(0.1), tolerance(1e-15));
}

TEST(Frames, EulerAnglesSurviveTheRoundTrip) {
  for (std::uint32_t i = 0; i < 200; ++i) {
    const auto draw = [&](std::uint64_t which) {
      return 2 * uniform_at({.seed = 1, .who = i, .which = which}) - 1;
    };
    const EulerAngles e{3.1 * draw(0), 1.5 * draw(1), 3.1 * draw(2)};
    const EulerAngles back = to_euler(to_quaternion(e));
    // Near pitch 1.5 the arcsine loses up to 1/cos(1.5) = 14 times the rounding error.
    EXPECT_NEAR(back.roll, e.roll, tolerance(1e-13));
    EXPECT_NEAR(back.pitch, e.pitch, tolerance(1e-13));
    EXPECT_NEAR(back.yaw, e.yaw, tolerance(1e-13));
  }
}

TEST(Frames, RotationsAreThoseOfEigen) {
  const Vec3 v(0.3, -0.9, 1.4);
  const Quaternion a = rotation_by(v), b = rotation_by(Vec3(-1, 0.2, 0.4));
  EXPECT_TRUE(a.isApprox(Quaternion(Eigen::AngleAxisd(v.norm(), v.normalized())), 1e-15));
  EXPECT_TRUE(rotation_by(Vec3::Zero()).isApprox(Quaternion::Identity()));
  for (const double share : {0.0, 0.25, 1.0}) {
    EXPECT_TRUE(between(a, b, share).isApprox(a.slerp(share, b), 1e-14)) << share;
    const Quaternion other_sign(-b.coeffs());
    EXPECT_TRUE(
        (between(a, other_sign, share) * Vec3::UnitX()).isApprox(a.slerp(share, b) * Vec3::UnitX(), 1e-14));
    EXPECT_TRUE(between(a, a, share).isApprox(a, 1e-15));
  }
}

TEST(Frames, ATideMovesTheSurfaceAndNotTheVehicle) {
  EXPECT_EQ(depth_below_surface_m({0, 0, 10}, 0), 10);
  EXPECT_EQ(depth_below_surface_m({0, 0, 10}, -2), 12);  // high water: the surface lies 2 m above the datum
}

}  // namespace
}  // namespace halocline
