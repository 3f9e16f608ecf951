// SPDX-License-Identifier: BSD-3-Clause
// Packets of several frames, kinds and rates of packets, and acknowledgements.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "channel_server/messages/packet_messages.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::for_s;
using testing::path;
using testing::receipts_in;
using testing::request_of;

// The quick modem: 10 ms a byte, nothing else.
class FramesTest : public testing::ScriptedWater {
 protected:
  static SendRequest with_frames(VehicleId source, double start_s, std::int64_t sequence,
                                 std::vector<std::int32_t> frame_bytes) {
    std::int32_t bytes = 0;
    for (const std::int32_t frame : frame_bytes) bytes += frame;
    SendRequest request = request_of(source, start_s, sequence, static_cast<std::size_t>(bytes));
    request.payload.assign(static_cast<std::size_t>(bytes), 7);
    request.frame_bytes = std::move(frame_bytes);
    return request;
  }
  // Sound of any level is received, if its bits are right.
  void without_cutoff() {
    change_modem({1, 2, 3, 4}, [](acoustics::Modem& modem) { modem.min_receivable_level = {-200}; });
  }
  void carry(VehicleId id, const VehicleModem& modem) {
    fleet.announce_modem(testing::name_of(id), at_s(0), modem, at_s(0));
  }
  std::vector<PacketOutcome> all_of(PacketKind kind) const {
    std::vector<PacketOutcome> found;
    for (const PacketOutcome& outcome : testing::outcomes_in(events)) {
      if (outcome.packet->request.kind == kind) found.push_back(outcome);
    }
    return found;
  }
};

// From 11.35 to 11.55 s another packet is as loud as three frames that sound from 11 to 11.9 s.
TEST_F(FramesTest, OfThreeFramesTheOneThatIsHitIsLost) {
  water.set(1, 2, {path(1, 120)});
  water.set(3, 2, {path(1, 130)});
  send(with_frames(1, 10, 0, {30, 30, 30}));
  send(3, 10.35, 5, 20);
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_EQ(end.kind, OutcomeKind::kReceived);
  EXPECT_EQ(end.statistics.frames_good, 0b101u);
  EXPECT_EQ(colliders_of(end), (Colliders{{3, 5}}));
  EXPECT_EQ(testing::outcomes_in(events).size(), 2u * 3) << "one a packet and receiver";

  const packet_outcome_t outcome = to_outcome(end, at_s(12));
  EXPECT_EQ(outcome.num_frames, 3);
  EXPECT_EQ(outcome.num_frames_good, 2);
  EXPECT_EQ(outcome.frames_good, 5);
  const modem_receive_t receive = to_receive(end, at_s(12));
  EXPECT_EQ(receive.frame_bytes, (std::vector<std::int32_t>{30, 30, 30}));
  EXPECT_EQ(receive.frames_good, 5);
  for (std::size_t i = 0; i < 90; ++i) EXPECT_EQ(receive.payload[i], i / 30 == 1 ? 0 : 7) << i;
}

TEST_F(FramesTest, APacketOfWhichEveryFrameIsHitIsLost) {
  water.set(1, 2, {path(1, 120)});
  water.set(3, 2, {path(1, 130)});
  send(with_frames(1, 10, 0, {30, 30, 30}));
  send(3, 10.05, 5, 80);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kCollided);
  EXPECT_EQ(end_of(1, 0, 2).statistics.frames_good, 0u);
}

