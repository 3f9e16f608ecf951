// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that seeks the depth where it is heard, beside one that stays above the thermocline.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class SeekLinkOutcomesTest : public testing::EmbeddedTest {};

// 40 packets each, 20 minutes of them from the fifth minute on, when the seeker has come down. Large-scale
// fading of two minutes leaves some 10 independent states.
TEST_F(SeekLinkOutcomesTest, WhoSeeksTheLinkIsHeardAndWhoStaysIsNot) {
  constexpr int kKeeper = 2, kSeeker = 3, kLander = 1;
  const auto log = run(load("seek_link", still_sea()), "seek_link");
  const auto share = [&](int source) {
    int received = 0, all = 0;
    for (const auto& [channel, o] : messages_in<packet_outcome_t>(log)) {
      if (o.source_id != source || o.receiver_id != kLander || o.departure_utime < 300'000'000) continue;
      received += o.outcome == packet_outcome_t::RECEIVED ? 1 : 0;
      ++all;
    }
    EXPECT_EQ(all, 40);
    return static_cast<double>(received) / std::max(all, 1);
  };
  EXPECT_GT(share(kSeeker), 0.9);
  EXPECT_LT(share(kKeeper), 0.6);
}

TEST_F(SeekLinkOutcomesTest, TheSeekerGoesBelowTheThermoclineAndStaysThere) {
  const auto log = run(load("seek_link", {"scenario.duration_s=600"}), "seek_link_depth");
  double last_z_m = 0;
  int seeking = 0;
  for (const auto& [channel, state] : messages_in<vehicle_state_t>(log)) {
    if (channel == "STATE.seeker") last_z_m = state.position_ned_m[2];
  }
  for (const auto& [channel, status] : messages_in<autopilot_status_t>(log)) {
    if (channel == "AUTOPILOT.seeker" && status.autopilot_activity == autopilot_status_t::SEEKING_LINK)
      ++seeking;
  }
  EXPECT_GT(last_z_m, 30);
  EXPECT_GT(seeking, 500);
}

}  // namespace
}  // namespace halocline::clients
