// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/comparison.h"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::TemporaryLog;

packet_outcome_t outcome(std::int64_t sequence, std::int8_t result, std::int32_t receiver = 2) {
  packet_outcome_t o{};
  o.num_receivers = 1;
  o.utime = 2'000'000;
  o.departure_utime = 1'000'000;
  o.send_session = 7;
  o.packet_sequence = sequence;
  o.source_id = 1;
  o.receiver_id = receiver;
  o.outcome = result;
  o.received_level_db = 100;
  o.noise_level_db = 80;
  o.interference_level_db = -300;
  o.strongest_path_doppler_factor = 1;
  o.success_probability = result == packet_outcome_t::RECEIVED ? 0.9 : 0.1;
  o.success_draw = 0.5;
  o.acquisition_draw = 0.5;
  o.num_paths = 1;
  return o;
}

LoggedOutcomes of(TemporaryLog& log, std::int64_t zero_us = 0) {
  LogReader reader(log.path());
  return outcomes_of(reader, zero_us);
}

class ComparisonTest : public ::testing::Test {
 protected:
  // Two logs of one test need two names.
  struct Other : TemporaryLog {
    Other() : TemporaryLog("-after") {}
  };
  TemporaryLog before_;
  Other after_;
  Comparison compared() { return {of(before_), of(after_)}; }
};

TEST_F(ComparisonTest, TheSameOutcomeIsIdenticalWhoeverPublishedIt) {
  packet_outcome_t o = outcome(0, packet_outcome_t::RECEIVED);
  before_.add(1, "OUTCOME", o);
  o.session = 99;
  o.sequence = 5;
  after_.add(1, "OUTCOME", o);
  const Comparison comparison = compared();
  EXPECT_EQ(comparison.identical(), 1);
  EXPECT_EQ(comparison.changed(), 0);
  EXPECT_TRUE(comparison.rows()[0].moved.empty());
}

TEST_F(ComparisonTest, AChangedOutcomeIsReportedWithTheDecisionAndTheInputsThatDiffer) {
  before_.add(1, "OUTCOME", outcome(0, packet_outcome_t::RECEIVED));
  packet_outcome_t o = outcome(0, packet_outcome_t::BIT_ERRORS);
  o.noise_level_db = 95;
  o.sinr_db = 5;
  after_.add(1, "OUTCOME", o);
  const Comparison comparison = compared();
  ASSERT_EQ(comparison.changed(), 1);
  const Comparison::Row& row = comparison.rows()[0];
  EXPECT_EQ(row.moved, (std::vector<std::string>{"noise"}));
  EXPECT_EQ(
      row.why,
      "bits were wrong: noise of 95.0 dB beside a signal of 100.0 dB. SINR 5.0 dB; 10 % of such packets "
      "survive, the draw was 0.500; noise 80.0 dB -> 95.0 dB");
  EXPECT_EQ(comparison.transitions().at({"received", "bit errors"}), 1);
}

TEST_F(ComparisonTest, InterferersAreNamed) {
  before_.add(1, "OUTCOME", outcome(0, packet_outcome_t::RECEIVED));
  packet_outcome_t o = outcome(0, packet_outcome_t::COLLIDED);
  o.num_colliders = 1;
  o.colliders.resize(1);
  o.colliders[0].source_id = 3;
  o.colliders[0].packet_sequence = 12;
  after_.add(1, "OUTCOME", o);
  vehicle_state_t state = testing::state_at(0);
  state.vehicle_id = 3;
  after_.add(1, "STATE.scout", state);
  const Comparison comparison = compared();
  EXPECT_THAT(comparison.rows()[0].moved, Contains("colliders"));
  EXPECT_THAT(comparison.rows()[0].why, HasSubstr("disturbed by scout:12"));
}

