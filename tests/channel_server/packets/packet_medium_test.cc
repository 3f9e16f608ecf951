// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/packet_medium.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/names.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;
using testing::for_s;
using testing::kSpeedMps;
using testing::move_steadily;
using testing::outcomes_in;
using testing::quick_modem;
using testing::receipts_in;
using testing::request_of;
using testing::state_at;

// Instants are integer nanoseconds; a rounding of either side is one.
constexpr double kNanosecondsS = 2e-9;

class PacketMediumTest : public ::testing::Test {
 protected:
  void stay(VehicleId id, const Vec3& position, double until_s = 60) {
    move_steadily(fleet_, id, position, Vec3::Zero(), 0, until_s);
  }
  SendResult result_of(const SendRequest& request) {
    const auto at_once = medium_.transmit(request, request.start);
    if (at_once) return at_once->result;
    return receipts_in(medium_.advance_to(request.start)).at(0).result;
  }

  VehicleRegistry fleet_{{for_s(0.05), for_s(5)}, {quick_modem(), {}}};
  StraightPropagation propagation_{even_water()};
  PacketMedium medium_{fleet_, propagation_, {for_s(10), for_s(60)}};
};

TEST_F(PacketMediumTest, APacketArrivesAfterItsDelayAndEndsAfterItsDuration) {
  stay(1, {0, 0, 50});
  stay(2, {3000, 0, 50});
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0, /*bytes=*/5), at_s(10)));
  const auto receipt = receipts_in(medium_.advance_to(at_s(10))).at(0);
  EXPECT_EQ(receipt.result, SendResult::kAccepted);
  EXPECT_EQ(receipt.start, at_s(10));
  EXPECT_EQ(receipt.duration, for_s(0.05));
  const auto events = medium_.advance_to(at_s(20));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].at, at_s(10 + 3000 / kSpeedMps + 0.05));
  const auto end = outcomes_in(events).at(0);
  EXPECT_NEAR(end.travel_time_s, 2, tolerance(1e-9));
  EXPECT_EQ(end.kind, OutcomeKind::kReceived);
  EXPECT_TRUE(end.deliver);
}

TEST_F(PacketMediumTest, NextEventIsTheInstantOfTheNextChange) {
  stay(1, {0, 0, 50});
  stay(2, {3000, 0, 50});
  EXPECT_EQ(medium_.next_event(), SimTime::never());
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0, 5), at_s(9)));
  EXPECT_EQ(medium_.next_event(), at_s(10));
  medium_.advance_to(at_s(10));
  EXPECT_EQ(medium_.next_event(), at_s(12));  // the first bit: the arrival is solved again
  EXPECT_TRUE(medium_.advance_to(at_s(12)).empty());
  EXPECT_EQ(medium_.next_event(), at_s(12.05));
  EXPECT_EQ(medium_.advance_to(at_s(12.05)).size(), 1u);
  EXPECT_EQ(medium_.next_event(), SimTime::never());
}

TEST_F(PacketMediumTest, TheOverheadIsPartOfTheDuration) {
  VehicleModem slow = quick_modem();
  slow.modem.packet_overhead = for_s(1.5);
  fleet_.announce_modem("v1", at_s(0), slow, at_s(0));
  stay(1, {0, 0, 50});
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0, 10), at_s(10)));
  EXPECT_EQ(receipts_in(medium_.advance_to(at_s(10))).at(0).duration, for_s(1.6));
}

// Closed form: a receiver that starts at distance d and recedes at v is met after d / (c - v).
TEST_F(PacketMediumTest, AMovingReceiverIsMetWhereItIsByThen) {
  const double recede_mps = 20;
  stay(1, {0, 0, 50});
  move_steadily(fleet_, 2, {3000 - 10 * recede_mps, 0, 50}, {recede_mps, 0, 0}, 0, 30);
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0), at_s(10)));
  const auto end = outcomes_in(medium_.advance_to(at_s(30))).at(0);
  const double expected_s = 3000 / (kSpeedMps - recede_mps);
  EXPECT_NEAR(end.travel_time_s, expected_s, tolerance(kNanosecondsS));
  EXPECT_NEAR(end.budget.range_m, expected_s * kSpeedMps, tolerance(1e-5));
}

// The sender's way after departure does not matter; the receiver's does, also where it could not be foreseen.
TEST_F(PacketMediumTest, ATurnDuringTheTravelCounts) {
  stay(1, {0, 0, 50});
  move_steadily(fleet_, 2, {3000, 0, 50}, Vec3::Zero(), 0, 10);
  for (int tick = 1; tick <= 100; ++tick) {  // from second 10 on away from the sender at 10 m/s
    const double time_s = 10 + tick / 10.0;
    EXPECT_EQ(fleet_.add_state("v2", 2, state_at(time_s, {3000 + (time_s - 10) * 10, 0, 50}, {10, 0, 0})),
              "");
  }
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0), at_s(10)));
  const auto end = outcomes_in(medium_.advance_to(at_s(20))).at(0);
  EXPECT_NEAR(end.travel_time_s, 3000 / (kSpeedMps - 10), tolerance(kNanosecondsS));
}

