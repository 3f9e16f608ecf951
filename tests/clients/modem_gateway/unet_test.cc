// SPDX-License-Identifier: BSD-3-Clause
// The JSON lines of the UnetStack gateway, one by one, in both directions.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "clients/modem_gateway/protocols/unet/unet_json.h"
#include "core/check.h"
#include "core/names.h"
#include "core/text/base64.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kHardBytes;
using testing::ProtocolBench;
using ::testing::SizeIs;

std::vector<json> lines_in(const std::string& written) {
  std::vector<json> lines;
  for (std::size_t begin = 0; begin < written.size();) {
    const std::size_t end = written.find('\n', begin);
    lines.push_back(json::parse(written.substr(begin, end - begin)));
    begin = end + 1;
  }
  return lines;
}

struct UnetBench : ProtocolBench {
  UnetBench() : ProtocolBench("unet") {}
  std::vector<json> say(const json& request) { return lines_in(ask(request.dump() + "\n")); }
  // The messages that follow a request to an agent.
  std::vector<json> request(const std::string& agent, const std::string& clazz, json data) {
    data["msgID"] = "m1";
    data["sender"] = "gateway-7";
    data["recipient"] = agent;
    return say({{"action", "send"}, {"relay", true}, {"message", {{"clazz", clazz}, {"data", data}}}});
  }
  json get(const std::string& agent, const std::string& param, int index = -1) {
    const auto answers =
        request(agent, "org.arl.fjage.param.ParameterReq", {{"param", param}, {"index", index}});
    return answers.at(0)["message"]["data"];
  }
};
std::string clazz_of(const json& line) { return line["message"]["clazz"]; }
const json& data_of(const json& line) { return line["message"]["data"]; }
json bytes(std::string_view text) { return unet_array(as_bytes(text)); }

TEST(UnetJson, Base64IsThatOfRfc4648) {
  for (const auto& [text, encoded] :
       {std::pair("", ""), {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}}) {
    EXPECT_EQ(base64_of(as_bytes(text)), encoded);
    EXPECT_EQ(bytes_of_base64(encoded), as_bytes(text));
  }
  EXPECT_FALSE(bytes_of_base64("Z!=="));
}

TEST(UnetJson, ArraysOfBytesAreListsOrBase64) {
  EXPECT_EQ(unet_bytes(json::parse("[0,10,13,43,44,255,-1]")),
            (std::vector<std::uint8_t>{0, 10, 13, 43, 44, 255, 255}));
  EXPECT_EQ(unet_bytes(bytes(kHardBytes)), as_bytes(kHardBytes));
  for (const auto* wrong : {"[256]", "[\"a\"]", "\"text\"", "{\"clazz\":\"[F\",\"data\":\"\"}", "7"})
    EXPECT_FALSE(unet_bytes(json::parse(wrong))) << wrong;
}

TEST(Unet, GreetsAHostWithTheseVeryBytes) {
  UnetBench bench;
  bench.protocol->on_opened(9);
  EXPECT_EQ(bench.port.take(), "{\"alive\": true}\n");
  EXPECT_EQ(bench.ask("{\"alive\": true}\n"), "");
}

TEST(Unet, AnswersRequestsOfFjageWithTheirId) {
  UnetBench bench;
  const auto answer = [&](json request) {
    request["id"] = "r1";
    const auto answers = bench.say(request);
    EXPECT_THAT(answers, SizeIs(1)) << request;
    EXPECT_EQ(answers.at(0)["id"], "r1");
    EXPECT_EQ(answers.at(0)["inResponseTo"], request["action"]);
    return answers.at(0);
  };
  EXPECT_THAT(answer({{"action", "agents"}})["agentIDs"].get<std::vector<std::string>>(),
              ElementsAre("node", "arp", "phy", "ranging", "uwlink"));
  EXPECT_EQ(answer({{"action", "containsAgent"}, {"agentID", "phy"}})["answer"], true);
  EXPECT_EQ(answer({{"action", "containsAgent"}, {"agentID", "nobody"}})["answer"], false);
  EXPECT_EQ(answer({{"action", "agentForService"}, {"service", "org.arl.unet.Services.PHYSICAL"}})["agentID"],
            "phy");
  EXPECT_FALSE(answer({{"action", "agentForService"}, {"service", "org.arl.unet.Services.ROUTING"}})
                   .contains("agentID"));
  EXPECT_EQ(
      answer({{"action", "agentsForService"}, {"service", "org.arl.unet.Services.DATAGRAM"}})["agentIDs"],
      json({"uwlink", "phy"}));
  EXPECT_THAT(answer({{"action", "services"}})["services"], SizeIs(6));
  EXPECT_EQ(answer({{"action", "auth"}, {"creds", "x"}})["auth"], true);
}

