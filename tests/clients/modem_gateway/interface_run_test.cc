// SPDX-License-Identifier: BSD-3-Clause
// Modem interfaces of three kinds over ten simulated minutes: what they report is what the channel decided.
#include "tests/clients/modem_gateway/interface_run.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "tests/clients/modem_gateway/host.h"

namespace halocline::modem_gateway {
namespace {

using testing::Host;
using testing::InterfaceRun;
using testing::InterfaceVehicle;

const std::vector<InterfaceVehicle> kFleet{
    {"micro-1", 1, "micromodem-psk-1", 0, 0, "micromodem", "pps=yes"},
    {"micro-2", 2, "micromodem-psk-1", 1000, 0, "micromodem", "pps=yes"},
    {"s2c-1", 3, "s2c-im", 0, 300, "evologics"},
    {"s2c-2", 4, "s2c-im", 700, 300, "evologics"},
    {"unet-1", 5, "unet-data", 0, 600, "unet"},
    {"unet-2", 6, "unet-data", 900, 600, "unet"}};

// What a host has read, line by line.
class Conversation {
 public:
  explicit Conversation(const std::string& place) : host_(place) {}
  void write(const std::string& text) { host_.write(text); }
  // The lines that came since the last call.
  std::vector<std::string> read() {
    text_ += host_.read();
    std::vector<std::string> fresh;
    for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
      fresh.push_back(text_.substr(0, end));
      text_.erase(0, end + 1);
    }
    lines.insert(lines.end(), fresh.begin(), fresh.end());
    return fresh;
  }
  std::size_t count(std::string_view part) const {
    return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.find(part) != std::string::npos;
    }));
  }

  std::vector<std::string> lines;

 private:
  Host host_;
  std::string text_;
};

