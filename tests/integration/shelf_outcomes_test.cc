// SPDX-License-Identifier: BSD-3-Clause
// What a thermocline does to links of 6.5 km: packets arrive below it, are lost in the layer above, where
// sound meets the rough surface, and across it, while 600 m across cost nothing.
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

// In a wind of 5 m/s the scattered sound of the warm layer leaves it: of 45 packets at 5.5 km half arrive, at
// 6.5 km 2.
TEST_F(ShelfOutcomesTest, PacketsArriveBelowTheThermoclineAndAreLostAboveAndAcrossIt) {
  constexpr int kBuoy = 1, kLander = 2, kShallow = 3, kDeep = 4;
  const std::pair<int, int> below{kLander, kDeep}, above{kBuoy, kShallow};
  const std::set<std::pair<int, int>> near{{kBuoy, kDeep}, {kLander, kShallow}};
  Share far_below, far_above, near_across, far_across;
  for (const auto& [channel, o] : messages_in<packet_outcome_t>(run(load("shelf", still_sea()), "shelf"))) {
    const std::pair<int, int> pair = std::minmax<int>(o.source_id, o.receiver_id);
    Share& share = pair == below         ? far_below
                   : pair == above       ? far_above
                   : near.contains(pair) ? near_across
                                         : far_across;
    share.add(o.outcome == packet_outcome_t::RECEIVED);
  }
  ASSERT_EQ(far_below.all + far_above.all + near_across.all + far_across.all, 270);
  EXPECT_GT(far_below.value(), 0.9);
  EXPECT_GT(near_across.value(), 0.95);
  EXPECT_LT(far_above.value(), 0.5);
  EXPECT_LT(far_across.value(), 0.1);
}

}  // namespace
}  // namespace halocline::clients
