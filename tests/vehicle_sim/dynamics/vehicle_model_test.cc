// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/vehicle_model.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;

const ModelParameters kRemus = remus100_pvs_parameters(CurrentTreatment::kUpstream);

void expect_equal(double actual, double expected, double digits) {
  EXPECT_LT(relative_error(actual, expected), tolerance(digits)) << actual << " for " << expected;
}

TEST(VehicleModel, RemusMassesAreThePublishedOnes) {
  expect_equal(kRemus.mass_kg, 31.029384975800244, 1e-14);
  expect_equal(kRemus.buoyancy_n, 304.3982666126004, 1e-14);
  expect_equal(kRemus.inertia_kg_m2(1, 1), 4.027769316783751, 1e-14);
  const double added[] = {0.8389085933, 29.4376366157, 29.4376366157,
                          0.0336048239, 3.4262101147,  3.4262101147};
  const double total[] = {31.8682935691, 60.4670215915, 60.4670215915,
                          0.1580326577,  7.4663911855,  7.4539794315};
  const Model model(kRemus);
  for (int k = 0; k < 6; ++k) {  // ten digits are given
    expect_equal(kRemus.added_mass(k, k), added[k], 1e-8);
    expect_equal(model.mass()(k, k), total[k], 1e-8);
  }
  expect_equal(model.mass()(0, 4), 0.6205876995, 1e-9);
  expect_equal(model.mass()(1, 3), -0.6205876995, 1e-9);
}

TEST(VehicleModel, RemusCoefficientsAreThePublishedOnes) {
  const double damping[] = {1.5934146785, 3.0233510796,  3.0233510796,
                            0.5885193649, 10.7872672433, 7.4539794315};
  for (int k = 0; k < 6; ++k) expect_equal(kRemus.damping.linear[k], damping[k], 1e-9);
  expect_equal(kRemus.lift_drag.zero_lift_drag, 0.05595961914206819, 1e-14);
  expect_equal(kRemus.lift_drag.lift_slope_per_rad, 0.2659967942359403, 1e-14);
  expect_equal(kRemus.lift_drag.reference_area_m2, 0.2128, 1e-14);
  EXPECT_EQ(kRemus.cross_flow.strips, 21);
}

TEST(VehicleModel, TheInverseMassInvertsTheMass) {
  const Model model(kRemus);
  EXPECT_LT((model.mass() * model.inverse_mass() - Mat6::Identity()).norm(), tolerance(1e-12));
}

// Lamb: a sphere's added mass is half of the water it displaces, and it does not resist rotation.
TEST(VehicleModel, LambsFactorsTendToThoseOfASphere) {
  const LambFactors k = lamb_factors(1, 0.99);
  EXPECT_NEAR(k.axial, 0.5, tolerance(0.01));
  EXPECT_NEAR(k.transverse, 0.5, tolerance(0.01));
  EXPECT_NEAR(k.rotational, 0, tolerance(1e-3));
}

// A needle carries no water along its axis and its own volume across it.
TEST(VehicleModel, LambsFactorsTendToThoseOfANeedle) {
  const LambFactors k = lamb_factors(1000, 1);
  EXPECT_NEAR(k.axial, 0, tolerance(1e-4));
  EXPECT_NEAR(k.transverse, 1, tolerance(1e-4));
  EXPECT_NEAR(k.rotational, 1, tolerance(1e-4));
}

TEST(VehicleModel, LambsFactorsRefuseWhatIsNotProlate) {
  EXPECT_THROW(lamb_factors(1, 1), InvalidArgument);
  EXPECT_THROW(lamb_factors(1, 0), InvalidArgument);
}

TEST(VehicleModel, ImpossibleParametersAreRefused) {
  const auto refused = [](const std::function<void(ModelParameters&)>& spoil) {
    ModelParameters p = kRemus;
    spoil(p);
    EXPECT_THROW(Model{p}, InvalidArgument);
  };
  refused([](auto& p) { p.mass_kg = 0; });
  refused([](auto& p) { p.mass_kg = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& p) { p.buoyancy_n = -1; });
  refused([](auto& p) { p.hull.diameter_m = 2; });
  refused([](auto& p) { p.damping.linear[2] = -1; });
  refused([](auto& p) { p.fin_servo.lag_s = 0; });
  refused([](auto& p) { p.fin_servo.max_angle_rad = 2; });
  refused([](auto& p) { p.added_mass(0, 1) = 3; });
  refused([](auto& p) { p.inertia_kg_m2(0, 0) = -1; });
  refused([](auto& p) { p.center_of_gravity_m.x() = std::numeric_limits<double>::infinity(); });
}

}  // namespace
}  // namespace halocline::vehicle_sim
