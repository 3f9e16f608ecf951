// One packet, one cause: each fate from a water in which only that can happen, and the numbers that decided it.
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/modem/bit_error.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::at_s;
using ::testing::ElementsAre;
using testing::even_water;
using testing::for_s;
using testing::path;
using testing::quick_modem;
using testing::request_of;

using PacketFateTest = testing::ScriptedWater;

// What the quick modem (800 bit/s in 5 kHz, non-coherent FSK) does with a bit at this ratio.
double bit_error(double sinr) { return acoustics::bit_error_rate(quick_modem().modem, PowerRatio{sinr}); }

// The level, dB, at which `error` of the bits are wrong in noise alone: exp(-Eb/2N0)/2 solved for S.
double level_with_bit_error(double error, double noise_power) {
  const double eb_over_n0 = -2 * std::log(2 * error);
  return 10 * std::log10(eb_over_n0 * 800 / 5000 * noise_power);
}

TEST_F(PacketFateTest, LoudAndAloneItIsReceivedForCertain) {
  water.set(1, 2, {path(1, 120)});
  send(1, 10, 0, 10);
  run();
  const PacketEnd& end = end_of(1, 0, 2);
  EXPECT_EQ(end.fate, PacketFate::kReceived);
  EXPECT_EQ(end.judgement.success_probability, 1);
  EXPECT_EQ(end.judgement.acquisition_probability, 1);
  EXPECT_EQ(end.judgement.interference, kSilence);
  EXPECT_NEAR(end.judgement.sinr.value, 120 - 10 * std::log10(noise_power()), tolerance(1e-9));
  EXPECT_TRUE(end.judgement.colliders.empty());
  EXPECT_GT(end.judgement.success_draw, 0);
}

TEST_F(PacketFateTest, WithoutAPathTheWaterOrTheTerrainIsTheCause) {
  water.set(1, 2, {}, PathState::kShadow);
  water.set(1, 3, {}, PathState::kBlocked);
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kShadow);
  EXPECT_EQ(end_of(1, 0, 2).path_count, 0u);
  EXPECT_EQ(end_of(1, 0, 3).fate, PacketFate::kBlocked);
}

TEST_F(PacketFateTest, BandsThatShareNothingAreOutOfBand) {
  VehicleModem low = big_modem();
  low.modem.centre_frequency_hz = 12'000;
  fleet.announce_modem("v2", at_s(0), low, at_s(0));
  water.set(1, 2, {path(1, 120)});
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kOutOfBand);
}

TEST_F(PacketFateTest, AllPathsTogetherDecideTheCutoff) {
  water.set(1, 2, {path(1, 69.9)});
  water.set(1, 3, {path(1, 67.5), path(1.001, 67.5)});  // 70.5 dB together; the cut-off is 70
  send(1, 10, 0, 1);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kBelowCutoff);
  EXPECT_EQ(end_of(1, 0, 3).fate, PacketFate::kReceived);
}

TEST_F(PacketFateTest, WhoeverTransmitsHearsNothing) {
  water.set(1, 2, {path(1, 120)});
  send(2, 10.9, 7, 20);  // until 11.1: the packet comes in at 11
  send(1, 10, 0, 50);
  run();
  const PacketEnd& end = end_of(1, 0, 2);
  EXPECT_EQ(end.fate, PacketFate::kHalfDuplex);
  ASSERT_EQ(end.judgement.colliders.size(), 1u);
  EXPECT_EQ(end.judgement.colliders[0].source_id, 2);
  EXPECT_EQ(end.judgement.colliders[0].packet_sequence, 7);
}

TEST_F(PacketFateTest, ATransmissionThatStartsDuringAReceptionKillsIt) {
  water.set(1, 2, {path(1, 120)});
  send(1, 10, 0, 50);  // at 2 from 11 to 11.5
  send(2, 11.49, 7, 1);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kHalfDuplex);
}

