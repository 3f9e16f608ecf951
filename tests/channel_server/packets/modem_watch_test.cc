// SPDX-License-Identifier: BSD-3-Clause
// What modems report and how they listen: events, carrier, sleep, packets for others.
#include "channel_server/packets/modem_watch.h"

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using Kind = ModemEventKind;
using halocline::testing::tolerance;
using testing::at_s;
using ::testing::ElementsAre;
using testing::for_s;
using ::testing::IsEmpty;
using testing::path;

// Vehicle 2 listens; a byte takes 10 ms.
class ModemWatchTest : public testing::ScriptedWater {
 protected:
  ModemWatchTest() {
    listen(2, 0, {.events = true});
    water.set(1, 2, {path(1, 120)});
    water.set(3, 2, {path(0.5, 120)});
    water.set(2, 1, {path(1, 120)});
  }
  void listen(VehicleId id, double from_s, const Listening& listening) {
    fleet.announce_listening(testing::name_of(id), at_s(from_s), listening, at_s(from_s));
    medium.on_listening_changed(testing::name_of(id), at_s(from_s));
  }
  struct Noticed {
    Kind kind;
    SimTime at;
    bool operator==(const Noticed&) const = default;
  };
  std::vector<Noticed> noticed_by(VehicleId id) const {
    std::vector<Noticed> noticed;
    for (const ModemEvent& event : events_of(id))
      noticed.push_back({event.kind, times_[&event - all_.data()]});
    return noticed;
  }
  const std::vector<ModemEvent>& events_of(VehicleId id) const {
    all_.clear();
    times_.clear();
    for (const MediumEvent& event : events) {
      const auto* of_modem = std::get_if<ModemEvent>(&event.what);
      if (of_modem == nullptr || of_modem->vehicle != testing::name_of(id)) continue;
      all_.push_back(*of_modem);
      times_.push_back(event.at);
    }
    return all_;
  }

 private:
  mutable std::vector<ModemEvent> all_;
  mutable std::vector<SimTime> times_;
};

TEST_F(ModemWatchTest, APacketIsDetectedAtTheEndOfItsPreambleAndEndsWithItsLastBit) {
  change_modem({1, 2}, [](acoustics::Modem& modem) { modem.packet_overhead = modem.preamble = for_s(0.25); });
  send(1, 10, 0, 100);  // a quarter and one second
  run();
  EXPECT_THAT(
      noticed_by(2),
      ElementsAre(Noticed{Kind::kCarrierBegan, at_s(11)}, Noticed{Kind::kPacketDetected, at_s(11.25)},
                  Noticed{Kind::kPacketEnded, at_s(12.25)}, Noticed{Kind::kCarrierEnded, at_s(12.25)}));
  for (const ModemEvent& event : events_of(2)) {
    if (event.kind == Kind::kCarrierEnded) continue;
    EXPECT_NEAR(event.level.value, 120, tolerance(1e-9));
    EXPECT_EQ(event.outcome, OutcomeKind::kReceived);
  }
}

TEST_F(ModemWatchTest, ADetectionTellsTheRateAndWhenThePacketBegan) {
  change_modem({1, 2}, [](acoustics::Modem& modem) { modem.packet_overhead = modem.preamble = for_s(0.25); });
  send(1, 10, 0, 100);
  run();
  const ModemEvent detected = events_of(2).at(1), ended = events_of(2).at(2);
  ASSERT_EQ(detected.kind, Kind::kPacketDetected);
  EXPECT_EQ(detected.rate_number, end_of(1, 0, 2).packet->rate_number);
  EXPECT_EQ(ended.rate_number, detected.rate_number);
  EXPECT_EQ(detected.measured_arrival, at_s(11));
}

// A preamble and a header of a quarter of a second each, then 100 bytes in a second.
class HeaderTest : public ModemWatchTest {
 protected:
  HeaderTest() {
    change_modem({1, 2}, [](acoustics::Modem& modem) {
      modem.packet_overhead = modem.preamble = for_s(0.25);
      modem.layout.header_bits = 200;
    });
    change_modem({3}, [](acoustics::Modem&) {});
  }
  std::vector<ModemEvent> of_kind(Kind kind) const {
    std::vector<ModemEvent> found;
    for (const ModemEvent& event : events_of(2))
      if (event.kind == kind) found.push_back(event);
    return found;
  }
};

