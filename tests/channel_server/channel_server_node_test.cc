// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_node.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/transport/event_log.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/names.h"
#include "core/units.h"
#include "tests/channel_server/node_bench.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using ::testing::ElementsAre;
using testing::for_s;
using ::testing::HasSubstr;
using testing::kSpeedMps;
using testing::NodeBench;

class ChannelServerNodeTest : public ::testing::Test {
 protected:
  void SetUp() override { bus::set_log_level(bus::LogLevel::kSilent); }
  // Two vehicles at rest 3000 m apart, states every half second over [begin, end] (no more than 10 s ahead
  // are taken).
  void two_at_rest(NodeBench& bench, double begin_s = 0, double end_s = 10) {
    for (double t = begin_s; t <= end_s; t += 0.5) {
      bench.state(1, t, {0, 0, 50});
      bench.state(2, t, {3000, 0, 50});
    }
  }
};

TEST_F(ChannelServerNodeTest, LinksComeOnTheGridForEachVehiclePresent) {
  NodeBench bench;
  for (double t = 0; t < 3; t += 0.1) {
    bench.state(1, t, {0, 0, 50});
    bench.state(2, t, {1500, 0, 50});
    bench.step(t);
  }
  std::vector<std::int64_t> instants;
  for (const auto& table : bench.links) {
    if (table.channel == "LINKS.v1") instants.push_back(table.message.utime);
  }
  EXPECT_THAT(instants, ElementsAre(1'000'000, 2'000'000));
  const link_t row = bench.last_table(1).peers.at(0);
  EXPECT_EQ(row.receiver_id, 2);
  EXPECT_NEAR(row.delay_s, 1500 / kSpeedMps, tolerance(1e-12));
  EXPECT_EQ(row.multipath, link_t::MULTIPATH_UNKNOWN);
}

TEST_F(ChannelServerNodeTest, TablesAreNumberedForEachVehicle) {
  NodeBench bench;
  two_at_rest(bench);
  bench.run_to(5);
  std::int64_t expected = 0;
  for (const auto& table : bench.links) {
    EXPECT_EQ(table.message.session, NodeBench::kSession);
    if (table.message.vehicle_id != 2) continue;
    EXPECT_EQ(table.message.sequence, expected++);
  }
  EXPECT_EQ(expected, 5);
}

TEST_F(ChannelServerNodeTest, AVehicleWhoseStatesEndLeavesTheTablesAndReturns) {
  NodeBench bench;
  two_at_rest(bench, 0, 3);
  for (double t = 3.5; t < 20; t += 0.5) bench.state(1, t, {0, 0, 50});
  bench.run_to(8);
  EXPECT_EQ(bench.last_table(1).num_peers, 1);
  bench.run_to(9);
  EXPECT_EQ(bench.last_table(1).num_peers, 0);
  bench.state(2, 10.5, {3000, 0, 50});
  bench.run_to(11);
  EXPECT_EQ(bench.last_table(1).num_peers, 1);
}

TEST_F(ChannelServerNodeTest, OfTwoVehiclesWithOneIdTheFirstIsKeptAndTheOtherRefused) {
  NodeBench bench;
  bench.state_of("first", 1, 0, {0, 0, 50});
  bench.run_to(1);
  bench.state_of("second", 1, 1, {9, 9, 9});
  bench.run_to(2);
  EXPECT_EQ(bench.node().counters().refused, 1);
  EXPECT_EQ(bench.links.back().channel, "LINKS.first");
}

TEST_F(ChannelServerNodeTest, AStateFromTheFutureIsRefused) {
  NodeBench bench;
  bench.state(1, 100, {0, 0, 50});
  bench.run_to(1);
  EXPECT_EQ(bench.node().counters().refused, 1);
}

TEST_F(ChannelServerNodeTest, TheEnvironmentIsPublishedAtTheStartAndEveryMinute) {
  NodeBench bench;
  bench.run_to(125);
  std::vector<std::int64_t> instants;
  for (const auto& environment : bench.environments) instants.push_back(environment.utime);
  EXPECT_THAT(instants, ElementsAre(0, 60'000'000, 120'000'000));
  EXPECT_EQ(bench.environments[0].layer_sound_speed_mps.at(0), kSpeedMps);
  EXPECT_EQ(bench.environments[2].sequence, 2);
}

