// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/messages/link_messages.h"

#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/link_budget.h"
#include "bus/messages/message_checks.h"
#include "channel_server/links/link_table.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;

TEST(LinkMessages, ALinkTableHoldsEveryFieldOfItsRows) {
  LinkRow row;
  row.transmitter_id = 1;
  row.receiver_id = 2;
  row.budget = acoustics::link_budget({}, {}, {}, {0, 0, 5}, {900, 0, 5});
  row.multipath = Multipath::kLikely;
  row.transmitter_age = for_s(0.5);
  row.receiver_age = for_s(0.25);
  row.forecast = {0.5, -3, 0.75, 0.5, 0.125, 2, 0.0625, 80, 0.25, 0.875};
  const std::vector<link_table_t> messages = to_messages(LinkTable{1, {row}}, at_s(4));
  ASSERT_EQ(messages.size(), 1u);
  const link_table_t& message = messages.front();
  EXPECT_EQ(bus::problem_in(message), "");
  ASSERT_EQ(message.num_peers, 1);
  const link_t& link = message.peers[0];
  EXPECT_EQ(link.transmitter_id, 1);
  EXPECT_EQ(link.receiver_id, 2);
  EXPECT_EQ(link.range_m, row.budget.range_m);
  EXPECT_EQ(link.delay_s, row.budget.delay_s);
  EXPECT_EQ(link.transmission_loss_db, row.budget.transmission_loss.value);
  EXPECT_EQ(link.received_level_db, row.budget.received_level.value);
  EXPECT_EQ(link.noise_level_db, row.budget.noise_level.value);
  EXPECT_EQ(link.snr_db, row.budget.snr.value);
  EXPECT_EQ(link.capacity_bps, row.budget.capacity_bps);
  EXPECT_EQ(link.receivable, 1);
  EXPECT_EQ(link.multipath, link_t::MULTIPATH_LIKELY);
  EXPECT_EQ(link.transmitter_age_s, 0.5);
  EXPECT_EQ(link.receiver_age_s, 0.25);
  EXPECT_EQ(link.first_path_delay_s, 0.5);
  EXPECT_EQ(link.sinr_db, -3);
  EXPECT_EQ(link.acquisition_probability, 0.75);
  EXPECT_EQ(link.delivery_probability, 0.5);
  EXPECT_EQ(link.delivery_low, 0.25);
  EXPECT_EQ(link.delivery_high, 0.875);
  EXPECT_EQ(link.coherence_time_s, 0.125);
  EXPECT_EQ(link.doppler_spread_hz, 2);
  EXPECT_EQ(link.rms_delay_spread_s, 0.0625);
  EXPECT_EQ(link.best_rate_bps, 80);
}

TEST(LinkMessages, ALinkTableOf4095PeersComesInPartsBelowSixtyKilobytes) {
  LinkTable table{1, {}};
  for (VehicleId id = 2; id <= 4096; ++id) {
    LinkRow row;
    row.transmitter_id = 1;
    row.receiver_id = id;
    table.rows.push_back(row);
  }
  VehicleId expected = 2;
  for (const link_table_t& message : to_messages(table, at_s(4))) {
    EXPECT_EQ(bus::problem_in(message), "");
    EXPECT_LT(message.getEncodedSize(), 60'000);
    EXPECT_EQ(message.vehicle_id, 1);
    EXPECT_EQ(message.utime, 4'000'000);
    for (const link_t& link : message.peers) EXPECT_EQ(link.receiver_id, expected++);
  }
  EXPECT_EQ(expected, 4097);
}

TEST(LinkMessages, ATableUpToTwoHundredAndFortyPeersIsOneMessage) {
  EXPECT_EQ(to_messages(LinkTable{1, {}}, at_s(4)).size(), 1u);
  EXPECT_EQ(to_messages(LinkTable{1, std::vector<LinkRow>(240)}, at_s(4)).size(), 1u);
  EXPECT_EQ(to_messages(LinkTable{1, std::vector<LinkRow>(241)}, at_s(4)).size(), 2u);
}

}  // namespace
}  // namespace halocline::channel_server
