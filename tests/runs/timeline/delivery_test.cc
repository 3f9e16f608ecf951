// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/delivery.h"

#include <gmock/gmock.h>

#include "runs/timeline/run_summary.h"
#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using testing::add;
using ::testing::HasSubstr;
using testing::kSecond;
using testing::outcome;
using testing::receipt;
using testing::send;
using testing::state;

void add_table(RunTimeline& store, double delivery_probability, double snr_db, std::int64_t utime) {
  link_table_t table{};
  table.utime = utime;
  table.vehicle_id = 1;
  table.num_peers = 1;
  table.peers.resize(1);
  table.peers[0].transmitter_id = 1;
  table.peers[0].receiver_id = 2;
  table.peers[0].first_path_doppler_factor = 1;
  table.peers[0].delivery_probability = delivery_probability;
  table.peers[0].snr_db = snr_db;
  add(store, "LINKS.a", table);
}

packet_outcome_t at_range(std::int64_t sequence, double range_m, std::int8_t result) {
  packet_outcome_t o = outcome(1, 2, sequence, sequence * 10 * kSecond, result);
  o.range_m = range_m;
  return o;
}

TEST(RoundStep, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(round_step(1), 1);
  EXPECT_DOUBLE_EQ(round_step(1.1), 2);
  EXPECT_DOUBLE_EQ(round_step(230), 500);
  EXPECT_DOUBLE_EQ(round_step(0.07), 0.1);
}

TEST(DeliveryByRange, CountsInStepsAndSetsThePredictionOfTheTableBeforeBesideIt) {
  RunTimeline store;
  add_table(store, 0.8, 10, 9 * kSecond);
  add_table(store, 0.4, 10, 15 * kSecond);
  add(store, "OUTCOME", at_range(1, 120, packet_outcome_t::RECEIVED));    // at 10 s
  add(store, "OUTCOME", at_range(2, 180, packet_outcome_t::BIT_ERRORS));  // at 20 s
  add(store, "OUTCOME", at_range(9, 990, packet_outcome_t::RECEIVED));    // at 90 s: no table that is fresh
  const auto ranges = delivery_by_range(store, 12);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_DOUBLE_EQ(ranges[0].from_m, 100);
  EXPECT_DOUBLE_EQ(ranges[0].to_m, 200);
  EXPECT_EQ(ranges[0].packets, 2);
  EXPECT_EQ(ranges[0].received, 1);
  EXPECT_DOUBLE_EQ(ranges[0].predicted.value(), 0.6);
  EXPECT_EQ(ranges[1].received, 1);
  EXPECT_FALSE(ranges[1].predicted);
}

TEST(DeliveryByPair, TheSnrIsTheMedianOfTheTablesElseOfTheOutcomes) {
  RunTimeline store;
  for (const double snr_db : {3.0, 5.0, 30.0})
    add_table(store, 1, snr_db, static_cast<std::int64_t>(snr_db) * kSecond);
  add(store, "OUTCOME", outcome(1, 2, 0, 0));
  add(store, "OUTCOME", outcome(2, 1, 0, 0, packet_outcome_t::COLLIDED));
  const auto pairs = delivery_by_pair(store);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].snr_db, 5);
  EXPECT_EQ(pairs[0].share(), 1);
  EXPECT_EQ(pairs[1].snr_db, 10);
  EXPECT_EQ(pairs[1].share(), 0);
}

std::string text_of(const RunTimeline& store) {
  std::string text;
  for (const SummaryRow& row : run_summary(store)) text += row.key + ": " + row.text + "\n";
  return text;
}

TEST(RunSummary, CountsWhatWasTransmittedReceivedRefusedAndLost) {
  RunTimeline store;
  add(store, "STATE.a", state(1, 0, 0));
  add(store, "STATE.b", state(2, 0, 0));
  for (std::int64_t i = 0; i < 3; ++i) {
    add(store, "SEND.a", send(1, i, i * 10 * kSecond));
    add(store, "RECEIPT.a",
        receipt(i, i * 10 * kSecond, i == 2 ? modem_receipt_t::REFUSED_BUSY : modem_receipt_t::ACCEPTED));
  }
  add(store, "OUTCOME", outcome(1, 2, 0, 0));
  add(store, "OUTCOME", outcome(1, 2, 1, 10 * kSecond, packet_outcome_t::SHADOW));
  EXPECT_EQ(text_of(store),
            "a: stayed at 0 m of depth\nb: stayed at 0 m of depth\n"
            "packets: 2 transmitted, received 1 of 2 (50 %) times at other vehicles; 1 refused busy\n"
            "received: between a and b: 1 of 2 (50 %)\nlost: 1 shadow\n");
}

TEST(RunSummary, ALargeFleetIsAFewRows) {
  RunTimeline store;
  for (std::int32_t v = 1; v <= 50; ++v) add(store, "STATE.v" + std::to_string(v), state(v, 0, v));
  for (std::int32_t v = 2; v <= 50; ++v) add(store, "OUTCOME", outcome(1, v, 0, 0));
  EXPECT_LE(run_summary(store).size(), 5u);
  EXPECT_THAT(text_of(store), HasSubstr("vehicles: 50, 50 at rest"));
  EXPECT_THAT(text_of(store), HasSubstr("received: between 49 of 49 pairs"));
}

TEST(RunSummary, AnEmptyRunHasASummaryToo) {
  EXPECT_EQ(text_of(RunTimeline()), "vehicles: none published a state\npackets: none\n");
}

}  // namespace
}  // namespace halocline::clients