TEST(Unet, ParametersAreAskedAndSet) {
  UnetBench bench;
  EXPECT_EQ(bench.get("node", "address")["value"], 1);
  EXPECT_EQ(bench.get("node", "version")["value"], "5.2.0");
  EXPECT_EQ(bench.get("phy", "org.arl.unet.phy.PhysicalParam.MTU")["value"], 64);
  EXPECT_EQ(bench.get("phy", "time")["value"], 100'000'000);
  bench.port.clock_ahead = SimDuration::from_milliseconds(5);
  EXPECT_EQ(bench.get("phy", "time")["value"], 100'005'000) << "the vehicle's clock";
  EXPECT_EQ(bench.get("phy", "dataRate", 1)["value"], 800.0);
  EXPECT_NEAR(bench.get("phy", "frameDuration", 2)["value"].get<double>(), 0.1 + 512 / 2400.0, 1e-9);
  EXPECT_EQ(bench.get("phy", "nothing")["perf"], "NOT_UNDERSTOOD");
  const auto set = bench.request("node", "org.arl.unet.ParameterReq", {{"param", "address"}, {"value", 31}});
  EXPECT_EQ(clazz_of(set.at(0)), "org.arl.unet.ParameterRsp");
  EXPECT_EQ(data_of(set.at(0))["value"], 31);
  EXPECT_EQ(bench.addresses.vehicle_of(31), 1);
  const auto several =
      bench.request("phy", "org.arl.fjage.param.ParameterReq",
                    {{"param", "MTU"}, {"requests", {{{"param", "time"}}, {{"param", "noise"}}}}});
  EXPECT_EQ(data_of(several.at(0))["values"].size(), 2u);
  EXPECT_GT(data_of(bench.request("phy", "org.arl.fjage.param.ParameterReq", json::object()).at(0))["values"]
                .size(),
            5u);
}

TEST(Unet, AFrameIsAgreedToSentAndItsEndReported) {
  UnetBench bench;
  const auto answers = bench.request("phy", "org.arl.unet.phy.TxFrameReq",
                                     {{"type", 1}, {"to", 2}, {"data", bytes(kHardBytes)}});
  ASSERT_THAT(answers, SizeIs(1));
  EXPECT_EQ(data_of(answers[0])["perf"], "AGREE");
  EXPECT_EQ(data_of(answers[0])["inReplyTo"], "m1");
  EXPECT_EQ(data_of(answers[0])["recipient"], "gateway-7");
  ASSERT_THAT(bench.port.sent, SizeIs(1));
  EXPECT_EQ(bench.port.sent[0].payload, kHardBytes);
  EXPECT_EQ(bench.port.sent[0].options.rate_number, 1);
  bench.accept(0.26);
  const auto end = lines_in(bench.wait(0.3));
  ASSERT_THAT(end, SizeIs(1));
  EXPECT_EQ(clazz_of(end[0]), "org.arl.unet.phy.TxFrameNtf");
  EXPECT_EQ(data_of(end[0])["txTime"], 100'000'000);
  EXPECT_EQ(data_of(end[0])["inReplyTo"], "m1");
}

