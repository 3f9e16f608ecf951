// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/paced_time.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "bus/transport/transport.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

class PacedTimeTest : public ::testing::Test {
 protected:
  lcm::LCM lcm_{"memq://"};
};

TEST_F(PacedTimeTest, StartsAtZeroOnASilentBusWhenItHasListened) {
  PacedTime time(lcm_, 4);
  EXPECT_FALSE(time.now(at(3)).has_value());
  EXPECT_EQ(time.steady_at(at(0)), at(3) + PacedTime::kListening);
  EXPECT_FALSE(time.now(at(3) + SimDuration::from_milliseconds(1199)).has_value());
  EXPECT_EQ(time.now(at(4.2)), at(0));
  EXPECT_EQ(time.now(at(5.2)), at(4));
  EXPECT_EQ(time.steady_at(at(8)), at(6.2));
}

TEST_F(PacedTimeTest, ContinuesTheTimeOfARunningSystem) {
  PacedTime time(lcm_, 2);
  time.now(at(1));
  time.set_steady(at(1.5));
  time.on_utime(100'000'000);
  time.set_steady(at(2));
  time.on_utime(100'500'000);  // older than the first: 101 is due by now
  EXPECT_EQ(time.now(at(2.5)), at(102));
}

TEST_F(PacedTimeTest, ReceivesStatesAndStatuses) {
  PacedTime time(lcm_, 1);
  bus::Bus publisher(lcm_, {"publisher", 1});
  time.now(at(0));
  time.set_steady(at(0));
  node_status_t status{};
  status.utime = 50'000'000;
  status.session = status.sequence = 1;
  status.messages_received = status.messages_sent = status.messages_refused = 0;
  status.messages_unsent = status.duplicate_publishers = 0;
  status.gaps = status.repaired = status.late = 0;
  status.node_name = "vehicle-sim";
  publisher.publish("STATUS.vehicle-sim", status);
  while (lcm_.handleTimeout(0) > 0) {
  }
  EXPECT_EQ(time.now(at(2)), at(52));
}

TEST_F(PacedTimeTest, ANodeThatKnowsNoTimeDoesNotSetIt) {
  PacedTime time(lcm_, 1);
  time.now(at(0));
  time.on_utime(0);
  EXPECT_EQ(time.now(at(2)), at(0));
}

TEST_F(PacedTimeTest, OneStrayMessageDoesNotSetIt) {
  for (const std::int64_t stray_s : {3'600, 315'576'000}) {
    PacedTime time(lcm_, 1);
    time.now(at(0));
    for (const std::int64_t sim_s : {50ll, static_cast<long long>(stray_s), 51ll})
      time.on_utime(sim_s * 1'000'000);
    EXPECT_EQ(time.now(at(2)), at(53));
  }
}

sim_clock_t clock_of(std::int64_t session, std::int64_t utime) {
  sim_clock_t clock{};
  clock.session = session;
  clock.utime = utime;
  return clock;
}

TEST_F(PacedTimeTest, WhereAnotherConductorRunsItDoesNotStart) {
  PacedTime time(lcm_, 1);
  time.now(at(0));
  for (const double steady_s : {0.5, 0.6}) {
    time.set_steady(at(steady_s));
    time.on_clock(clock_of(7, at(steady_s).to_utime()));
  }
  EXPECT_THROW(time.now(at(1.3)), bus::NetworkError);
}

TEST_F(PacedTimeTest, AnOldClockAgainAndAgainIsNoOtherConductor) {
  PacedTime time(lcm_, 1);
  time.now(at(0));
  for (const double steady_s : {0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1}) {
    time.set_steady(at(steady_s));
    time.on_clock(clock_of(7, 1'000'000));
  }
  EXPECT_TRUE(time.now(at(1.3)).has_value());
}

TEST_F(PacedTimeTest, OneClockOrOnesThatHaveEndedDoNotKeepItFromStarting) {
  PacedTime one(lcm_, 1), ended(lcm_, 1);
  one.now(at(0));
  one.set_steady(at(1));
  one.on_clock(clock_of(7, 1'000'000));
  EXPECT_TRUE(one.now(at(1.3)).has_value());
  ended.now(at(0));
  ended.set_steady(at(0.1));
  for (int i = 0; i < 5; ++i) ended.on_clock(clock_of(7, 1'000'000 + i));
  EXPECT_TRUE(ended.now(at(1.3)).has_value());
}

TEST_F(PacedTimeTest, OnceRunningItIgnoresOtherTimes) {
  PacedTime time(lcm_, 1);
  time.now(at(0));
  time.now(at(2));
  time.on_utime(900'000'000);
  EXPECT_EQ(time.now(at(3)), at(1));
}

TEST_F(PacedTimeTest, ARateIsAboveZero) {
  EXPECT_THROW(PacedTime(lcm_, 0), InvalidArgument);
  EXPECT_THROW(PacedTime(lcm_, -1), InvalidArgument);
}

// Simulation time is a multiple of the steady clock's, not a sum of steps: after a day it is off by no more
// than a rounding of doubles, however often it was read.
TEST_F(PacedTimeTest, DoesNotDriftInADay) {
  for (const double rate : {1.0, 0.1, 3.7, 1000.0}) {
    PacedTime time(lcm_, rate);
    time.now(at(0));
    const double start_s = PacedTime::kListening.seconds();
    ASSERT_EQ(time.now(at(start_s)), at(0));
    for (double steady = start_s; steady < 86'400; steady += 0.37) {
      const double expected = (steady - start_s) * rate;
      ASSERT_NEAR(time.now(at(steady))->seconds(), expected, 1e-6 * std::max(1.0, rate)) << "rate " << rate;
    }
  }
}

}  // namespace
}  // namespace halocline::conductor
