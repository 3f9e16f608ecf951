// SPDX-License-Identifier: BSD-3-Clause
// Navigation error after minutes by the vehicle's own sensors, from its true motion through messages to
// its reckoning.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <variant>

#include <gtest/gtest.h>

#include "clients/onboard/autopilot/autopilot_messages.h"
#include "clients/onboard/autopilot/control_laws.h"
#include "clients/onboard/autopilot/guidance.h"
#include "clients/onboard/autopilot/navigation/attitude_keeper.h"
#include "clients/onboard/autopilot/navigation/navigator.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/model_library.h"
#include "vehicle_sim/sensor_station.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"
#include "vehicle_sim/vehicle_sim_messages.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;
using vehicle_sim::DvlPing;
using vehicle_sim::Fleet;
using vehicle_sim::GpsFix;
using vehicle_sim::SensorReading;
using vehicle_sim::SensorSettings;
using vehicle_sim::SensorStation;
using vehicle_sim::SensorTick;

constexpr double kCurrent = 0.2, kMinutes = 10;
constexpr SimDuration kPeriod = SimDuration::from_milliseconds(200);
const Vec3 kStart(100, -50, 30);

// A torpedo under way towards the north-east across a current towards the south-east.
Fleet torpedo() {
  vehicle_sim::FleetSettings settings;
  settings.current.uniform_ned_mps = Vec3(-kCurrent, kCurrent, 0) / std::numbers::sqrt2;
  vehicle_sim::VehicleState start;
  start.position_ned_m = kStart;
  start.orientation = to_quaternion({0, 0, std::numbers::pi / 4});
  start.velocity_body.head<3>() =
      1.5 * Vec3::UnitX() + start.orientation.conjugate() * settings.current.uniform_ned_mps;
  const auto model = std::make_shared<const vehicle_sim::Model>(*vehicle_sim::programmed_model("torpedo"));
  return Fleet(settings, {{"auv", model, start}}, nullptr, SimTime());
}

// Even seabed at 90 m.
void answer(SensorTick& tick) {
  for (std::size_t i = 0; i < tick.beams.size(); ++i) {
    const auto& beam = tick.beams[i];
    const double range = (90 - beam.origin_ned_m.z()) / beam.direction_ned.z();
    if (range > 0 && range <= beam.range_m) tick.echoes[i] = {vehicle_sim::AltitudeStatus::kMeasured, range};
  }
}

struct Way {
  double error_m = 0;      // of the reckoned place at the end
  double deviation_m = 0;  // that the navigator gives
};

Way way_with(const SensorSettings& sensors, double minutes = kMinutes) {
  Fleet fleet = torpedo();
  SensorStation station({{1, sensors}}, 1, kPeriod, 100);
  Navigator navigator(kStart, {});
  AttitudeKeeper attitude(NavigatorRules{}.gyro_bias_radps);
  std::optional<vehicle_dvl_t> ping;
  const SimTime end = SimTime::from_seconds(60 * minutes);
  for (SimTime now = station.next(); now <= end; now = station.next()) {
    EXPECT_EQ(fleet.command(0, {now, {.propeller_hz = 15}}), vehicle_sim::CommandVerdict::kTaken);
    fleet.advance(now);
    for (SensorTick& tick : station.take(fleet, 4096)) {
      answer(tick);
      for (const auto& job : tick.jobs) {
        if (const auto* noted = std::get_if<SensorReading>(&job.sample)) {
          const auto message = to_sensors_message(now, station.finish(tick, job, *noted));
          attitude.add(to_attitude_reading(message));
          navigator.add(to_navigation_sample(message, attitude, ping));
        } else if (const auto* fix = std::get_if<GpsFix>(&job.sample)) {
          if (now > SimTime()) take_in(to_gps_message(now, *fix, sensors.gps.errors.noise), navigator);
        } else if (const auto* out = std::get_if<DvlPing>(&job.sample)) {
          ping = to_dvl_message(now, station.finish(tick, job, *out), sensors.dvl.errors.noise);
        }
      }
    }
  }
  const Vec3 off = navigator.position_ned_m(end.seconds()) - fleet.state_at(0, end).position_ned_m;
  return {off.head<2>().norm(), navigator.deviation_m()};
}

SensorSettings with_doppler_log() {
  SensorSettings s;
  s.dvl.period = SimDuration::from_milliseconds(250);
  s.dvl.scale_error = 0.003;
  s.dvl.errors.noise = 0.01;
  return s;
}

// The current is all that is wrong; the trim of the hull and the start take a little.
TEST(NavigationTest, BySpeedThroughTheWaterTheErrorIsTheCurrentTimesTheTime) {
  EXPECT_NEAR(way_with({}).error_m, 60 * kMinutes * kCurrent, 1);
}

// 0.3 % of about 900 m, and noise of 14 mm/s four times a second: 0.2 m after 10 minutes.
TEST(NavigationTest, ADopplerLogLeavesItsScaleError) {
  const Way way = way_with(with_doppler_log());
  EXPECT_LT(way.error_m, tolerance(3.5));
  EXPECT_GT(way.error_m, 2);
  EXPECT_GT(way.deviation_m, way.error_m);  // the deviation covers the error
}

