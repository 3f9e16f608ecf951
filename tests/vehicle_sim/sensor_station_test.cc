// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensor_station.h"

#include <array>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/model_library.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr SimDuration kPeriod = SimDuration::from_milliseconds(200);
using halocline::testing::at_ms;

Fleet fleet_of(std::size_t count, double depth = 20) {
  const auto model = std::make_shared<const Model>(*programmed_model("torpedo"));
  std::vector<FleetMember> members;
  for (std::size_t i = 0; i < count; ++i) {
    VehicleState start;
    start.position_ned_m = {20.0 * static_cast<double>(i), 0, depth};
    start.velocity_body[0] = 1.5;
    members.push_back({"v", model, start});
  }
  return Fleet({}, members, nullptr, SimTime());
}

SensorSettings all_sensors() {
  SensorSettings s;
  s.depth.errors.noise = 0.1;
  s.gyro.errors = {.noise = 0.01, .bias = 0, .walk = 0.001, .dropout = 0.1};
  s.dvl.period = SimDuration::from_milliseconds(250);
  s.dvl.errors = {.noise = 0.01, .bias = 0, .walk = 0.001, .dropout = 0.1};
  s.gps.period = SimDuration::from_milliseconds(1000);
  s.gps.errors.noise = 2;
  s.sonar.period = SimDuration::from_milliseconds(500);
  s.sonar.rays = 7;
  return s;
}

SensorStation station_of(std::size_t count, const SensorSettings& settings = all_sensors()) {
  std::vector<SensorStation::Vehicle> vehicles;
  for (std::size_t i = 0; i < count; ++i) vehicles.push_back({static_cast<std::int32_t>(i + 1), settings});
  return {std::move(vehicles), 5, kPeriod, 100};
}

// Flat seabed at 50 m.
void answer(SensorTick& tick) {
  for (std::size_t i = 0; i < tick.beams.size(); ++i) {
    const EchoBeam& beam = tick.beams[i];
    const double range = (50 - beam.origin_ned_m.z()) / beam.direction_ned.z();
    const bool hit = range > 0 && range <= beam.range_m;
    tick.echoes[i] = {hit ? AltitudeStatus::kMeasured : AltitudeStatus::kNoBottom, hit ? range : 0};
  }
}

// How often each kind measured, until `end`, and all numbers of all Doppler logs and depths by vehicle and
// instant.
struct Record {
  std::array<int, 4> jobs = {};  // SENSORS, GPS, DVL, sonar
  std::map<std::pair<std::size_t, std::int64_t>, std::array<double, 3>> dvl, basic;
};
Record record(SensorStation& station, Fleet& fleet, SimTime end) {
  Record record;
  while (station.next() <= end) {
    fleet.advance(station.next());
    for (SensorTick& tick : station.take(fleet, 4096)) {
      answer(tick);
      for (const SensorJob& job : tick.jobs) {
        ++record.jobs[job.sample.index()];
        const std::pair key(job.vehicle, tick.when.to_utime());
        if (const auto* ping = std::get_if<DvlPing>(&job.sample)) {
          const Vec3 v = station.finish(tick, job, *ping).ground_velocity_body_mps;
          record.dvl[key] = {v.x(), v.y(), v.z()};
        } else if (const auto* noted = std::get_if<SensorReading>(&job.sample)) {
          const SensorReading r = station.finish(tick, job, *noted);
          record.basic[key] = {r.depth_m, r.altitude.range_m, r.angular_velocity_body_radps.z()};
        }
      }
    }
  }
  return record;
}

TEST(SensorStation, EachSensorMeasuresAtItsRate) {
  Fleet fleet = fleet_of(2, 0.1);
  SensorStation station = station_of(2);
  const Record r = record(station, fleet, at_ms(1999));
  EXPECT_EQ(r.jobs[0], 2 * 10);
  EXPECT_EQ(r.jobs[1], 2 * 2);
  EXPECT_EQ(r.jobs[2], 2 * 8);
  EXPECT_EQ(r.jobs[3], 2 * 4);
}

TEST(SensorStation, GpsHasNoFixUnderWater) {
  Fleet fleet = fleet_of(1, 5);
  SensorStation station = station_of(1);
  EXPECT_EQ(record(station, fleet, at_ms(5000)).jobs[1], 0);
}

TEST(SensorStation, WhatAVehicleMeasuresDoesNotDependOnOtherVehicles) {
  Fleet one = fleet_of(1), five = fleet_of(5);
  SensorStation alone = station_of(1), among = station_of(5);
  const Record a = record(alone, one, at_ms(10'000)), b = record(among, five, at_ms(10'000));
  for (const auto& [key, values] : a.dvl) EXPECT_EQ(values, b.dvl.at(key));
  for (const auto& [key, values] : a.basic) EXPECT_EQ(values, b.basic.at(key));
}