class ModemInterfacesInARun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    run = std::make_unique<InterfaceRun>(kFleet);
    run->run_until(SimTime::from_seconds(1));
    for (std::size_t i = 0; i < kFleet.size(); ++i)
      hosts.push_back(std::make_unique<Conversation>(run->gateway().place_of(i)));
    for (const std::size_t i : {0, 1}) hosts[i]->write("$CCCFG,SNV,1\r\n$CCCLK,2026,11,24,10,30,00\r\n");
    for (const std::size_t i : {2, 3}) hosts[i]->write("AT@ZX1\nAT!RI0\n");
    for (int tick = 20; tick <= 600 * 20; ++tick) step(tick);
    for (auto& host : hosts) host->read();
  }
  static void TearDownTestSuite() {
    hosts.clear();
    run.reset();
  }

  // A twentieth of a second.
  static void step(int tick) {
    run->run_until(SimTime::from_nanoseconds(std::int64_t{tick} * 50'000'000));
    const int second = tick % 20 == 0 ? tick / 20 : -1;
    for (std::size_t i = 0; i < hosts.size(); ++i) {
      for (const std::string& line : hosts[i]->read()) {
        if (line.starts_with("$CADRQ"))
          hosts[i]->write("$CCTXD," + std::to_string(i + 1) + "," + std::to_string(2 - i) +
                          ",1,000A0D2B2CFF\r\n");
      }
      if (second > 2 && second < 590) talk(i, second);
    }
  }

  static void talk(std::size_t i, int second) {
    Conversation& host = *hosts[i];
    const std::string own = std::to_string(i + 1), other = std::to_string(i % 2 == 0 ? i + 2 : i);
    if (i < 2 && second % 23 == static_cast<int>(11 * i))
      host.write("$CCCYC,0," + own + "," + other + ",1,1,3\r\n");
    if (i < 2 && second % 47 == static_cast<int>(11 + 9 * i))
      host.write("$CCMPC," + own + "," + other + "\r\n");
    if (i < 2 && second % 37 == static_cast<int>(3 + 5 * i))
      host.write("$CCMUC," + own + "," + other + ",1ABC\r\n");
    if (i / 2 == 1 && second % 7 == static_cast<int>(i))
      host.write("AT*SENDIM,6," + other + ",ack,a+,b\r\n\n");
    if (i / 2 == 2 && second % 3 == static_cast<int>(i % 2))
      host.write(R"({"action":"send","message":{"clazz":"org.arl.unet.DatagramReq","data":{"msgID":"m",)"
                 R"("sender":"g",)"
                 R"("recipient":"phy","to":)" +
                 other +
                 R"(,"data":[1,2,3]}}})"
                 "\n");
  }

  // Outcomes of packets that this vehicle's modem had detected and lost.
  static std::size_t losses_at(std::size_t i) {
    std::size_t losses = 0;
    for (const auto& [vehicle, event] : run->events) {
      if (vehicle != kFleet[i].name || event.modem_event != modem_event_t::PACKET_ENDED) continue;
      losses += event.packet_outcome == packet_outcome_t::RECEIVED ? 0 : 1;
    }
    return losses;
  }
  // Outcomes at this vehicle of packets that its modem followed to their end, received or lost.
  static std::vector<packet_outcome_t> followed_at(std::size_t i) {
    std::set<std::int64_t> lost_at;
    for (const auto& [vehicle, event] : run->events) {
      const bool is_loss = vehicle == kFleet[i].name && event.modem_event == modem_event_t::PACKET_ENDED &&
                           event.packet_outcome != packet_outcome_t::RECEIVED;
      if (is_loss) lost_at.insert(event.utime);
    }
    std::vector<packet_outcome_t> followed;
    for (const packet_outcome_t& outcome : run->outcomes) {
      const bool is_here = outcome.receiver_id == kFleet[i].id;
      if (is_here && (outcome.outcome == packet_outcome_t::RECEIVED || lost_at.contains(outcome.utime)))
        followed.push_back(outcome);
    }
    return followed;
  }
  static std::size_t received_at(std::size_t i) {
    const auto followed = followed_at(i);
    return static_cast<std::size_t>(
        std::count_if(followed.begin(), followed.end(),
                      [](const packet_outcome_t& o) { return o.outcome == packet_outcome_t::RECEIVED; }));
  }

  static std::unique_ptr<InterfaceRun> run;
  static std::vector<std::unique_ptr<Conversation>> hosts;
};
std::unique_ptr<InterfaceRun> ModemInterfacesInARun::run;
std::vector<std::unique_ptr<Conversation>> ModemInterfacesInARun::hosts;

TEST_F(ModemInterfacesInARun, MicromodemsReportEachReceptionOnceAndEachLossOnce) {
  for (const std::size_t i : {0, 1}) {
    EXPECT_GT(received_at(i), 20u);
    EXPECT_GT(losses_at(i), 5u);
    EXPECT_EQ(hosts[i]->count("$CACST,"), received_at(i) + losses_at(i));
    std::size_t whole = 0, bad_frames = 0, broken_off = 0;
    for (const packet_outcome_t& outcome : followed_at(i)) {
      whole += outcome.outcome == packet_outcome_t::RECEIVED && outcome.num_frames_good == outcome.num_frames
                   ? 1
                   : 0;
      const bool broke_off = outcome.outcome == packet_outcome_t::HALF_DUPLEX;
      broken_off += broke_off ? 1 : 0;
      const bool has_frames = outcome.packet_kind == modem_receive_t::DATA && !broke_off;
      if (has_frames) bad_frames += static_cast<std::size_t>(outcome.num_frames - outcome.num_frames_good);
    }
    EXPECT_EQ(hosts[i]->count("$CACST,6,0,"), whole);
    EXPECT_EQ(hosts[i]->count("$CAMSG,BAD_CRC"), bad_frames);
    EXPECT_EQ(hosts[i]->count("$CAMSG,PACKET_TIMEOUT"), broken_off);
    EXPECT_GT(bad_frames, 0u);
  }
}

