#include "channel_server/packets/hearing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

HeardPacket heard(const PacketPointer& packet, double begin_s, double end_s, double power) {
  return {packet, at_s(begin_s), at_s(end_s), {{at_s(begin_s), at_s(end_s), power}}};
}

TEST(BandShare, IsThePartOfABandWithinAnother) {
  EXPECT_NEAR(band_share({20, 30}, {25, 40}), 0.5, tolerance(1e-15));
  EXPECT_NEAR(band_share({20, 30}, {0, 100}), 1, tolerance(1e-15));
  EXPECT_NEAR(band_share({0, 100}, {20, 30}), 0.1, tolerance(1e-15));
  EXPECT_EQ(band_share({20, 30}, {30, 40}), 0);
}

TEST(Hearing, TellsWhoElseSoundsDuringAReceptionInWhateverOrderTheyCame) {
  Hearing hearing(for_s(10));
  const auto own = packet_of(1, 0), before = packet_of(2, 0), across = packet_of(3, 0),
             after = packet_of(4, 0);
  hearing.open(heard(after, 12, 13, 4));
  hearing.open(heard(across, 5, 25, 3));  // longer than all others
  hearing.open(heard(own, 10, 12, 1));
  hearing.open(heard(before, 9, 10, 2));
  const Interferers found = hearing.interferers_of(*own, at_s(10), at_s(12));
  EXPECT_THAT(found.packets, ElementsAre(across));
  ASSERT_EQ(found.paths.size(), 1u);
  EXPECT_EQ(found.paths[0].power, 3);
}

TEST(Hearing, ALockLastsFromTheNoticeToTheEnd) {
  Hearing hearing(for_s(10));
  const auto packet = packet_of(1, 0);
  hearing.lock({packet, at_s(10), at_s(12)}, at_s(10.5));
  EXPECT_EQ(hearing.locked_onto(at_s(10.4)), nullptr);
  EXPECT_EQ(hearing.locked_onto(at_s(10.5)), packet);
  EXPECT_EQ(hearing.locked_onto(at_s(11.9)), packet);
  EXPECT_EQ(hearing.locked_onto(at_s(12)), nullptr);
}

TEST(Hearing, ATransmissionEndsALock) {
  Hearing hearing(for_s(10));
  hearing.lock({packet_of(1, 0), at_s(10), at_s(12)}, at_s(10.5));
  hearing.transmit({packet_of(2, 0), at_s(11), at_s(11.1)});
  EXPECT_NE(hearing.locked_onto(at_s(10.9)), nullptr);
  EXPECT_EQ(hearing.locked_onto(at_s(11.5)), nullptr);
}

TEST(Hearing, OwnTransmissionsComeInTheOrderOfTheirStarts) {
  Hearing hearing(for_s(10));
  const auto late = packet_of(1, 11), early = packet_of(1, 10);
  hearing.transmit({late, at_s(11), at_s(12)});
  hearing.transmit({early, at_s(10), at_s(10.5)});
  EXPECT_THAT(hearing.transmitted_during(at_s(10), at_s(12)), ElementsAre(early, late));
  EXPECT_THAT(hearing.transmitted_during(at_s(10.5), at_s(11)), ElementsAre());
}

TEST(Hearing, NothingIsForgottenThatAnOpenReceptionMayNeed) {
  Hearing hearing(for_s(10));
  const auto open = packet_of(1, 0), disturbing = packet_of(2, 0);
  hearing.open(heard(open, 100, 200, 1));
  hearing.open(heard(disturbing, 101, 102, 1));
  hearing.close(at_s(101), at_s(102));
  hearing.forget(at_s(190));
  EXPECT_EQ(hearing.interferers_of(*open, at_s(100), at_s(200)).packets.size(), 1u);
  hearing.close(at_s(100), at_s(200));
  hearing.forget(at_s(209));
  EXPECT_FALSE(hearing.silent());  // asked about by what is told late
  hearing.forget(at_s(211));
  EXPECT_TRUE(hearing.silent());
  EXPECT_EQ(hearing.size(), 0u);
}

}  // namespace
}  // namespace halocline::channel_server