TEST_F(PacketFateTest, TransmissionsThatTouchAReceptionOnlyAtItsEndsDoNoHarm) {
  water.set(1, 2, {path(1, 120)});
  send(2, 10.9, 7, 10);  // until 11
  send(1, 10, 0, 50);    // at 2 from 11 to 11.5
  send(2, 11.5, 8, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kReceived);
}

TEST_F(PacketFateTest, BeyondTheModemsToleranceDopplerLosesIt) {
  VehicleModem strict = big_modem();
  strict.modem.doppler_tolerance = 0.003;
  fleet.announce_modem("v2", at_s(0), strict, at_s(0));
  fleet.announce_modem("v3", at_s(0), strict, at_s(0));
  water.set(1, 2, {path(1, 120, 1.0031)});
  water.set(1, 3, {path(1, 120, 0.9971)});
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kDoppler);
  EXPECT_EQ(end_of(1, 0, 3).fate, PacketFate::kReceived);
}

TEST_F(PacketFateTest, DopplerStretchesThePacketAtTheReceiver) {
  water.set(1, 2, {path(1, 120, 0.99)});
  send(1, 10, 0, 99);
  run();
  for (const MediumEvent& event : events) {
    if (std::holds_alternative<PacketEnd>(event.what) && std::get<PacketEnd>(event.what).receiver_id == 2) {
      EXPECT_EQ(event.at, at_s(12));  // 0.99 s as sent last 1 s
    }
  }
  EXPECT_EQ(end_of(1, 0, 2).doppler_factor, 0.99);
}

TEST_F(PacketFateTest, InNoiseAloneALostPacketHasBitErrors) {
  VehicleModem deep = big_modem();
  deep.modem.min_receivable_level = {-100};
  fleet.announce_modem("v2", at_s(0), deep, at_s(0));
  water.set(1, 2, {path(1, level_with_bit_error(0.01, noise_power()))});
  send(1, 10, 0, 1000);
  run();
  const PacketEnd& end = end_of(1, 0, 2);
  EXPECT_EQ(end.fate, PacketFate::kBitErrors);
  EXPECT_LT(relative_error(end.judgement.success_probability, std::pow(0.99, 8000)), tolerance(1e-7));
  EXPECT_TRUE(end.judgement.colliders.empty());
}

TEST_F(PacketFateTest, APreambleBelowTheNoiseIsNotNoticed) {
  VehicleModem shy = big_modem();
  shy.modem.preamble = shy.modem.packet_overhead = for_s(0.1);
  shy.modem.min_receivable_level = {-100};
  fleet.announce_modem("v1", at_s(0), shy, at_s(0));
  fleet.announce_modem("v2", at_s(0), shy, at_s(0));
  water.set(1, 2, {path(1, 20)});
  send(1, 10, 0, 10);
  run();
  const PacketEnd& end = end_of(1, 0, 2);
  EXPECT_EQ(end.fate, PacketFate::kNotAcquired);
  EXPECT_LT(end.judgement.acquisition_probability, end.judgement.acquisition_draw);
  EXPECT_EQ(end.judgement.success_probability, 0);
}

// A kilobyte of 8000 bits: 7200 in noise, 800 under the other packet.
TEST_F(PacketFateTest, ACollisionOfTheLastTenthCostsByTheBitsOverlapped) {
  const double level = 80;
  water.set(1, 2, {path(1, level)});
  water.set(3, 2, {path(1, level - 3)});
  send(1, 10, 0, 1000);  // at 2 from 11 to 21
  send(3, 19, 0, 1000);  // at 2 from 20 on
  run();
  const PacketEnd& end = end_of(1, 0, 2);
  const double alone = bit_error(power_of(level) / noise_power());
  const double together = bit_error(power_of(level) / (noise_power() + power_of(level - 3)));
  const double expected = std::exp(7200 * std::log1p(-alone) + 800 * std::log1p(-together));
  EXPECT_LT(relative_error(end.judgement.success_probability, expected), tolerance(1e-9));
  EXPECT_LT(expected, 1);
  EXPECT_NEAR(end.judgement.interference.value, level - 3 - 10, tolerance(1e-9));  // a tenth of the time
}