TEST_F(ModemInterfacesInARun, MicromodemsDeliverThreeFramesAndAcknowledgeThem) {
  EXPECT_GT(hosts[1]->count("$CARXD,1,2,1,3,000A0D2B2CFF"), 5u);
  EXPECT_GT(hosts[0]->count("$CAACK,2,1,3,1"), 5u);
  EXPECT_GT(hosts[1]->count("$CAMUA,1,2,1ABC"), 1u);
  EXPECT_GT(hosts[0]->count("$CAMPR,2,1,"), 1u);
}

// The clocks were set, pulses are whole seconds, and transmissions start on them. 1000 m are 0.66667 s.
TEST_F(ModemInterfacesInARun, TheFractionOfASecondOfAnArrivalIsTheTravelTime) {
  constexpr double kBound_s = 1e-4;
  std::size_t checked = 0;
  for (std::size_t at = 0; at < hosts[1]->lines.size(); ++at) {
    const std::string& line = hosts[1]->lines[at];
    const auto fields = fields_of(line, ',');
    if (!line.starts_with("$CACST,6,0,") || fields.at(18) != "3") continue;  // data by phase-shift keying
    const double arrival_s = number_in(fields[3].substr(14), 0, 1).value_or(-1);
    EXPECT_NEAR(arrival_s, 1000.0 / 1500.0, kBound_s) << line;
    EXPECT_EQ(fields[4], "14");
    ++checked;
  }
  EXPECT_GT(checked, 5u);
  for (const packet_outcome_t& outcome : run->outcomes) {
    if (outcome.receiver_id == 2 && outcome.source_id == 1) {
      EXPECT_NEAR(outcome.travel_time_s, 1000.0 / 1500.0, kBound_s);
    }
  }
}

TEST_F(ModemInterfacesInARun, EvologicsModemsReportEachReceptionAndEachLossOnce) {
  for (const std::size_t i : {2, 3}) {
    EXPECT_GT(losses_at(i), 5u);
    EXPECT_EQ(hosts[i]->count("RECVFAILED,"), losses_at(i));
    EXPECT_EQ(hosts[i]->count("RECVEND,"), received_at(i));
    EXPECT_EQ(hosts[i]->count("RECVSTART"), received_at(i) + losses_at(i));
    EXPECT_GT(hosts[i]->count("DELIVEREDIM,"), 10u);
    EXPECT_GT(hosts[i]->count("FAILEDIM,"), 5u);
    EXPECT_GT(hosts[i]->count(",a+,b"), 10u);
  }
}

TEST_F(ModemInterfacesInARun, UnetGatewaysReportEachFrameAndEachLossOnce) {
  for (const std::size_t i : {4, 5}) {
    EXPECT_GT(received_at(i), 50u);
    EXPECT_GT(losses_at(i), 5u);
    EXPECT_EQ(hosts[i]->count(".RxFrameNtf"), received_at(i));
    EXPECT_EQ(hosts[i]->count(".BadFrameNtf") + hosts[i]->count(".CollisionNtf"), losses_at(i));
  }
}

