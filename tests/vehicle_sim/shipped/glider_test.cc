// SPDX-License-Identifier: BSD-3-Clause
// The glider against the closed form of its steady glide (Graver 2005, section 5.1).
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/shipped/shipped_model.h"
#include "vehicle_sim/dynamics/actuator_forces.h"
#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/hull_forces.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::run;
using testing::shipped;

// A steady glide downwards at the slope `path`, radians below the horizontal.
struct SteadyGlide {
  double attack_rad, pitch_rad, speed_mps;  // pitch positive nose up
  double moving_mass_m;                     // that holds this pitch
};

double induced_drag(const LiftDrag& l) {
  return l.lift_slope_per_rad * l.lift_slope_per_rad /
         (std::numbers::pi * l.oswald_efficiency * l.aspect_ratio);
}

// The mass that balances the moments about CO, nose up positive: weight below CO -m g z sin(theta), mass off
// its middle -m_p g x cos(theta), bladder rho g V x_b cos(theta), Munk (A33 - A11) u w, lift and drag -x Z.
double balancing_mass(const Model& model, double volume_m3, const SteadyGlide& g) {
  const ModelParameters& p = model.parameters();
  const double u = g.speed_mps * std::cos(g.attack_rad), w = g.speed_mps * std::sin(g.attack_rad);
  const double c = std::cos(g.pitch_rad), s = std::sin(g.pitch_rad);
  const double flow =
      lift_drag_force(p.lift_drag, p.water_density_kg_m3, BodyVelocity(Axes(u, 0, w), {}), g.speed_mps).m;
  const double rest =
      -model.weight_n() * p.center_of_gravity_m.z() * s +
      p.water_density_kg_m3 * p.gravity_m_s2 * volume_m3 * p.buoyancy_engine.position_m.x() * c +
      (p.added_mass(2, 2) - p.added_mass(0, 0)) * u * w + flow;
  return rest / (p.moving_mass.mass_kg * p.gravity_m_s2 * c);
}

double drag_coefficient(const LiftDrag& l, double alpha) {
  const double k = induced_drag(l), s = std::sin(alpha) * std::sin(alpha);
  return l.zero_lift_drag + k * s / (1 + (k / l.broadside_drag - 1) * s);
}

// tan(path) = D / L = C_D / (a sin(alpha) cos(alpha)), by halving between no attack and the best ratio, at
// 4.7 degrees; D = net weight times sin(path).
SteadyGlide steady_glide(const Model& model, double volume_m3, double path_rad) {
  const ModelParameters& p = model.parameters();
  const LiftDrag& l = p.lift_drag;
  double low = 1e-6, high = std::sqrt(l.zero_lift_drag / induced_drag(l));
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const double ratio =
        drag_coefficient(l, middle) / (l.lift_slope_per_rad * std::sin(middle) * std::cos(middle));
    (ratio > std::tan(path_rad) ? low : high) = middle;
  }
  SteadyGlide g{};
  g.attack_rad = low;
  g.pitch_rad = g.attack_rad - path_rad;
  const double rho = p.water_density_kg_m3, net_weight_n = -rho * p.gravity_m_s2 * volume_m3;
  g.speed_mps = std::sqrt(net_weight_n * std::sin(path_rad) /
                          (0.5 * rho * l.reference_area_m2 * drag_coefficient(l, g.attack_rad)));
  g.moving_mass_m = balancing_mass(model, volume_m3, g);
  return g;
}

double path_of(const VehicleState& s) {
  const Vec3 v = s.orientation * Vec3(s.linear_velocity_body_mps());
  return std::atan2(v.z(), v.head<2>().norm());
}

// After 600 s what is left of the start is below 1e-6 of the speed.
TEST(Glider, GlidesSteadilyAsLiftDragAndNetBuoyancySay) {
  const auto model = shipped("glider");
  for (const double volume : {-1e-4, -2.5e-4}) {
    for (const double path_deg : {28.0, 33.0, 45.0}) {
      const SteadyGlide expected = steady_glide(*model, volume, to_radians(path_deg));
      const VehicleState s =
          run(*model, {}, {.buoyancy_m3 = volume, .moving_mass_m = expected.moving_mass_m}, 600);
      EXPECT_LT(relative_error(s.linear_velocity_body_mps().norm(), expected.speed_mps), tolerance(1e-5));
      EXPECT_NEAR(path_of(s), to_radians(path_deg), tolerance(1e-5));
      EXPECT_NEAR(to_euler(s.orientation).pitch, expected.pitch_rad, tolerance(1e-5));
      EXPECT_EQ(s.position_ned_m.y(), 0);
    }
  }
}

