// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/gateway_node.h"

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "bus/runtime/node_process.h"
#include "tests/clients/modem/fake_server.h"
#include "tests/clients/modem_gateway/host.h"

namespace halocline::modem_gateway {
namespace {

using testing::Host;
using testing::work_until;

// A gateway with two modem interfaces on one bus, and the channel server's side of the first by hand.
class GatewayNodeTest : public ::testing::Test {
 protected:
  static GatewayConfig two_interfaces() {
    GatewayConfig config;
    config.vehicles = {{"auv-1", 1}, {"auv-2", 2}};
    add_interface(config, "auv-1=nm3:tcp:0");
    add_interface(config, "auv-2=nm3:tcp:0");
    return config;
  }
  void work() {
    while (lcm_.handleTimeout(0) > 0) {
    }
    const SimTime steady = bus::steady_now();
    node_.note_due_changed();
    node_.step({SimTime::from_seconds(sim_s_), steady, true});
  }
  std::string read(Host& host, std::size_t size) {
    std::string text;
    work_until([&] { work(), text += host.read(); }, [&] { return text.size() >= size; });
    return text;
  }

  double sim_s_ = 10;
  lcm::LCM lcm_{"memq://"};
  clients::testing::FakeServer server_{lcm_, "auv-1"};
  GatewayNode node_{lcm_, {"modem-gateway", 5}, two_interfaces(), SimDuration()};
};

TEST_F(GatewayNodeTest, WhatAHostAsksForGoesOutAsASend) {
  server_.answers = true;
  Host host(node_.place_of(0));
  host.write("$B05hello");
  EXPECT_EQ(read(host, 6), "$B05\r\n");
  ASSERT_TRUE(work_until([&] { work(); }, [&] { return !server_.sends.empty(); }));
  EXPECT_EQ(server_.sends[0].source_id, 1);
  EXPECT_EQ(server_.sends[0].utime, 10'000'000);
  EXPECT_EQ(server_.sends[0].payload, (std::vector<std::uint8_t>{'h', 'e', 'l', 'l', 'o'}));
}

TEST_F(GatewayNodeTest, WhatAModemReceivesGoesToItsHostsAlone) {
  Host one(node_.place_of(0)), two(node_.place_of(1));
  one.write("$?"), two.write("$?");
  EXPECT_EQ(read(one, 13), "#A001V52429\r\n");
  EXPECT_EQ(read(two, 13), "#A002V52429\r\n");
  server_.deliver(8, 2, 'x');
  EXPECT_EQ(read(one, 7), "#U01x\r\n");
  EXPECT_EQ(two.read(), "");
}

TEST_F(GatewayNodeTest, AnAddressThatAHostSetsHoldsAtTheOtherModemInterfaces) {
  Host one(node_.place_of(0)), two(node_.place_of(1));
  two.write("$A077");
  EXPECT_EQ(read(two, 7), "#A077\r\n");
  one.write("$U07702ab");
  read(one, 9);
  ASSERT_TRUE(work_until([&] { work(); }, [&] { return !server_.sends.empty(); }));
  EXPECT_EQ(server_.sends[0].destination_id, 2);
}

TEST_F(GatewayNodeTest, IsDueAtOnceWhenAHostHasWritten) {
  work();
  EXPECT_NE(node_.due().sim, SimTime::at_once());
  const Host host(node_.place_of(0));
  EXPECT_TRUE(
      work_until([&] { node_.note_due_changed(); }, [&] { return node_.due().sim == SimTime::at_once(); }));
}

TEST_F(GatewayNodeTest, WhatNoModemSendsIsNotSentAndHarmsNothing) {
  Host host(node_.place_of(0));
  host.write("$P000$U00002ab$M00002ab");
  EXPECT_EQ(read(host, 13), "$P000\r\nE\r\nE\r\n");
  host.write("$?");
  EXPECT_EQ(read(host, 13), "#A001V52429\r\n");
  for (const auto& send : server_.sends) EXPECT_NE(send.destination_id, 0);
}

TEST_F(GatewayNodeTest, HostsThatMisbehaveDisturbNobodyElse) {
  Host good(node_.place_of(1));
  Host garbage(node_.place_of(0)), half(node_.place_of(0)), deaf(node_.place_of(0));
  for (int i = 0; i < 64; ++i) {
    garbage.write(std::string(16 * 1024, static_cast<char>(i * 37)));
    deaf.write("$?$?$?$?$?$?$?$?");
    work();
  }
  half.write("$U00264half");
  work();
  half.close();
  good.write("$?");
  EXPECT_EQ(read(good, 13), "#A002V52429\r\n");
}

// Nobody answers its SENDs.
TEST_F(GatewayNodeTest, OfAHostThatCommandsWithoutEndWhatIsNotRefusedIsSent) {
  Host host(node_.place_of(0));
  std::string commands;
  for (int i = 0; i < 500; ++i) commands += "$B05hello";
  host.write(commands);
  EXPECT_EQ(read(host, 6 + 3 * 499).size(), 6u + 3 * 499) << "one confirmed, all others refused";
  work();
  std::set<std::int64_t> packets;
  for (const auto& send : server_.sends) packets.insert(send.packet_sequence);
  EXPECT_EQ(packets.size(), 1u);
}

// As the modem is while it sends an acknowledgement of its own.
TEST_F(GatewayNodeTest, APacketThatABusyModemRefusesIsSentAgainAndItsAnswerIsKnown) {
  Host host(node_.place_of(0));
  host.write("$M00902ab");
  EXPECT_EQ(read(host, 9), "$M00902\r\n");
  ASSERT_TRUE(work_until([&] { work(); }, [&] { return server_.sends.size() == 1; }));
  server_.answer(server_.sends[0], modem_receipt_t::REFUSED_BUSY);
  ASSERT_TRUE(work_until([&] { sim_s_ += 0.001, work(); }, [&] { return server_.sends.size() == 2; }));
  EXPECT_NE(server_.sends[1].packet_sequence, server_.sends[0].packet_sequence);
  EXPECT_EQ(server_.sends[1].payload, server_.sends[0].payload);
  EXPECT_GE(server_.sends[1].utime - server_.sends[0].utime, 100'000);
  server_.accept(server_.sends[1]);
  work();
  server_.reply_to_ping(server_.sends[1], 9, 0.5);
  EXPECT_EQ(read(host, 13), "#R009T08000\r\n");
}

TEST_F(GatewayNodeTest, ANewRunBeginsWithTheModemsOfTheScenario) {
  Host host(node_.place_of(0));
  host.write("$A077$P009");
  EXPECT_EQ(read(host, 14), "#A077\r\n$P009\r\n");
  node_.restart({SimTime::from_seconds(1), bus::steady_now(), true});
  sim_s_ = 1;
  host.write("$?$P009");
  EXPECT_EQ(read(host, 20), "#A001V52429\r\n$P009\r\n");
}

}  // namespace
}  // namespace halocline::modem_gateway
