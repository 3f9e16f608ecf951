// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/sensor_errors.h"

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr int kSamples = 40'000;
// All statistics below are of fixed draws: 4 standard deviations of the statistic bound them, which a sound
// generator exceeds with a chance of 6e-5.
constexpr double kSigmas = 4;

using halocline::testing::at_ms;

std::vector<double> draws_of(const SensorIdentity& sensor, int axis = 0) {
  std::vector<double> draws;
  for (int i = 0; i < kSamples; ++i) draws.push_back(noise_draw(sensor, i, axis));
  return draws;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size());
}

TEST(SensorErrors, NoiseHasMeanZeroAndVarianceOne) {
  const std::vector<double> draws = draws_of({1, 7, SensorKind::kDepth});
  double mean = 0;
  for (const double draw : draws) mean += draw / kSamples;
  EXPECT_NEAR(mean, 0, kSigmas / std::sqrt(kSamples));
  EXPECT_NEAR(correlation(draws, draws), 1, kSigmas * std::sqrt(2.0 / kSamples));
}

TEST(SensorErrors, VehiclesSensorsAxesSeedsAndSamplesAreIndependent) {
  const SensorIdentity one{1, 7, SensorKind::kGyro};
  const std::vector<double> draws = draws_of(one);
  std::vector<double> next(draws.begin() + 1, draws.end());
  next.push_back(draws.front());
  for (const auto& other : {draws_of({2, 7, SensorKind::kGyro}), draws_of({1, 8, SensorKind::kGyro}),
                            draws_of({1, 7, SensorKind::kDepth}), draws_of(one, 1), next}) {
    EXPECT_NEAR(correlation(draws, other), 0, kSigmas / std::sqrt(kSamples));
  }
}

TEST(SensorErrors, ADrawDoesNotDependOnWhatWasDrawnBefore) {
  const SensorIdentity sensor{3, 4, SensorKind::kCompass};
  const double first = noise_draw(sensor, 1000, 2);
  for (int i = 0; i < 10; ++i) noise_draw(sensor, i, 0);
  EXPECT_EQ(noise_draw(sensor, 1000, 2), first);
}

TEST(SensorErrors, NoTwoAddressesShareADraw) {
  std::set<double> seen;
  int count = 0;
  for (const SensorKind kind : kSensorKinds) {
    for (std::int64_t sample = 0; sample < 20; ++sample) {
      for (int axis = 0; axis < 1024; axis += 31, ++count)
        seen.insert(noise_draw({1, 1, kind}, sample, axis));
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), count);
}

TEST(SensorErrors, DropOutsComeWithTheirProbability) {
  for (const double probability : {0.0, 0.1, 0.5, 1.0}) {
    int missing = 0;
    for (int i = 0; i < kSamples; ++i) missing += drops_out({1, 2, SensorKind::kDvl}, i, probability);
    const double deviation = std::sqrt(probability * (1 - probability) / kSamples);
    EXPECT_NEAR(static_cast<double>(missing) / kSamples, probability, kSigmas * deviation);
  }
}

TEST(SensorErrors, TheVarianceOfAWalkGrowsWithTime) {
  constexpr int kVehicles = 4000;
  for (const int seconds : {1, 4, 16}) {
    double square = 0;
    for (int vehicle = 1; vehicle <= kVehicles; ++vehicle) {
      const double walk = BiasWalk({1, vehicle, SensorKind::kGyro}, 0).at(SimTime::from_seconds(seconds));
      square += walk * walk / kVehicles;
    }
    EXPECT_NEAR(square / seconds, 1, kSigmas * std::sqrt(2.0 / kVehicles));
  }
}

