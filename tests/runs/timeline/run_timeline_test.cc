// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/run_timeline.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using testing::add;
using testing::kSecond;
using testing::outcome;
using testing::receipt;
using testing::send;
using testing::state;

TEST(RunTimeline, AVehicleIsMetByItsChannelAndItsId) {
  RunTimeline store;
  add(store, "STATE.auv-1", state(4, 0, 1));
  add(store, "STATE.auv-2", state(9, 0, 2));
  ASSERT_EQ(store.vehicles().size(), 2u);
  EXPECT_EQ(store.vehicles()[1].index, 1u);
  EXPECT_EQ(store.find("auv-1")->id, 4);
  EXPECT_EQ(store.find(9)->name, "auv-2");
  EXPECT_EQ(store.name(9), "auv-2");
  EXPECT_EQ(store.name(5), "5");
}

TEST(RunTimeline, AVehicleThatWasKnownByItsIdGetsItsName) {
  RunTimeline store;
  add(store, "OUTCOME", outcome(4, 5, 0, 0));
  EXPECT_EQ(store.find(4)->name, "4");
  add(store, "STATE.auv-1", state(4, kSecond, 1));
  EXPECT_EQ(store.vehicles().size(), 2u);
  EXPECT_EQ(store.name(4), "auv-1");
  EXPECT_EQ(store.find("auv-1")->index, 0u);
}

TEST(RunTimeline, ANameMetBeforeItsIdTakesTheIdFromWhatHadItAlone) {
  RunTimeline store;
  add(store, "COMMAND.auv-1", vehicle_command_t{});
  add(store, "OUTCOME", outcome(4, 5, 0, 0));
  add(store, "STATE.auv-1", state(4, kSecond, 1));
  EXPECT_EQ(store.name(4), "auv-1");
  EXPECT_EQ(store.find(4)->track.size(), 1u);
}

TEST(RunTimeline, PacketsAreJoinedAcrossChannels) {
  RunTimeline store;
  add(store, "STATE.auv-1", state(4, 0, 1));
  add(store, "SEND.auv-1", send(4, 0, 10 * kSecond));
  add(store, "RECEIPT.auv-1", receipt(0, 10 * kSecond));
  add(store, "OUTCOME", outcome(4, 5, 0, 10 * kSecond));
  add(store, "REPAIR.OUTCOME", outcome(4, 5, 0, 10 * kSecond));
  ASSERT_EQ(store.packets().all().size(), 1u);
  EXPECT_EQ(store.packets().all()[0].outcomes.size(), 1u);
  EXPECT_EQ(sum(store.ledger().total()), 1);
  EXPECT_EQ(store.repeated_outcomes(), 1);
}

TEST(RunTimeline, WhatIsUnknownOrDamagedIsCounted) {
  RunTimeline store;
  store.add(0, "PICTURE", std::vector<std::uint8_t>{1, 2, 3});
  store.add(0, "STATE.auv-1", std::vector<std::uint8_t>{1, 2, 3});
  store.add(0, "STATE.no name", bus::encoded(state(1, 0, 0)));
  EXPECT_EQ(store.counts().messages, 3);
  EXPECT_EQ(store.counts().unknown, 2);
  EXPECT_EQ(store.counts().undecodable, 1);
  EXPECT_TRUE(store.vehicles().empty());
  EXPECT_GT(store.begin(), store.end());
}

TEST(RunTimeline, TimesOfAnotherEpochAreShiftedAndThoseOfAnotherClockHoldNow) {
  const std::int64_t unix_us = 1'800'000'000 * kSecond;
  RunTimeline store({unix_us, unix_us + 500 * kSecond});
  add(store, "STATE.auv-1", state(1, unix_us + 3 * kSecond, 30));
  add(store, "STATE.auv-2", state(2, 0, 50));  // no clock
  add(store, "OUTCOME", outcome(1, 2, 0, unix_us + 4 * kSecond));
  EXPECT_EQ(store.find("auv-1")->track.back().at, SimTime::from_seconds(3));
  EXPECT_EQ(store.find("auv-2")->track.back().at, SimTime::from_seconds(3));
  EXPECT_EQ(store.packets().all()[0].departure, SimTime::from_seconds(4));
  EXPECT_EQ(store.counts().without_time, 1);
}

