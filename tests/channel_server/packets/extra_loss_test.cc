// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/extra_loss.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "core/sim_time.h"
#include "tests/channel_server/scripted_water.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::path;

class ExtraLossTest : public testing::ScriptedWater {
 protected:
  ExtraLossTest() {
    water.set(1, 2, {path(1, 120)});
    water.set(1, 3, {path(1, 120)});
    water.set(3, 2, {path(1, 120)});
  }
  // Outcomes at `receiver` of packets of 1 sent at 10, 11, ... s, by their number.
  std::vector<OutcomeKind> outcomes_with(const std::vector<ExtraLoss>& rules, VehicleId receiver, int packets,
                                         std::uint64_t seed = 1) {
    PacketMedium lossy{
        fleet,
        water,
        {.max_lateness = for_s(10), .max_earliness = for_s(200), .seed = seed, .extra_loss = rules}};
    for (int i = 0; i < packets; ++i) {
      EXPECT_FALSE(lossy.transmit(testing::request_of(1, 10 + 0.05 * i, i, 1), SimTime()));
    }
    std::vector<OutcomeKind> kinds;
    for (const PacketOutcome& outcome : testing::outcomes_in(lossy.advance_to(at_s(115)))) {
      if (outcome.receiver_id == receiver) kinds.push_back(outcome.kind);
    }
    return kinds;
  }
  static int lost(const std::vector<OutcomeKind>& kinds) {
    int count = 0;
    for (const OutcomeKind kind : kinds) count += kind == OutcomeKind::kExtraLoss ? 1 : 0;
    return count;
  }
};

constexpr int kPackets = 2000;

// 99.9 % of counts of n draws of probability p lie within 3.3 standard deviations.
void expect_share(int count, double share) {
  EXPECT_NEAR(count, share * kPackets, 3.3 * std::sqrt(kPackets * share * (1 - share)));
}

TEST_F(ExtraLossTest, TakesTheStatedShare) {
  expect_share(lost(outcomes_with({{.share = 0.3}}, 2, kPackets)), 0.3);
}

TEST_F(ExtraLossTest, RulesTakeOneAfterTheOther) {
  expect_share(lost(outcomes_with({{.share = 0.3}, {.to = "v2", .share = 0.5}}, 2, kPackets)), 1 - 0.7 * 0.5);
}

TEST_F(ExtraLossTest, AllOrNothingAreExact) {
  EXPECT_EQ(lost(outcomes_with({{.share = 1}}, 2, 100)), 100);
  EXPECT_EQ(lost(outcomes_with({{.share = 0}}, 2, 100)), 0);
}

TEST_F(ExtraLossTest, ConcernsOnePairAlone) {
  const std::vector<ExtraLoss> rules{{.from = "v1", .to = "v3", .share = 1}};
  EXPECT_EQ(lost(outcomes_with(rules, 3, 50)), 50);
  EXPECT_EQ(lost(outcomes_with(rules, 2, 50)), 0);
  EXPECT_EQ(lost(outcomes_with({{.from = "v3", .share = 1}}, 2, 50)), 0);
}

TEST_F(ExtraLossTest, ConcernsOneKindAlone) {
  EXPECT_EQ(lost(outcomes_with({{.kind = PacketKind::kPing, .share = 1}}, 2, 50)), 0);
  EXPECT_EQ(lost(outcomes_with({{.kind = PacketKind::kData, .share = 1}}, 2, 50)), 50);
}

TEST_F(ExtraLossTest, ConcernsDeparturesOfItsSpanOfTime) {
  const auto kinds = outcomes_with({{.share = 1, .begin = at_s(11), .end = at_s(12)}}, 2, 60);
  for (int i = 0; i < 60; ++i) {
    const bool is_within = i >= 20 && i < 40;  // 0.05 s apart, from 10 s on
    EXPECT_EQ(kinds[static_cast<std::size_t>(i)] == OutcomeKind::kExtraLoss, is_within) << i;
  }
}

TEST_F(ExtraLossTest, TheSameSeedLosesTheSamePacketsAndAnotherOthers) {
  const std::vector<ExtraLoss> rules{{.share = 0.5}};
  EXPECT_EQ(outcomes_with(rules, 2, 200), outcomes_with(rules, 2, 200));
  EXPECT_NE(outcomes_with(rules, 2, 200, 1), outcomes_with(rules, 2, 200, 2));
  EXPECT_NE(outcomes_with(rules, 2, 200), outcomes_with(rules, 3, 200));
}

TEST_F(ExtraLossTest, APacketThatWouldNotHaveBeenReceivedKeepsItsCause) {
  for (const OutcomeKind kind : outcomes_with({{.share = 1}}, 4, 20)) EXPECT_EQ(kind, OutcomeKind::kShadow);
}

}  // namespace
}  // namespace halocline::channel_server