// One frame has one draw whoever names it: the bytes of a frame that is given are those of a packet without.
TEST_F(FramesTest, OneFrameIsDecidedAsAPacketWithoutFrames) {
  without_cutoff();
  const double level_db = testing::level_with_bit_error(1e-3, noise_power());
  water.set(1, 2, {path(1, level_db)});
  water.set(1, 3, {path(1, level_db)});
  send(with_frames(1, 10, 0, {40}));
  SendRequest other = request_of(1, 10, 0, 40);
  run();
  const DecisionStatistics one = end_of(1, 0, 2).statistics;
  PacketMedium again{fleet, water, {for_s(10), for_s(200)}};
  EXPECT_FALSE(again.transmit(other, SimTime()));
  events = again.advance_to(at_s(100));
  const DecisionStatistics& same = end_of(1, 0, 2).statistics;
  EXPECT_EQ(one.success_draw, same.success_draw);
  EXPECT_EQ(one.success_probability, same.success_probability);
  EXPECT_NEAR(one.success_probability, std::pow(1 - 1e-3, 320), tolerance(1e-9));
  EXPECT_EQ(one.frames_good, same.frames_good);
}

// Each of four frames of 5 bytes is right with P = 0.99^40, independently: of 500 packets the number of good
// frames in each place, and of packets with all four and with none, lie within the central 99.9 % (3.29
// standard deviations).
TEST_F(FramesTest, FramesAreRightAsOftenAsTheirBitsAndIndependently) {
  constexpr int kPackets = 500;
  constexpr double kError = 0.01;
  const double chance = std::pow(1 - kError, 40);
  without_cutoff();
  water.set(1, 2, {path(0.1, testing::level_with_bit_error(kError, noise_power()))});
  for (int i = 0; i < kPackets; ++i) send(with_frames(1, 1 + 0.22 * i, i, {5, 5, 5, 5}));
  run(119);
  std::vector<int> good(4);
  int packets = 0, all = 0, none = 0;
  for (const PacketOutcome& end : testing::outcomes_in(events)) {
    if (end.receiver_id != 2) continue;
    ++packets;
    for (std::size_t frame = 0; frame < 4; ++frame) good[frame] += end.statistics.frames_good >> frame & 1;
    all += end.statistics.frames_good == 0b1111u;
    none += end.statistics.frames_good == 0;
    EXPECT_EQ(end.kind == OutcomeKind::kReceived, end.statistics.frames_good != 0);
    EXPECT_NEAR(end.statistics.success_probability, 1 - std::pow(1 - chance, 4), tolerance(1e-6));
  }
  const auto expect_share = [&](int count, double probability, const std::string& what) {
    EXPECT_NEAR(count, packets * probability,
                3.29 * std::sqrt(packets * probability * (1 - probability)) + 0.5)
        << what;
  };
  ASSERT_EQ(packets, kPackets);
  for (std::size_t frame = 0; frame < 4; ++frame)
    expect_share(good[frame], chance, "frame " + std::to_string(frame));
  expect_share(all, std::pow(chance, 4), "all");
  expect_share(none, std::pow(1 - chance, 4), "none");
}

class KindsTest : public FramesTest {};

TEST_F(KindsTest, AMiniPacketOfAPskModemGoesByFskAndIsReceivedByPskModems) {
  carry(1, load_modem("micromodem-psk-5"));
  carry(2, load_modem("micromodem-psk-1"));
  water.set(1, 2, {path(1, 140)});
  SendRequest request = request_of(1, 10, 0, 0);
  request.kind = PacketKind::kMiniPacket;
  request.payload = {0x1f, 0xff};  // the greatest number of 13 bits
  send(request);
  request.packet_sequence = 1;
  request.start = at_s(20);
  request.payload = {0x20, 0x00};  // one of 14
  send(request);
  run();
  const PacketOutcome& end = end_of(1, 0, 2, PacketKind::kMiniPacket);
  EXPECT_EQ(end.kind, OutcomeKind::kReceived);
  EXPECT_EQ(end.packet->modem.family, "micromodem-fsk");
  EXPECT_EQ(end.packet->rate_number, 0);
  EXPECT_EQ(end.packet->timing.duration, for_s(0.7));
  EXPECT_EQ(result_of(1), SendResult::kTooLarge);
}

