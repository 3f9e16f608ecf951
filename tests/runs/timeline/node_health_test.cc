// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/node_health.h"

#include <gtest/gtest.h>

#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using testing::kSecond;

node_status_t status(std::int64_t session, std::int64_t gaps) {
  node_status_t s{};
  s.session = session;
  s.gaps = gaps;
  return s;
}

sim_clock_t clock(std::int64_t utime) {
  sim_clock_t c{};
  c.utime = utime;
  return c;
}

TEST(NodeHealth, CountersAreThoseOfTheLastStatus) {
  NodeHealth health;
  health.add_status(1 * kSecond, "bathymetry", status(7, 2));
  health.add_status(2 * kSecond, "bathymetry", status(7, 3));
  health.add_status(2 * kSecond, "autopilot", status(8, 10));
  EXPECT_EQ(health.nodes().at("bathymetry").status.gaps, 3);
  EXPECT_EQ(health.nodes().at("autopilot").status.gaps, 10);
  EXPECT_EQ(health.nodes().at("bathymetry").statuses, 2);
}

TEST(NodeHealth, TheGreatestLatenessOfTheRunTellsWhetherRealTimeWasHeld) {
  NodeHealth health;
  node_status_t s = status(7, 0);
  s.lateness_limit_s = 0.05;
  for (const double max_s : {0.01, 0.06, 0.02}) {
    s.lateness_max_s = max_s;
    health.add_status(1 * kSecond, "channel-server", s);
    EXPECT_EQ(health.nodes().at("channel-server").held_real_time(), max_s == 0.01);
  }
  EXPECT_EQ(health.nodes().at("channel-server").lateness_max_s, 0.06);
}

TEST(NodeHealth, ASilenceEndsWithAStatusOrAHeartbeat) {
  NodeHealth health;
  health.add_status(1 * kSecond, "bathymetry", status(7, 0));
  health.add_heartbeat(4 * kSecond, "bathymetry");
  health.add_status(9 * kSecond, "bathymetry", status(9, 0));
  EXPECT_EQ(health.nodes().at("bathymetry").longest_silence_us, 5 * kSecond);
  EXPECT_EQ(health.nodes().at("bathymetry").incarnations, 2);
}

TEST(NodeHealth, TheFactorIsSimulatedTimeOverTheRecordersTime) {
  NodeHealth health;
  EXPECT_FALSE(health.real_time_factor());
  for (std::int64_t i = 0; i < 100; ++i)
    health.add_clock(1000 * kSecond + i * kSecond, clock(i * 3 * kSecond));
  EXPECT_DOUBLE_EQ(health.real_time_factor().value(), 3);
}

TEST(NodeHealth, ALogStampedWithSimulationTimeHasNoFactor) {
  NodeHealth health;
  for (std::int64_t i = 0; i < 10; ++i) health.add_clock(i * kSecond, clock(i * kSecond));
  EXPECT_FALSE(health.real_time_factor());
}

}  // namespace
}  // namespace halocline::clients