TEST_F(PacketMediumTest, AReceiverThatCameCloserIsMetAtItsTrueInstant) {
  stay(1, {0, 0, 50});
  move_steadily(fleet_, 2, {3000, 0, 50}, Vec3::Zero(), 0, 10);
  for (int tick = 1; tick <= 100; ++tick) {
    const double time_s = 10 + tick / 10.0;
    EXPECT_EQ(fleet_.add_state("v2", 2, state_at(time_s, {3000 - (time_s - 10) * 10, 0, 50}, {-10, 0, 0})),
              "");
  }
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0, 5), at_s(10)));
  const auto events = medium_.advance_to(at_s(20));
  const auto end = outcomes_in(events).at(0);
  // Solved at the predicted first bit, 13 ms after the true one: then the true one counts.
  EXPECT_NEAR(end.travel_time_s, 3000 / (kSpeedMps + 10), tolerance(kNanosecondsS));
  EXPECT_EQ(events.back().at, at_s(10 + end.travel_time_s) + for_s(0.05 / end.doppler_factor));
  EXPECT_NEAR(end.doppler_factor, (kSpeedMps + 10) / kSpeedMps, tolerance(1e-12));
}

TEST_F(PacketMediumTest, EachOtherVehicleGetsExactlyOneEnd) {
  for (VehicleId id = 1; id <= 5; ++id) stay(id, {100.0 * id, 0, 50});
  EXPECT_FALSE(medium_.transmit(request_of(3, 10, 0), at_s(10)));
  std::vector<VehicleId> receivers;
  for (const auto& end : outcomes_in(medium_.advance_to(at_s(20)))) receivers.push_back(end.receiver_id);
  std::sort(receivers.begin(), receivers.end());
  EXPECT_EQ(receivers, (std::vector<VehicleId>{1, 2, 4, 5}));
}

TEST_F(PacketMediumTest, APacketForOneIsDeliveredToThatOneAndDecidedForAll) {
  for (VehicleId id = 1; id <= 3; ++id) stay(id, {100.0 * id, 0, 50});
  SendRequest request = request_of(1, 10, 0);
  request.destination_id = 3;
  EXPECT_FALSE(medium_.transmit(request, at_s(10)));
  const auto outcomes = outcomes_in(medium_.advance_to(at_s(20)));
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_FALSE(outcomes[0].deliver);
  EXPECT_EQ(outcomes[0].kind, OutcomeKind::kReceived);
  EXPECT_TRUE(outcomes[1].deliver);
}

TEST_F(PacketMediumTest, BelowTheCutoffAPacketIsLost) {
  VehicleModem insensitive = quick_modem();
  insensitive.modem.min_receivable_level = {140};
  fleet_.announce_modem("v2", at_s(0), insensitive, at_s(0));
  stay(1, {0, 0, 50});
  stay(2, {5000, 0, 50});
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0), at_s(10)));
  const auto end = outcomes_in(medium_.advance_to(at_s(20))).at(0);
  EXPECT_EQ(end.kind, OutcomeKind::kBelowCutoff);
  EXPECT_FALSE(end.deliver);
  EXPECT_EQ(end.cutoff.value, 140);
  EXPECT_LT(end.budget.received_level, end.cutoff);
}

TEST_F(PacketMediumTest, AReceiverWhoseStatesEndedIsAbsent) {
  stay(1, {0, 0, 50});
  stay(2, {9000, 0, 50}, /*until_s=*/10);  // the packet arrives at 16
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0), at_s(10)));
  const auto end = outcomes_in(medium_.advance_to(at_s(30))).at(0);
  EXPECT_EQ(end.kind, OutcomeKind::kReceiverGone);
  EXPECT_FALSE(end.deliver);
  EXPECT_NEAR(end.budget.range_m, 9000, tolerance(1e-6));
}

TEST_F(PacketMediumTest, AReceiverThatIsForgottenMidwayStillGetsItsEnd) {
  stay(1, {0, 0, 50}, 100);
  stay(2, {60000, 0, 50}, 10);
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0), at_s(10)));
  medium_.advance_to(at_s(40));
  fleet_.forget_before(at_s(30));
  ASSERT_FALSE(fleet_.id_of("v2"));
  const auto outcomes = outcomes_in(medium_.advance_to(at_s(60)));
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_EQ(outcomes[0].kind, OutcomeKind::kReceiverGone);
  EXPECT_EQ(outcomes[0].receiver, "v2");
}