TEST(NavigationTest, ADopplerLogWithoutErrorsLeavesTheLagOfItsPings) {
  SensorSettings s;
  s.dvl.period = kPeriod;
  EXPECT_LT(way_with(s).error_m, tolerance(0.05));
}

TEST(NavigationTest, OneFixAtTheEndTakesAwayWhatTheCurrentDid) {
  SensorSettings s;
  s.gps.period = SimDuration::from_seconds(60 * kMinutes);
  s.gps.max_depth_m = 1000;  // an antenna on a float
  s.gps.errors.noise = 2;
  const Way way = way_with(s);
  EXPECT_LT(way.error_m, 4 * 2 + 0.2);  // 4 standard deviations, and what the gain leaves of 120 m
  EXPECT_NEAR(way.deviation_m, 2, 0.1);
}

struct Kept {
  double heading_off_rad = 0;  // of the true heading at the end from the one steered for
  double deviation_rad = 0;    // as the vehicle estimates it
  double max_off_rad = 0;      // of the reckoned heading from the true one
};

// The torpedo keeps its heading for ten minutes with the autopilot's fins; the compass fails after one.
Kept way_without_compass(double gyro_bias_radps) {
  Fleet fleet = torpedo();
  SensorSettings sensors;
  sensors.gyro.errors.bias = gyro_bias_radps;
  SensorStation station({{1, sensors}}, 1, kPeriod, 100);
  EXPECT_TRUE(fleet.apply_fault(0, {.from = SimTime::from_seconds(60),
                                    .kind = vehicle_sim::FaultKind::kDeadSensor,
                                    .sensor = vehicle_sim::SensorKind::kCompass}));
  AttitudeKeeper attitude(gyro_bias_radps);
  Integrals integrals;
  const double course = std::numbers::pi / 4;
  const SetPoints points{.course_rad = course, .z_ned_m = kStart.z(), .speed_mps = 1.5};
  Kept kept;
  const SimTime end = SimTime::from_seconds(60 * kMinutes);
  for (SimTime now = station.next(); now <= end; now = station.next()) {
    fleet.advance(now);
    const double truth = to_euler(fleet.state_at(0, now).orientation).yaw;
    for (SensorTick& tick : station.take(fleet, 4096)) {
      for (const auto& job : tick.jobs) {
        const auto* noted = std::get_if<SensorReading>(&job.sample);
        if (noted == nullptr) continue;
        const auto m = to_sensors_message(now, station.finish(tick, job, *noted));
        attitude.add(to_attitude_reading(m));
        const EulerAngles& a = attitude.attitude();
        const ActuatorCommand c = command(Gains{}, points,
                                          {m.depth_m, a.yaw, a.pitch, m.angular_rate_body_radps[1],
                                           m.angular_rate_body_radps[2], m.water_speed_mps},
                                          kPeriod.seconds(), integrals);
        EXPECT_EQ(fleet.command(0, {now, {c.rudder_rad, c.stern_plane_rad, c.propeller_rpm / 60}}),
                  vehicle_sim::CommandVerdict::kTaken);
        kept.max_off_rad = std::max(kept.max_off_rad, std::abs(a.yaw - truth));
      }
    }
    kept.heading_off_rad = truth - course;
  }
  kept.deviation_rad = attitude.heading_deviation_rad();
  return kept;
}

// The bias times nine minutes; its part about the other axes tilts the reckoned axes by as much, which is of
// second order.
TEST(NavigationTest, WithAFailedCompassTheHeadingIsOffByTheGyrosBiasTimesTheTime) {
  const double bias = std::numbers::pi / 180 * 0.01, drift = bias * 60 * (kMinutes - 1);
  const Kept kept = way_without_compass(bias);
  EXPECT_NEAR(kept.heading_off_rad, -drift, 0.1 * drift);
  EXPECT_LT(kept.max_off_rad, 1.1 * drift);
  EXPECT_NEAR(kept.deviation_rad, drift, 0.01 * drift);
}

TEST(NavigationTest, AGyroWithoutBiasReplacesACompass) {
  const Kept kept = way_without_compass(0);
  EXPECT_LT(std::abs(kept.heading_off_rad), std::numbers::pi / 180 * 0.5);
  EXPECT_LT(kept.max_off_rad, std::numbers::pi / 180 * 0.5);
}

TEST(NavigationTest, AnUnseenBottomLeavesTheSpeedThroughTheWater) {
  SensorSettings s = with_doppler_log();
  s.dvl.range_m = 20;
  Fleet fleet = torpedo();
  SensorStation station({{1, s}}, 1, kPeriod, 100);
  auto ticks = station.take(fleet, 4096);
  answer(ticks[0]);
  for (const auto& job : ticks[0].jobs) {
    const auto* out = std::get_if<DvlPing>(&job.sample);
    if (out != nullptr) {
      EXPECT_FALSE(to_dvl_message(SimTime(), station.finish(ticks[0], job, *out), 0).ground_velocity_valid);
    }
  }
}

}  // namespace
}  // namespace halocline::clients
