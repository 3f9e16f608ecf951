// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;
using std::numbers::pi;

constexpr WaveSettings kRegular{.kind = SeaKind::kRegular, .height_m = 2, .period_s = 8, .toward_rad = 0.7};

TEST(Waves, UnderRegularWavesTheWaterGoesRoundInCircles) {
  const WaveField waves(kRegular, 1);
  for (double t = 0; t < 8; t += 0.5) {
    // a omega e^{-k d} with k = omega^2 / g
    const double omega = 2 * pi / 8, speed = omega * std::exp(-omega * omega / 9.81 * 5);
    const WaterMotion m = waves.at({3, -4, 5}, 5, SimTime::from_seconds(t));
    EXPECT_NEAR(m.velocity_mps.norm(), speed, tolerance(1e-12));
    EXPECT_NEAR(m.acceleration_mps2.norm(), omega * speed, tolerance(1e-12));
    EXPECT_NEAR(m.velocity_mps.dot(m.acceleration_mps2), 0, tolerance(1e-12));
    EXPECT_NEAR(m.velocity_mps.dot(Vec3(-std::sin(0.7), std::cos(0.7), 0)), 0,
                tolerance(1e-12));  // long-crested
  }
}

TEST(Waves, MotionDiesOutWithDepth) {
  const WaveField waves(kRegular, 1);
  const double length = 9.81 * 64 / (2 * pi);
  EXPECT_NEAR(waves.at({0, 0, 0}, length / 2, SimTime()).velocity_mps.norm() /
                  waves.at({0, 0, 0}, 0, SimTime()).velocity_mps.norm(),
              std::exp(-pi), tolerance(1e-12));
}

constexpr double kDelta = 1e-4;

// Central differences of step 1e-4: errors of order 1e-8.
TEST(Waves, TheFlowHasNoSourcesAndNoVortices) {
  const WaveField waves({.kind = SeaKind::kJonswap, .height_m = 3, .period_s = 7, .toward_rad = 2}, 5);
  const Vec3 p(12, 7, 4);
  Eigen::Matrix3d gradient;  // d v_i / d x_j
  for (int j = 0; j < 3; ++j) {
    const Vec3 d = kDelta * Vec3::Unit(j);
    gradient.col(j) = (waves.at(p + d, (p + d).z(), SimTime()).velocity_mps -
                       waves.at(p - d, (p - d).z(), SimTime()).velocity_mps) /
                      (2 * kDelta);
  }
  EXPECT_NEAR(gradient.trace(), 0, tolerance(1e-6));
  EXPECT_LT((gradient - gradient.transpose()).norm(), tolerance(1e-6));
}

TEST(Waves, AccelerationIsTheRateOfTheVelocity) {
  const WaveField waves({.kind = SeaKind::kPiersonMoskowitz, .height_m = 3, .period_s = 9}, 5);
  const Vec3 p(12, 7, 4);
  const auto velocity = [&](double t) { return waves.at(p, 4, SimTime::from_seconds(t)).velocity_mps; };
  const Vec3 rate = (velocity(10 + kDelta) - velocity(10 - kDelta)) / (2 * kDelta);
  EXPECT_LT((rate - waves.at(p, 4, SimTime::from_seconds(10)).acceleration_mps2).norm(), tolerance(1e-6));
}

// At the surface its rate is the water's velocity up and its slope the acceleration along over -g; below, its
// change with depth is the acceleration down over -g, as pressure drives the water. Central differences as
// above.
TEST(Waves, TheSurfaceMovesAndSlopesWithTheWater) {
  const WaveField waves({.kind = SeaKind::kJonswap, .height_m = 3, .period_s = 7, .toward_rad = 2}, 5);
  const Vec3 p(12, 7, 0);
  const auto elevation = [&](const Vec3& at, double depth, double t) {
    return waves.elevation_m(at, depth, SimTime::from_seconds(t));
  };
  const WaterMotion water = waves.at(p, 0, SimTime::from_seconds(9));
  EXPECT_NEAR((elevation(p, 0, 9 + kDelta) - elevation(p, 0, 9 - kDelta)) / (2 * kDelta),
              -water.velocity_mps.z(), tolerance(1e-6));
  for (int axis = 0; axis < 2; ++axis) {
    const Vec3 d = kDelta * Vec3::Unit(axis);
    EXPECT_NEAR((elevation(p + d, 0, 9) - elevation(p - d, 0, 9)) / (2 * kDelta),
                -water.acceleration_mps2[axis] / WaveField::kGravity, tolerance(1e-6));
  }
  const WaterMotion below = waves.at({12, 7, 4}, 4, SimTime::from_seconds(9));
  EXPECT_NEAR((elevation(p, 4 + kDelta, 9) - elevation(p, 4 - kDelta, 9)) / (2 * kDelta),
              -below.acceleration_mps2.z() / WaveField::kGravity, tolerance(1e-6));
  EXPECT_LE(std::abs(elevation(p, 0, 9)), waves.highest_m());
}

TEST(Waves, ASeaHasItsSignificantHeight) {
  for (const SeaKind kind : {SeaKind::kPiersonMoskowitz, SeaKind::kJonswap}) {
    double energy = 0;
    const WaveField sea({.kind = kind, .height_m = 2.5}, 3);
    for (const auto& c : sea.components()) energy += c.amplitude_m * c.amplitude_m / 2;
    EXPECT_NEAR(4 * std::sqrt(energy), 2.5, tolerance(1e-12));
  }
}

TEST(Waves, JonswapIsMorePeakedThanPiersonMoskowitz) {
  const auto highest = [](SeaKind kind) {
    double most = 0;
    const WaveField sea({.kind = kind, .height_m = 2, .components = 100}, 3);
    for (const auto& c : sea.components()) most = std::max(most, c.amplitude_m);
    return most;
  };
  EXPECT_GT(highest(SeaKind::kJonswap), 1.2 * highest(SeaKind::kPiersonMoskowitz));
}

TEST(Waves, PhasesBelongToTheSeed) {
  const WaveSettings sea{.kind = SeaKind::kJonswap};
  const auto moved = [&](std::uint64_t seed) {
    return WaveField(sea, seed).at({0, 0, 1}, 1, SimTime()).velocity_mps;
  };
  EXPECT_EQ(moved(1), moved(1));
  EXPECT_NE(moved(1), moved(2));
}

TEST(Waves, ACalmSeaDoesNotMove) {
  EXPECT_TRUE(WaveField({}, 1).calm());
  EXPECT_EQ(WaveField({}, 1).at({1, 2, 3}, 3, SimTime()).velocity_mps, Vec3::Zero());
}

TEST(Waves, ImpossibleSettingsAreRefused) {
  EXPECT_THROW(WaveField({.kind = SeaKind::kRegular, .height_m = -1}, 1), InvalidArgument);
  EXPECT_THROW(WaveField({.kind = SeaKind::kRegular, .period_s = 0}, 1), InvalidArgument);
  EXPECT_THROW(WaveField({.kind = SeaKind::kJonswap, .components = 0}, 1), InvalidArgument);
}

}  // namespace
}  // namespace halocline::vehicle_sim
