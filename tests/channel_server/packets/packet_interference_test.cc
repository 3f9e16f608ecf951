// SPDX-License-Identifier: BSD-3-Clause
// What other packets, and late paths of its own, do to a packet.
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::at_s;
using testing::bit_error;
using testing::path;
using testing::quick_modem;

using PacketInterferenceTest = testing::ScriptedWater;

// A kilobyte of 8000 bits: 7200 in noise, 800 under the other packet.
TEST_F(PacketInterferenceTest, ACollisionOfTheLastTenthCostsByTheBitsOverlapped) {
  const double level = 80;
  water.set(1, 2, {path(1, level)});
  water.set(3, 2, {path(1, level - 3)});
  send(1, 10, 0, 1000);  // at 2 from 11 to 21
  send(3, 19, 0, 1000);  // at 2 from 20 on
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  const double alone = bit_error(power_of(level) / noise_power());
  const double together = bit_error(power_of(level) / (noise_power() + power_of(level - 3)));
  const double expected = std::exp(7200 * std::log1p(-alone) + 800 * std::log1p(-together));
  EXPECT_LT(relative_error(end.statistics.success_probability, expected), tolerance(1e-9));
  EXPECT_LT(expected, 1);
  EXPECT_NEAR(end.statistics.interference.value, level - 3 - 10, tolerance(1e-9));  // a tenth of the time
}

TEST_F(PacketInterferenceTest, APacketReceivedWithoutTheOthersCollided) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 95)});
  send(1, 10, 0, 200);  // at 2 from 11 to 13
  send(3, 11, 5, 200);  // at 2 from 12 to 14
  run();
  const PacketOutcome& weak = end_of(1, 0, 2);
  EXPECT_EQ(weak.kind, OutcomeKind::kCollided);
  ASSERT_EQ(colliders_of(weak), (Colliders{{3, 5}}));
  EXPECT_EQ(weak.statistics.colliders[0].departure, at_s(11));
}

TEST_F(PacketInterferenceTest, AModemThatFollowsOnePacketMissesAStrongerOne) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 130)});
  send(1, 10, 0, 200);
  send(3, 11, 5, 200);
  run();
  const PacketOutcome& strong = end_of(3, 5, 2);
  EXPECT_EQ(strong.kind, OutcomeKind::kCollided);
  EXPECT_EQ(colliders_of(strong), (Colliders{{1, 0}}));
  EXPECT_EQ(strong.statistics.acquisition_probability, 0);  // it never came to that
}

TEST_F(PacketInterferenceTest, AStrongPacketSurvivesAWeakOneThatComesLater) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 120)});
  send(3, 10, 5, 200);
  send(1, 11, 0, 200);
  run();
  EXPECT_EQ(end_of(3, 5, 2).kind, OutcomeKind::kReceived);
  EXPECT_EQ(end_of(3, 5, 2).statistics.colliders.size(), 1u);  // named all the same
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kCollided);
}

TEST_F(PacketInterferenceTest, APacketTooWeakToBeReceivedIsNotAcquired) {
  water.set(1, 2, {path(1, 69)});  // below the cut-off of 70
  water.set(3, 2, {path(1, 110)});
  send(1, 10, 0, 200);
  send(3, 11, 5, 200);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kBelowCutoff);
  EXPECT_EQ(end_of(3, 5, 2).kind, OutcomeKind::kReceived);
}

TEST_F(PacketInterferenceTest, ATransmissionOfItsOwnFreesAModemForTheNextPacket) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 120)});
  send(1, 10, 0, 200);   // at 2 from 11 to 13
  send(2, 11.5, 9, 10);  // until 11.6
  send(3, 11, 5, 50);    // at 2 from 12 on
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kHalfDuplex);
  EXPECT_EQ(end_of(3, 5, 2).kind, OutcomeKind::kReceived);
}