TEST(Unet, TimesAreTheVehiclesClock) {
  UnetBench bench;
  bench.port.clock_ahead = SimDuration::from_milliseconds(5);
  bench.request("phy", "org.arl.unet.phy.TxFrameReq",
                {{"type", 1}, {"to", 2}, {"data", bytes("x")}, {"txTime", 101'005'000}});
  EXPECT_EQ(bench.port.sent.at(0).start, SimTime::from_seconds(101));
  bench.accept(0.26);
  EXPECT_EQ(data_of(lines_in(bench.wait(2)).at(0))["txTime"], 101'005'000);
}

TEST(Unet, FramesWaitForEachOther) {
  UnetBench bench;
  for (int i = 0; i < 17; ++i)
    bench.request("phy", "org.arl.unet.DatagramReq", {{"to", 0}, {"data", bytes("x")}});
  EXPECT_THAT(bench.port.sent, SizeIs(1));
  EXPECT_EQ(bench.port.sent[0].destination, kBroadcastId);
  EXPECT_EQ(
      clazz_of(bench.request("phy", "org.arl.unet.DatagramReq", {{"to", 0}, {"data", bytes("x")}}).at(0)),
      "org.arl.unet.RefuseRsp");
  bench.accept(0.3);
  bench.wait(0.4);
  EXPECT_THAT(bench.port.sent, SizeIs(2));
}

TEST(Unet, AReliableDatagramIsDeliveredOrFails) {
  UnetBench bench;
  const json datagram{{"to", 2}, {"data", bytes("hi")}, {"reliability", true}};
  bench.request("uwlink", "org.arl.unet.DatagramReq", datagram);
  EXPECT_TRUE(bench.port.sent.at(0).options.wants_ack);
  bench.accept(0.3);
  EXPECT_THAT(lines_in(bench.wait(0.4)), IsEmpty())
      << "a host takes the first notification as the datagram's fate";
  const auto delivered = lines_in(bench.receive(bench.answer_from(2, modem_receive_t::ACK, 1, "\x01")));
  EXPECT_EQ(clazz_of(delivered.at(0)), "org.arl.unet.DatagramDeliveryNtf");
  EXPECT_EQ(data_of(delivered.at(0))["to"], 2);
  bench.request("uwlink", "org.arl.unet.DatagramReq", datagram);
  for (int tries = 1; tries <= 3; ++tries) {
    ASSERT_THAT(bench.port.sent, SizeIs(1 + tries));
    bench.accept(0.3);
    const auto written = lines_in(bench.wait(5.4));
    ASSERT_THAT(written, SizeIs(tries == 3 ? 1 : 0));
    if (tries == 3) {
      EXPECT_EQ(clazz_of(written[0]), "org.arl.unet.DatagramFailureNtf");
    }
  }
}

TEST(Unet, AReliableDatagramHoldsUpThoseToTheSameNodeAlone) {
  UnetBench bench;
  json datagram{{"to", 2}, {"data", bytes("hi")}, {"reliability", true}};
  bench.request("uwlink", "org.arl.unet.DatagramReq", datagram);
  bench.request("uwlink", "org.arl.unet.DatagramReq", datagram);
  datagram["to"] = 3;
  bench.request("uwlink", "org.arl.unet.DatagramReq", datagram);
  bench.accept(0.3);
  bench.wait(0.4);
  ASSERT_THAT(bench.port.sent, SizeIs(2));
  EXPECT_EQ(bench.port.sent[1].destination, 3);
  modem_receive_t ack = bench.answer_from(2, modem_receive_t::ACK, 1, "\x01");
  ack.packet_sequence = bench.port.sent[0].sequence;
  bench.receive(ack);
  bench.accept(0.3);
  bench.wait(0.4);
  ASSERT_THAT(bench.port.sent, SizeIs(3));
  EXPECT_EQ(bench.port.sent[2].destination, 2);
}

