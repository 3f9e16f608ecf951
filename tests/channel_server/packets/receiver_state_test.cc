// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/receiver_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/vehicles/vehicle_id.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using ::testing::ElementsAre;
using testing::for_s;

PacketPointer packet_of(VehicleId source, double departure_s) {
  Packet packet;
  packet.request = testing::request_of(source, departure_s, 0);
  packet.departure = at_s(departure_s);
  return std::make_shared<const Packet>(packet);
}

AudiblePacket audible(const PacketPointer& packet, double begin_s, double end_s, double power) {
  return {packet, at_s(begin_s), at_s(end_s), {{at_s(begin_s), at_s(end_s), power}}};
}

TEST(ReceiverState, FindsTheInterferersOfAReceptionWhateverTheOrderOfArrival) {
  ReceiverState receiver(for_s(10));
  const auto own = packet_of(1, 0), before = packet_of(2, 0), across = packet_of(3, 0),
             after = packet_of(4, 0);
  receiver.open(audible(after, 12, 13, 4));
  receiver.open(audible(across, 5, 25, 3));  // longer than all others
  receiver.open(audible(own, 10, 12, 1));
  receiver.open(audible(before, 9, 10, 2));
  const Interferers found = receiver.interferers_of(*own, at_s(10), at_s(12));
  EXPECT_THAT(found.packets, ElementsAre(across));
  ASSERT_EQ(found.paths.size(), 1u);
  EXPECT_EQ(found.paths[0].power, 3);
}

TEST(ReceiverState, AnAcquiredPacketIsFollowedToItsEnd) {
  ReceiverState receiver(for_s(10));
  const auto packet = packet_of(1, 0);
  receiver.acquire({packet, at_s(10), at_s(12)}, at_s(10.5));
  const Packet other = *packet_of(9, 0);
  EXPECT_EQ(receiver.followed_at(at_s(10.4), other), nullptr);
  EXPECT_EQ(receiver.followed_at(at_s(10.5), other), packet);
  EXPECT_EQ(receiver.followed_at(at_s(11.9), other), packet);
  EXPECT_EQ(receiver.followed_at(at_s(12), other), nullptr);
}

TEST(ReceiverState, ATransmissionEndsAReception) {
  ReceiverState receiver(for_s(10));
  receiver.acquire({packet_of(1, 0), at_s(10), at_s(12)}, at_s(10.5));
  receiver.transmit({packet_of(2, 0), at_s(11), at_s(11.1)});
  const Packet other = *packet_of(9, 0);
  EXPECT_NE(receiver.followed_at(at_s(10.9), other), nullptr);
  EXPECT_EQ(receiver.followed_at(at_s(11.5), other), nullptr);
}

TEST(ReceiverState, OwnTransmissionsComeInTheOrderOfTheirStarts) {
  ReceiverState receiver(for_s(10));
  const auto late = packet_of(1, 11), early = packet_of(1, 10);
  receiver.transmit({late, at_s(11), at_s(12)});
  receiver.transmit({early, at_s(10), at_s(10.5)});
  EXPECT_THAT(receiver.transmitted_during(at_s(10), at_s(12)), ElementsAre(early, late));
  EXPECT_THAT(receiver.transmitted_during(at_s(10.5), at_s(11)), ElementsAre());
}

TEST(ReceiverState, NothingIsForgottenThatAnOpenReceptionMayNeed) {
  ReceiverState receiver(for_s(10));
  const auto open = packet_of(1, 0), disturbing = packet_of(2, 0);
  receiver.open(audible(open, 100, 200, 1));
  receiver.open(audible(disturbing, 101, 102, 1));
  receiver.close(at_s(101), at_s(102));
  receiver.forget(at_s(190));
  EXPECT_EQ(receiver.interferers_of(*open, at_s(100), at_s(200)).packets.size(), 1u);
  receiver.close(at_s(100), at_s(200));
  receiver.forget(at_s(209));
  EXPECT_FALSE(receiver.silent());  // it may overlap a reception that is added late
  receiver.forget(at_s(211));
  EXPECT_TRUE(receiver.silent());
  EXPECT_EQ(receiver.size(), 0u);
}

}  // namespace
}  // namespace halocline::channel_server