TEST_F(PacketInterferenceTest, InterferenceCountsByTheShareOfItsBand) {
  // 25..30 kHz; the packet's band is 22.5..27.5.
  change_modem({3}, [](acoustics::Modem& m) { m.centre_frequency_hz = 27'500; });
  water.set(1, 2, {path(1, 100)});
  water.set(3, 2, {path(1, 95)});
  send(1, 10, 0, 100);
  send(3, 10, 0, 100);
  run();
  EXPECT_NEAR(end_of(1, 0, 2).statistics.interference.value, 95 - 10 * std::log10(2), tolerance(1e-9));
}

TEST_F(PacketInterferenceTest, ThreeInterferersAddTheirPowersAndAreNamedByLoudness) {
  water.set(1, 2, {path(1, 110)});
  water.set(3, 2, {path(1, 80)});
  water.set(4, 2, {path(1, 90)});
  send(1, 10, 0, 300);
  send(3, 10, 0, 100);  // a third of the time
  send(4, 10, 0, 150);  // half of it
  send(4, 11.5, 1, 150);
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_LT(relative_error(power_of(end.statistics.interference.value), power_of(80) / 3 + power_of(90)),
            tolerance(1e-9));
  EXPECT_EQ(colliders_of(end), (Colliders{{4, 0}, {4, 1}, {3, 0}}));
}

TEST_F(PacketInterferenceTest, ANegligibleInterfererIsNotNamed) {
  water.set(1, 2, {path(1, 110)});
  water.set(3, 2, {path(1, 10 * std::log10(noise_power()) - 20.1)});
  water.set(4, 2, {path(1, 10 * std::log10(noise_power()) - 19.9)});
  send(1, 10, 0, 100);
  send(3, 10, 0, 100);
  send(4, 10, 0, 100);
  run();
  EXPECT_EQ(colliders_of(end_of(1, 0, 2)), (Colliders{{4, 0}}));
}

TEST_F(PacketInterferenceTest, EchoesWithinTheGuardTimeHelpAndLaterOnesHarm) {
  const double guard_s = quick_modem().modem.guard_time.seconds();
  water.set(1, 2, {path(1, 80), path(1 + 0.9 * guard_s, 77)});
  water.set(1, 3, {path(1, 80), path(1 + 1.5 * guard_s, 77)});
  send(1, 10, 0, 1000);
  run();
  const DecisionStatistics &within = end_of(1, 0, 2).statistics, &beyond = end_of(1, 0, 3).statistics;
  EXPECT_LT(relative_error(power_of(within.sinr.value), (power_of(80) + power_of(77)) / noise_power()),
            tolerance(1e-9));
  EXPECT_EQ(within.interference, kSilence);
  // Half way through the taper its weight is 1/2: of its power 1/4 is signal. The rest interferes while it
  // sounds, all but the first 1.5 guard times of the packet.
  const double share = 1 - 1.5 * guard_s / 10;
  EXPECT_LT(relative_error(power_of(beyond.interference.value), 0.75 * share * power_of(77)),
            tolerance(1e-9));
  EXPECT_LT(relative_error(power_of(beyond.sinr.value), (power_of(80) + 0.25 * power_of(77)) /
                                                            (noise_power() + 0.75 * share * power_of(77))),
            tolerance(1e-9));
}

TEST_F(PacketInterferenceTest, ItsOwnEchoesCauseBitErrors) {
  water.set(1, 2, {path(1, 90), path(1.5, 90)});
  send(1, 10, 0, 1000);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kBitErrors);
  EXPECT_TRUE(end_of(1, 0, 2).statistics.colliders.empty());
}

// It is no part of the signal, and sounds during nearly all of it.
TEST_F(PacketInterferenceTest, AnEarlyPathTooWeakToAnnounceThePacketInterferes) {
  water.set(1, 2, {path(0.9, 75), path(1, 100)});
  send(1, 10, 0, 1000);  // 10 s; the forerunner ends 0.1 s before the signal does
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_EQ(end.travel_time_s, 1);
  EXPECT_LT(relative_error(power_of(end.statistics.interference.value), 0.99 * power_of(75)),
            tolerance(1e-9));
}

TEST_F(PacketInterferenceTest, EveryPathOfAnotherPacketInterferesDuringItsOwnInterval) {
  water.set(1, 2, {path(1, 110)});
  water.set(3, 2, {path(1, 80), path(4, 83)});
  send(1, 10, 0, 1000);  // at 2 from 11 to 21
  send(3, 12, 0, 200);   // at 2 from 13 to 15 and from 16 to 18
  run();
  EXPECT_LT(relative_error(power_of(end_of(1, 0, 2).statistics.interference.value),
                           0.2 * power_of(80) + 0.2 * power_of(83)),
            tolerance(1e-9));
}

}  // namespace
}  // namespace halocline::channel_server
