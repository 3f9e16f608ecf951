// SPDX-License-Identifier: BSD-3-Clause
// Hulls that pierce the surface: hydrostatics, free heave, and motion in waves against closed forms.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/shipped/shipped_model.h"
#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/submergence.h"
#include "vehicle_sim/dynamics/waves.h"
#include "vehicle_sim/fleet.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using std::numbers::pi;
using testing::run;
using testing::shipped;
using Complex = std::complex<double>;

constexpr double kRho = 1025, kGravity = 9.81;
const Water kSea{.sea_surface_z_m = 0};

SimTime at_s(double seconds) { return SimTime::from_seconds(seconds); }

// Upright or heeled by phi about x, with CO at the depth d on its axis: wet length l = b + d / cos(phi) from
// the bottom b below CO up, V = A l, and the centroid off the axis by I / V tan(phi) and up by half of I / V
// tan(phi)^2 (wall-sided formula).
TEST(Floats, OfAHeeledCylinderAreThoseOfTheWallSidedFormula) {
  const std::vector<Float> floats{{.bottom_m = {0, 0, 0.9}, .length_m = 2, .beam_m = 1.2, .height_m = 2}};
  const double area = pi / 4 * 2 * 1.2, inertia = area * 1.2 * 1.2 / 16;
  for (const double heel : {0.0, 0.1, 0.3, -0.3}) {
    for (const double depth : {-0.2, 0.1, 0.4}) {
      const Axes down(0, std::sin(heel), std::cos(heel));
      const WetFloats wet = wet_floats(floats, -depth, down, {});
      const double length = 0.9 + depth / std::cos(heel), t = std::tan(heel);
      EXPECT_NEAR(wet.volume_m3, area * length, tolerance(1e-12));
      EXPECT_NEAR(wet.moment_m4.x, 0, tolerance(1e-12));
      EXPECT_NEAR(wet.moment_m4.y, inertia * t, tolerance(1e-12));
      EXPECT_NEAR(wet.moment_m4.z, area * length * (0.9 - length / 2) - inertia * t * t / 2,
                  tolerance(1e-12));
      EXPECT_EQ(wet.bottom_share, 1);
    }
  }
}

// A surface that slopes is the same as a hull that leans the other way, but for the direction of the
// buoyancy.
TEST(Floats, AreWetByTheSlopeOfTheSurface) {
  const std::vector<Float> floats{{.bottom_m = {0, 0, 0.5}, .length_m = 2, .beam_m = 2, .height_m = 1}};
  const double area = pi, inertia = area * 4 / 16;
  const WetFloats wet = wet_floats(floats, 0, {0, 0, 1}, {0.1, 0, 0});  // the surface lies lower towards x
  EXPECT_NEAR(wet.volume_m3, area * 0.5, tolerance(1e-12));
  EXPECT_NEAR(wet.moment_m4.x, -0.1 * inertia, tolerance(1e-12));
}

TEST(Floats, AreWhollyWetOrDryFarFromTheSurface) {
  const std::vector<Float> floats{{.bottom_m = {1, 0, 0.5}, .length_m = 2, .beam_m = 1, .height_m = 1},
                                  {.bottom_m = {-1, 0, 0.5}, .length_m = 2, .beam_m = 1, .height_m = 1}};
  for (const Axes& down : {Axes(0, 0, 1), Axes(0, 0.6, 0.8), Axes(1, 0, 0), Axes(0, 0, -1)}) {
    EXPECT_NEAR(wet_floats(floats, -50, down, {}).volume_m3, pi, tolerance(1e-12));
    EXPECT_EQ(wet_floats(floats, 50, down, {}).volume_m3, 0);
    EXPECT_EQ(wet_floats(floats, 50, down, {}).bottom_share, 0);
  }
}

TEST(Floats, VolumeHasNoJumpsAsTheHullTurnsOver) {
  const std::vector<Float> floats{{.bottom_m = {0, 0, 0.5}, .length_m = 1, .beam_m = 1, .height_m = 1}};
  double last = wet_floats(floats, 0.1, {0, 0, 1}, {}).volume_m3;
  for (int degrees = 1; degrees <= 180; ++degrees) {
    const double angle = to_radians(degrees);
    const double now = wet_floats(floats, 0.1, {0, std::sin(angle), std::cos(angle)}, {}).volume_m3;
    EXPECT_LT(std::abs(now - last), 0.15) << degrees;  // a column of eight at once
    last = now;
  }
}

