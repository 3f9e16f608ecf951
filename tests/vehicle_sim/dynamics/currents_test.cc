// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/currents.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr SimDuration kStep = SimDuration::from_milliseconds(10);

TEST(OceanCurrent, ByDepthIsLinearBetweenRowsAndConstantBeyond) {
  CurrentSettings s;
  s.by_depth = {{10, 1, 0}, {20, 0, -1}};
  const OceanCurrent current(s, 1);
  EXPECT_EQ(current.at_depth(-5), Vec3(1, 0, 0));
  EXPECT_EQ(current.at_depth(10), Vec3(1, 0, 0));
  EXPECT_LT((current.at_depth(12.5) - Vec3(0.75, -0.25, 0)).norm(), tolerance(1e-15));
  EXPECT_EQ(current.at_depth(99), Vec3(0, -1, 0));
}

TEST(OceanCurrent, TheTideSwingsToAndFro) {
  CurrentSettings s;
  s.tide = {.amplitude_mps = 0.5, .period_s = 40, .phase_rad = 0, .toward_rad = std::numbers::pi / 2};
  OceanCurrent current(s, 1);
  const auto at = [&](double t) { return current.everywhere(SimTime::from_seconds(t), kStep).velocity_mps; };
  EXPECT_LT((at(0) - Vec3(0, 0.5, 0)).norm(), tolerance(1e-15));
  EXPECT_LT(at(10).norm(), tolerance(1e-15));
  EXPECT_LT((at(20) - Vec3(0, -0.5, 0)).norm(), tolerance(1e-15));
}

TEST(OceanCurrent, AccelerationLeadsToTheNextStepsValue) {
  CurrentSettings s;
  s.uniform_ned_mps = {0.1, 0.2, 0.3};
  s.tide.amplitude_mps = 0.4;
  s.tide.period_s = 100;
  s.random = {0.2, 5};
  OceanCurrent current(s, 3);
  for (int i = 0; i < 100; ++i) {
    const SimTime t = SimTime() + kStep * i;
    const WaterMotion now = current.everywhere(t, kStep), next = current.everywhere(t + kStep, kStep);
    EXPECT_LT((now.velocity_mps + kStep.seconds() * now.acceleration_mps2 - next.velocity_mps).norm(),
              tolerance(1e-15));
  }
}

TEST(OceanCurrent, PartsAddUp) {
  CurrentSettings all, tide_alone, random_alone;
  tide_alone.tide = all.tide = {.amplitude_mps = 0.5, .period_s = 40, .phase_rad = 1, .toward_rad = 2};
  random_alone.random = all.random = {0.3, 10};
  all.uniform_ned_mps = {0.1, -0.2, 0.05};
  const SimTime t = SimTime::from_seconds(7.77);
  const auto part = [&](const CurrentSettings& s) {
    return OceanCurrent(s, 9).everywhere(t, kStep).velocity_mps;
  };
  EXPECT_LT((part(all) - part(tide_alone) - part(random_alone) - all.uniform_ned_mps).norm(),
            tolerance(1e-15));
}

TEST(OceanCurrent, AnotherSeedIsAnotherRandomCurrent) {
  CurrentSettings s;
  s.random = {0.3, 10};
  const auto with = [&](std::uint64_t seed) {
    return OceanCurrent(s, seed).everywhere(SimTime(), kStep).velocity_mps;
  };
  EXPECT_EQ(with(1), with(1));
  EXPECT_NE(with(1), with(2));
  EXPECT_NE(with(1).x(), with(1).y());
}

TEST(OceanCurrent, ImpossibleSettingsAreRefused) {
  const auto refused = [](const std::function<void(CurrentSettings&)>& spoil) {
    CurrentSettings s;
    spoil(s);
    EXPECT_THROW(OceanCurrent(s, 1), InvalidArgument);
  };
  refused([](auto& s) { s.uniform_ned_mps.x() = 11; });
  refused([](auto& s) { s.uniform_ned_mps.x() = std::nan(""); });
  refused([](auto& s) { s.by_depth = {{5, 0, 0}, {5, 1, 0}}; });
  refused([](auto& s) { s.tide.period_s = 0; });
  refused([](auto& s) { s.random.deviation_mps = -1; });
}

}  // namespace
}  // namespace halocline::vehicle_sim