TEST_F(PacketFateTest, APacketThatHadComeThroughAloneCollided) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 95)});
  send(1, 10, 0, 200);  // at 2 from 11 to 13
  send(3, 11, 5, 200);  // at 2 from 12 to 14
  run();
  const PacketEnd& weak = end_of(1, 0, 2);
  EXPECT_EQ(weak.fate, PacketFate::kCollided);
  ASSERT_EQ(weak.judgement.colliders.size(), 1u);
  EXPECT_EQ(weak.judgement.colliders[0].source_id, 3);
  EXPECT_EQ(weak.judgement.colliders[0].packet_sequence, 5);
  EXPECT_EQ(weak.judgement.colliders[0].departure, at_s(11));
}

TEST_F(PacketFateTest, AModemThatFollowsOnePacketMissesAStrongerOne) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 130)});
  send(1, 10, 0, 200);
  send(3, 11, 5, 200);
  run();
  const PacketEnd& strong = end_of(3, 5, 2);
  EXPECT_EQ(strong.fate, PacketFate::kCollided);
  ASSERT_EQ(strong.judgement.colliders.size(), 1u);
  EXPECT_EQ(strong.judgement.colliders[0].source_id, 1);
  EXPECT_EQ(strong.judgement.acquisition_probability, 0);  // it never came to that
}

TEST_F(PacketFateTest, AStrongPacketSurvivesAWeakOneThatComesLater) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 120)});
  send(3, 10, 5, 200);
  send(1, 11, 0, 200);
  run();
  EXPECT_EQ(end_of(3, 5, 2).fate, PacketFate::kReceived);
  EXPECT_EQ(end_of(3, 5, 2).judgement.colliders.size(), 1u);  // named all the same
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kCollided);
}

TEST_F(PacketFateTest, APacketTooWeakToBeFollowedLocksNobody) {
  water.set(1, 2, {path(1, 69)});  // below the cut-off of 70
  water.set(3, 2, {path(1, 110)});
  send(1, 10, 0, 200);
  send(3, 11, 5, 200);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kBelowCutoff);
  EXPECT_EQ(end_of(3, 5, 2).fate, PacketFate::kReceived);
}

TEST_F(PacketFateTest, ATransmissionOfItsOwnFreesAModemForTheNextPacket) {
  water.set(1, 2, {path(1, 90)});
  water.set(3, 2, {path(1, 120)});
  send(1, 10, 0, 200);   // at 2 from 11 to 13
  send(2, 11.5, 9, 10);  // until 11.6
  send(3, 11, 5, 50);    // at 2 from 12 on
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kHalfDuplex);
  EXPECT_EQ(end_of(3, 5, 2).fate, PacketFate::kReceived);
}

TEST_F(PacketFateTest, InterferenceCountsByTheShareOfItsBand) {
  VehicleModem shifted = big_modem();
  shifted.modem.centre_frequency_hz = 27'500;  // 25..30 kHz; the packet's band is 22.5..27.5
  fleet.announce_modem("v3", at_s(0), shifted, at_s(0));
  water.set(1, 2, {path(1, 100)});
  water.set(3, 2, {path(1, 95)});
  send(1, 10, 0, 100);
  send(3, 10, 0, 100);
  run();
  EXPECT_NEAR(end_of(1, 0, 2).judgement.interference.value, 95 - 10 * std::log10(2), tolerance(1e-9));
}

TEST_F(PacketFateTest, ThreeInterferersAddTheirPowersAndAreNamedByLoudness) {
  water.set(1, 2, {path(1, 110)});
  water.set(3, 2, {path(1, 80)});
  water.set(4, 2, {path(1, 90)});
  send(1, 10, 0, 300);
  send(3, 10, 0, 100);  // a third of the time
  send(4, 10, 0, 150);  // half of it
  send(4, 11.5, 1, 150);
  run();
  const PacketEnd& end = end_of(1, 0, 2);
  EXPECT_LT(relative_error(power_of(end.judgement.interference.value), power_of(80) / 3 + power_of(90)),
            tolerance(1e-9));
  std::vector<std::pair<VehicleId, std::int64_t>> names;
  for (const auto& name : end.judgement.colliders) names.emplace_back(name.source_id, name.packet_sequence);
  EXPECT_THAT(names, ElementsAre(std::pair(4, 0), std::pair(4, 1), std::pair(3, 0)));
}