// Graver's own law, C_L = a alpha and C_D = C_D0 + k alpha^2: alpha = K_L / (2 K_D) tan(path) (1 - sqrt(1 - 4
// K_D K_D0 / (K_L tan(path))^2)). The bounded law differs by the square of alpha, 5 degrees at most: 0.8 %.
TEST(Glider, IsWithinOnePercentOfTheLinearLawOfThePaper) {
  const auto model = shipped("glider");
  const LiftDrag& l = model->parameters().lift_drag;
  for (const double path_deg : {26.0, 30.0, 40.0}) {
    const double t = std::tan(to_radians(path_deg)), a = l.lift_slope_per_rad, k = induced_drag(l);
    const double alpha = a / (2 * k) * t * (1 - std::sqrt(1 - 4 * k * l.zero_lift_drag / (a * a * t * t)));
    const double drag_kg_m = 0.5 * 1025 * l.reference_area_m2 * (l.zero_lift_drag + k * alpha * alpha);
    const double speed = std::sqrt(1025 * 9.81 * 2.5e-4 * std::sin(to_radians(path_deg)) / drag_kg_m);
    const SteadyGlide ours = steady_glide(*model, -2.5e-4, to_radians(path_deg));
    EXPECT_LT(relative_error(ours.speed_mps, speed), tolerance(0.01));
    EXPECT_LT(relative_error(ours.attack_rad, alpha), tolerance(0.06));
  }
}

// In the steady state; on the way there the low centre of gravity makes a difference.
TEST(Glider, ClimbsAsItDives) {
  const auto model = shipped("glider");
  const double mass = steady_glide(*model, -2e-4, to_radians(30)).moving_mass_m;
  const VehicleState down = run(*model, {}, {.buoyancy_m3 = -2e-4, .moving_mass_m = mass}, 600),
                     up = run(*model, {}, {.buoyancy_m3 = 2e-4, .moving_mass_m = -mass}, 600);
  EXPECT_NEAR(up.velocity_body[0], down.velocity_body[0], tolerance(1e-6));
  EXPECT_NEAR(up.velocity_body[2], -down.velocity_body[2], tolerance(1e-6));
}

// Flatter than about 2 sqrt(C_D0 k) / a, 24 degrees, there is no glide: it sinks broadside.
TEST(Glider, SinksSteeplyWhereItsPitchIsTooFlatToGlide) {
  const auto model = shipped("glider");
  const VehicleState s = run(*model, {}, {.buoyancy_m3 = -2.5e-4, .moving_mass_m = -0.02}, 600);
  EXPECT_GT(to_euler(s.orientation).pitch, to_radians(-15));
  EXPECT_GT(path_of(s), to_radians(50));
}

TEST(Glider, TurnsToTheSideOfItsRudder) {
  const auto model = shipped("glider");
  const double mass = steady_glide(*model, -2.5e-4, to_radians(30)).moving_mass_m;
  for (const double side : {1.0, -1.0}) {
    VehicleState s = run(*model, {}, {.buoyancy_m3 = -2.5e-4, .moving_mass_m = mass}, 120);
    s = run(*model, s, {.rudder_rad = side * 0.1, .buoyancy_m3 = -2.5e-4, .moving_mass_m = mass}, 120);
    EXPECT_GT(side * s.velocity_body[5], 0.005);
    EXPECT_LT(std::abs(to_euler(s.orientation).roll), to_radians(30));
  }
}

TEST(Glider, ActuatorsMoveNoFasterThanTheyCan) {
  const auto model = shipped("glider");
  const ActuatorValues command{.buoyancy_m3 = 1, .moving_mass_m = 1};
  const ActuatorValues limits = limited(model->parameters(), command);
  EXPECT_EQ(limits.buoyancy_m3, 2.5e-4);
  EXPECT_EQ(limits.moving_mass_m, 0.05);
  EXPECT_EQ(limits.weight, DropWeightState::kHeld);
  const VehicleState s = run(*model, {}, command, 5);
  EXPECT_NEAR(s.actuators.buoyancy_m3, 5 * 2.5e-5, tolerance(1e-12));
  EXPECT_NEAR(s.actuators.moving_mass_m, 5 * 0.005, tolerance(1e-12));
}

TEST(BoundedLift, IsTheAngleLawAtSmallAnglesAndTakesEnergyAtAll) {
  LiftDrag bounded = shipped("glider")->parameters().lift_drag;
  bounded.x_m = 0;
  LiftDrag angle = bounded;
  angle.law = LiftLaw::kAngle;
  for (int i = 0; i < 360; ++i) {
    const double alpha = to_radians(i);
    const BodyVelocity nu(Axes(std::cos(alpha), 0, std::sin(alpha)), {});
    const BodyForce f = lift_drag_force(bounded, 1025, nu, 1), linear = lift_drag_force(angle, 1025, nu, 1);
    EXPECT_LT(f.x * nu.u + f.z * nu.w, 0) << i;  // the power of the drag
    if (i > 3) continue;
    const double third_order = 20 * alpha * alpha;
    EXPECT_NEAR(f.z, linear.z, third_order * std::abs(linear.z) + 1e-9);
    EXPECT_NEAR(f.x, linear.x, third_order * std::abs(linear.x) + 1e-9);
  }
}

}  // namespace
}  // namespace halocline::vehicle_sim