TEST(Unet, ACancelledDatagramFails) {
  UnetBench bench;
  for (int i = 0; i < 3; ++i)
    bench.request("uwlink", "org.arl.unet.DatagramReq",
                  {{"to", 2}, {"data", bytes("hi")}, {"reliability", i < 2}});
  const auto lines = bench.request("uwlink", "org.arl.unet.ClearReq", json::object());
  ASSERT_THAT(lines, SizeIs(3));
  EXPECT_EQ(data_of(lines[0])["perf"], "AGREE");
  EXPECT_EQ(clazz_of(lines[1]), "org.arl.unet.DatagramFailureNtf");
  EXPECT_EQ(data_of(lines[2])["perf"], "FAILURE");
}

TEST(Unet, NoRequestStaysWithoutAnAnswer) {
  UnetBench bench;
  EXPECT_THAT(bench.request("nobody", "org.arl.unet.DatagramReq", {{"to", 2}}).at(0).dump(),
              HasSubstr("no agent nobody"));
  EXPECT_EQ(bench.say({{"action", "dance"}, {"id", "7"}}).at(0)["id"], "7");
  EXPECT_THAT(
      bench.request("uwlink", "org.arl.unet.DatagramReq", {{"to", 0}, {"reliability", true}}).at(0).dump(),
      HasSubstr("no reliable broadcast"));
  EXPECT_THAT(bench.request("phy", "org.arl.unet.DatagramReq", {{"to", 2}, {"protocol", 20}}).at(0).dump(),
              HasSubstr("bad protocol"));
}

TEST(Unet, RefusesWhatCannotBeSent) {
  UnetBench bench;
  EXPECT_THAT(
      bench
          .request("phy", "org.arl.unet.phy.TxFrameReq", {{"type", 1}, {"data", bytes(std::string(17, 'x'))}})
          .at(0)
          .dump(),
      HasSubstr("data too long"));
  EXPECT_THAT(bench.request("phy", "org.arl.unet.phy.TxFrameReq", {{"type", 3}}).at(0).dump(),
              HasSubstr("REFUSE"));
  EXPECT_THAT(bench.request("phy", "org.arl.unet.bb.TxBasebandSignalReq", {{"signal", {1}}}).at(0).dump(),
              HasSubstr("no waveform channel"));
  EXPECT_THAT(bench.request("ranging", "org.arl.unet.localization.RangeReq", {{"to", 1}}).at(0).dump(),
              HasSubstr("REFUSE"));
  EXPECT_EQ(data_of(bench.request("phy", "org.arl.unet.Nonsense", json::object()).at(0))["perf"],
            "NOT_UNDERSTOOD");
  EXPECT_EQ(data_of(bench.request("phy", "org.arl.unet.ClearReq", json::object()).at(0))["perf"], "AGREE");
  EXPECT_THAT(bench.port.sent, IsEmpty());
}

TEST(Unet, RangesByTheTwoWayTimeAndItsSoundSpeed) {
  UnetBench bench;
  EXPECT_EQ(
      data_of(bench.request("ranging", "org.arl.unet.localization.RangeReq", {{"to", 2}}).at(0))["perf"],
      "AGREE");
  EXPECT_EQ(bench.port.sent.at(0).options.kind, modem_send_t::PING);
  bench.accept(0.1);
  const auto range = lines_in(bench.receive(bench.answer_from(2, modem_receive_t::PING_REPLY, 1.0)));
  ASSERT_THAT(range, SizeIs(1));
  EXPECT_EQ(clazz_of(range[0]), "org.arl.unet.localization.RangeNtf");
  EXPECT_EQ(data_of(range[0])["recipient"], "#ranging__ntf");
  EXPECT_EQ(data_of(range[0])["range"], 750.0);
}