// The heave of a buoy: M z'' + B z' + rho g A z = 0.
struct Heave {
  double mass, damping, stiffness;
  double natural() const { return std::sqrt(stiffness / mass); }
};

Heave heave_of(const Model& model) {
  const Float& f = model.parameters().floats[0];
  return {model.mass()(2, 2), model.parameters().damping.linear[2],
          kRho * kGravity * pi / 4 * f.length_m * f.beam_m};
}

// z(t) = z0 exp(-d t) (cos(w t) + d / w sin(w t)), d = B / 2 M, w^2 = C / M - d^2: a period of 2.08 s.
TEST(Buoy, HeavesFreelyAtItsNaturalFrequency) {
  const auto model = shipped("buoy");
  const Heave h = heave_of(*model);
  EXPECT_NEAR(h.natural(),
              std::sqrt(kRho * kGravity * pi * 0.36 / (kRho * pi * 0.36 * 0.8 + 4.0 / 3 * kRho * 0.216)),
              tolerance(1e-4));
  VehicleState s;
  s.position_ned_m.z() = 0.4 + 0.1;
  const double d = h.damping / (2 * h.mass), w = std::sqrt(h.stiffness / h.mass - d * d);
  for (double t = 0; t < 20; t += 0.5) {
    EXPECT_NEAR(s.position_ned_m.z() - 0.4,
                0.1 * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t)), tolerance(1e-6))
        << t;
    s = run(*model, s, {}, 0.5, kSea);
  }
}

// Small pitch about the water line's own place: m g GM holds it, GM = KB + I / V - KG.
TEST(Buoy, RightsItselfByItsMetacentricHeight) {
  const auto model = shipped("buoy");
  VehicleState s;
  s.position_ned_m.z() = 0.4;
  const double gm = 0.4 + 0.36 / (4 * 0.8) - 0.25, angle = 0.01;
  s.orientation = to_quaternion({0, angle, 0});
  const double moment = (model->mass() * acceleration(*model, s, kSea))[4];
  EXPECT_LT(relative_error(moment, -model->weight_n() * gm * std::sin(angle)), tolerance(1e-3));
}

// 2 / T times the integral of x exp(i w t) over whole periods.
struct Response {
  Complex heave, pitch;
};

constexpr double kWaveHeight = 0.02;  // m: small, so that the equations are linear

Response response_to_waves(double period_s) {
  FleetSettings settings;
  settings.step = SimDuration::from_milliseconds(5);
  settings.waves = {.kind = SeaKind::kRegular, .height_m = kWaveHeight, .period_s = period_s};
  VehicleState start;
  start.position_ned_m.z() = 0.4;
  Fleet fleet(settings, {{"buoy", shipped("buoy"), start}}, nullptr, SimTime());
  const double omega = 2 * pi / period_s;
  const int samples = 200, periods = 5;
  const double settled = 60 * period_s;
  Response r{};
  for (int i = 0; i < samples * periods; ++i) {
    const double t = settled + i * period_s / samples;
    fleet.advance(at_s(t));
    const VehicleState s = fleet.state_at(0, at_s(t));
    const Complex turn = 2.0 / (samples * periods) * std::exp(Complex(0, omega * t));
    r.heave += turn * (s.position_ned_m.z() - 0.4);
    r.pitch += turn * to_euler(s.orientation).pitch;
  }
  return r;
}