TEST_F(ChannelServerNodeTest, APacketIsAnsweredDeliveredAndAccountedForAtItsExactInstants) {
  NodeBench bench;
  two_at_rest(bench);
  bench.send(1, 10, 77, /*bytes=*/5, /*destination=*/2);
  bench.run_to(20);
  ASSERT_EQ(bench.receipts.size(), 1u);
  EXPECT_EQ(bench.receipts[0].channel, "RECEIPT.v1");
  EXPECT_EQ(bench.receipts[0].message.receipt_result, modem_receipt_t::ACCEPTED);
  EXPECT_EQ(bench.receipts[0].message.start_utime, 10'000'000);
  EXPECT_EQ(bench.receipts[0].message.packet_sequence, 77);
  EXPECT_NEAR(bench.receipts[0].message.duration_s, 0.05, tolerance(1e-9));
  ASSERT_EQ(bench.receives.size(), 1u);
  EXPECT_EQ(bench.receives[0].channel, "RECEIVE.v2");
  EXPECT_EQ(bench.receives[0].message.utime, 12'050'000);
  EXPECT_NEAR(bench.receives[0].message.travel_time_s, 2, tolerance(1e-9));
  EXPECT_EQ(bench.receives[0].message.payload, std::vector<std::uint8_t>(5, 0x42));
  ASSERT_EQ(bench.outcomes.size(), 1u);
  EXPECT_EQ(bench.outcomes[0].outcome, packet_outcome_t::RECEIVED);
  EXPECT_EQ(bench.outcomes[0].utime, 12'050'000);
  EXPECT_EQ(bench.outcomes[0].send_session, 7);
}

TEST_F(ChannelServerNodeTest, APingIsReceivedAndAnsweredWithTheTwoWayTravelTime) {
  NodeBench bench;
  two_at_rest(bench);
  modem_send_t ping{};
  ping.utime = 10'000'000;
  ping.session = 7;
  ping.packet_sequence = 77;
  ping.source_id = 1;
  ping.destination_id = 2;
  ping.packet_kind = modem_send_t::PING;
  bench.bus().publish(testing::channels::kSend.of("v1"), ping);
  bench.run_to(20);
  ASSERT_EQ(bench.receives.size(), 2u);
  EXPECT_EQ(bench.receives[0].channel, "RECEIVE.v2");
  EXPECT_EQ(bench.receives[0].message.packet_kind, modem_receive_t::PING);
  EXPECT_EQ(bench.receives[0].message.travel_time_s, 0);  // not stamped
  EXPECT_EQ(bench.receives[1].channel, "RECEIVE.v1");
  EXPECT_EQ(bench.receives[1].message.packet_kind, modem_receive_t::PING_REPLY);
  EXPECT_EQ(bench.receives[1].message.packet_sequence, 77);
  EXPECT_NEAR(bench.receives[1].message.two_way_travel_time_s, 4, tolerance(3e-9));
  EXPECT_EQ(bench.receipts.size(), 1u);
  EXPECT_EQ(bench.outcomes.size(), 2u);
}

TEST_F(ChannelServerNodeTest, APacketForAnotherIsAccountedForAndNotDelivered) {
  NodeBench bench;
  two_at_rest(bench);
  bench.send(1, 10, 0, 5, /*destination=*/9);
  bench.run_to(20);
  EXPECT_TRUE(bench.receives.empty());
  EXPECT_EQ(bench.outcomes.size(), 1u);
}

TEST_F(ChannelServerNodeTest, ARepeatedSendGetsItsReceiptAgainAndIsNotTransmittedAgain) {
  NodeBench bench;
  two_at_rest(bench);
  bench.send(1, 10, 0);
  bench.run_to(11);
  bench.send(1, 10, 0);
  bench.run_to(20);
  ASSERT_EQ(bench.receipts.size(), 2u);
  EXPECT_EQ(bench.receipts[1].message.start_utime, bench.receipts[0].message.start_utime);
  EXPECT_EQ(bench.receives.size(), 1u);
}

