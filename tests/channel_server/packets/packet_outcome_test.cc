// SPDX-License-Identifier: BSD-3-Clause
// One packet, one outcome: each from a water in which only that can happen, and the numbers that decided it.
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;
using testing::for_s;
using testing::level_with_bit_error;
using testing::path;
using testing::quick_modem;
using testing::request_of;

using PacketOutcomeTest = testing::ScriptedWater;

TEST_F(PacketOutcomeTest, LoudAndAloneItIsReceivedForCertain) {
  water.set(1, 2, {path(1, 120)});
  send(1, 10, 0, 10);
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_EQ(end.kind, OutcomeKind::kReceived);
  EXPECT_EQ(end.statistics.success_probability, 1);
  EXPECT_EQ(end.statistics.acquisition_probability, 1);
  EXPECT_EQ(end.statistics.interference, kSilence);
  EXPECT_NEAR(end.statistics.sinr.value, 120 - 10 * std::log10(noise_power()), tolerance(1e-9));
  EXPECT_TRUE(end.statistics.colliders.empty());
  EXPECT_GT(end.statistics.success_draw, 0);
}

TEST_F(PacketOutcomeTest, WithoutAPathItHasTheCauseOfTheLink) {
  water.set(1, 2, {}, PathState::kShadow);
  water.set(1, 3, {}, PathState::kBlocked);
  water.set(2, 1, {}, PathState::kTooWeak);
  water.set(2, 3, {}, PathState::kTooSteep);
  send(1, 10, 0, 10);
  send(2, 20, 0, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kShadow);
  EXPECT_EQ(end_of(1, 0, 2).path_count, 0u);
  EXPECT_EQ(end_of(1, 0, 3).kind, OutcomeKind::kBlocked);
  EXPECT_EQ(end_of(2, 0, 1).kind, OutcomeKind::kTooWeak);
  EXPECT_EQ(end_of(2, 0, 3).kind, OutcomeKind::kTooSteep);
}

TEST_F(PacketOutcomeTest, BandsThatShareNothingAreOutOfBand) {
  change_modem({2}, [](acoustics::Modem& m) { m.centre_frequency_hz = 12'000; });
  water.set(1, 2, {path(1, 120)});
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kOutOfBand);
}

TEST_F(PacketOutcomeTest, AllPathsTogetherDecideTheCutoff) {
  water.set(1, 2, {path(1, 69.9)});
  water.set(1, 3, {path(1, 67.5), path(1.001, 67.5)});  // 70.5 dB together; the cut-off is 70
  send(1, 10, 0, 1);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kBelowCutoff);
  EXPECT_EQ(end_of(1, 0, 3).kind, OutcomeKind::kReceived);
}

TEST_F(PacketOutcomeTest, AModemThatTransmitsReceivesNothing) {
  water.set(1, 2, {path(1, 120)});
  send(2, 10.9, 7, 20);  // until 11.1: the packet comes in at 11
  send(1, 10, 0, 50);
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_EQ(end.kind, OutcomeKind::kHalfDuplex);
  EXPECT_EQ(colliders_of(end), (Colliders{{2, 7}}));
}

TEST_F(PacketOutcomeTest, ATransmissionThatStartsDuringAReceptionEndsIt) {
  water.set(1, 2, {path(1, 120)});
  send(1, 10, 0, 50);  // at 2 from 11 to 11.5
  send(2, 11.49, 7, 1);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kHalfDuplex);
}

TEST_F(PacketOutcomeTest, TransmissionsThatTouchAReceptionOnlyAtItsEndsDoNoHarm) {
  water.set(1, 2, {path(1, 120)});
  send(2, 10.9, 7, 10);  // until 11
  send(1, 10, 0, 50);    // at 2 from 11 to 11.5
  send(2, 11.5, 8, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kReceived);
}

TEST_F(PacketOutcomeTest, BeyondTheModemsToleranceDopplerLosesIt) {
  change_modem({2, 3}, [](acoustics::Modem& m) { m.doppler_tolerance = 0.003; });
  water.set(1, 2, {path(1, 120, 1.0031)});
  water.set(1, 3, {path(1, 120, 0.9971)});
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(end_of(1, 0, 2).kind, OutcomeKind::kDoppler);
  EXPECT_EQ(end_of(1, 0, 3).kind, OutcomeKind::kReceived);
}

TEST_F(PacketOutcomeTest, DopplerStretchesThePacketAtTheReceiver) {
  water.set(1, 2, {path(1, 120, 0.99)});
  send(1, 10, 0, 99);
  run();
  for (const MediumEvent& event : events) {
    if (std::holds_alternative<PacketOutcome>(event.what) &&
        std::get<PacketOutcome>(event.what).receiver_id == 2) {
      EXPECT_EQ(event.at, at_s(12));  // 0.99 s as sent last 1 s
    }
  }
  EXPECT_EQ(end_of(1, 0, 2).doppler_factor, 0.99);
}

TEST_F(PacketOutcomeTest, InNoiseAloneALostPacketHasBitErrors) {
  change_modem({2}, [](acoustics::Modem& m) { m.min_receivable_level = {-100}; });
  water.set(1, 2, {path(1, level_with_bit_error(0.01, noise_power()))});
  send(1, 10, 0, 1000);
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_EQ(end.kind, OutcomeKind::kBitErrors);
  EXPECT_LT(relative_error(end.statistics.success_probability, std::pow(0.99, 8000)), tolerance(1e-7));
  EXPECT_TRUE(end.statistics.colliders.empty());
}