// Per metre of wave amplitude, with the draught T and the middle at T / 2: buoyancy and Froude-Krylov rho g A
// exp(-k T), added mass and damping in the water's motion at the middle:
//   z / a = (C exp(-k T) + (-w^2 A33 - i w B) exp(-k T / 2)) / (C - w^2 M - i w B)    (time as exp(-i w t)).
// The model takes the water's acceleration at the middle for that over the draught: an error of C (k T)^3 /
// 24 of the numerator's force, a few per cent of it at 2.1 s; the rest is for the orbit of the buoy itself.
TEST(Buoy, HeavesOnWavesAsTheClosedFormSays) {
  const auto model = shipped("buoy");
  const Heave h = heave_of(*model);
  const double added = model->parameters().added_mass(2, 2);
  for (const double period : {2.1, 3.0, 4.0, 8.0}) {
    const double w = 2 * pi / period, k = w * w / kGravity;
    const Complex damping(0, -w * h.damping);
    const Complex force = h.stiffness * std::exp(-k * 0.8) + (-w * w * added + damping) * std::exp(-k * 0.4);
    const double expected = std::abs(force / (h.stiffness - w * w * h.mass + damping));
    const double bound = h.stiffness * std::pow(k * 0.8, 3) / 24 / std::abs(force) + 0.002;
    const double measured = std::abs(response_to_waves(period).heave) / (kWaveHeight / 2);
    EXPECT_LT(relative_error(measured, expected), tolerance(bound)) << period << " s: " << measured;
    RecordProperty("error_percent_" + std::to_string(std::lround(10 * period)),
                   std::to_string(100 * relative_error(measured, expected)));
  }
}

// Surge and pitch are coupled by the low centre of gravity. About the middle, where the wet part's centroid
// lies:
//   (m + A11) x'' + m z_g q' + D1 (x' - u) = (m + A11) u',   m z_g x'' + I q' + D5 q + m g GM theta = rho g
//                                                            I_wp s.
TEST(Buoy, PitchesOnWavesAsTheClosedFormSays) {
  const auto model = shipped("buoy");
  const ModelParameters& p = model->parameters();
  const double m = p.mass_kg, zg = 0.15, wedge = kRho * kGravity * pi * std::pow(0.6, 4) / 4;
  for (const double period : {4.0, 6.0, 10.0}) {
    const double w = 2 * pi / period, k = w * w / kGravity;
    const Complex i(0, 1), rate = -i * w;  // of exp(-i w t)
    // Per metre of amplitude, elevation exp(-i w t) at x = 0: u = w exp(-k d), the surface rises along x by i
    // k. Pitch is nose up.
    const Complex u = w * std::exp(-k * 0.4), rises = i * k;
    const Complex a11 = rate * rate * model->mass()(0, 0) + rate * p.damping.linear[0];
    const Complex a12 = rate * rate * m * zg;
    const Complex a22 = rate * rate * model->mass()(4, 4) + rate * p.damping.linear[4] +
                        m * kGravity * (0.4 + 0.36 / 3.2 - 0.25);
    const Complex b1 = (rate * model->mass()(0, 0) + p.damping.linear[0]) * u, b2 = wedge * rises;
    const Complex expected = (a11 * b2 - a12 * b1) / (a11 * a22 - a12 * a12);
    const double measured = std::abs(response_to_waves(period).pitch) / (kWaveHeight / 2);
    EXPECT_LT(relative_error(measured, std::abs(expected)), tolerance(0.01)) << period << " s: " << measured;
    if (period == 10.0) {
      EXPECT_LT(relative_error(measured, k), tolerance(0.1))
          << "a long swell tilts it as it tilts the surface";
    }
  }
}

TEST(Buoy, ItsModemGoesUpAndDownWithTheWaves) {
  FleetSettings settings;
  settings.waves = {.kind = SeaKind::kRegular, .height_m = 1, .period_s = 8};
  VehicleState start;
  start.position_ned_m.z() = 0.4;
  const auto model = shipped("buoy");
  Fleet fleet(settings, {{"buoy", model, start}}, nullptr, SimTime());
  double shallowest = 100, deepest = 0;
  for (double t = 40; t < 56; t += 0.1) {
    fleet.advance(at_s(t));
    const VehicleState s = fleet.state_at(0, at_s(t));
    const KinematicState seen = fleet.published_at(0, at_s(t));
    EXPECT_LT((seen.pose.position_ned_m - s.position_ned_m - s.orientation * Vec3(0, 0, 4)).norm(),
              tolerance(1e-12));
    EXPECT_NEAR(fleet.reading_at(0, at_s(t)).depth_m, 0.4,
                0.05);  // it rides the wave that its pressure sensor feels
    shallowest = std::min(shallowest, seen.pose.position_ned_m.z());
    deepest = std::max(deepest, seen.pose.position_ned_m.z());
  }
  EXPECT_NEAR(deepest - shallowest, 1, 0.06);
}