TEST_F(HeaderTest, SaysWhosePacketItIsBeforeItsEnd) {
  send(1, 10, 0, 100);
  run();
  EXPECT_THAT(noticed_by(2),
              ElementsAre(Noticed{Kind::kCarrierBegan, at_s(11)}, Noticed{Kind::kPacketDetected, at_s(11.25)},
                          Noticed{Kind::kHeaderReceived, at_s(11.5)}, Noticed{Kind::kPacketEnded, at_s(12.5)},
                          Noticed{Kind::kCarrierEnded, at_s(12.5)}));
  for (const Kind kind : {Kind::kHeaderReceived, Kind::kPacketEnded}) {
    const ModemEvent event = of_kind(kind).at(0);
    EXPECT_EQ(event.source_id, 1);
    EXPECT_EQ(event.destination_id, end_of(1, 0, 2).packet->request.destination_id);
    EXPECT_EQ(event.packet_duration, for_s(1.5));
    EXPECT_EQ(event.packet_end, at_s(12.5));
  }
}

// The other packet sounds at 2 from 11.75 to 12.25: after the header.
TEST_F(HeaderTest, OutlivesALossOfTheRest) {
  water.set(3, 2, {path(0.5, 140)});
  send(1, 10, 0, 100);
  send(3, 11.25, 1, 50);
  run();
  ASSERT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kCollided);
  EXPECT_EQ(of_kind(Kind::kHeaderReceived).size(), 1u);
  EXPECT_EQ(of_kind(Kind::kPacketEnded).at(0).source_id, 0);
}

// From 11.3 to 11.4: within the header.
TEST_F(HeaderTest, IsNotReceivedWhereItIsHit) {
  water.set(3, 2, {path(0.5, 140)});
  send(1, 10, 0, 100);
  send(3, 10.8, 1, 10);
  run();
  ASSERT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kCollided);
  EXPECT_EQ(of_kind(Kind::kPacketDetected).size(), 1u);
  EXPECT_EQ(of_kind(Kind::kHeaderReceived).size(), 0u);
}

TEST_F(HeaderTest, IsNotReceivedByAModemThatTransmits) {
  send(1, 10, 0, 100);
  send(2, 11.3, 1, 1);
  run();
  ASSERT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kHalfDuplex);
  EXPECT_EQ(of_kind(Kind::kHeaderReceived).size(), 0u);
}

TEST_F(ModemWatchTest, OwnTransmissionsBeginAndEndAtTheirInstants) {
  send(2, 10, 5, 100);
  run();
  EXPECT_THAT(noticed_by(2), ElementsAre(Noticed{Kind::kTransmissionBegan, at_s(10)},
                                         Noticed{Kind::kTransmissionEnded, at_s(11)}));
  for (const ModemEvent& event : events_of(2)) {
    EXPECT_EQ(event.session, 7);
    EXPECT_EQ(event.packet_sequence, 5);
  }
}

TEST_F(ModemWatchTest, APacketThatIsLostAfterItsDetectionEndsWithTheReason) {
  water.set(3, 2, {path(0.5, 140)});
  send(1, 10, 0, 100);  // there from 11 to 12
  send(3, 11, 1, 50);   // there from 11.5 to 12, 20 dB louder, and not acquired
  run();
  ASSERT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kCollided);
  const auto& noticed = events_of(2);
  ASSERT_EQ(noticed.size(), 4u);
  EXPECT_EQ(noticed[2].kind, Kind::kPacketEnded);
  EXPECT_EQ(noticed[2].outcome, OutcomeKind::kCollided);
  EXPECT_EQ(noticed[2].sinr.value, end_of(1, 0, 2).statistics.sinr.value);
}

TEST_F(ModemWatchTest, AModemReportsNothingUnlessItIsToldTo) {
  listen(2, 0, {.events = false});
  send(1, 10, 0, 10);
  send(2, 20, 1, 10);
  run();
  EXPECT_THAT(noticed_by(2), IsEmpty());
}