TEST_F(PacketMediumTest, ATransmittingModemRefuses) {
  stay(1, {0, 0, 50});
  EXPECT_EQ(result_of(request_of(1, 10, 0, 50)), SendResult::kAccepted);  // 0.5 s
  EXPECT_EQ(result_of(request_of(1, 10.4, 1)), SendResult::kBusy);
  EXPECT_EQ(result_of(request_of(1, 10.5, 2)), SendResult::kAccepted);
}

TEST_F(PacketMediumTest, ALargePayloadIsRefused) {
  stay(1, {0, 0, 50});
  EXPECT_EQ(result_of(request_of(1, 10, 0, 65)), SendResult::kTooLarge);
  EXPECT_EQ(result_of(request_of(1, 10, 1, 64)), SendResult::kAccepted);
}

TEST_F(PacketMediumTest, ASenderNobodyHasSeenIsRefused) {
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0), at_s(10)));
  EXPECT_TRUE(medium_.advance_to(at_s(10.049)).empty());  // its first state may be on the bus yet
  EXPECT_EQ(receipts_in(medium_.advance_to(at_s(10.05))).at(0).result, SendResult::kUnknownVehicle);
}

TEST_F(PacketMediumTest, ASenderWhoseStateGrewOldIsRefused) {
  stay(1, {0, 0, 50}, /*until_s=*/4);
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0), at_s(10)));
  EXPECT_EQ(receipts_in(medium_.advance_to(at_s(10.05))).at(0).result, SendResult::kUnknownVehicle);
}

// A state counts only when it is older than the lag: without this the packet of a vehicle that has just
// appeared was lost.
TEST_F(PacketMediumTest, APacketSentWithTheFirstStateLeavesAfterTheLag) {
  ASSERT_EQ(fleet_.add_state("v1", 1, {at_s(0), {0, 0, 50}, Vec3::Zero()}), "");
  ASSERT_EQ(fleet_.add_state("v2", 2, {at_s(0), {1500, 0, 50}, Vec3::Zero()}), "");
  const SendRequest request = request_of(1, 0, 0, 5);
  EXPECT_FALSE(medium_.transmit(request, at_s(0)));
  const auto receipt = receipts_in(medium_.advance_to(at_s(0.05))).at(0);
  EXPECT_EQ(receipt.result, SendResult::kAccepted);
  EXPECT_EQ(receipt.start, at_s(0.05));
  EXPECT_EQ(medium_.transmit(request, at_s(0.2))->start, at_s(0.05));  // a repetition has the same receipt
  const auto outcome = outcomes_in(medium_.advance_to(at_s(3))).at(0);
  EXPECT_TRUE(outcome.deliver);
  EXPECT_EQ(outcome.packet->departure, at_s(0.05));
}

TEST_F(PacketMediumTest, ASenderThatGivesAnotherIdIsRefused) {
  stay(1, {0, 0, 50});
  SendRequest request = request_of(1, 10, 0);
  request.source_id = 2;
  EXPECT_EQ(result_of(request), SendResult::kWrongSource);
}

TEST_F(PacketMediumTest, ARepetitionHasTheReceiptOfItsPacketForTenMinutes) {
  stay(1, {0, 0, 50});
  const SendRequest accepted = request_of(1, 10, 0), refused = request_of(1, 10, 1);
  EXPECT_FALSE(medium_.transmit(accepted, at_s(10)));
  EXPECT_FALSE(medium_.transmit(refused, at_s(10)));
  medium_.advance_to(at_s(12));
  for (const double now_s : {15.0, 21.0, 100.0, 600.0}) {
    fleet_.forget_before(at_s(now_s - 16));
    medium_.forget_before(at_s(now_s - 11));
    EXPECT_EQ(medium_.transmit(accepted, at_s(now_s))->start, at_s(10)) << now_s;
    EXPECT_EQ(medium_.transmit(refused, at_s(now_s))->result, SendResult::kBusy) << now_s;
  }
}

TEST_F(PacketMediumTest, ARequestIsTooEarlyByTheTimeOfItsSendersNotByThatOfAMediumThatLags) {
  stay(1, {0, 0, 50});
  EXPECT_FALSE(medium_.transmit(request_of(1, 95, 0), at_s(20), at_s(95)));
  EXPECT_EQ(medium_.transmit(request_of(1, 155.1, 1), at_s(20), at_s(95))->result, SendResult::kTooEarly);
}

TEST_F(PacketMediumTest, AStartTooLongAgoOrAheadIsRefusedAtOnce) {
  stay(1, {0, 0, 50});
  EXPECT_EQ(medium_.transmit(request_of(1, 9.9, 0), at_s(20))->result, SendResult::kStale);
  EXPECT_EQ(medium_.transmit(request_of(1, 80.1, 1), at_s(20))->result, SendResult::kTooEarly);
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 2), at_s(20)));
  EXPECT_FALSE(medium_.transmit(request_of(1, 80, 3), at_s(20)));
}