TEST_F(ChannelServerNodeTest, RefusalsHoldTheirReason) {
  NodeBench bench;
  two_at_rest(bench);
  bench.send(1, 10, 0, 64);
  bench.send(1, 10.1, 1);
  bench.send(2, 10, 2, 65);
  bench.send(3, 10, 3);
  bench.run_to(11);
  std::map<std::int64_t, int> results;
  for (const auto& receipt : bench.receipts) {
    results[receipt.message.packet_sequence] = receipt.message.receipt_result;
  }
  EXPECT_EQ(results[0], modem_receipt_t::ACCEPTED);
  EXPECT_EQ(results[1], modem_receipt_t::REFUSED_BUSY);
  EXPECT_EQ(results[2], modem_receipt_t::REFUSED_TOO_LARGE);
  EXPECT_EQ(results[3], modem_receipt_t::REFUSED_UNKNOWN_VEHICLE);
}

TEST_F(ChannelServerNodeTest, ASendReceivedLateIsPublishedAtOnceWithExactStampsAndCounted) {
  NodeBench bench;
  two_at_rest(bench);
  bench.run_to(15);
  bench.send(1, 10, 0, 5);
  bench.run_to(15);
  ASSERT_EQ(bench.receives.size(), 1u);
  EXPECT_EQ(bench.receives[0].message.utime, 12'050'000);
  EXPECT_EQ(bench.node().counters().late, 1);
}

TEST_F(ChannelServerNodeTest, ASendReceivedTooLateIsRefused) {
  NodeBench bench;
  two_at_rest(bench);
  bench.run_to(25);
  bench.send(1, 10, 0, 5);
  bench.run_to(25);
  EXPECT_EQ(bench.receipts.at(0).message.receipt_result, modem_receipt_t::REFUSED_STALE);
}

TEST_F(ChannelServerNodeTest, AnAnnouncedModemIsUsed) {
  NodeBench bench;
  two_at_rest(bench);
  VehicleModem loud = testing::quick_modem();
  loud.modem.source_level = loud.modem.source_level + Decibels{6};
  bench.run_to(2);
  const double before_db = bench.last_table(1).peers.at(0).received_level_db;
  bench.bus().publish("MODEM.v1", to_message(loud, at_s(2.5)));
  bench.run_to(3);
  EXPECT_NEAR(bench.last_table(1).peers.at(0).received_level_db - before_db, 6, tolerance(1e-9));
}

TEST_F(ChannelServerNodeTest, ModemsUnderForgedNamesDoNotKeepANewVehiclesModemOut) {
  NodeBench bench;
  two_at_rest(bench);
  bench.run_to(2);
  const double before_db = bench.last_table(1).peers.at(0).received_level_db;
  for (int i = 0; i < 5000; ++i) {
    bench.bus().publish("MODEM.forged" + std::to_string(i), to_message(testing::quick_modem(), at_s(2)));
    if (i % 100 == 0) bench.run_to(2 + i / 5000.0);
  }
  VehicleModem loud = testing::quick_modem();
  loud.modem.source_level = loud.modem.source_level + Decibels{6};
  bench.bus().publish("MODEM.new", to_message(loud, at_s(3)));
  bench.state_of("new", 9, 3.1, {0, 0, 50});
  bench.run_to(4);
  const link_table_t& table = bench.last_table(9);
  ASSERT_EQ(table.num_peers, 2);
  EXPECT_NEAR(table.peers.at(1).received_level_db - before_db, 6, tolerance(1e-9));
  EXPECT_EQ(bench.node().counters().refused, 0);
}

TEST_F(ChannelServerNodeTest, AnImpossibleModemIsRefused) {
  NodeBench bench;
  VehicleModem modem;
  modem_config_t message = to_message(modem, at_s(0));
  message.directivity_index_db = 60;  // no NaN, so the bus lets it pass; no hydrophone has it
  bench.bus().publish("MODEM.v1", message);
  bench.run_to(1);
  EXPECT_EQ(bench.node().counters().refused, 1);
}

