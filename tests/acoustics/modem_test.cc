#include "acoustics/modem.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

TEST(Modem, DefaultsAreValid) { EXPECT_NO_THROW(validate(Modem{})); }

TEST(Modem, TakesThePapersFourParameters) {
  const Modem modem = generic_modem({120}, {40}, 10e3, 4e3);
  EXPECT_EQ(modem.source_level.value, 120);
  EXPECT_EQ(modem.least_receivable_level.value, 40);
  EXPECT_EQ(modem.band().low_hz, 8e3);
  EXPECT_EQ(modem.band().high_hz, 12e3);
}

TEST(Modem, PacketLastsOverheadPlusBits) {
  Modem modem;
  modem.bit_rate_bps = 80;
  modem.packet_overhead = SimDuration::from_milliseconds(500);
  EXPECT_EQ(packet_duration(modem, 10).nanoseconds(), 1'500'000'000);
  EXPECT_EQ(packet_duration(modem, 0).nanoseconds(), 500'000'000);
}

TEST(Modem, BandsOverlapOnlyWhereTheyShareFrequencies) {
  const Modem a = generic_modem({185}, {70}, 10e3, 2e3);
  EXPECT_TRUE(bands_overlap(a, a));
  EXPECT_TRUE(bands_overlap(a, generic_modem({185}, {70}, 11.5e3, 2e3)));
  EXPECT_FALSE(bands_overlap(a, generic_modem({185}, {70}, 12e3, 2e3)));  // they touch at 11 kHz
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
}

}  // namespace
}  // namespace halocline::acoustics