// What is published as velocity carries the place published on: central differences over 2 ms.
TEST(Buoy, PublishedVelocityIsTheRateOfThePublishedPlace) {
  FleetSettings settings;
  settings.step = SimDuration::from_milliseconds(1);
  settings.waves = {.kind = SeaKind::kJonswap, .height_m = 2, .period_s = 6};
  VehicleState start;
  start.position_ned_m.z() = 0.4;
  Fleet fleet(settings, {{"buoy", shipped("buoy"), start}}, nullptr, SimTime());
  std::vector<KinematicState> seen;
  for (const double t : {20.0, 20.001, 20.002}) {
    fleet.advance(at_s(t));
    seen.push_back(fleet.published_at(0, at_s(t)));
  }
  const Vec3 rate = (seen[2].pose.position_ned_m - seen[0].pose.position_ned_m) / 0.002;
  EXPECT_LT((rate - seen[1].velocity_ned_mps).norm(), tolerance(1e-4));
}

// Without a pilot and without current it stays where it is but for what waves carry it.
TEST(SurfaceCraft, FloatsLevelAtItsDraught) {
  const auto model = shipped("surface-craft");
  const VehicleState s = run(*model, {}, {}, 60, kSea);
  EXPECT_NEAR(s.position_ned_m.z(), 0, tolerance(1e-5));
  EXPECT_NEAR(to_euler(s.orientation).pitch, 0, tolerance(1e-6));
}

// 2 k n^2 = D u at the published greatest speed, 6 knots.
TEST(SurfaceCraft, ReachesSixKnotsWithBothPropellers) {
  const auto model = shipped("surface-craft");
  const VehicleState s = run(*model, {}, {.thruster_hz = {16.541, 16.541, 0, 0}}, 60, kSea);
  EXPECT_LT(
      relative_error(s.orientation.toRotationMatrix().row(0).dot(s.velocity_body.head<3>()), 6 * 0.5144),
      tolerance(0.01));
}

TEST(SurfaceCraft, TurnsAwayFromTheFasterPropeller) {
  const auto model = shipped("surface-craft");
  const VehicleState s = run(*model, {}, {.thruster_hz = {12, 6, 0, 0}}, 20, kSea);
  EXPECT_GT(s.velocity_body[5], 0.05);
  EXPECT_LT(std::abs(to_euler(s.orientation).roll), to_radians(15));
}

// Fossen's stiffness, with Otter's water planes: rho g A in heave, rho g V GM in roll.
TEST(SurfaceCraft, IsAsStiffAsPublished) {
  const auto model = shipped("surface-craft");
  const double volume = 80 / kRho, area = 0.75, draught = volume / area;
  VehicleState down;
  down.position_ned_m.z() = 0.01;
  EXPECT_LT(
      relative_error((model->mass() * acceleration(*model, down, kSea))[2], -kRho * kGravity * area * 0.01),
      tolerance(1e-3));
  const double beam = 4 * 0.375 / (pi * 2), inertia = 2 * 0.375 * (beam * beam / 16 + 0.395 * 0.395);
  const double gm = draught / 2 + inertia / volume - (draught + 0.246875);
  VehicleState heeled;
  heeled.orientation = to_quaternion({0.01, 0, 0});
  EXPECT_LT(
      relative_error((model->mass() * acceleration(*model, heeled, kSea))[3], -80 * kGravity * gm * 0.01),
      tolerance(2e-3));
}

TEST(Glider, FloatsOnTheWavesWithItsBladderFull) {
  FleetSettings settings;
  settings.waves = {.kind = SeaKind::kRegular, .height_m = 1, .period_s = 8};
  VehicleState start;
  start.position_ned_m.z() = 3;
  Fleet fleet(settings, {{"glider", shipped("glider"), start}}, nullptr, SimTime());
  fleet.advance(at_s(120));
  double lowest = 0, highest = 0;
  for (double t = 120; t < 136; t += 0.2) {
    fleet.advance(at_s(t));
    const Vec3 p = fleet.state_at(0, at_s(t)).position_ned_m;
    const double below = p.z() - fleet.sea_surface_z_m(0, p, at_s(t));
    EXPECT_LT(below, 0.6) << t;  // under the wave that it is on
    EXPECT_GT(below, -0.2) << t;
    lowest = std::max(lowest, p.z());
    highest = std::min(highest, p.z());
  }
  EXPECT_GT(lowest - highest, 0.5);  // up and down with it
}

}  // namespace
}  // namespace halocline::vehicle_sim