TEST_F(PacketFateTest, ANegligibleInterfererIsNotNamed) {
  water.set(1, 2, {path(1, 110)});
  water.set(3, 2, {path(1, 10 * std::log10(noise_power()) - 20.1)});
  water.set(4, 2, {path(1, 10 * std::log10(noise_power()) - 19.9)});
  send(1, 10, 0, 100);
  send(3, 10, 0, 100);
  send(4, 10, 0, 100);
  run();
  ASSERT_EQ(end_of(1, 0, 2).judgement.colliders.size(), 1u);
  EXPECT_EQ(end_of(1, 0, 2).judgement.colliders[0].source_id, 4);
}

TEST_F(PacketFateTest, EchoesWithinTheGuardTimeHelpAndLaterOnesHarm) {
  const double guard_s = quick_modem().modem.guard_time.seconds();
  water.set(1, 2, {path(1, 80), path(1 + 0.9 * guard_s, 77)});
  water.set(1, 3, {path(1, 80), path(1 + 1.1 * guard_s, 77)});
  send(1, 10, 0, 1000);
  run();
  const Judgement &within = end_of(1, 0, 2).judgement, &beyond = end_of(1, 0, 3).judgement;
  EXPECT_LT(relative_error(power_of(within.sinr.value), (power_of(80) + power_of(77)) / noise_power()),
            tolerance(1e-9));
  EXPECT_EQ(within.interference, kSilence);
  // The echo sounds during all but the first 1.1 guard times of the packet.
  const double share = 1 - 1.1 * guard_s / 10;
  EXPECT_LT(relative_error(power_of(beyond.interference.value), share * power_of(77)), tolerance(1e-9));
}

TEST_F(PacketFateTest, ItsOwnEchoesCauseBitErrors) {
  water.set(1, 2, {path(1, 90), path(1.5, 90)});
  send(1, 10, 0, 1000);
  run();
  EXPECT_EQ(end_of(1, 0, 2).fate, PacketFate::kBitErrors);
  EXPECT_TRUE(end_of(1, 0, 2).judgement.colliders.empty());
}

// It is no part of the signal, and sounds during nearly all of it.
TEST_F(PacketFateTest, AnEarlyPathTooWeakToAnnounceThePacketInterferes) {
  water.set(1, 2, {path(0.9, 75), path(1, 100)});
  send(1, 10, 0, 1000);  // 10 s; the forerunner ends 0.1 s before the signal does
  run();
  const PacketEnd& end = end_of(1, 0, 2);
  EXPECT_EQ(end.travel_time_s, 1);
  EXPECT_LT(relative_error(power_of(end.judgement.interference.value), 0.99 * power_of(75)), tolerance(1e-9));
}

TEST_F(PacketFateTest, EveryPathOfAnotherPacketInterferesDuringItsOwnInterval) {
  water.set(1, 2, {path(1, 110)});
  water.set(3, 2, {path(1, 80), path(4, 83)});
  send(1, 10, 0, 1000);  // at 2 from 11 to 21
  send(3, 12, 0, 200);   // at 2 from 13 to 15 and from 16 to 18
  run();
  EXPECT_LT(relative_error(power_of(end_of(1, 0, 2).judgement.interference.value),
                           0.2 * power_of(80) + 0.2 * power_of(83)),
            tolerance(1e-9));
}

TEST_F(PacketFateTest, DirectivityLowersTheNoise) {
  VehicleModem keen = big_modem();
  keen.modem.directivity_index = {6};
  fleet.announce_modem("v2", at_s(0), keen, at_s(0));
  water.set(1, 2, {path(1, 100)});
  water.set(1, 3, {path(1, 100)});
  send(1, 10, 0, 10);
  run();
  EXPECT_NEAR(end_of(1, 0, 2).judgement.sinr.value - end_of(1, 0, 3).judgement.sinr.value, 6,
              tolerance(1e-9));
}