TEST_F(ComparisonTest, PacketsOfOneNameAreDistinguishedByTheirDeparture) {
  for (const std::int64_t departure : {1'000'000, 3'000'000}) {
    packet_outcome_t o =
        outcome(0, departure == 1'000'000 ? packet_outcome_t::RECEIVED : packet_outcome_t::SHADOW);
    o.departure_utime = departure;
    before_.add(1, "OUTCOME", o);
    after_.add(1, "OUTCOME", o);
  }
  const Comparison comparison = compared();
  EXPECT_EQ(comparison.rows().size(), 2u);
  EXPECT_EQ(comparison.identical(), 2);
}

TEST_F(ComparisonTest, APacketThatLeftAtAnotherInstantIsTheSamePacket) {
  before_.add(1, "OUTCOME", outcome(0, packet_outcome_t::RECEIVED));
  packet_outcome_t o = outcome(0, packet_outcome_t::RECEIVED);
  o.departure_utime = 1'500'000;  // a queue that was longer
  after_.add(1, "OUTCOME", o);
  EXPECT_EQ(compared().rows().size(), 1u);
}

TEST_F(ComparisonTest, ARefusalExplainsAMissingOutcome) {
  before_.add(1, "STATE.auv-1", testing::state_at(0));
  before_.add(1, "OUTCOME", outcome(4, packet_outcome_t::RECEIVED));
  modem_receipt_t receipt{};
  receipt.utime = 9'000'000;
  receipt.send_session = 7;
  receipt.packet_sequence = 4;
  receipt.receipt_result = modem_receipt_t::REFUSED_TOO_LARGE;
  after_.add(1, "RECEIPT.auv-1", receipt);
  after_.add(1, "OUTCOME", outcome(5, packet_outcome_t::RECEIVED));
  const Comparison comparison = compared();
  ASSERT_EQ(comparison.rows().size(), 2u);
  EXPECT_EQ(comparison.rows()[0].outcome_after, "refused too large");
  EXPECT_EQ(comparison.rows()[1].outcome_before, "undecided at the end");
}

TEST_F(ComparisonTest, ARunWithoutOutcomesIsReportedAsNotRecorded) {
  before_.add(1, "STATE.auv-1", testing::state_at(0));
  after_.add(1, "OUTCOME", outcome(0, packet_outcome_t::RECEIVED));
  const Comparison comparison = compared();
  EXPECT_FALSE(comparison.anything_before());
  EXPECT_EQ(comparison.rows()[0].outcome_before, "not recorded");
  std::ostringstream text;
  print(text, comparison);
  EXPECT_THAT(text.str(), HasSubstr("holds no outcomes"));
}

TEST_F(ComparisonTest, TimesThatAReplayMovedAreComparedMoved) {
  packet_outcome_t o = outcome(0, packet_outcome_t::RECEIVED);
  after_.add(1, "OUTCOME", o);
  constexpr std::int64_t kZero_us = 1'700'000'000'000'000;
  o.utime += kZero_us;
  o.departure_utime += kZero_us;
  before_.add(1, "OUTCOME", o);
  EXPECT_EQ(Comparison(of(before_, kZero_us), of(after_)).identical(), 1);
}

TEST_F(ComparisonTest, TablesHoldARowAPacketAndReceiverAndJsonTheChanged) {
  before_.add(1, "OUTCOME", outcome(0, packet_outcome_t::RECEIVED));
  before_.add(1, "OUTCOME", outcome(0, packet_outcome_t::RECEIVED, 3));
  after_.add(1, "OUTCOME", outcome(0, packet_outcome_t::SHADOW));
  after_.add(1, "OUTCOME", outcome(0, packet_outcome_t::RECEIVED, 3));
  const Comparison comparison = compared();
  std::ostringstream csv;
  print_csv(csv, comparison);
  const std::string text = csv.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_THAT(text, HasSubstr("1,2,all,7,0,received,shadow,1,,"));
  const std::string json = to_json(comparison);
  EXPECT_THAT(json, HasSubstr("\"after\": \"shadow\""));
  EXPECT_THAT(json, HasSubstr("\"changed\": 1"));
}

}  // namespace
}  // namespace halocline::clients
