// SPDX-License-Identifier: BSD-3-Clause
// How packets are divided, and how long they last.
#include "acoustics/modem/packet_format.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Bits = std::vector<std::int64_t>;
using Bytes = std::vector<std::int32_t>;

Modem framed() {
  Modem modem;
  modem.bit_rate_bps = 1000;
  modem.packet_overhead = SimDuration::from_milliseconds(500);
  modem.layout = {.header_bits = 64, .tail_bits = 8, .frame_bytes = 32, .max_frames = 4};
  return modem;
}

TEST(PacketFormat, APayloadFillsWholeFrames) {
  EXPECT_EQ(data_format(framed(), 65).header_bits, 64);
  EXPECT_EQ(data_format(framed(), 65).frame_bits, (Bits{256, 256, 256}));
  EXPECT_EQ(frame_bytes_of(framed(), 65), (Bytes{32, 32, 1}));
  EXPECT_EQ(data_format(framed(), 65).blocks(), (Bits{64, 256, 256, 256}));
  EXPECT_EQ(data_format(framed(), 65).information_bits(), 64 + 3 * 256);
  EXPECT_THROW(data_format(framed(), 129), InvalidArgument);
}

TEST(PacketFormat, WithoutPayloadThereIsOneFrameOfNoBits) {
  EXPECT_EQ(data_format(framed(), 0).frame_bits, (Bits{0}));
  EXPECT_EQ(frame_bytes_of(framed(), 0), (Bytes{0}));
  EXPECT_EQ(data_format(framed(), 0).blocks(), (Bits{64}));
  EXPECT_TRUE(data_format(Modem(), 0).blocks().empty());
}

TEST(PacketFormat, AModemWithoutFramesSendsThePayloadInOne) {
  EXPECT_EQ(data_format(Modem(), 100).frame_bits, (Bits{800}));
  EXPECT_EQ(frame_bytes_of(Modem(), 100), (Bytes{100}));
}

TEST(PacketFormat, FramesMayBeGiven) {
  EXPECT_EQ(framed_format(Modem(), Bytes{3, 0, 5})->frame_bits, (Bits{24, 0, 40}));
  EXPECT_EQ(framed_format(framed(), Bytes{3, 32})->frame_bits, (Bits{256, 256})) << "sent whole";
  EXPECT_FALSE(framed_format(framed(), Bytes{33}));
  EXPECT_FALSE(framed_format(framed(), Bytes{1, 1, 1, 1, 1})) << "one more than the modem has";
  EXPECT_FALSE(framed_format(Modem(), Bytes(kMaxFrames + 1, 1)));
  EXPECT_FALSE(framed_format(Modem(), Bytes{kMaxPayloadBytes, 1}));
  EXPECT_FALSE(framed_format(Modem(), Bytes{}));
}

// overhead + (64 + 8 + 3 (256 + 8)) bits at 1000 bit/s
TEST(PacketFormat, EachBlockEndsWithItsTail) {
  const PacketTiming timing = packet_timing(framed(), data_format(framed(), 65));
  EXPECT_EQ(timing.duration, SimDuration::from_milliseconds(500 + 72 + 3 * 264));
  EXPECT_EQ(timing.information_bits, 64 + 3 * 256);
}

TEST(PacketFormat, AMiniPacketIsOneBlockWithoutHeader) {
  EXPECT_FALSE(mini_format(framed()));
  Modem modem = framed();
  modem.layout.mini_packet_bits = 32;
  EXPECT_EQ(mini_format(modem)->blocks(), (Bits{32}));
  EXPECT_EQ(packet_timing(modem, *mini_format(modem)).duration, SimDuration::from_milliseconds(540));
}

// J = 1 / (1 + SINR): all of it without signal, half at 0 dB, a thousandth at 30 dB.
TEST(ReceiveQuality, OfSymbolsAndBits) {
  EXPECT_EQ(least_mean_square_error(PowerRatio{0}).value, 1);
  EXPECT_EQ(least_mean_square_error(PowerRatio{1}).value, 0.5);
  EXPECT_EQ(least_mean_square_error(PowerRatio{999}).value, 1e-3);
  EXPECT_THROW(least_mean_square_error(PowerRatio{-1}), InvalidArgument);
  // 5 kHz at 80 bit/s gain 62.5.
  EXPECT_EQ(bit_energy(Modem(), PowerRatio{2}).value, 125);
}

}  // namespace
}  // namespace halocline::acoustics