// Transmissions start on whole seconds of the sender's clock, which is 4 ms ahead; the receiver's is 3 ms
// late.
TEST(ModemInterfaceClocks, AMeasuredTravelTimeIsOffByWhatTheClocksDiffer) {
  std::vector<InterfaceVehicle> fleet{kFleet[0], kFleet[1]};
  fleet[0].more = "[vehicle.clock]\noffset_s = 0.004\n";
  fleet[1].more = "[vehicle.clock]\noffset_s = -0.003\n";
  InterfaceRun run(fleet);
  run.run_until(SimTime::from_seconds(1));
  Conversation sender(run.gateway().place_of(0)), receiver(run.gateway().place_of(1));
  for (Conversation* host : {&sender, &receiver})
    host->write("$CCCFG,SNV,1\r\n$CCCLK,2026,11,24,10,30,00\r\n");
  for (int second = 2; second < 40; ++second) {
    if (second % 4 == 0) sender.write("$CCMUC,1,2,0001\r\n");
    run.run_until(SimTime::from_seconds(second));
  }
  receiver.read();
  std::size_t checked = 0;
  for (const std::string& line : receiver.lines) {
    const auto fields = fields_of(line, ',');
    if (!line.starts_with("$CACST,6,0,")) continue;
    EXPECT_NEAR(number_in(fields.at(3).substr(14), 0, 1).value_or(-1), 1000.0 / 1500.0 - 0.007, 1e-4) << line;
    ++checked;
  }
  EXPECT_GT(checked, 3u);
  for (const packet_outcome_t& outcome : run.outcomes)
    EXPECT_EQ(outcome.departure_utime % 1'000'000, 996'000) << "4 ms before a second of the simulation";
}

TEST(ModemInterfaceSleep, AModemThatSleepsHearsNothingUntilItReboots) {
  InterfaceRun run({kFleet[0], kFleet[1]});
  run.run_until(SimTime::from_seconds(1));
  Conversation sender(run.gateway().place_of(0)), sleeper(run.gateway().place_of(1));
  sleeper.write("$CCMSC,2,2,1\r\n");
  for (int second = 2; second < 100; ++second) {
    run.run_until(SimTime::from_seconds(second));
    if (second % 7 == 0) sender.write("$CCMUC,1,2,0001\r\n");
  }
  sleeper.read();
  EXPECT_EQ(sleeper.count(",INIT,"), 1u);
  std::size_t received = 0;
  for (const packet_outcome_t& outcome : run.outcomes) {
    if (outcome.receiver_id != 2) continue;
    const bool sleeps = outcome.utime < 61'000'000;
    EXPECT_EQ(outcome.outcome == packet_outcome_t::ASLEEP, sleeps) << outcome.utime;
    received += outcome.outcome == packet_outcome_t::RECEIVED ? 1 : 0;
  }
  EXPECT_GT(received, 2u);
  EXPECT_EQ(sleeper.count("$CAMUA,1,2,0001"), received);
}

// Hosts of one modem interface that do what none should; everybody else's packets fare as if nobody had.
std::vector<std::string> outcomes_with(bool has_bad_hosts) {
  std::vector<InterfaceVehicle> fleet = kFleet;
  for (InterfaceVehicle& vehicle : fleet) vehicle.more = "";
  fleet[1].kind = "";
  fleet.push_back({"talker", 7, "micromodem-psk-1", 500, 0, "", "", ""});
  InterfaceRun run(fleet);
  run.run_until(SimTime::from_seconds(1));
  Conversation good(run.gateway().place_of(1));
  std::vector<std::unique_ptr<Host>> bad;
  const std::string place = run.gateway().place_of(0);
  for (int tick = 11; tick <= 600; ++tick) {
    if (has_bad_hosts) {
      if (bad.size() < 500) bad.push_back(std::make_unique<Host>(place));
      bad[static_cast<std::size_t>(tick) % bad.size()]->write(
          std::string(4096, static_cast<char>('A' + tick % 26)));
      if (tick <= 42) bad.front()->write(std::string(32'768, 'x'));  // a line of 1 MiB that has no end
      if (tick % 10 == 0) bad[static_cast<std::size_t>(tick / 10) % bad.size()]->write("$CCTXD,1,2,0,00112");
      if (tick % 50 == 0) bad[static_cast<std::size_t>(tick / 50)]->close();
      bad[bad.size() / 2]->write("$CCCFQ,ALL\r\n");  // and reads none of it
    }
    if (tick % 40 == 0) good.write("AT*SENDIM,5,4,ack,hello\n");
    run.run_until(SimTime::from_nanoseconds(std::int64_t{tick} * 100'000'000));
  }
  std::vector<std::string> all;
  for (const packet_outcome_t& outcome : run.outcomes) {
    const bus::Bytes bytes = bus::encoded(outcome);
    all.emplace_back(bytes.begin(), bytes.end());
  }
  return all;
}

TEST(ModemInterfaceHosts, ThatMisbehaveChangeNoOutcomeOfOthers) {
  const auto quiet = outcomes_with(false);
  EXPECT_GT(quiet.size(), 50u);
  EXPECT_EQ(outcomes_with(true), quiet);
}

}  // namespace
}  // namespace halocline::modem_gateway
