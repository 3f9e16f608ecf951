// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/submergence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr double kStep = 0.01;
const Water kSeaAtZero{.sea_surface_z_m = 0};

VehicleState at_depth(double depth_m, double pitch_rad = 0) {
  VehicleState s;
  s.position_ned_m.z() = depth_m;
  s.orientation = to_quaternion({0, pitch_rad, 0});
  return s;
}

ModelParameters remus(double buoyancy_ratio = 1) {
  ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kGalilean);
  p.buoyancy_n *= buoyancy_ratio;
  return p;
}

TEST(Submergence, TheShareOfACircleIsThatOfItsSegment) {
  EXPECT_EQ(submerged_share_of_circle(1), 1);
  EXPECT_EQ(submerged_share_of_circle(-1), 0);
  EXPECT_NEAR(submerged_share_of_circle(0), 0.5, tolerance(1e-15));
  // A level half a radius above the centre leaves a cap of (pi/3 - sqrt(3)/4) r^2 dry.
  EXPECT_NEAR(submerged_share_of_circle(0.5),
              1 - (std::numbers::pi / 3 - std::sqrt(3) / 4) / std::numbers::pi, tolerance(1e-15));
}

TEST(Submergence, ADeepHullIsWhollyUnderWater) {
  for (const double pitch : {0.0, 1.5, -1.5}) {
    const Submergence under = submergence(remus(), at_depth(1.1, pitch), 0);
    EXPECT_EQ(under.hull, 1);
    EXPECT_EQ(under.stern, 1);
    EXPECT_EQ(under.x_shift_m, 0);
  }
}

TEST(Submergence, WithoutASurfaceEveryHeightIsUnderWater) {
  EXPECT_EQ(submergence(remus(), at_depth(-1e6), Water{}.sea_surface_z_m).hull, 1);
}

TEST(Submergence, AHullAboveTheSurfaceIsDry) {
  const Submergence under = submergence(remus(), at_depth(-1), 0);
  EXPECT_EQ(under.hull, 0);
  EXPECT_EQ(under.stern, 0);
}

TEST(Submergence, ALevelHullWithItsAxisInTheSurfaceIsHalfUnder) {
  const Submergence under = submergence(remus(), at_depth(0), 0);
  EXPECT_NEAR(under.hull, 0.5, tolerance(1e-12));
  EXPECT_NEAR(under.x_shift_m, 0, tolerance(1e-12));
}

TEST(Submergence, ARaisedBowMovesTheBuoyancyAft) {
  const Submergence under = submergence(remus(), at_depth(0, to_radians(20)), 0);
  EXPECT_LT(under.x_shift_m, -0.1);
  EXPECT_EQ(under.stern, 1);
}

TEST(Submergence, TheTideMovesTheSurface) {
  EXPECT_EQ(submergence(remus(), at_depth(5), 6).hull, 0);
  EXPECT_EQ(submergence(remus(), at_depth(-5), -8).hull, 1);
}

TEST(Submergence, ABuoyantVehicleComesToFloatWithItsWeightInWaterDisplaced) {
  const Model model(remus(1.1));
  VehicleState state = at_depth(10);
  for (int i = 0; i < 60'000; ++i) state = rk4_step(model, state, {}, kSeaAtZero, kStep);
  const Submergence under = submergence(model.parameters(), state, 0);
  EXPECT_NEAR(under.hull, 1 / 1.1, tolerance(1e-3));  // heave oscillations have died down to this
  EXPECT_LT(state.velocity_body.norm(), tolerance(1e-2));
}

TEST(Submergence, AVehicleDrivenUpwardsDoesNotFly) {
  const Model model(remus());
  VehicleState state = at_depth(3, to_radians(60));
  double highest = 0;
  for (int i = 0; i < 6'000; ++i) {
    state = rk4_step(model, state, {0, 0, 25}, kSeaAtZero, kStep);
    ASSERT_TRUE(is_finite(state));
    highest = std::max(highest, -state.position_ned_m.z());
  }
  EXPECT_LT(highest, model.parameters().hull.length_m);
}

TEST(Submergence, AVehicleDroppedFromTheAirFallsAndStaysFinite) {
  const Model model(remus());
  for (const double step : {0.005, 0.01, 0.02}) {
    VehicleState state = at_depth(-50);
    for (double t = 0; t < 30; t += step) {
      state = rk4_step(model, state, {0.2, 0.2, 25}, kSeaAtZero, step);
      ASSERT_TRUE(is_finite(state)) << step << " s, at " << t;
    }
    EXPECT_GT(state.position_ned_m.z(), -1);
    EXPECT_LT(state.velocity_body.norm(), 5);
  }
}

}  // namespace
}  // namespace halocline::vehicle_sim
