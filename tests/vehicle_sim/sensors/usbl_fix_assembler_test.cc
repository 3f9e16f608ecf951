// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/usbl_fix_assembler.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr PacketKey kPacket{2, 2, 100, 7};
using halocline::testing::at_ms;

// A desk that has noted a vehicle which turns at 0.1 rad/s, from 0 to 2 s.
UsblFixAssembler turning(const UsblSettings& settings = {.fitted = true}) {
  UsblFixAssembler desk(settings, {1, 3, SensorKind::kUsbl});
  for (int ms = 0; ms <= 2000; ms += 100) desk.note_pose(at_ms(ms), to_quaternion({0, 0, 1e-4 * ms}));
  return desk;
}

TEST(UsblFixAssembler, ABearingIsThatOfTheAttitudeWhenTheSoundCame) {
  UsblFixAssembler desk = turning();
  desk.on_arrival(kPacket, {at_ms(1250), 0.5, 0.2});
  desk.on_packet(kPacket, 0.3);
  const auto fixes = desk.take(false);
  ASSERT_EQ(fixes.size(), 1u);
  EXPECT_EQ(fixes[0].packet, kPacket);
  EXPECT_EQ(fixes[0].when, at_ms(1250));
  EXPECT_NEAR(fixes[0].direction.bearing_rad, 0.5 - 0.125, tolerance(1e-9));
  EXPECT_NEAR(fixes[0].direction.elevation_rad, 0.2, tolerance(1e-9));
  EXPECT_EQ(fixes[0].travel_time_s, 0.3);
  EXPECT_TRUE(desk.take(false).empty());
}

TEST(UsblFixAssembler, BothHalvesAreNeededInAnyOrder) {
  UsblFixAssembler desk = turning();
  desk.on_packet(kPacket, {});
  EXPECT_TRUE(desk.take(false).empty());
  desk.on_arrival(kPacket, {at_ms(1000), 0, 0});
  const auto fixes = desk.take(false);
  ASSERT_EQ(fixes.size(), 1u);
  EXPECT_EQ(fixes[0].travel_time_s, std::nullopt);
}

TEST(UsblFixAssembler, ItWaitsForAPoseAfterTheSound) {
  UsblFixAssembler desk = turning();
  desk.on_arrival(kPacket, {at_ms(2050), 0, 0});
  desk.on_packet(kPacket, {});
  EXPECT_TRUE(desk.take(false).empty());
  desk.note_pose(at_ms(2100), to_quaternion({0, 0, 0.21}));
  EXPECT_EQ(desk.take(false).size(), 1u);
}

TEST(UsblFixAssembler, APacketForOthersGivesNoBearing) {
  UsblFixAssembler desk = turning();
  desk.on_arrival(kPacket, {at_ms(1000), 0, 0});
  for (int ms = 2100; ms < 40'000; ms += 100) desk.note_pose(at_ms(ms), Quaternion::Identity());
  EXPECT_TRUE(desk.take(false).empty());
  desk.on_packet(kPacket, {});  // its other half was forgotten
  EXPECT_TRUE(desk.take(false).empty());
}

TEST(UsblFixAssembler, ADeadArrayGivesNoFixes) {
  UsblFixAssembler desk = turning();
  desk.on_arrival(kPacket, {at_ms(1000), 0, 0});
  desk.on_packet(kPacket, {});
  EXPECT_TRUE(desk.take(true).empty());
  EXPECT_TRUE(desk.take(false).empty());
}

TEST(UsblFixAssembler, NoiseIsThePacketsOwn) {
  const UsblSettings noisy{.fitted = true, .errors = {.noise = 0.05}};
  const auto bearing_of = [&](std::initializer_list<std::int64_t> sequences) {
    UsblFixAssembler desk = turning(noisy);
    for (const std::int64_t sequence : sequences) {
      desk.on_arrival({2, 0, 100, sequence}, {at_ms(0), 0, 0});
      desk.on_packet({2, 0, 100, sequence}, {});
    }
    return desk.take(false).back().direction.bearing_rad;
  };
  EXPECT_EQ(bearing_of({9}), bearing_of({7, 8, 9}));
  EXPECT_NE(bearing_of({9}), bearing_of({8}));
}

// 4 standard deviations of a variance from 5000 packets.
TEST(UsblFixAssembler, NoiseOfBothAnglesIsTheConfiguredOneAndPacketsDropOut) {
  UsblFixAssembler desk = turning({.fitted = true, .errors = {.noise = 0.02, .dropout = 0.3}});
  constexpr int kPackets = 5000;
  double bearing = 0, elevation = 0;
  int received = 0;
  for (int i = 0; i < kPackets; ++i) {
    desk.on_arrival({2, 0, 100, i}, {at_ms(0), 0, 0});
    desk.on_packet({2, 0, 100, i}, {});
    for (const UsblFix& fix : desk.take(false)) {
      ++received;
      bearing += fix.direction.bearing_rad * fix.direction.bearing_rad;
      elevation += fix.direction.elevation_rad * fix.direction.elevation_rad;
    }
  }
  EXPECT_NEAR(received / static_cast<double>(kPackets), 0.7, 4 * std::sqrt(0.21 / kPackets));
  EXPECT_NEAR(bearing / received / 4e-4, 1, 4 * std::sqrt(2.0 / received));
  EXPECT_NEAR(elevation / received / 4e-4, 1, 4 * std::sqrt(2.0 / received));
}

}  // namespace
}  // namespace halocline::vehicle_sim