TEST_F(KindsTest, AModemSendsAtAnyOfItsRatesAndTheOthersReceiveIt) {
  carry(1, load_modem("micromodem-psk-1"));
  carry(2, load_modem("micromodem-psk-4"));
  water.set(1, 2, {path(1, 150)});
  double at = 1;
  for (std::int32_t rate = 0; rate <= 7; ++rate, at += 12) {
    SendRequest request = request_of(1, at, rate, 32);
    request.rate_number = rate;
    send(request);
  }
  run(119);
  const double rates_bps[] = {80, 250, 500, 1200, 1300, 5300, 500};
  for (std::int32_t rate = 0; rate <= 6; ++rate) {
    const PacketOutcome& end = end_of(1, rate, 2);
    EXPECT_EQ(end.kind, OutcomeKind::kReceived) << rate;
    EXPECT_EQ(end.packet->modem.bit_rate_bps, rates_bps[rate]);
    EXPECT_EQ(to_receive(end, at_s(1)).rate_number, rate);
  }
  EXPECT_EQ(result_of(7), SendResult::kNoRate);
}

TEST_F(KindsTest, JanusCarries34BitsInItsBaselinePacketAndCargoBehind) {
  for (const VehicleId id : {1, 2}) carry(id, load_modem("janus"));
  water.set(1, 2, {path(1, 140)});
  SendRequest request = request_of(1, 10, 0, 0);
  request.kind = PacketKind::kJanus;
  request.payload = {0x03, 0xff, 0xff, 0xff, 0xff};
  send(request);
  request.packet_sequence = 1;
  request.start = at_s(20);
  request.kind = PacketKind::kJanusCargo;
  request.payload.insert(request.payload.end(), 8, 9);
  send(request);
  request.packet_sequence = 2;
  request.start = at_s(30);
  request.payload[0] = 0x04;  // 35 bits
  send(request);
  run();
  const PacketOutcome& baseline = end_of(1, 0, 2, PacketKind::kJanus);
  EXPECT_EQ(baseline.kind, OutcomeKind::kReceived);
  EXPECT_EQ(baseline.packet->timing.duration, for_s(1.1));
  const PacketOutcome& cargo = end_of(1, 1, 2, PacketKind::kJanusCargo);
  EXPECT_EQ(cargo.packet->timing.duration, for_s(1.1 + 0.9));
  EXPECT_EQ(cargo.statistics.frames_good, 0b11u);
  EXPECT_EQ(to_receive(cargo, at_s(1)).frame_bytes, (std::vector<std::int32_t>{5, 8}));
  EXPECT_EQ(result_of(2), SendResult::kTooLarge);
}

TEST_F(KindsTest, AModemWithoutAKindRefusesIt) {
  SendRequest request = request_of(1, 10, 0, 1);
  for (const PacketKind kind : {PacketKind::kMiniPacket, PacketKind::kJanus, PacketKind::kJanusCargo}) {
    request.kind = kind;
    request.packet_sequence = static_cast<std::int64_t>(kind);
    send(request);
  }
  run();
  for (const Receipt& receipt : receipts_in(events)) EXPECT_EQ(receipt.result, SendResult::kNoKind);
  EXPECT_EQ(receipts_in(events).size(), 3u);
}

TEST_F(KindsTest, APacketMayHaveALevelOfItsOwn) {
  SendRequest request = request_of(1, 10, 0, 1);
  request.source_level = Decibels{160};
  send(request);
  run();
  EXPECT_EQ(end_of(1, 0, 2).packet->modem.source_level.value, 160);
}

TEST_F(KindsTest, TheNumberInTheHeaderArrivesAndTakesNoTime) {
  SendRequest request = request_of(1, 10, 0, 1);
  send(request);
  request = request_of(1, 12, 1, 1);
  request.header_number = 200;
  send(request);
  run();
  EXPECT_EQ(to_receive(end_of(1, 0, 2), at_s(13)).header_number, 0);
  EXPECT_EQ(to_receive(end_of(1, 1, 2), at_s(13)).header_number, 200);
  EXPECT_EQ(end_of(1, 1, 2).packet->timing.duration, end_of(1, 0, 2).packet->timing.duration);
}

