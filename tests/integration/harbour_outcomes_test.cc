// SPDX-License-Identifier: BSD-3-Clause
// The harbour shows why packets are lost: four outcomes at least, each with the numbers that decided it, and
// no outcome missing or double.
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

constexpr double kLastDepartureS = 145;  // all packets have ended 5 s later

class HarbourOutcomesTest : public testing::EmbeddedTest {
 protected:
  std::string log() { return run(load("harbour", {"scenario.duration_s=150"}), "harbour"); }
};

std::map<int, std::vector<packet_outcome_t>> by_outcome(
    const std::vector<std::pair<std::string, packet_outcome_t>>& outcomes) {
  std::map<int, std::vector<packet_outcome_t>> by_kind;
  for (const auto& [channel, outcome] : outcomes) by_kind[outcome.outcome].push_back(outcome);
  return by_kind;
}

TEST_F(HarbourOutcomesTest, FourOutcomesOccurAndTheNumbersConfirmEach) {
  auto outcomes = by_outcome(messages_in<packet_outcome_t>(run(load("harbour", {}), "harbour")));
  for (const int kind : {packet_outcome_t::RECEIVED, packet_outcome_t::HALF_DUPLEX,
                         packet_outcome_t::COLLIDED, packet_outcome_t::BIT_ERRORS}) {
    EXPECT_GE(outcomes[kind].size(), 5u) << kind;
  }
  for (const auto& o : outcomes[packet_outcome_t::RECEIVED]) {
    EXPECT_GE(o.received_level_db, o.cutoff_level_db);
    EXPECT_LT(o.acquisition_draw, o.acquisition_probability);
    EXPECT_LT(o.success_draw, o.success_probability);
  }
  for (const auto& o : outcomes[packet_outcome_t::HALF_DUPLEX]) {
    ASSERT_GE(o.colliders.size(), 1u);
    EXPECT_EQ(o.colliders[0].source_id, o.receiver_id);
  }
  for (const auto& o : outcomes[packet_outcome_t::COLLIDED]) {
    ASSERT_GE(o.colliders.size(), 1u);
    EXPECT_NE(o.colliders[0].source_id, o.receiver_id);
  }
  for (const auto& o : outcomes[packet_outcome_t::BIT_ERRORS]) {
    EXPECT_LT(o.acquisition_draw, o.acquisition_probability);
    EXPECT_GE(o.success_draw, o.success_probability);
    EXPECT_EQ(o.propagation_used, packet_outcome_t::RAYS);
  }
}

using PacketKey = std::tuple<int, std::int64_t, std::int64_t>;  // source, session, number

// All five are present all along.
TEST_F(HarbourOutcomesTest, EveryAcceptedPacketEndsOnceAtEachOfTheFourOthers) {
  const std::map<std::string, int> ids{
      {"quay", 1}, {"scout-1", 2}, {"scout-2", 3}, {"gate", 4}, {"visitor", 5}};
  const std::string path = log();
  std::map<PacketKey, std::multiset<int>> ends;  // of each packet: where
  for (const auto& [channel, receipt] : messages_in<modem_receipt_t>(path)) {
    const bool sent = receipt.receipt_result == modem_receipt_t::ACCEPTED;
    if (!sent || receipt.start_utime >= static_cast<std::int64_t>(kLastDepartureS * 1e6)) continue;
    const int source = ids.at(channel.substr(channel.find('.') + 1));
    ends[{source, receipt.send_session, receipt.packet_sequence}];
  }
  ASSERT_GT(ends.size(), 40u);
  for (const auto& [channel, o] : messages_in<packet_outcome_t>(path)) {
    const auto packet = ends.find({o.source_id, o.send_session, o.packet_sequence});
    if (packet != ends.end()) packet->second.insert(o.receiver_id);
  }
  for (const auto& [packet, receivers] : ends) {
    std::multiset<int> others{1, 2, 3, 4, 5};
    others.erase(std::get<0>(packet));
    EXPECT_EQ(receivers, others);
  }
}

// A rate of reports decides nothing: every packet requests the bottom under it, from the first one on.
TEST_F(HarbourOutcomesTest, OutcomesDoNotDependOnTheRateOfLinkTables) {
  const auto outcomes_at = [&](const std::string& rate_hz) {
    std::vector<packet_outcome_t> outcomes;
    const auto config = load("harbour", {"scenario.duration_s=60", "channel_server.link_rate_hz=" + rate_hz});
    for (auto& [channel, outcome] : messages_in<packet_outcome_t>(run(config, "harbour-" + rate_hz))) {
      outcomes.push_back(outcome);
    }
    return outcomes;
  };
  const auto often = outcomes_at("5"), seldom = outcomes_at("0.0167");
  ASSERT_GT(often.size(), 50u);
  ASSERT_EQ(often.size(), seldom.size());
  for (std::size_t i = 0; i < often.size(); ++i) {
    EXPECT_EQ(often[i].propagation_used, packet_outcome_t::RAYS);
    EXPECT_EQ(seldom[i].propagation_used, packet_outcome_t::RAYS);
    EXPECT_EQ(often[i].utime, seldom[i].utime);
    EXPECT_EQ(often[i].receiver_id, seldom[i].receiver_id);
    EXPECT_EQ(often[i].outcome, seldom[i].outcome);
    EXPECT_EQ(often[i].received_level_db, seldom[i].received_level_db);
    EXPECT_EQ(often[i].success_probability, seldom[i].success_probability);
  }
}

}  // namespace
}  // namespace halocline::clients