TEST_F(PacketOutcomeTest, APreambleBelowTheNoiseIsNotAcquired) {
  change_modem({1, 2}, [](acoustics::Modem& m) {
    m.preamble = m.packet_overhead = for_s(0.1);
    m.min_receivable_level = {-100};
  });
  water.set(1, 2, {path(1, 20)});
  send(1, 10, 0, 10);
  run();
  const PacketOutcome& end = end_of(1, 0, 2);
  EXPECT_EQ(end.kind, OutcomeKind::kNotAcquired);
  EXPECT_LT(end.statistics.acquisition_probability, end.statistics.acquisition_draw);
  EXPECT_EQ(end.statistics.success_probability, 0);
}

TEST_F(PacketOutcomeTest, DirectivityLowersTheNoise) {
  change_modem({2}, [](acoustics::Modem& m) { m.directivity_index = {6}; });
  water.set(1, 2, {path(1, 100)});
  water.set(1, 3, {path(1, 100)});
  send(1, 10, 0, 10);
  run();
  EXPECT_NEAR(end_of(1, 0, 2).statistics.sinr.value - end_of(1, 0, 3).statistics.sinr.value, 6,
              tolerance(1e-9));
}

TEST_F(PacketOutcomeTest, TheDrawsAreThoseOfTheContentsNotOfTheSession) {
  water.set(1, 2, {path(1, 100)});
  send(1, 10, 3, 10);
  run();
  const auto first = end_of(1, 3, 2).statistics;
  PacketMedium again(fleet, water, {for_s(10), for_s(200)}), other(fleet, water, {for_s(10), for_s(200), 2});
  SendRequest request = request_of(1, 10, 3, 10);
  request.session = 999'999;
  EXPECT_FALSE(again.transmit(request, SimTime()));
  EXPECT_FALSE(other.transmit(request, SimTime()));
  const auto same = testing::outcomes_in(again.advance_to(at_s(110))).at(0).statistics;
  const auto seeded = testing::outcomes_in(other.advance_to(at_s(110))).at(0).statistics;
  EXPECT_EQ(same.acquisition_draw, first.acquisition_draw);
  EXPECT_EQ(same.success_draw, first.success_draw);
  EXPECT_NE(seeded.acquisition_draw, first.acquisition_draw);
  EXPECT_NE(seeded.success_draw, first.success_draw);
}

// Generators that are seeded again for each packet give each the same number.
TEST_F(PacketOutcomeTest, NoTwoPacketsReceiversOrPurposesShareADraw) {
  for (const VehicleId to : {2, 3, 4}) water.set(1, to, {path(1, 100)});
  for (int i = 0; i < 20; ++i) send(1, 10 + i, i, 10);
  run();
  std::set<double> draws;
  for (const auto& end : testing::outcomes_in(events)) {
    EXPECT_TRUE(draws.insert(end.statistics.acquisition_draw).second);
    EXPECT_TRUE(draws.insert(end.statistics.success_draw).second);
  }
  EXPECT_EQ(draws.size(), 20u * 3 * 2);
}

TEST_F(PacketOutcomeTest, TheDirectionIsThatOfTheArrivingSound) {
  auto from_above = path(1, 100);
  from_above.arrival_angle_rad = 0.25;
  water.set(1, 2, {from_above});
  send(1, 10, 0, 10);
  run();
  // 1 lies south of 2.
  EXPECT_NEAR(std::abs(end_of(1, 0, 2).arrival_azimuth_rad), std::numbers::pi, tolerance(1e-12));
  EXPECT_EQ(end_of(1, 0, 2).arrival_elevation_rad, 0.25);
}

TEST_F(PacketOutcomeTest, AReceiverAtRestIsEvaluatedOnce) {
  for (const VehicleId to : {2, 3, 4}) water.set(1, to, {path(1, 100)});
  send(1, 10, 0, 10);
  run();
  EXPECT_EQ(water.calls, 3);
}

// Sender near and far: geometry and straight paths, not a script.
TEST(NearFar, TheNearSenderIsReceivedAndTheFarOneIsNot) {
  VehicleRegistry fleet({for_s(0.05), for_s(5)}, {quick_modem(), {}});
  testing::move_steadily(fleet, 1, {100, 0, 50}, Vec3::Zero(), 0, 30);
  testing::move_steadily(fleet, 2, {0, 0, 50}, Vec3::Zero(), 0, 30);
  testing::move_steadily(fleet, 3, {3000, 0, 50}, Vec3::Zero(), 0, 30);
  StraightPropagation propagation(even_water());
  PacketMedium medium(fleet, propagation, {});
  EXPECT_FALSE(medium.transmit(request_of(3, 10, 0, 60), at_s(10)));    // at 2 from 12 to 12.6
  EXPECT_FALSE(medium.transmit(request_of(1, 11.9, 0, 20), at_s(10)));  // at 2 from 11.97 to 12.17
  std::map<VehicleId, OutcomeKind> at_two;
  for (const auto& end : testing::outcomes_in(medium.advance_to(at_s(25)))) {
    if (end.receiver_id == 2) at_two[end.packet->request.source_id] = end.kind;
  }
  EXPECT_EQ(at_two[1], OutcomeKind::kReceived);
  EXPECT_EQ(at_two[3], OutcomeKind::kCollided);
}

}  // namespace
}  // namespace halocline::channel_server
