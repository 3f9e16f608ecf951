// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/doppler_log.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr double kPi = std::numbers::pi;
const SensorIdentity kSensor{1, 3, SensorKind::kDvl};

VehicleState moving() {
  VehicleState s;
  s.position_ned_m = {1, 2, 30};
  s.orientation = to_quaternion({0.1, -0.2, 1.5});
  s.velocity_body << 2, 0.3, -0.2, 0.1, 0.05, 0.2;
  return s;
}

// First hits of a plane through `point` with the unit `normal`.
std::vector<Echo> echoes_of_plane(std::span<const EchoBeam> beams, const Vec3& point, const Vec3& normal) {
  std::vector<Echo> echoes;
  for (const EchoBeam& beam : beams) {
    const double range = normal.dot(point - beam.origin_ned_m) / normal.dot(beam.direction_ned);
    const bool hit = range > 0 && range <= beam.range_m;
    echoes.push_back({hit ? AltitudeStatus::kMeasured : AltitudeStatus::kNoBottom, hit ? range : 0});
  }
  return echoes;
}

DvlReading ping_over_flat(const DvlSettings& dvl, const VehicleState& state, std::int64_t sample = 0) {
  const auto beams = dvl_beams(dvl, state);
  return read_dvl(dvl, kSensor, sample, state, echoes_of_plane(beams, {0, 0, 60}, -Vec3::UnitZ()), 0);
}

TEST(DopplerLog, MeasuresTheVelocityOverGroundOfItsOwnPlace) {
  const DvlSettings dvl{.place_m = {-0.5, 0.1, 0.1}, .mounting_yaw_rad = 0.4};
  const VehicleState state = moving();
  const DvlReading reading = ping_over_flat(dvl, state);
  ASSERT_TRUE(reading.valid);
  const Vec3 expected = Vec3(2, 0.3, -0.2) + Vec3(0.1, 0.05, 0.2).cross(dvl.place_m);
  EXPECT_LT((reading.ground_velocity_body_mps - expected).norm(), tolerance(1e-12));
}

TEST(DopplerLog, BeamsLeanOutByTheirAngleTowardsTheQuarters) {
  const auto beams = true_dvl_beams({.beam_angle_rad = 0.5});
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(beams[k].norm(), 1, tolerance(1e-12));
    EXPECT_NEAR(beams[k].z(), std::cos(0.5), tolerance(1e-12));
    EXPECT_NEAR(std::abs(beams[k].x()), std::sin(0.5) / std::sqrt(2), tolerance(1e-12));
  }
  EXPECT_TRUE(beams[0].x() > 0 && beams[0].y() > 0);  // bow, starboard
  EXPECT_TRUE(beams[1].x() < 0 && beams[1].y() > 0);
  EXPECT_TRUE(beams[2].x() < 0 && beams[2].y() < 0);
  EXPECT_TRUE(beams[3].x() > 0 && beams[3].y() < 0);
}

// Level over a seabed that falls away by `slope` towards north, h above it: along a beam the range is
// h / (cos J - slope sin J cos(azimuth)).
TEST(DopplerLog, RangesOverASlopeAreThoseOfTheBeamsAndThePlane) {
  const DvlSettings dvl;
  VehicleState level;
  const double slope = 0.3, height = 20;
  const Vec3 normal = Vec3(slope, 0, -1).normalized();
  const DvlReading reading =
      read_dvl(dvl, kSensor, 0, level, echoes_of_plane(dvl_beams(dvl, level), {0, 0, height}, normal), 0);
  for (std::size_t k = 0; k < 4; ++k) {
    const double azimuth = kPi / 4 + static_cast<double>(k) * kPi / 2, angle = dvl.beam_angle_rad;
    EXPECT_NEAR(reading.beams[k].range_m,
                height / (std::cos(angle) - slope * std::sin(angle) * std::cos(azimuth)), tolerance(1e-9));
  }
}

TEST(DopplerLog, ThreeBeamsAreEnoughTwoAreNot) {
  const DvlSettings dvl;
  const VehicleState state = moving();
  std::vector<Echo> echoes(4, {AltitudeStatus::kMeasured, 30});
  echoes[2] = {AltitudeStatus::kNoBottom, 0};
  const DvlReading three = read_dvl(dvl, kSensor, 0, state, echoes, 0);
  EXPECT_TRUE(three.valid);
  EXPECT_LT((three.ground_velocity_body_mps - Vec3(2, 0.3, -0.2)).norm(), tolerance(1e-12));
  echoes[0] = {AltitudeStatus::kUnavailable, 0};
  const DvlReading two = read_dvl(dvl, kSensor, 0, state, echoes, 0);
  EXPECT_FALSE(two.valid);
  EXPECT_EQ(two.ground_velocity_body_mps, Vec3::Zero());
  EXPECT_EQ(two.beam_speed_mps[0], 0);
}

