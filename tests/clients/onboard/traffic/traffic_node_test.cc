// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/traffic/traffic_node.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "core/check.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/clients/modem/fake_server.h"
#include "tests/support/at_ms.h"

namespace halocline::clients {
namespace {

using ::testing::ElementsAre;

using halocline::testing::at_ms;

TrafficConfig two_vehicles() {
  TrafficConfig config;
  config.vehicles.resize(2);
  config.vehicles[0] = {"auv-1", 4, SimDuration::from_seconds(10), SimTime::from_seconds(2), "auv-2", 12};
  config.vehicles[1] = {"auv-2", 5, SimDuration(), SimTime(), "all", 0};
  return config;
}

class ShownTrafficNode : public TrafficNode {
 public:
  using TrafficNode::status_text;
  using TrafficNode::TrafficNode;
};

class TrafficNodeTest : public ::testing::Test {
 protected:
  void step(std::int64_t ms) {
    node_.step({at_ms(ms), at_ms(ms)});
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  lcm::LCM lcm_{"memq://"};
  testing::FakeServer server_{lcm_, "auv-1"};
  ShownTrafficNode node_{lcm_, {"traffic", 77}, two_vehicles()};
};

TEST_F(TrafficNodeTest, PacketsStartOnTheGrid) {
  server_.answers = true;
  EXPECT_EQ(node_.due().sim, at_ms(2000));
  step(2000);
  EXPECT_EQ(node_.due().sim, at_ms(12000));
  step(12000);
  ASSERT_EQ(server_.sends.size(), 2u);
  EXPECT_EQ(server_.sends[0].utime, 2'000'000);
  EXPECT_EQ(server_.sends[1].utime, 12'000'000);
  EXPECT_EQ(server_.sends[0].destination_id, 5);
  EXPECT_EQ(server_.sends[0].source_id, 4);
  EXPECT_EQ(server_.sends[0].payload_size, 12);
}

TEST_F(TrafficNodeTest, StartedLateItSendsOnlyThePresentPacket) {
  step(47'500);
  ASSERT_EQ(server_.sends.size(), 1u);
  EXPECT_EQ(server_.sends[0].utime, 42'000'000);
  EXPECT_EQ(node_.due().sim, at_ms(52'000));
}

TEST_F(TrafficNodeTest, UnansweredPacketIsRepeatedAtSteadyTime) {
  step(2000);
  EXPECT_EQ(node_.due().steady, std::min(at_ms(2200), at_ms(3000)));
  step(2200);
  EXPECT_EQ(server_.sends.size(), 2u);
}

TEST_F(TrafficNodeTest, CountsReceiptsAndPackets) {
  server_.answers = true;
  step(2000);
  server_.deliver(9, 5, 0);
  step(2100);
  EXPECT_EQ(node_.status_text(), "sent 1, accepted 1, refused 0, received 1");
}

TEST(Traffic, PayloadBeginsWithThePacketsNumber) {
  EXPECT_THAT(traffic_payload(0x0102, 3), ElementsAre(2, 1, 0));
  EXPECT_THAT(traffic_payload(5, 10), ElementsAre(5, 0, 0, 0, 0, 0, 0, 0, 13, 14));
  EXPECT_TRUE(traffic_payload(5, 0).empty());
}

TEST(Traffic, UnknownDestinationIsRefused) {
  lcm::LCM lcm("memq://");
  TrafficConfig config = two_vehicles();
  config.vehicles[0].destination = "auv-9";
  EXPECT_THROW(TrafficNode(lcm, {"traffic", 1}, config), InvalidArgument);
}

TEST(Traffic, ConfigIsReadFromTheScenario) {
  TrafficConfig config;
  auto file = bus::ConfigFile::parse(R"(
[[vehicle]]
name = "auv-1"
id = 3
[vehicle.traffic]
period_s = 5
start_s = 1.5
destination = "all"
payload_bytes = 64
)",
                                     "test.toml");
  file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/true);
  ASSERT_EQ(config.vehicles.size(), 1u);
  EXPECT_EQ(config.vehicles[0].period, SimDuration::from_seconds(5));
  EXPECT_EQ(config.vehicles[0].start, SimTime::from_seconds(1.5));
  EXPECT_EQ(destination_id(config, config.vehicles[0]), kBroadcastId);
}

std::string errors_of_traffic(const std::string& keys) {
  TrafficConfig config;
  auto file = bus::ConfigFile::parse(
      "[[vehicle]]\nname = \"a\"\nid = 1\n[vehicle.traffic]\n" + keys + "[[vehicle]]\nname = \"b\"\nid = 2\n",
      "test.toml");
  file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
  try {
    file.check(/*whole_file=*/true);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(Traffic, KindAndAcknowledgementFitTheDestination) {
  using ::testing::HasSubstr;
  EXPECT_EQ(errors_of_traffic("destination = \"b\"\nack = true\nrate = 3\n"), "");
  EXPECT_EQ(errors_of_traffic("destination = \"b\"\nkind = \"ping\"\n"), "");
  EXPECT_THAT(errors_of_traffic("ack = true\n"), HasSubstr("ack"));
  EXPECT_THAT(errors_of_traffic("kind = \"ping\"\n"), HasSubstr("destination"));
  EXPECT_THAT(errors_of_traffic("destination = \"b\"\nkind = \"ping\"\nack = true\n"), HasSubstr("ack"));
  EXPECT_THAT(errors_of_traffic("hops = 2\nkind = \"janus\"\n"), HasSubstr("kind"));
  EXPECT_THAT(errors_of_traffic("kind = \"ack\"\n"), HasSubstr("mini-packet"));
}

// The lowest 13 bits of the number in 2 bytes, and its lowest 34 in 5 before the cargo.
TEST(Traffic, PayloadsOfBitsFitTheirKind) {
  VehicleTraffic traffic;
  traffic.kind = modem_send_t::MINI_PACKET;
  EXPECT_THAT(payload_of(traffic, 0x7abc), ElementsAre(0x1a, 0xbc));
  traffic.kind = modem_send_t::JANUS;
  EXPECT_THAT(payload_of(traffic, 0x7abc), ElementsAre(0, 0, 0, 0x7a, 0xbc));
  traffic.kind = modem_send_t::JANUS_CARGO;
  traffic.payload_bytes = 8;
  EXPECT_EQ(payload_of(traffic, 3).size(), 13u);
  EXPECT_EQ(payload_of(traffic, 3)[4], 3);
  traffic.kind = modem_send_t::PING;
  EXPECT_TRUE(payload_of(traffic, 3).empty());
}

TEST_F(TrafficNodeTest, KilledItRepeatsWhatHasNoReceiptAndGoesOnWithItsNumbers) {
  const bus::testing::JournalFiles files;
  node_.keep_state_in(files.open());
  step(2000);
  TrafficNode resumed(lcm_, {"traffic", 77}, two_vehicles());
  resumed.keep_state_in(files.open());
  server_.answers = true;
  resumed.step({at_ms(3000), at_ms(0)});
  while (lcm_.handleTimeout(0) > 0) {
  }
  resumed.step({at_ms(12'000), at_ms(9000)});
  while (lcm_.handleTimeout(0) > 0) {
  }
  ASSERT_EQ(server_.sends.size(), 3u);
  EXPECT_EQ(bus::encoded(server_.sends[1]), bus::encoded(server_.sends[0]));
  EXPECT_EQ(server_.sends[2].packet_sequence, 1);
  EXPECT_EQ(server_.sends[2].session, server_.sends[0].session);
  EXPECT_EQ(server_.sends[2].payload, traffic_payload(1, 12));
}

}  // namespace
}  // namespace halocline::clients