TEST(RunTimeline, AForeignStateMayLackItsIdAndOrientation) {
  RunTimeline store;
  vehicle_state_t bare = state(0, kSecond, 12);
  bare.orientation_wxyz[0] = 0;
  add(store, "STATE.visitor", bare);
  ASSERT_NE(store.find("visitor"), nullptr);
  EXPECT_EQ(store.find("visitor")->id, 0);
  EXPECT_EQ(store.find("visitor")->track.back().value.attitude.yaw, 0);
  bare.position_ned_m[0] = std::numeric_limits<double>::quiet_NaN();
  add(store, "STATE.visitor", bare);
  EXPECT_EQ(store.counts().undecodable, 1);
}

TEST(RunTimeline, TheTimeOfARunIsThatOfItsStatesAndOutcomes) {
  RunTimeline store;
  add(store, "STATE.auv-1", state(1, 5 * kSecond, 0));
  add(store, "SEND.auv-1", send(1, 0, 900 * kSecond));  // for later
  add(store, "OUTCOME", outcome(1, 2, 0, 7 * kSecond));
  EXPECT_EQ(store.begin(), SimTime::from_seconds(5));
  EXPECT_EQ(store.end(), SimTime::from_seconds(10));
}

TEST(RunTimeline, ALimitedHistoryForgetsWhatIsOlderButStillCountsIt) {
  RunTimeline store;
  store.limit_history(SimDuration::from_seconds(100));
  for (std::int64_t s = 0; s < 1000; ++s) {
    add(store, "STATE.auv-1", state(1, s * kSecond, static_cast<double>(s)));
    add(store, "OUTCOME", outcome(1, 2, s, s * kSecond));
  }
  EXPECT_LE(store.vehicles()[0].track.size(), 115u);
  EXPECT_GE(store.vehicles()[0].track.size(), 100u);
  EXPECT_LE(store.packets().all().size(), 115u);
  EXPECT_EQ(sum(store.ledger().total()), 1000);
  EXPECT_THROW(store.limit_history(SimDuration()), InvalidArgument);
}

TEST(RunTimeline, MemoryIsBoundedAndTheLedgerComplete) {
  RunTimeline store({}, {.samples = 1000, .link_rows = 100, .outcomes = 50});
  for (std::int64_t s = 0; s < 5000; ++s) {
    add(store, "STATE.auv-1", state(1, s * kSecond, static_cast<double>(s)));
    add(store, "OUTCOME", outcome(1, 2, s, s * kSecond));
    link_table_t table{};
    table.utime = s * kSecond;
    table.vehicle_id = 1;
    table.num_peers = 1;
    table.peers.resize(1);
    table.peers[0].first_path_doppler_factor = 1;
    add(store, "LINKS.auv-1", table);
  }
  EXPECT_LE(store.vehicles()[0].track.size(), 1000u);
  EXPECT_GE(store.vehicles()[0].track.size(), 400u);
  EXPECT_LE(store.links().row_count(), 100u);
  EXPECT_LE(store.packets().outcome_count(), 50u);
  EXPECT_EQ(sum(store.ledger().total()), 5000);
  // What was kept lies where it was, from the first instant to the last.
  const auto half = state_at(store.vehicles()[0].track, SimTime::from_seconds(2500));
  EXPECT_DOUBLE_EQ(half->point.position_ned_m.x(), 2500);
  EXPECT_EQ(store.vehicles()[0].track.back().value.position_ned_m.x(), 4999);
}

TEST(RunTimeline, MoreVehiclesThanSamplesAreKeptAllTheSame) {
  RunTimeline store({}, {.samples = 10, .link_rows = 1, .outcomes = 1});
  for (int v = 1; v <= 40; ++v) add(store, "STATE.v" + std::to_string(v), state(v, 0, v));
  EXPECT_EQ(store.vehicles().size(), 40u);
  for (const VehicleRecord& vehicle : store.vehicles()) EXPECT_EQ(vehicle.track.size(), 1u);
}

}  // namespace
}  // namespace halocline::clients