TEST(Unet, AFrameReceivedIsPublishedOnTheTopicOfPhy) {
  UnetBench bench;
  bench.request("phy", "org.arl.unet.phy.TxFrameReq",
                {{"type", 2}, {"to", 2}, {"protocol", 33}, {"data", bytes(kHardBytes)}});
  modem_receive_t packet = bench.packet_from(5, 1, bench.port.sent.at(0).payload);
  packet.header_number = bench.port.sent[0].options.header_number;
  modem_event_t detected{};
  detected.modem_event = modem_event_t::PACKET_DETECTED;
  detected.rate_number = 2;
  detected.arrival_utime = packet.arrival_utime;
  bench.protocol->on_event(detected);
  const auto start = lines_in(bench.port.take());
  ASSERT_THAT(start, SizeIs(1));
  EXPECT_EQ(clazz_of(start[0]), "org.arl.unet.phy.RxFrameStartNtf");
  EXPECT_EQ(data_of(start[0])["type"], 2);
  EXPECT_EQ(data_of(start[0])["rxTime"], 99'750'000);
  packet.rate_number = 2;
  const auto lines = lines_in(bench.receive(packet));
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_EQ(clazz_of(lines[0]), "org.arl.unet.phy.RxFrameNtf");
  const json& frame = data_of(lines[0]);
  EXPECT_EQ(frame["recipient"], "#phy__ntf");
  EXPECT_EQ(frame["from"], 5);
  EXPECT_EQ(frame["to"], 1);
  EXPECT_EQ(frame["protocol"], 33);
  EXPECT_EQ(frame["type"], 2);
  EXPECT_EQ(frame["rxTime"], 99'750'000);
  EXPECT_EQ(unet_bytes(frame["data"]), as_bytes(kHardBytes));
}

TEST(Unet, LostFramesAreReportedByTheirCause) {
  UnetBench bench;
  packet_outcome_t loss{};
  loss.rate_number = 1;
  loss.outcome = packet_outcome_t::BIT_ERRORS;
  EXPECT_EQ(clazz_of(lines_in(bench.lose(loss)).at(0)), "org.arl.unet.phy.BadFrameNtf");
  loss.outcome = packet_outcome_t::COLLIDED;
  EXPECT_EQ(clazz_of(lines_in(bench.lose(loss)).at(0)), "org.arl.unet.phy.CollisionNtf");
}

TEST(Unet, AHostGetsOnlyMessagesThatItWants) {
  UnetBench bench;
  bench.say({{"action", "wantsMessagesFor"}, {"agentIDs", {"gateway-8"}}});
  EXPECT_EQ(bench.receive(bench.packet_from(5, 1, "hi")), "");
  bench.say({{"action", "wantsMessagesFor"}, {"agentIDs", {"gateway-8", "#phy__ntf"}}});
  EXPECT_THAT(lines_in(bench.receive(bench.packet_from(5, 1, "hi"))), SizeIs(1));
}

TEST(Unet, GarbageIsNotAnsweredAndHarmsNothing) {
  UnetBench bench;
  EXPECT_EQ(
      bench.ask(
          "no json\n[1,2]\n{\"action\":7}\n{\"action\":\"send\",\"message\":[]}\n{\"action\":\"send\"}\n"),
      "");
  EXPECT_EQ(bench.ask(std::string(8000, '[') + "\n" + std::string(20'000, '{') + "\n"), "");
  EXPECT_THAT(bench.say({{"action", "agents"}, {"id", "1"}}), SizeIs(1));
}

TEST(Unet, NamesOfVehiclesAreResolved) {
  testing::FakePort port;
  AddressBook addresses;
  const auto protocol =
      make_protocol("unet", {port, addresses, 1, InterfaceOptions(), {{"auv-1", 1}, {"buoy", 9}}});
  const auto resolve = [&](const std::string& name) {
    const json data{{"msgID", "m"}, {"sender", "g"}, {"recipient", "arp"}, {"name", name}};
    const json message{{"clazz", "org.arl.unet.addr.AddressResolutionReq"}, {"data", data}};
    protocol->on_bytes(1, json{{"action", "send"}, {"message", message}}.dump() + "\n");
    return data_of(lines_in(port.take()).at(0));
  };
  EXPECT_EQ(resolve("buoy")["address"], 9);
  EXPECT_EQ(resolve("12")["address"], 12);
  EXPECT_EQ(resolve("nobody")["perf"], "REFUSE");
}

}  // namespace
}  // namespace halocline::modem_gateway