TEST_F(ModemWatchTest, CarrierIsTheSumOfAllSoundAboveTheThreshold) {
  // Each of two sounds is 2 dB below the threshold: together 1 dB above it.
  const double each_db = level_of(noise_power()).value + 6 - 2;
  water.set(1, 2, {path(1, each_db)});
  water.set(3, 2, {path(0.5, each_db)});
  change_modem({2}, [](acoustics::Modem& modem) { modem.min_receivable_level = {200}; });  // detects nothing
  send(1, 10, 0, 100);  // there from 11 to 12
  send(3, 11, 1, 100);  // there from 11.5 to 12.5
  run();
  EXPECT_THAT(noticed_by(2),
              ElementsAre(Noticed{Kind::kCarrierBegan, at_s(11.5)}, Noticed{Kind::kCarrierEnded, at_s(12)}));
  EXPECT_NEAR(events_of(2)[0].level.value, each_db + 10 * std::log10(2), tolerance(1e-9));
  EXPECT_NEAR(events_of(2)[1].level.value, each_db, tolerance(1e-6));
}

TEST_F(ModemWatchTest, TheThresholdIsSetByTheVehicle) {
  listen(2, 0, {.events = true, .carrier_threshold = {60}});
  water.set(1, 2, {path(1, level_of(noise_power()).value + 59)});
  water.set(3, 2, {path(0.5, level_of(noise_power()).value + 61)});
  send(1, 10, 0, 100);
  send(3, 30, 1, 100);
  run();
  std::vector<SimTime> begins;
  for (const Noticed& noticed : noticed_by(2)) {
    if (noticed.kind == Kind::kCarrierBegan) begins.push_back(noticed.at);
  }
  EXPECT_THAT(begins, ElementsAre(at_s(30.5)));
}

TEST_F(ModemWatchTest, AModemThatTransmitsSensesNothing) {
  send(1, 10, 0, 300);  // there from 11 to 14
  send(2, 12, 1, 100);  // until 13
  run();
  EXPECT_THAT(noticed_by(2),
              ElementsAre(Noticed{Kind::kPacketDetected, at_s(11)}, Noticed{Kind::kCarrierBegan, at_s(11)},
                          Noticed{Kind::kTransmissionBegan, at_s(12)}, Noticed{Kind::kCarrierEnded, at_s(12)},
                          Noticed{Kind::kTransmissionEnded, at_s(13)}, Noticed{Kind::kCarrierBegan, at_s(13)},
                          Noticed{Kind::kPacketEnded, at_s(14)}, Noticed{Kind::kCarrierEnded, at_s(14)}));
}

TEST_F(ModemWatchTest, ChangesOfCarrierComeNoFasterThanADetectorAverages) {
  for (int i = 0; i < 50; ++i) send(i % 2 == 0 ? 1 : 3, 10 + 0.004 * i + (i % 2 == 0 ? 0 : 0.502), i, 0);
  // 100 paths of 1 ms, 2 ms apart.
  std::vector<Arrival> paths;
  for (int i = 0; i < 100; ++i) paths.push_back(path(1 + 0.002 * i, 120));
  water.set(1, 2, paths);
  change_modem({1}, [](acoustics::Modem& modem) { modem.packet_overhead = for_s(0.001); });
  run();
  SimTime last = SimTime();
  int changes = 0;
  for (const Noticed& noticed : noticed_by(2)) {
    if (noticed.kind != Kind::kCarrierBegan && noticed.kind != Kind::kCarrierEnded) continue;
    EXPECT_GE(noticed.at - last, ModemWatch::kCarrierHold);
    last = noticed.at;
    ++changes;
  }
  EXPECT_GT(changes, 10);
}