class AckTest : public FramesTest {
 protected:
  void send_wanting_ack(VehicleId from, VehicleId to, double start_s, std::int64_t sequence,
                        std::vector<std::int32_t> frames) {
    SendRequest request = with_frames(from, start_s, sequence, std::move(frames));
    request.destination_id = to;
    request.wants_ack = true;
    send(request);
  }
};

// The last bit arrives at 11 + 0.9 s; the answer of one byte (10 ms) leaves 0.1 s later and is back 0.9 s
// after that.
TEST_F(AckTest, LeavesATurnaroundAfterTheLastBitAndSaysWhichFramesWereRight) {
  water.set(1, 2, {path(1, 120)});
  water.set(2, 1, {path(0.9, 120)});
  water.set(3, 2, {path(1, 130)});
  send_wanting_ack(1, 2, 10, 4, {30, 30, 30});
  send(3, 10.35, 5, 20);
  run();
  const auto acks = all_of(PacketKind::kAck);
  ASSERT_EQ(acks.size(), 3u) << "an outcome at each other vehicle";
  const PacketOutcome& end = end_of(2, 4, 1, PacketKind::kAck);
  EXPECT_EQ(end.packet->departure, at_s(12));
  EXPECT_EQ(end.packet->timing.duration, for_s(0.01));
  EXPECT_EQ(end.kind, OutcomeKind::kReceived);
  EXPECT_TRUE(end.deliver);
  EXPECT_EQ(end.packet->request.payload, (std::vector<std::uint8_t>{0b101}));
  EXPECT_NEAR(end.two_way_travel_time_s, 1.9, tolerance(1e-9));
  EXPECT_EQ(to_receive(end, at_s(13)).packet_sequence, 4);
}

TEST_F(AckTest, NobodyAcknowledgesWhatIsLostOrForAnother) {
  water.set(1, 2, {path(1, 120)});
  send_wanting_ack(1, 3, 10, 0, {30});
  SendRequest request = with_frames(1, 20, 1, {30});
  request.destination_id = 2;
  send(request);  // does not want one
  run();
  EXPECT_TRUE(all_of(PacketKind::kAck).empty());
}

TEST_F(AckTest, CollidesAndIsLostLikeAnyPacket) {
  water.set(1, 2, {path(1, 120)});
  water.set(2, 1, {path(0.9, 120)});
  water.set(3, 1, {path(1, 125)});
  send_wanting_ack(1, 2, 10, 0, {30});  // its answer arrives from 12.3 s on
  send(3, 11, 5, 100);                  // at 1 from 12 to 13 s
  run();
  EXPECT_EQ(end_of(2, 0, 1, PacketKind::kAck).kind, OutcomeKind::kCollided);
}

TEST_F(AckTest, IsNotSentByAModemThatTransmits) {
  water.set(1, 2, {path(1, 120)});
  water.set(2, 1, {path(0.9, 120)});
  send_wanting_ack(1, 2, 10, 0, {30});
  send(2, 11.35, 1, 100);
  run();
  EXPECT_TRUE(all_of(PacketKind::kAck).empty());
}

TEST_F(AckTest, OfAMicromodemIsAMiniPacket) {
  for (const VehicleId id : {1, 2}) carry(id, load_modem("micromodem-psk-2"));
  water.set(1, 2, {path(1, 140)});
  water.set(2, 1, {path(1, 140)});
  send_wanting_ack(1, 2, 10, 0, {5, 64});
  run();
  const PacketOutcome& end = end_of(2, 0, 1, PacketKind::kAck);
  EXPECT_EQ(end.packet->rate_number, 0);
  EXPECT_EQ(end.packet->timing.duration, for_s(0.7));
  EXPECT_EQ(end.packet->request.payload, (std::vector<std::uint8_t>{0b11}));
}

}  // namespace
}  // namespace halocline::channel_server
