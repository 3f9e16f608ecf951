// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/traffic/relay.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/onboard/traffic/relay_packet.h"
#include "core/archive.h"
#include "core/names.h"
#include "tests/support/archived_changes.h"

namespace halocline::clients {
namespace {

using ::testing::ElementsAre;
using Verdict = Relay::Verdict;

SimTime at_s(double s) { return SimTime::from_seconds(s); }

RelayRules rules(bool passes_on, int hops = 1, double wait_s = 2) {
  return {passes_on, hops, false, SimDuration::from_seconds(wait_s)};
}

// What vehicle 1 transmits for vehicle 9 with three transmissions allowed.
std::vector<std::uint8_t> first_packet() {
  Relay origin(1, rules(false, 3), 5);
  origin.originate(9, {7, 8}, at_s(10));
  return origin.transmit_due(at_s(10))->bytes;
}

TEST(RelayPacketBytes, ReadBackAsTheyWere) {
  const RelayPacket packet{RelayKind::kDataToConfirm, 15, 14, 1, 2'000'000'000, 65'535, {1, 2, 3}};
  EXPECT_EQ(decode_relay_packet(encode(packet)), packet);
  EXPECT_EQ(encode(packet).size(), RelayPacket::kHeaderBytes + 3);
}

TEST(RelayPacketBytes, OfAnotherKindOrChangedAreNone) {
  auto bytes = encode({.hops_left = 2, .origin = 1, .destination = 9, .payload = {1, 2, 3}});
  ++bytes[1];  // transmissions left: changes on the way
  EXPECT_TRUE(decode_relay_packet(bytes));
  for (const std::size_t at : {0u, 2u, 6u, 10u, 12u, 14u, 16u}) {
    auto changed = bytes;
    changed[at] ^= 0x40;
    EXPECT_FALSE(decode_relay_packet(changed)) << at;
  }
  EXPECT_FALSE(decode_relay_packet({}));
  EXPECT_FALSE(decode_relay_packet(std::span(bytes).first(13)));
}

TEST(Relay, PassesAPacketOnOnceAfterAWait) {
  Relay relay(2, rules(true), 5);
  relay.take(first_packet(), at_s(11));
  relay.take(first_packet(), at_s(11.5));
  EXPECT_GT(relay.next(), at_s(11));
  EXPECT_LT(relay.next(), at_s(13));
  const auto sent = relay.transmit_due(at_s(13));
  ASSERT_TRUE(sent);
  relay.on_sent(0);
  relay.on_receipt(0, Verdict::kAccepted, at_s(13));
  EXPECT_FALSE(relay.transmit_due(at_s(100)));
  const auto packet = decode_relay_packet(sent->bytes).value();
  EXPECT_EQ(packet.hops_left, 1);
  EXPECT_EQ(packet.origin, 1);
  EXPECT_THAT(packet.payload, ElementsAre(7, 8));
  EXPECT_EQ(relay.counters().passed_on, 1);
  EXPECT_EQ(relay.counters().duplicates, 1);
  EXPECT_EQ(relay.counters().delivered, 0);
}

TEST(Relay, TwoRelaysWaitForDifferentTimes) {
  Relay one(2, rules(true), 5), other(3, rules(true), 5);
  one.take(first_packet(), at_s(11));
  other.take(first_packet(), at_s(11));
  EXPECT_NE(one.next(), other.next());
}

TEST(Relay, EndsWithTheTransmissionsAllowed) {
  auto bytes = first_packet();
  for (const std::int32_t id : {2, 3}) {
    Relay relay(id, rules(true), 5);
    relay.take(bytes, at_s(11));
    bytes = relay.transmit_due(at_s(20)).value().bytes;
  }
  Relay last(4, rules(true), 5);
  last.take(bytes, at_s(11));
  EXPECT_EQ(last.next(), SimTime::never());
  EXPECT_EQ(last.counters().expired, 1);
}

TEST(Relay, AVehicleThatIsNoRelayOnlyTakesWhatIsForIt) {
  Relay other(8, rules(false), 5), addressed(9, rules(false), 5);
  other.take(first_packet(), at_s(11));
  addressed.take(first_packet(), at_s(11));
  EXPECT_EQ(other.next(), SimTime::never());
  EXPECT_EQ(other.counters().delivered, 0);
  EXPECT_EQ(addressed.counters().delivered, 1);
}

TEST(Relay, HandsOnEachPacketThatIsForItOnce) {
  Relay addressed(9, rules(false), 5);
  std::vector<SimTime> deliveries;
  addressed.on_delivery([&](const RelayPacket& packet, SimTime at) {
    EXPECT_EQ(packet.destination, 9);
    deliveries.push_back(at);
  });
  addressed.take(first_packet(), at_s(11));
  addressed.take(first_packet(), at_s(12));
  ASSERT_EQ(deliveries.size(), 1u);
  EXPECT_EQ(deliveries[0], at_s(11));
}

TEST(Relay, APacketToAllIsDeliveredAndPassedOn) {
  Relay origin(1, rules(false, 2), 5), relay(2, rules(true), 5);
  origin.originate(kBroadcastId, {1}, at_s(0));
  relay.take(origin.transmit_due(at_s(0))->bytes, at_s(1));
  EXPECT_EQ(relay.counters().delivered, 1);
  EXPECT_NE(relay.next(), SimTime::never());
}

TEST(Relay, ItsOwnPacketThatComesBackIsADuplicate) {
  Relay origin(1, rules(true, 3), 5);
  origin.originate(9, {7}, at_s(10));
  const auto sent = origin.transmit_due(at_s(10));
  origin.take(sent->bytes, at_s(12));
  EXPECT_EQ(origin.next(), SimTime::never());
  EXPECT_EQ(origin.counters().duplicates, 1);
}

TEST(Relay, TheDestinationConfirmsWhereThatIsRequested) {
  Relay origin(1, {false, 3, true, {}}, 5), relay(2, rules(true), 5), destination(9, rules(false), 5);
  origin.originate(9, {7}, at_s(10));
  relay.take(origin.transmit_due(at_s(10))->bytes, at_s(11));
  destination.take(relay.transmit_due(at_s(20))->bytes, at_s(21));
  const auto confirmation = destination.transmit_due(at_s(30));
  ASSERT_TRUE(confirmation);
  relay.take(confirmation->bytes, at_s(31));
  origin.take(relay.transmit_due(at_s(40)).value().bytes, at_s(41));
  EXPECT_EQ(origin.counters().confirmed, 1);
  EXPECT_EQ(origin.counters().delivered, 0);
  EXPECT_EQ(destination.counters().delivered, 1);
}

TEST(Relay, WhatABusyModemRefusesIsTriedAgain) {
  Relay relay(2, rules(true), 5);
  relay.take(first_packet(), at_s(11));
  ASSERT_TRUE(relay.transmit_due(at_s(13)));
  relay.on_sent(4);
  relay.on_receipt(4, Verdict::kBusy, at_s(13));
  EXPECT_GE(relay.next(), at_s(13.5));
  ASSERT_TRUE(relay.transmit_due(at_s(20)));
  relay.on_sent(5);
  relay.on_receipt(5, Verdict::kAccepted, at_s(20));
  EXPECT_EQ(relay.counters().retried, 1);
  EXPECT_EQ(relay.counters().passed_on, 1);
}

TEST(Relay, GivesUpAfterManyTriesAndWhatTheModemNeverTakes) {
  Relay relay(2, rules(true), 5);
  relay.take(first_packet(), at_s(11));
  int tries = 0;
  for (SimTime at = at_s(13); relay.next() != SimTime::never();
       at = at + SimDuration::from_seconds(10), ++tries) {
    ASSERT_TRUE(relay.transmit_due(at));
    relay.on_sent(tries);
    relay.on_receipt(tries, Verdict::kBusy, at);
  }
  EXPECT_EQ(tries, Relay::kMaxTries);
  EXPECT_EQ(relay.counters().dropped, 1);
  Relay other(3, rules(true), 5);
  other.take(first_packet(), at_s(11));
  ASSERT_TRUE(other.transmit_due(at_s(13)));
  other.on_sent(0);
  other.on_receipt(0, Verdict::kImpossible, at_s(13));
  EXPECT_EQ(other.next(), SimTime::never());
  EXPECT_EQ(other.counters().dropped, 1);
}

TEST(Relay, KeepsABoundedNumberOfPackets) {
  Relay origin(1, rules(false, 3), 5), relay(2, rules(true), 5);
  const auto count = static_cast<int>(Relay::kMaxStored) + 5;
  for (int i = 0; i < count; ++i) {
    origin.originate(9, {7}, at_s(10));
    relay.take(origin.transmit_due(at_s(10))->bytes, at_s(11));
  }
  EXPECT_EQ(relay.counters().dropped, 5);
}

TEST(Relay, GoesOnFromItsArchive) {
  Relay relay(2, rules(true), 5);
  relay.take(first_packet(), at_s(11));
  Archive saved;
  saved(relay);
  Relay resumed(2, rules(true), 5);
  Archive(saved.bytes())(resumed);
  EXPECT_EQ(resumed.next(), relay.next());
  resumed.take(first_packet(), at_s(12));
  EXPECT_EQ(resumed.counters().duplicates, 1);
  EXPECT_EQ(resumed.transmit_due(at_s(20))->bytes, relay.transmit_due(at_s(20))->bytes);
}

TEST(Relay, CountsWhatChangesItsArchive) {
  Relay relay(2, {true, 3, true, SimDuration::from_seconds(2)}, 5);
  testing::ArchivedChanges changes(relay);
  const auto after = [&](const auto& act) {
    act();
    return changes.are_counted();
  };
  EXPECT_TRUE(after([&] { relay.originate(9, {1}, at_s(1)); }));
  for (const Verdict verdict : {Verdict::kBusy, Verdict::kAccepted}) {
    EXPECT_TRUE(after([&] { relay.transmit_due(at_s(100)); }));
    EXPECT_TRUE(after([&] { relay.on_sent(7); }));
    EXPECT_TRUE(after([&] { relay.on_receipt(7, verdict, at_s(2)); }));
  }
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(after([&] { relay.take(first_packet(), at_s(3)); }));
  EXPECT_TRUE(after([&] { relay.clear(); }));
  const auto before = relay.changes();
  relay.take({}, at_s(4));
  relay.next();
  EXPECT_EQ(relay.changes(), before);
}

}  // namespace
}  // namespace halocline::clients
