// How well a vehicle knows where it is after minutes by its sensors, from its true motion through messages to its reckoning.
#include <numbers>

#include <gtest/gtest.h>

#include "clients/autopilot/autopilot_messages.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/model_library.h"
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
  const auto model = std::make_shared<const vehicle_sim::Model>(*vehicle_sim::built_in_model("torpedo"));
  return Fleet(settings, {{"auv", model, start}}, nullptr, SimTime());
}

// Even ground at 90 m.
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
  std::optional<vehicle_dvl_t> ping;
  const SimTime end = SimTime::from_seconds(60 * minutes);
  for (SimTime now = station.next(); now <= end; now = station.next()) {
    fleet.command(0, {now, {.propeller_hz = 15}});
    fleet.advance(now);
    for (SensorTick& tick : station.take(fleet, 4096)) {
      answer(tick);
      for (const auto& job : tick.jobs) {
        if (const auto* noted = std::get_if<SensorReading>(&job.sample)) {
          navigator.add(
              to_navigation_sample(to_sensors_message(now, station.finish(tick, job, *noted)), ping));
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
  EXPECT_GT(way.deviation_m, way.error_m);  // it knows that it is off
}

TEST(NavigationTest, ADopplerLogWithoutErrorsLeavesTheLagOfItsPings) {
  SensorSettings s;
  s.dvl.period = kPeriod;
  EXPECT_LT(way_with(s).error_m, tolerance(0.05));
}

TEST(NavigationTest, OneFixAtTheEndTakesAwayWhatTheCurrentDid) {
  SensorSettings s;
  s.gps.period = SimDuration::from_seconds(60 * kMinutes);
  s.gps.greatest_depth_m = 1000;  // an antenna on a float
  s.gps.errors.noise = 2;
  const Way way = way_with(s);
  EXPECT_LT(way.error_m, 4 * 2 + 0.2);  // 4 standard deviations, and what the gain leaves of 120 m
  EXPECT_NEAR(way.deviation_m, 2, 0.1);
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
