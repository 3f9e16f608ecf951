// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/modem.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

TEST(Modem, DefaultsAreValid) { EXPECT_NO_THROW(validate(Modem{})); }

TEST(Modem, TakesThePapersFourParameters) {
  const Modem modem = generic_modem({120}, {40}, 10e3, 4e3);
  EXPECT_EQ(modem.source_level.value, 120);
  EXPECT_EQ(modem.min_receivable_level.value, 40);
  EXPECT_EQ(modem.band().low_hz, 8e3);
  EXPECT_EQ(modem.band().high_hz, 12e3);
}

TEST(Modem, PacketLastsOverheadPlusBits) {
  Modem modem;
  modem.bit_rate_bps = 80;
  modem.packet_overhead = SimDuration::from_milliseconds(500);
  EXPECT_EQ(packet_timing(modem, 10).duration.nanoseconds(), 1'500'000'000);
  EXPECT_EQ(packet_timing(modem, 0).duration.nanoseconds(), 500'000'000);
}

TEST(Modem, WithoutFramesSendsJustThePayloadsBits) {
  EXPECT_EQ(packet_timing(Modem{}, 0).information_bits, 0);
  EXPECT_EQ(packet_timing(Modem{}, 13).information_bits, 104);
}

TEST(Modem, SendsWholeFrames) {
  Modem modem;
  modem.layout = {.frame_bytes = 32, .max_frames = 3};
  modem.bit_rate_bps = 256;
  EXPECT_EQ(packet_timing(modem, 0).duration, SimDuration());
  for (const std::size_t bytes : {1u, 31u, 32u}) {
    EXPECT_EQ(packet_timing(modem, bytes).duration, SimDuration::from_milliseconds(1000));
  }
  EXPECT_EQ(packet_timing(modem, 33).duration, SimDuration::from_milliseconds(2000));
  EXPECT_EQ(packet_timing(modem, 33).information_bits, 512);
  EXPECT_EQ(max_payload_bytes(modem), 96u);
}

TEST(Modem, RefusesAPayloadBeyondItsLargest) {
  Modem modem;
  EXPECT_NO_THROW(packet_timing(modem, kMaxPayloadBytes));
  EXPECT_THROW(packet_timing(modem, kMaxPayloadBytes + 1), InvalidArgument);
  modem.layout = {.frame_bytes = 50, .max_frames = 2};
  EXPECT_NO_THROW(packet_timing(modem, 100));
  EXPECT_THROW(packet_timing(modem, 101), InvalidArgument);
}

TEST(Modem, EveryPacketIsDetectedWithoutAPreamble) { EXPECT_EQ(acquisition_probability(Modem{}, {0}), 1); }

TEST(Modem, ALongerPreambleIsDetectedAtLowerRatios) {
  Modem brief, lengthy;
  brief.packet_overhead = lengthy.packet_overhead = SimDuration::from_milliseconds(400);
  brief.preamble = SimDuration::from_milliseconds(100);
  lengthy.preamble = SimDuration::from_milliseconds(400);
  const PowerRatio sinr = to_power_ratio(Decibels{-14});
  EXPECT_GT(acquisition_probability(lengthy, sinr), acquisition_probability(brief, sinr));
  // Energy is what counts: four times as long is as good as four times as strong.
  EXPECT_DOUBLE_EQ(acquisition_probability(lengthy, sinr), acquisition_probability(brief, {4 * sinr.value}));
}

TEST(Modem, GenericModemsBitsAreThoseOfNonCoherentFskWithTheBandsGain) {
  const Modem modem;  // 5000 Hz, 80 bit/s: Eb/N0 is 62.5 times the ratio in the band
  EXPECT_DOUBLE_EQ(bit_error_rate(modem, {0.2}), std::exp(-0.2 * 62.5 / 2) / 2);
}

TEST(Modem, ASlowerBitIsSafer) {
  Modem slow, fast;
  slow.bit_rate_bps = 40;
  EXPECT_LT(bit_error_rate(slow, {0.1}), bit_error_rate(fast, {0.1}));
}

TEST(Modem, IsOfOneFamilyWithItsOwnKindAlone) {
  Modem one, other;
  one.family = other.family = "sonobuoy-3";
  EXPECT_TRUE(same_family(one, other));
  EXPECT_FALSE(same_family(one, Modem()));
}

TEST(Modem, TapersOverOneMoreGuardTimeUnlessATaperIsGiven) {
  Modem modem;
  modem.guard_time = SimDuration::from_milliseconds(4);
  EXPECT_EQ(modem.guard_taper_or_default(), modem.guard_time);
  modem.guard_taper = SimDuration();
  EXPECT_EQ(modem.guard_taper_or_default(), SimDuration());
}

TEST(Modem, RefusesImpossibleValues) {
  const auto refuses = [](auto change) {
    Modem modem;
    change(modem);
    EXPECT_THROW(validate(modem), InvalidArgument);
  };
  refuses([](Modem& m) { m.source_level.value = std::numeric_limits<double>::quiet_NaN(); });
  refuses([](Modem& m) { m.centre_frequency_hz = 0; });
  refuses([](Modem& m) { m.bandwidth_hz = 2 * m.centre_frequency_hz; });
  refuses([](Modem& m) { m.bandwidth_hz = 0; });
  refuses([](Modem& m) { m.bit_rate_bps = 0; });
  refuses([](Modem& m) { m.directivity_index.value = -1; });
  refuses([](Modem& m) { m.packet_overhead = SimDuration::from_seconds(-1); });
  refuses([](Modem& m) { m.preamble = SimDuration::from_milliseconds(1); });  // longer than the overhead
  refuses([](Modem& m) { m.preamble_pieces = 0; });
  refuses([](Modem& m) { m.guard_time = SimDuration::from_seconds(-1); });
  refuses([](Modem& m) { m.doppler_tolerance = -0.1; });
  refuses([](Modem& m) { m.doppler_correction = 1.1; });
  refuses([](Modem& m) { m.family = "two words"; });
  refuses([](Modem& m) { m.guard_taper = SimDuration::from_seconds(-1); });
  refuses([](Modem& m) { m.time_quantum = SimDuration::from_seconds(2); });
  refuses([](Modem& m) { m.hop_count = 13; });  // without a chip
  refuses([](Modem& m) {
    m.chip = SimDuration::from_milliseconds(6);
    m.hop_count = 13;
    m.hop_clearing = SimDuration::from_milliseconds(-5);
  });
  refuses([](Modem& m) { m.layout = {.frame_bytes = 32, .max_frames = 0}; });
  refuses([](Modem& m) { m.layout.header_bits = -1; });
}

}  // namespace
}  // namespace halocline::acoustics