TEST_F(PacketFateTest, TheDrawsAreThoseOfTheContentsNotOfTheSession) {
  water.set(1, 2, {path(1, 100)});
  send(1, 10, 3, 10);
  run();
  const auto first = end_of(1, 3, 2).judgement;
  PacketMedium again(fleet, water, {for_s(10), for_s(200)}), other(fleet, water, {for_s(10), for_s(200), 2});
  SendRequest request = request_of(1, 10, 3, 10);
  request.session = 999'999;
  again.transmit(request, SimTime());
  other.transmit(request, SimTime());
  const auto same = testing::ends_in(again.advance_to(at_s(110))).at(0).judgement;
  const auto seeded = testing::ends_in(other.advance_to(at_s(110))).at(0).judgement;
  EXPECT_EQ(same.acquisition_draw, first.acquisition_draw);
  EXPECT_EQ(same.success_draw, first.success_draw);
  EXPECT_NE(seeded.acquisition_draw, first.acquisition_draw);
  EXPECT_NE(seeded.success_draw, first.success_draw);
}

// Generators that are seeded anew for each packet give each the same number.
TEST_F(PacketFateTest, NoTwoPacketsReceiversOrPurposesShareADraw) {
  for (const VehicleId to : {2, 3, 4}) water.set(1, to, {path(1, 100)});
  for (int i = 0; i < 20; ++i) send(1, 10 + i, i, 10);
  run();
  std::set<double> draws;
  for (const auto& end : testing::ends_in(events)) {
    EXPECT_TRUE(draws.insert(end.judgement.acquisition_draw).second);
    EXPECT_TRUE(draws.insert(end.judgement.success_draw).second);
  }
  EXPECT_EQ(draws.size(), 20u * 3 * 2);
}

TEST_F(PacketFateTest, TheDirectionIsThatFromWhichTheSoundCame) {
  auto from_above = path(1, 100);
  from_above.arrival_angle_rad = 0.25;
  water.set(1, 2, {from_above});
  send(1, 10, 0, 10);
  run();
  // 1 lies south of 2.
  EXPECT_NEAR(std::abs(end_of(1, 0, 2).arrival_azimuth_rad), std::numbers::pi, tolerance(1e-12));
  EXPECT_EQ(end_of(1, 0, 2).arrival_elevation_rad, 0.25);
}

TEST_F(PacketFateTest, AStillReceiverIsAskedAboutOnce) {
  for (const VehicleId to : {2, 3, 4}) water.set(1, to, {path(1, 100)});
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(water.questions, 3);
}

// Sender near and far: geometry and straight paths, not a script.
TEST(NearFar, TheNearSenderComesThroughAndTheFarOneDoesNot) {
  VehicleRegistry fleet({for_s(0.05), for_s(5)}, {quick_modem(), {}});
  testing::move_steadily(fleet, 1, {100, 0, 50}, Vec3::Zero(), 0, 30);
  testing::move_steadily(fleet, 2, {0, 0, 50}, Vec3::Zero(), 0, 30);
  testing::move_steadily(fleet, 3, {3000, 0, 50}, Vec3::Zero(), 0, 30);
  StraightPropagation propagation(even_water());
  PacketMedium medium(fleet, propagation, {});
  medium.transmit(request_of(3, 10, 0, 60), at_s(10));    // at 2 from 12 to 12.6
  medium.transmit(request_of(1, 11.9, 0, 20), at_s(10));  // at 2 from 11.97 to 12.17
  std::map<VehicleId, PacketFate> at_two;
  for (const auto& end : testing::ends_in(medium.advance_to(at_s(25)))) {
    if (end.receiver_id == 2) at_two[end.packet->request.source_id] = end.fate;
  }
  EXPECT_EQ(at_two[1], PacketFate::kReceived);
  EXPECT_EQ(at_two[3], PacketFate::kCollided);
}

}  // namespace
}  // namespace halocline::channel_server