TEST_F(ChannelServerNodeTest, ARestartForgetsTheOldRun) {
  NodeBench bench;
  two_at_rest(bench, 100, 130);
  bench.step(120);
  bench.send(1, 120, 0);
  bench.step(120);
  EXPECT_EQ(bench.receipts.size(), 1u);
  bench.state(1, 0, {0, 0, 50});
  bench.drain();
  bench.node().restart({at_s(0.2), at_s(30), true});
  bench.step(at_s(0.2), at_s(30));
  bench.step(at_s(1), at_s(31));
  EXPECT_EQ(bench.last_table(1).utime, 1'000'000);
  EXPECT_EQ(bench.last_table(1).num_peers, 0);  // the other has no state in this run
  bench.step(at_s(4), at_s(40));
  EXPECT_TRUE(bench.outcomes.empty());
}

TEST_F(ChannelServerNodeTest, RecordedAnswersOnTheBusAreNotTakenForItsOwn) {
  NodeBench bench;
  two_at_rest(bench);
  bench.run_to(2);
  const auto received = bench.node().counters().received, refused = bench.node().counters().refused;
  bench.bus().publish("LINKS.v1", bench.links[0].message);
  bench.bus().publish("OUTCOME", packet_outcome_t{});
  ray_reply_t recorded{};
  recorded.request_id = 1;
  bench.bus().publish(bus::channels::kRayReply.of(SeabedClient::client_name(815)), recorded);
  bench.drain();
  EXPECT_EQ(bench.node().counters().received, received);
  EXPECT_EQ(bench.node().counters().refused, refused);
}

TEST_F(ChannelServerNodeTest, TheRayClientNameHoldsEverySessionAndIsAName) {
  EXPECT_TRUE(is_valid_name(SeabedClient::client_name(1)));
  EXPECT_TRUE(is_valid_name(SeabedClient::client_name(std::numeric_limits<std::int64_t>::max())));
  EXPECT_NE(SeabedClient::client_name(1), SeabedClient::client_name(2));
}

TEST_F(ChannelServerNodeTest, TheOrderInWhichMessagesArriveChangesNothing) {
  const auto run = [](bool backward) {
    NodeBench bench;
    for (int second = 0; second < 20; ++second) {
      std::vector<std::function<void()>> messages;
      for (int part = 0; part < 4; ++part) {
        for (VehicleId id = 1; id <= 4; ++id) {
          const double t = second + 0.25 * part;
          messages.push_back([&bench, id, t] {
            bench.state(id, t, {900.0 * id + 2 * t, 3 * t, 40}, {2, 3, 0});
          });
        }
      }
      for (VehicleId id = 1; id <= 4; ++id) {
        messages.push_back([&bench, id, second] { bench.send(id, second + 1.0 + 0.01 * id, second, id); });
      }
      if (backward) std::reverse(messages.begin(), messages.end());
      for (const auto& message : messages) message();
      bench.run_to(second + 0.999);
    }
    bench.run_to(30);
    std::vector<std::string> lines;
    for (const auto& t : bench.links) {
      for (const auto& p : t.message.peers) {
        lines.push_back(t.channel + std::to_string(t.message.utime) + " " + std::to_string(p.receiver_id) +
                        " " + std::to_string(p.range_m) + " " + std::to_string(p.transmitter_age_s));
      }
    }
    for (const auto& o : bench.outcomes) {
      lines.push_back(std::to_string(o.utime) + " " + std::to_string(o.sequence) + " " +
                      std::to_string(o.source_id) + " " + std::to_string(o.receiver_id) + " " +
                      std::to_string(o.travel_time_s) + " " + std::to_string(o.outcome));
    }
    return lines;
  };
  const auto forward = run(false);
  EXPECT_GT(forward.size(), 400u);
  EXPECT_EQ(run(true), forward);
}

TEST_F(ChannelServerNodeTest, StatusShowsVehiclesLinksPacketsAndTheTerrain) {
  NodeBench bench;
  two_at_rest(bench);
  bench.run_to(5);
  EXPECT_THAT(bench.statuses.back().message.status_text, HasSubstr("2 vehicles"));
}

}  // namespace
}  // namespace halocline::channel_server