// sigma / (sqrt(2) sin J) along the hull and across, sigma / (2 cos J) down; 4 standard deviations of a
// variance.
TEST(DopplerLog, NoiseOfTheVelocityIsThatOfTheGeometry) {
  const DvlSettings dvl{.errors = {.noise = 0.01}};
  constexpr int kSamples = 20'000;
  Vec3 squares = Vec3::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 error = ping_over_flat(dvl, moving(), i).ground_velocity_body_mps - Vec3(2, 0.3, -0.2);
    squares += error.cwiseAbs2() / kSamples;
  }
  const double s = std::sin(dvl.beam_angle_rad), c = std::cos(dvl.beam_angle_rad);
  const double level = 1e-4 / (2 * s * s), down = 1e-4 / (4 * c * c), share = 4 * std::sqrt(2.0 / kSamples);
  EXPECT_NEAR(squares.x(), level, share * level);
  EXPECT_NEAR(squares.y(), level, share * level);
  EXPECT_NEAR(squares.z(), down, share * down);
}

TEST(DopplerLog, AMisalignmentTurnsTheVelocity) {
  const DvlSettings dvl{.misalignment_rad = 0.02};
  VehicleState ahead;
  ahead.position_ned_m.z() = 30;
  ahead.velocity_body[0] = 2;
  const Vec3 v = ping_over_flat(dvl, ahead).ground_velocity_body_mps;
  EXPECT_NEAR(std::atan2(v.y(), v.x()), -0.02, tolerance(1e-12));
}

TEST(DopplerLog, AScaleErrorScalesAndBeamsDropOutOneByOne) {
  EXPECT_NEAR(ping_over_flat({.scale_error = 0.01}, moving()).ground_velocity_body_mps.x(), 2.02,
              tolerance(1e-12));
  const DvlSettings dvl{.errors = {.dropout = 0.2}};
  constexpr int kPings = 5000;
  int locked = 0, valid = 0;
  for (int i = 0; i < kPings; ++i) {
    const DvlReading r = ping_over_flat(dvl, moving(), i);
    for (const Echo& beam : r.beams) locked += beam.status == AltitudeStatus::kMeasured;
    valid += r.valid;
  }
  EXPECT_NEAR(locked / (4.0 * kPings), 0.8, 4 * std::sqrt(0.16 / (4 * kPings)));
  const double three_or_four = std::pow(0.8, 4) + 4 * 0.2 * std::pow(0.8, 3);
  EXPECT_NEAR(valid / static_cast<double>(kPings), three_or_four,
              4 * std::sqrt(three_or_four * (1 - three_or_four) / kPings));
}

TEST(DopplerLog, BeyondItsRangeThereIsNoLock) {
  EXPECT_TRUE(ping_over_flat({.range_m = 60}, moving()).valid);
  EXPECT_FALSE(ping_over_flat({.range_m = 25}, moving()).valid);
}

TEST(Sonar, RaysFanOutEvenlyAboutTheBow) {
  const SonarSettings sonar{.rays = 5, .sector_rad = kPi / 2};
  const std::vector<double> azimuths = sonar_azimuths_rad(sonar);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(azimuths[i], kPi / 8 * (static_cast<double>(i) - 2), tolerance(1e-12));
  const VehicleState level;
  const auto beams = sonar_beams(sonar, level);
  EXPECT_LT((beams[2].direction_ned - Vec3::UnitX()).norm(), tolerance(1e-12));
  EXPECT_GT(beams[4].direction_ned.y(), 0.7);  // starboard last
  EXPECT_EQ(sonar_azimuths_rad({.rays = 1}), std::vector<double>{0});
}

// A fan tilted by t below the bow, d above a flat seabed: its middle ray is d / sin t long, one at azimuth a
// d / (sin t cos a).
TEST(Sonar, TiltedFanMeetsAFlatSeabedWhereItShould) {
  const SonarSettings sonar{.rays = 9, .sector_rad = 1, .tilt_rad = 0.5, .range_m = 100};
  VehicleState level;
  const auto echoes = echoes_of_plane(sonar_beams(sonar, level), {0, 0, 10}, -Vec3::UnitZ());
  const auto azimuths = sonar_azimuths_rad(sonar);
  for (std::size_t i = 0; i < echoes.size(); ++i)
    EXPECT_NEAR(echoes[i].range_m, 10 / (std::sin(0.5) * std::cos(azimuths[i])), tolerance(1e-9));
}

TEST(Sonar, RaysHaveNoiseOfTheirOwn) {
  const SonarSettings sonar{.rays = 512, .errors = {.noise = 0.1, .bias = 0.5}};
  std::vector<Echo> echoes(512, {AltitudeStatus::kMeasured, 20});
  const auto read = read_sonar(sonar, {1, 1, SensorKind::kSonar}, 3, echoes);
  double mean = 0, square = 0;
  for (const Echo& echo : read) {
    mean += (echo.range_m - 20) / 512;
    square += (echo.range_m - 20.5) * (echo.range_m - 20.5) / 512;
  }
  EXPECT_NEAR(mean, 0.5, 4 * 0.1 / std::sqrt(512));
  EXPECT_NEAR(square, 0.01, 4 * 0.01 * std::sqrt(2.0 / 512));
}

TEST(Sonar, WhatIsNotKnownStaysSo) {
  const auto read =
      read_sonar({}, {1, 1, SensorKind::kSonar}, 0,
                 std::vector<Echo>{{AltitudeStatus::kUnavailable, 0}, {AltitudeStatus::kNoBottom, 0}});
  EXPECT_EQ(read[0].status, AltitudeStatus::kUnavailable);
  EXPECT_EQ(read[1].status, AltitudeStatus::kNoBottom);
}

}  // namespace
}  // namespace halocline::vehicle_sim
