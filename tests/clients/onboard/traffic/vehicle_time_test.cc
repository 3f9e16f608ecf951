// SPDX-License-Identifier: BSD-3-Clause
// What clocks show and when they will, against the formula of the clock.
#include "clients/onboard/clocks/vehicle_time.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "bus/messages/channels.h"
#include "bus/messages/messages.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "clients/onboard/clocks/clock_set_config.h"
#include "core/archive.h"
#include "core/sim_time.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

ClockSetConfig one_clock(const channel_server::ClockSettings& settings) {
  ClockSetConfig config;
  config.clocks = {{"late", 7, settings}};
  return config;
}

class VehicleTimeTest : public ::testing::Test {
 protected:
  void fix(std::int64_t utime) {
    vehicle_gps_t message{};
    message.utime = utime;
    surface_.publish(bus::channels::kGps.of("late"), message);
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  lcm::LCM lcm_{"memq://"};
  bus::Bus bus_{lcm_, {"traffic", 77}}, surface_{lcm_, {"vehicles", 78}};
};

TEST_F(VehicleTimeTest, WithoutAClockItIsSimulationTime) {
  const VehicleTime time(bus_, one_clock({.offset_s = 3}));
  const SimTime at = SimTime::from_nanoseconds(123'456'789);
  EXPECT_EQ(time.shown(4, at), at);
  EXPECT_EQ(time.due(4, at), at);
  EXPECT_EQ(time.instant_of(4, at, at), at);
}

TEST_F(VehicleTimeTest, IsDueWhenTheClockShowsIt) {
  for (const double offset_s : {-20.0, 0.5, 100.0}) {
    for (const double drift : {-1e-3, 0.0, 1e-3}) {
      const VehicleTime time(bus_, one_clock({.offset_s = offset_s, .drift = drift, .is_set_by_gps = false}));
      const SimTime wanted = SimTime::from_seconds(500);
      const SimTime due = time.due(7, wanted);
      EXPECT_NEAR(due.seconds(), (500 - offset_s) / (1 + drift), 2e-6) << offset_s << " " << drift;
      EXPECT_GE(time.shown(7, due), wanted);
      EXPECT_NEAR(time.instant_of(7, wanted, due).seconds(), due.seconds(), 2e-6);
    }
  }
}

TEST_F(VehicleTimeTest, ARandomWalkIsMetToo) {
  const VehicleTime time(bus_, one_clock({.random_walk = 1e-5, .is_set_by_gps = false}));
  for (int i = 1; i <= 200; ++i) {
    const SimTime wanted = SimTime::from_seconds(10.0 * i);
    const SimTime due = time.due(7, wanted);
    EXPECT_GE(time.shown(7, due), wanted);
    EXPECT_LT((time.shown(7, due) - wanted).seconds(), 5e-4) << i;
  }
}

// A clock that is 5 s slow shows 20 s at 20 s once the fix of 10 s counts, not at 25 s.
TEST_F(VehicleTimeTest, AFixThatIsNotInForceYetAdvancesWhatIsDue) {
  VehicleTime time(bus_, one_clock({.offset_s = -5, .gps_residual_s = 0}));
  EXPECT_EQ(time.due(7, SimTime::from_seconds(20)), SimTime::from_seconds(25));
  fix(10'000'000);
  time.set_now(SimTime::from_seconds(10));
  EXPECT_EQ(time.due(7, SimTime::from_seconds(20)), SimTime::from_seconds(20));
}

// What has passed by the clock is due now, never before the step: a node that is due in the past would not
// come to rest.
TEST_F(VehicleTimeTest, WhatHasPassedIsDueAtTheStep) {
  VehicleTime time(bus_, one_clock({.offset_s = 50, .is_set_by_gps = false}));
  time.set_now(SimTime::from_seconds(30));
  EXPECT_EQ(time.due(7, SimTime::from_seconds(60)), SimTime::from_seconds(30));
  EXPECT_EQ(time.due(7, SimTime::never()), SimTime::never());
  EXPECT_EQ(time.due(7, SimTime::at_once()), SimTime::at_once());
}

TEST_F(VehicleTimeTest, AFixSetsItAlsoAfterARestart) {
  const ClockSetConfig config = one_clock({.offset_s = 5, .gps_residual_s = 0});
  VehicleTime time(bus_, config);
  fix(10'000'000);
  EXPECT_EQ(time.shown(7, SimTime::from_seconds(10)), SimTime::from_seconds(15))
      << "before the lag has passed";
  EXPECT_EQ(time.shown(7, SimTime::from_seconds(20)), SimTime::from_seconds(20));
  Archive saved;
  saved(time);
  VehicleTime next(bus_, config);
  Archive loaded(saved.bytes());
  loaded(next);
  EXPECT_EQ(next.shown(7, SimTime::from_seconds(20)), SimTime::from_seconds(20));
}

}  // namespace
}  // namespace halocline::clients