TEST(SensorStation, StartedLaterItMeasuresTheSame) {
  Fleet early = fleet_of(1), late = fleet_of(1);
  SensorSettings settings = all_sensors();
  settings.gyro.errors.dropout = 0;  // what is held depends on what came before
  SensorStation first = station_of(1, settings), second = station_of(1, settings);
  const Record a = record(first, early, at_ms(6000));
  late.advance(at_ms(4000));
  second.begin(at_ms(4000));
  const Record b = record(second, late, at_ms(6000));
  EXPECT_EQ(b.dvl.size(), 9u);
  for (const auto& [key, values] : b.dvl) EXPECT_EQ(values, a.dvl.at(key));
  for (const auto& [key, values] : b.basic) EXPECT_EQ(values, a.basic.at(key));
}

TEST(SensorStation, BeamsAreSharedAmongMessagesAndEachJobKeepsItsOwn) {
  Fleet fleet = fleet_of(9);
  SensorStation station = station_of(9);
  const auto ticks = station.take(fleet, 30);  // 12 beams a vehicle: altimeter, Doppler log, sonar
  EXPECT_GE(ticks.size(), 4u);
  std::size_t beams = 0, jobs = 0;
  for (const SensorTick& tick : ticks) {
    EXPECT_LE(tick.beams.size(), 30u);
    beams += tick.beams.size();
    for (const SensorJob& job : tick.jobs) {
      ++jobs;
      ASSERT_LE(job.first_beam + job.beams, tick.beams.size());
      if (job.beams > 0) {
        EXPECT_EQ(tick.beams[job.first_beam].origin_ned_m.x(), 20.0 * static_cast<double>(job.vehicle));
      }
    }
  }
  EXPECT_EQ(beams, 9u * 12u);
  EXPECT_EQ(jobs, 9u * 3u);
}

// So its SENSORS come at the same place of an instant, whoever else there is.
TEST(SensorStation, AVehicleWithoutBeamsDoesNotWaitForTheEchoesOfOthers) {
  Fleet fleet = fleet_of(3);
  for (const SensorKind kind : {SensorKind::kDvl, SensorKind::kSonar, SensorKind::kAltimeter})
    EXPECT_TRUE(fleet.apply_fault(1, {.from = SimTime(), .kind = FaultKind::kDeadSensor, .sensor = kind}));
  SensorStation station = station_of(3);
  const auto ticks = station.take(fleet, 4096);
  ASSERT_EQ(ticks.size(), 2u);
  EXPECT_TRUE(ticks[0].beams.empty());
  ASSERT_EQ(ticks[0].jobs.size(), 1u);
  EXPECT_EQ(ticks[0].jobs[0].vehicle, 1u);
  EXPECT_EQ(ticks[1].jobs.size(), 2u * 3u);
  for (const SensorJob& job : ticks[1].jobs) EXPECT_NE(job.vehicle, 1u);
}

TEST(SensorStation, UnansweredBeamsLeaveAPingWithoutVelocity) {
  Fleet fleet = fleet_of(1);
  SensorStation station = station_of(1);
  const auto ticks = station.take(fleet, 4096);
  const SensorJob& job = ticks[0].jobs[1];
  const DvlReading ping = station.finish(ticks[0], job, std::get<DvlPing>(job.sample));
  EXPECT_FALSE(ping.valid);
  EXPECT_EQ(ping.beams[0].status, AltitudeStatus::kUnavailable);
}

TEST(SensorStation, DeadSensorsDoNotPing) {
  Fleet fleet = fleet_of(1, 0.1);
  for (const SensorKind kind :
       {SensorKind::kDvl, SensorKind::kGps, SensorKind::kSonar, SensorKind::kAltimeter})
    EXPECT_TRUE(fleet.apply_fault(0, {.from = SimTime(), .kind = FaultKind::kDeadSensor, .sensor = kind}));
  SensorStation station = station_of(1);
  const auto ticks = station.take(fleet, 4096);
  ASSERT_EQ(ticks.size(), 1u);
  EXPECT_EQ(ticks[0].jobs.size(), 1u);  // SENSORS alone
  EXPECT_TRUE(ticks[0].beams.empty());
}

TEST(SensorStation, AltimeterErrorsAreOnTopOfTheEcho) {
  SensorSettings settings;
  settings.altimeter.errors.bias = 0.5;
  Fleet fleet = fleet_of(1);
  SensorStation station = station_of(1, settings);
  const Record r = record(station, fleet, SimTime());
  EXPECT_NEAR(r.basic.begin()->second[1], 30.5, tolerance(1e-9));
}

}  // namespace
}  // namespace halocline::vehicle_sim
