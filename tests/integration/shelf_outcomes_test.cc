// SPDX-License-Identifier: BSD-3-Clause
// What a thermocline does to links of 6.5 km: packets arrive within a layer and are mostly lost across it,
// while 600 m across cost nothing.
#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class ShelfOutcomesTest : public testing::EmbeddedTest {};

struct Share {
  int received = 0, all = 0;
  void add(bool is_received) {
    received += is_received ? 1 : 0;
    ++all;
  }
  double value() const { return static_cast<double>(received) / all; }
};

TEST_F(ShelfOutcomesTest, PacketsArriveWithinALayerAndAreMostlyLostAcrossTheThermocline) {
  constexpr int kBuoy = 1, kLander = 2, kShallow = 3, kDeep = 4;
  const std::set<std::pair<int, int>> within{{kBuoy, kShallow}, {kLander, kDeep}},
      near{{kBuoy, kDeep}, {kLander, kShallow}};
  Share within_layer, near_across, far_across;
  for (const auto& [channel, o] : messages_in<packet_outcome_t>(run(load("shelf", still_sea()), "shelf"))) {
    const std::pair<int, int> pair = std::minmax<int>(o.source_id, o.receiver_id);
    Share& share = within.contains(pair) ? within_layer : near.contains(pair) ? near_across : far_across;
    share.add(o.outcome == packet_outcome_t::RECEIVED);
  }
  ASSERT_EQ(within_layer.all + near_across.all + far_across.all, 270);
  EXPECT_GT(within_layer.value(), 0.9);
  EXPECT_GT(near_across.value(), 0.95);
  // 90 packets over two links, whose large-scale fading of two minutes leaves some 10 independent states.
  EXPECT_GT(far_across.value(), 0.05);
  EXPECT_LT(far_across.value(), 0.5);
}

}  // namespace
}  // namespace halocline::clients