TEST_F(PacketMediumTest, ARepetitionGetsTheSameReceiptAndIsNotTransmittedAgain) {
  stay(1, {0, 0, 50});
  stay(2, {3000, 0, 50});
  const SendRequest request = request_of(1, 10, 0, 5);
  EXPECT_FALSE(medium_.transmit(request, at_s(10)));
  EXPECT_FALSE(medium_.transmit(request, at_s(10)));  // undecided yet: one receipt will come
  const auto first = receipts_in(medium_.advance_to(at_s(10)));
  ASSERT_EQ(first.size(), 1u);
  const auto again = medium_.transmit(request, at_s(11));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->result, first[0].result);
  EXPECT_EQ(again->start, first[0].start);
  EXPECT_EQ(again->duration, first[0].duration);
  EXPECT_EQ(outcomes_in(medium_.advance_to(at_s(20))).size(), 1u);
}

TEST_F(PacketMediumTest, ARequestReceivedLateIsProcessedAsOfItsStart) {
  stay(1, {0, 0, 50});
  move_steadily(fleet_, 2, {3000, 0, 50}, {5, 0, 0}, 0, 30);
  PacketMedium punctual(fleet_, propagation_, {});
  EXPECT_FALSE(punctual.transmit(request_of(1, 10, 0, 5), at_s(10)));
  const auto expected = punctual.advance_to(at_s(30));
  medium_.advance_to(at_s(15));
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0, 5), at_s(15)));
  const auto late = medium_.advance_to(at_s(15));
  ASSERT_EQ(late.size(), expected.size());
  for (std::size_t i = 0; i < late.size(); ++i) {
    EXPECT_EQ(late[i].at, expected[i].at);
    EXPECT_TRUE(late[i].late);
    EXPECT_FALSE(expected[i].late);
  }
  EXPECT_EQ(outcomes_in(late)[0].travel_time_s, outcomes_in(expected)[0].travel_time_s);
  EXPECT_EQ(outcomes_in(late)[0].budget.received_level, outcomes_in(expected)[0].budget.received_level);
}

// At 2, one from 1 sounds from 12 s on, whose outcome has come at 15 s.
TEST_F(PacketMediumTest, ARequestReceivedAfterAnOutcomeThatItWouldHaveChangedConflictsWithThePast) {
  stay(1, {0, 0, 50});
  stay(2, {3000, 0, 50});
  stay(3, {6000, 0, 50});
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0, 5), at_s(10)));
  medium_.advance_to(at_s(15));
  EXPECT_FALSE(medium_.transmit(request_of(3, 10, 0, 5), at_s(15)));
  bool conflicts_with_past = false;
  for (const PacketOutcome& outcome : outcomes_in(medium_.advance_to(at_s(25))))
    conflicts_with_past = conflicts_with_past || (outcome.receiver_id == 2 && outcome.conflicts_with_past);
  EXPECT_TRUE(conflicts_with_past);
}

TEST_F(PacketMediumTest, ARequestReceivedLateThatChangesNoOutcomeDoesNotConflict) {
  stay(1, {0, 0, 50});
  stay(2, {3000, 0, 50});
  stay(3, {6000, 0, 50});
  EXPECT_FALSE(medium_.transmit(request_of(1, 10, 0, 5), at_s(10)));
  medium_.advance_to(at_s(15));
  EXPECT_FALSE(medium_.transmit(request_of(3, 14.5, 0, 5), at_s(15)));  // sounds at 2 from 16.5 s on
  for (const PacketOutcome& outcome : outcomes_in(medium_.advance_to(at_s(25))))
    EXPECT_FALSE(outcome.conflicts_with_past);
}

TEST_F(PacketMediumTest, ALateRequestDoesNotOverlapWhatWasAcceptedMeanwhile) {
  stay(1, {0, 0, 50});
  EXPECT_EQ(result_of(request_of(1, 10, 1, 5)), SendResult::kAccepted);
  EXPECT_EQ(medium_.transmit(request_of(1, 9.98, 0, 5), at_s(11)), std::nullopt);
  EXPECT_EQ(receipts_in(medium_.advance_to(at_s(11))).at(0).result, SendResult::kBusy);
}

TEST_F(PacketMediumTest, ImpossibleRulesAreRefused) {
  EXPECT_THROW(PacketMedium(fleet_, propagation_, {for_s(-1), for_s(1)}), InvalidArgument);
  EXPECT_THROW(PacketMedium(fleet_, propagation_, {for_s(1), for_s(-1)}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::channel_server
