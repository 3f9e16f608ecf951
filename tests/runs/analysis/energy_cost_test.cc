// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/energy_cost.h"

#include <vector>

#include <gtest/gtest.h>

namespace halocline::clients {
namespace {

packet_outcome_t outcome_of(std::int32_t destination, std::int32_t receiver, double range_m,
                            bool is_received) {
  packet_outcome_t o{};
  o.source_id = 1;
  o.destination_id = destination;
  o.receiver_id = receiver;
  o.num_receivers = 1;
  o.range_m = range_m;
  o.outcome = is_received ? packet_outcome_t::RECEIVED : packet_outcome_t::BIT_ERRORS;
  o.payload_bytes = 32;
  o.transmit_energy_j = 60;
  o.receive_energy_j = 4;
  return o;
}

TEST(EnergyCost, IsAllThatWasSpentOverTheBytesThatCame) {
  const EnergyCosts costs = energy_costs({outcome_of(2, 2, 400, true), outcome_of(2, 2, 300, false)});
  ASSERT_EQ(costs.size(), 1u);
  const EnergyCost& cost = costs.at({1, 500});
  EXPECT_EQ(cost.packets, 2);
  EXPECT_EQ(cost.received, 1);
  EXPECT_EQ(cost.per_byte_j(), 128 / 32.0);
}

TEST(EnergyCost, GoesByOctavesOfDistanceAndLeavesOutBystanders) {
  const EnergyCosts costs =
      energy_costs({outcome_of(2, 2, 250, true), outcome_of(2, 3, 251, true), outcome_of(0, 3, 1001, true)});
  ASSERT_EQ(costs.size(), 2u);
  EXPECT_TRUE(costs.contains({1, 250}));
  EXPECT_TRUE(costs.contains({1, 2000}));
}

TEST(EnergyCost, WithoutBatteriesThereIsNone) {
  packet_outcome_t o = outcome_of(2, 2, 400, true);
  o.transmit_energy_j = o.receive_energy_j = 0;
  EXPECT_TRUE(energy_costs({o}).empty());
}

}  // namespace
}  // namespace halocline::clients