TEST_F(ModemWatchTest, AModemThatIsAsleepAcquiresNothingAndSensesNothing) {
  listen(2, 5, {.asleep = true, .events = true});
  send(1, 10, 0, 100);
  send(2, 20, 1, 10);  // but it transmits
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kAsleep);
  EXPECT_EQ(end_of(2, 1, 1).kind, OutcomeKind::kReceived);
  EXPECT_THAT(noticed_by(2), ElementsAre(Noticed{Kind::kTransmissionBegan, at_s(20)},
                                         Noticed{Kind::kTransmissionEnded, at_s(20.1)}));
}

TEST_F(ModemWatchTest, AModemWakesAtTheInstantItWasToldAndSensesWhatIsThere) {
  listen(2, 5, {.asleep = true, .wakes = at_s(11.5), .events = true});
  send(1, 10, 0, 100);  // there from 11 to 12
  send(1, 20, 1, 100);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kAsleep);  // at the packet's begin
  EXPECT_EQ(end_of(1, 1, 2).kind, OutcomeKind::kReceived);
  EXPECT_EQ(noticed_by(2).front(), (Noticed{Kind::kCarrierBegan, at_s(11.5)}));
}

TEST_F(ModemWatchTest, FallingAsleepLosesThePacketUnderWay) {
  listen(2, 11.5, {.asleep = true, .wakes = at_s(11.6), .events = true});
  send(1, 10, 0, 100);  // there from 11 to 12
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kAsleep);
  const auto& noticed = events_of(2);
  ASSERT_THAT(noticed_by(2),
              ElementsAre(Noticed{Kind::kPacketDetected, at_s(11)}, Noticed{Kind::kCarrierBegan, at_s(11)},
                          Noticed{Kind::kCarrierEnded, at_s(11.5)}, Noticed{Kind::kCarrierBegan, at_s(11.6)},
                          Noticed{Kind::kPacketEnded, at_s(12)}, Noticed{Kind::kCarrierEnded, at_s(12)}));
  EXPECT_EQ(noticed[4].outcome, OutcomeKind::kAsleep);
}

TEST_F(ModemWatchTest, AnotherCommandWakesItAndALaterOneCountsInThePlaceOfTheWakingTime) {
  listen(2, 5, {.asleep = true, .wakes = at_s(15)});
  listen(2, 8, {.asleep = true});  // no waking by itself any more
  listen(2, 30, {});
  send(1, 20, 0, 10);
  send(1, 40, 1, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kAsleep);
  EXPECT_EQ(end_of(1, 1, 2).kind, OutcomeKind::kReceived);
}

TEST_F(ModemWatchTest, APingToASleeperIsNotAnswered) {
  listen(2, 5, {.asleep = true});
  SendRequest ping = testing::request_of(1, 10, 0, 0);
  ping.kind = PacketKind::kPing;
  ping.destination_id = 2;
  send(ping);
  run();
  EXPECT_EQ(end_of(1, 0, 2, PacketKind::kPing).kind, OutcomeKind::kAsleep);
  for (const PacketOutcome& outcome : testing::outcomes_in(events))
    EXPECT_NE(outcome.packet->request.kind, PacketKind::kPingReply);
}

TEST_F(ModemWatchTest, APromiscuousModemReceivesWhatIsForOthersAndAnswersNoneOfTheirPings) {
  listen(2, 0, {.promiscuous = true});
  water.set(1, 3, {path(1, 120)});
  SendRequest data = testing::request_of(1, 10, 0, 10), ping = testing::request_of(1, 20, 1, 0);
  data.destination_id = ping.destination_id = 3;
  ping.kind = PacketKind::kPing;
  send(data);
  send(ping);
  run();
  EXPECT_TRUE(end_of(1, 0, 2).deliver);
  EXPECT_TRUE(end_of(1, 1, 2, PacketKind::kPing).deliver);
  EXPECT_FALSE(end_of(1, 0, 4).deliver);  // out of its reach, and not promiscuous
  int replies = 0;
  for (const PacketOutcome& outcome : testing::outcomes_in(events)) {
    const SendRequest& request = outcome.packet->request;
    if (request.kind != PacketKind::kPingReply) continue;
    EXPECT_EQ(request.source_id, 3);
    ++replies;
  }
  EXPECT_GT(replies, 0);
}

}  // namespace
}  // namespace halocline::channel_server