TEST(SensorErrors, AWalkIsTheSameInAnyOrderOfTimes) {
  const SensorIdentity sensor{1, 5, SensorKind::kGyro};
  BiasWalk often(sensor, 1), once(sensor, 1);
  for (int ms = 0; ms <= 60'000; ms += 100) often.at(at_ms(ms));
  EXPECT_EQ(often.at(at_ms(60'000)), once.at(at_ms(60'000)));
  EXPECT_EQ(often.at(at_ms(20'500)), once.at(at_ms(20'500)));  // backwards
  EXPECT_NEAR(once.at(at_ms(20'500)), 0.5 * (once.at(at_ms(20'000)) + once.at(at_ms(21'000))),
              tolerance(1e-12));
}

SensorReading true_reading() {
  SensorReading truth;
  truth.depth_m = 20;
  truth.water_speed_mps = 1.5;
  truth.attitude = {0.1, 0.2, 3.1};
  truth.angular_velocity_body_radps = {0.01, 0.02, 0.03};
  return truth;
}

constexpr SimDuration kPeriod = SimDuration::from_milliseconds(200);

TEST(SensorSuite, WithoutErrorsItReadsTheTruth) {
  SensorSuite suite({}, 1, 1, kPeriod);
  const SensorReading r = suite.read(true_reading(), at_ms(400), {});
  EXPECT_EQ(r.depth_m, 20);
  EXPECT_EQ(r.water_speed_mps, 1.5);
  EXPECT_NEAR(r.attitude.yaw, 3.1, tolerance(1e-12));
  EXPECT_EQ(r.angular_velocity_body_radps, Vec3(0.01, 0.02, 0.03));
  EXPECT_TRUE(r.depth_fresh && r.water_speed_fresh && r.attitude_fresh && r.angular_rate_fresh);
  EXPECT_TRUE(suite.altimeter_fires());
}

TEST(SensorSuite, BiasAndNoiseAreTheConfiguredOnes) {
  SensorSettings settings;
  settings.depth.errors = {.noise = 0.3, .bias = 0.7, .walk = 0, .dropout = 0};
  SensorSuite suite(settings, 1, 1, kPeriod);
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double error = suite.read(true_reading(), at_ms(200 * i), {}).depth_m - 20;
    sum += error / kSamples;
    squares += (error - 0.7) * (error - 0.7) / kSamples;
  }
  EXPECT_NEAR(sum, 0.7, kSigmas * 0.3 / std::sqrt(kSamples));
  EXPECT_NEAR(squares, 0.09, kSigmas * 0.09 * std::sqrt(2.0 / kSamples));
}

TEST(SensorSuite, AHeadingStaysWithinATurn) {
  SensorSettings settings;
  settings.compass.errors.bias = 0.1;
  SensorSuite suite(settings, 1, 1, kPeriod);
  EXPECT_NEAR(suite.read(true_reading(), at_ms(0), {}).attitude.yaw, 3.2 - 2 * std::numbers::pi,
              tolerance(1e-12));
}

TEST(SensorSuite, ASlowSensorHoldsItsReading) {
  SensorSettings settings;
  settings.depth.period = SimDuration::from_milliseconds(1000);
  SensorSuite suite(settings, 1, 1, kPeriod);
  SensorReading truth = true_reading();
  int fresh = 0;
  for (int i = 0; i < 50; ++i) {
    truth.depth_m = i;
    const SensorReading r = suite.read(truth, at_ms(200 * i), {});
    fresh += r.depth_fresh;
    EXPECT_EQ(r.depth_m, i - i % 5);
    EXPECT_TRUE(r.water_speed_fresh);
  }
  EXPECT_EQ(fresh, 10);
}

TEST(SensorSuite, ADeadSensorHoldsWhatItMeasuredLast) {
  SensorSuite suite({}, 1, 1, kPeriod);
  suite.read(true_reading(), at_ms(0), {});
  SensorReading later = true_reading();
  later.depth_m = 50;
  later.attitude.yaw = 1;
  SensorSuite::Dead dead = {};
  dead[static_cast<std::size_t>(SensorKind::kCompass)] = true;
  dead[static_cast<std::size_t>(SensorKind::kAltimeter)] = true;
  const SensorReading r = suite.read(later, at_ms(200), dead);
  EXPECT_FALSE(r.attitude_fresh);
  EXPECT_NEAR(r.attitude.yaw, 3.1, tolerance(1e-12));
  EXPECT_EQ(r.depth_m, 50);
  EXPECT_FALSE(suite.altimeter_fires());
}

TEST(SensorSuite, TwoVehiclesWithOneSeedDisagree) {
  SensorSettings settings;
  settings.depth.errors.noise = 1;
  SensorSuite one(settings, 1, 1, kPeriod), two(settings, 1, 2, kPeriod), again(settings, 1, 1, kPeriod);
  const double depth = one.read(true_reading(), at_ms(0), {}).depth_m;
  EXPECT_NE(depth, two.read(true_reading(), at_ms(0), {}).depth_m);
  EXPECT_EQ(depth, again.read(true_reading(), at_ms(0), {}).depth_m);
}

TEST(Gps, IsSeenNearTheSurfaceAlone) {
  const GpsSettings gps{.period = SimDuration::from_seconds(1)};
  VehicleState state;
  for (const double depth : {-0.5, 0.0, 0.2}) {
    state.position_ned_m = {1, 2, depth + 0.3};
    EXPECT_TRUE(gps_sees_sky(gps, state, 0.3));
  }
  state.position_ned_m.z() = 0.51;
  EXPECT_FALSE(gps_sees_sky(gps, state, 0.3));
}

TEST(Gps, MeasuresThePlaceOfItsAntenna) {
  GpsSettings gps;
  gps.place_m = {0.5, 0, -0.1};
  VehicleState state;
  state.position_ned_m = {10, 20, 0};
  state.orientation = to_quaternion({0, 0, std::numbers::pi / 2});
  const Eigen::Vector2d fix = read_gps(gps, {1, 1, SensorKind::kGps}, 0, state);
  EXPECT_NEAR(fix.x(), 10, tolerance(1e-9));
  EXPECT_NEAR(fix.y(), 20.5, tolerance(1e-9));
}

TEST(Usbl, TurnsTheDirectionOfSoundIntoTheBody) {
  const SensorIdentity sensor{1, 1, SensorKind::kUsbl};
  const auto measured = [&](double azimuth, double elevation, const EulerAngles& attitude) {
    return read_usbl({.fitted = true}, sensor, 1, azimuth, elevation, to_quaternion(attitude));
  };
  EXPECT_NEAR(measured(1, 0, {0, 0, 1}).bearing_rad, 0, tolerance(1e-12));
  EXPECT_NEAR(measured(1, 0, {0, 0, 0}).bearing_rad, 1, tolerance(1e-12));
  EXPECT_NEAR(measured(0, 0.3, {0, 0, 0}).elevation_rad, 0.3, tolerance(1e-12));
  EXPECT_NEAR(measured(0, 0.3, {0, 0.3, 0}).elevation_rad, 0, tolerance(1e-12));  // the bow points at it
  EXPECT_NEAR(measured(std::numbers::pi / 2, 0, {0.2, 0, 0}).elevation_rad, 0.2,
              tolerance(1e-12));  // starboard is down
}

}  // namespace
}  // namespace halocline::vehicle_sim
