// SPDX-License-Identifier: BSD-3-Clause
// Modems that queue, and modems that answer pings.
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/names.h"
#include "core/sim_time.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;
using testing::for_s;
using testing::kSpeedMps;
using testing::path;
using testing::quick_modem;
using testing::receipts_in;
using testing::request_of;

class QueueTest : public testing::ScriptedWater {
 protected:
  QueueTest() {
    VehicleModem queueing = big_modem();
    queueing.when_busy = WhenBusy::kQueue;
    fleet.announce_modem("v1", at_s(0), queueing, at_s(0));
    water.set(1, 2, {path(1, 120)});
  }
  Receipt receipt_of(std::int64_t sequence) {
    for (const Receipt& receipt : receipts_in(events)) {
      if (receipt.packet_sequence == sequence) return receipt;
    }
    throw std::runtime_error("no receipt of packet " + std::to_string(sequence));
  }
};

TEST_F(QueueTest, ABusyModemSendsOneAfterTheOther) {
  send(1, 10, 0, 100);   // until 11
  send(1, 10.5, 1, 50);  // from 11 to 11.5
  send(1, 10.6, 2, 30);  // from 11.5 to 11.8
  run();
  EXPECT_EQ(receipt_of(0).result, SendResult::kAccepted);
  EXPECT_EQ(receipt_of(1).result, SendResult::kQueued);
  EXPECT_EQ(receipt_of(1).start, at_s(11));
  EXPECT_EQ(receipt_of(1).duration, for_s(0.5));
  EXPECT_EQ(receipt_of(2).start, at_s(11.5));
  for (int sequence = 0; sequence < 3; ++sequence) {
    EXPECT_EQ(end_of(1, sequence, 2).kind, OutcomeKind::kReceived);
  }
  EXPECT_EQ(end_of(1, 2, 2).packet->departure, at_s(11.5));
}

TEST_F(QueueTest, TheReceiptComesAtOnceAndStaysTheSame) {
  send(1, 10, 0, 100);
  send(1, 10.5, 1, 50);
  run(10.5);
  EXPECT_EQ(receipt_of(1).result, SendResult::kQueued);
  const auto again = medium.transmit(request_of(1, 10.5, 1, 50), at_s(10.6));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->result, SendResult::kQueued);
  EXPECT_EQ(again->start, at_s(11));
  run();
  EXPECT_EQ(testing::outcomes_in(events).size(), 2u * 3);
}

TEST_F(QueueTest, AFreeModemSendsAtTheStartRequested) {
  send(1, 10, 0, 100);
  send(1, 11.2, 1, 50);
  run();
  EXPECT_EQ(receipt_of(1).result, SendResult::kAccepted);
  EXPECT_EQ(receipt_of(1).start, at_s(11.2));
}

TEST_F(QueueTest, SixteenWaitAndTheNextIsRefused) {
  for (int sequence = 0; sequence < 20; ++sequence) send(1, 10 + 0.01 * sequence, sequence, 100);
  run(10.5);
  std::map<SendResult, int> results;
  for (const Receipt& receipt : receipts_in(events)) ++results[receipt.result];
  EXPECT_EQ(results[SendResult::kAccepted], 1);
  EXPECT_EQ(results[SendResult::kQueued], 16);
  EXPECT_EQ(results[SendResult::kQueueFull], 3);
  send(1, 11.5, 30, 100);  // the second is on the air: there is room again
  run();
  EXPECT_EQ(receipt_of(30).result, SendResult::kQueued);
  EXPECT_EQ(receipt_of(30).start, at_s(27));
}

TEST_F(QueueTest, AQueuedPacketLeavesFromWhereTheVehicleIsByThen) {
  testing::move_steadily(fleet, 7, {0, 0, 50}, {10, 0, 0}, 0, 60);
  VehicleModem queueing = big_modem();
  queueing.when_busy = WhenBusy::kQueue;
  fleet.announce_modem("v7", at_s(0), queueing, at_s(0));
  send(7, 10, 0, 500);
  send(7, 11, 1, 100);  // from 15 on
  run();
  EXPECT_NEAR(end_of(7, 1, 2).packet->departure_ned_m.x(), 150, tolerance(1e-9));
}

class PingTest : public ::testing::Test {
 protected:
  PingTest() {
    for (VehicleId id = 1; id <= 3; ++id) {
      testing::move_steadily(fleet_, id, place_of(id), Vec3::Zero(), 0, 60);
    }
  }
  static Vec3 place_of(VehicleId id) { return {800.0 * id, 300.0 * id * id, 40.0 * id}; }
  void ping(VehicleId from, VehicleId to, double start_s, std::int64_t sequence) {
    SendRequest request = request_of(from, start_s, sequence, 0);
    request.kind = PacketKind::kPing;
    request.destination_id = to;
    EXPECT_FALSE(medium_.transmit(request, SimTime()));
  }
  void send(VehicleId from, double start_s, std::int64_t sequence, std::size_t bytes) {
    EXPECT_FALSE(medium_.transmit(request_of(from, start_s, sequence, bytes), SimTime()));
  }
  std::vector<PacketOutcome> run() {
    events_ = medium_.advance_to(at_s(40));
    return testing::outcomes_in(events_);
  }
  static VehicleModem modem() {
    VehicleModem modem = quick_modem();
    modem.modem.packet_overhead = for_s(0.2);
    return modem;
  }

  VehicleRegistry fleet_{{for_s(0.05), for_s(5)}, {modem(), {}}};
  StraightPropagation propagation_{even_water()};
  PacketMedium medium_{fleet_, propagation_, {for_s(10), for_s(60)}};
  std::vector<MediumEvent> events_;
};

std::vector<PacketOutcome> replies_in(const std::vector<PacketOutcome>& outcomes) {
  std::vector<PacketOutcome> replies;
  for (const PacketOutcome& outcome : outcomes) {
    if (outcome.packet->request.kind == PacketKind::kPingReply) replies.push_back(outcome);
  }
  return replies;
}

TEST_F(PingTest, BetweenStillVehiclesTheTwoWayTimeIsTwiceTheRangeOverTheSpeed) {
  ping(1, 2, 10, 5);
  const auto replies = replies_in(run());
  ASSERT_EQ(replies.size(), 2u);  // at 1, and overheard at 3
  const double range_m = (place_of(2) - place_of(1)).norm();
  for (const PacketOutcome& reply : replies) {
    EXPECT_EQ(reply.deliver, reply.receiver_id == 1);
    EXPECT_EQ(reply.packet->request.source_id, 2);
    EXPECT_EQ(reply.packet->request.packet_sequence, 5);
    EXPECT_EQ(reply.packet->request.session, 7);
    if (!reply.deliver) continue;
    // Three roundings to a nanosecond.
    EXPECT_NEAR(reply.two_way_travel_time_s, 2 * range_m / kSpeedMps, tolerance(3e-9));
  }
}

TEST_F(PingTest, TheAnswerLeavesATurnaroundAfterThePing) {
  ping(1, 2, 10, 5);
  const auto replies = replies_in(run());
  ASSERT_FALSE(replies.empty());
  const double one_way_s = (place_of(2) - place_of(1)).norm() / kSpeedMps;
  EXPECT_NEAR(replies[0].packet->departure.seconds(), 10 + one_way_s + 0.2 + kReplyTurnaround.seconds(),
              tolerance(2e-9));
}

TEST_F(PingTest, ABusyModemDoesNotAnswer) {
  const double received_s = 10 + (place_of(2) - place_of(1)).norm() / kSpeedMps + 0.2;
  ping(1, 2, 10, 5);
  send(2, received_s + 0.01, 0, 30);  // 0.5 s: on the air when the answer is due
  const auto outcomes = run();
  EXPECT_TRUE(replies_in(outcomes).empty());
  EXPECT_EQ(receipts_in(events_).size(), 2u);
}

TEST_F(PingTest, AnAnswerKeepsItsModemBusyAndGivesNoReceipt) {
  const double answers_s = 10 + (place_of(2) - place_of(1)).norm() / kSpeedMps + 0.2 + 0.1;
  ping(1, 2, 10, 5);
  send(2, answers_s + 0.05, 0, 1);
  EXPECT_EQ(replies_in(run()).size(), 2u);
  ASSERT_EQ(receipts_in(events_).size(), 2u);
  EXPECT_EQ(receipts_in(events_)[1].result, SendResult::kBusy);
}

TEST_F(PingTest, OnlyTheAddresseeAnswersAndOnlyAPing) {
  ping(1, 3, 10, 5);
  send(1, 20, 6, 5);
  for (const PacketOutcome& reply : replies_in(run())) EXPECT_EQ(reply.packet->request.source_id, 3);
}

TEST_F(PingTest, APingThatWasLostIsNotAnswered) {
  VehicleModem insensitive = modem();
  insensitive.modem.min_receivable_level = {200};
  fleet_.announce_modem("v2", at_s(0), insensitive, at_s(0));
  ping(1, 2, 10, 5);
  EXPECT_TRUE(replies_in(run()).empty());
}

// Transponders 11 to 14 at four ranges of vehicle 1; 2 and 3 are none.
class TransponderTest : public PingTest {
 protected:
  static constexpr double kRangesM[] = {1000, 1060, 1130, 2000};

  TransponderTest() {
    for (VehicleId id = 11; id <= 14; ++id) {
      const double angle = id;
      testing::move_steadily(fleet_, id,
                             place_of(1) + range_m(id) * Vec3(std::cos(angle), std::sin(angle), 0),
                             Vec3::Zero(), 0, 60);
      fleet_.equipment().transponders.insert(id);
    }
  }
  static double range_m(VehicleId id) { return kRangesM[id - 11]; }
  std::vector<PacketOutcome> answers_at(VehicleId receiver, VehicleId asked) {
    ping(receiver, asked, 10, 5);
    std::vector<PacketOutcome> answers = replies_in(run());
    std::erase_if(answers, [&](const PacketOutcome& answer) { return answer.receiver_id != receiver; });
    return answers;
  }
};

// Each answer takes 0.2 s: the second begins 0.08 s after the first, the third 0.09 s after that.
TEST_F(TransponderTest, OnePingToAllIsAnsweredByEachTransponderAndNoAnswerHidesAnother) {
  const auto answers = answers_at(1, kBroadcastId);
  ASSERT_EQ(answers.size(), 4u);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto source = static_cast<VehicleId>(11 + i);
    EXPECT_EQ(answers[i].packet->request.source_id, source);
    EXPECT_EQ(answers[i].kind, OutcomeKind::kReceived) << source;
    EXPECT_TRUE(answers[i].deliver);
    EXPECT_TRUE(answers[i].statistics.colliders.empty());
    // Three roundings to a nanosecond.
    EXPECT_NEAR(answers[i].two_way_travel_time_s, 2 * range_m(source) / kSpeedMps, tolerance(3e-9));
  }
}

TEST_F(TransponderTest, AnotherPacketHidesAnAnswerAsItHidesAny) {
  const double answer_s = 10 + 2 * range_m(11) / kSpeedMps + 0.3;
  const double way_s = (place_of(2) - place_of(1)).norm() / kSpeedMps;
  send(2, answer_s - way_s - 0.21, 0, 30);  // 0.5 s, acquired just before the first answer begins
  const auto answers = answers_at(1, kBroadcastId);
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[0].kind, OutcomeKind::kCollided);
  EXPECT_EQ(answers[3].kind, OutcomeKind::kReceived);
}

TEST_F(TransponderTest, APingToOneIsAnsweredByThatOneAlone) {
  const auto answers = answers_at(1, 3);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].packet->request.source_id, 3);
}

// Both keep no session and count alike; the answers are two packets all the same.
TEST_F(PingTest, AnswersToTwoSendersWithoutSessionsAreDistinguished) {
  for (const VehicleId from : {1, 3}) {
    SendRequest request = request_of(from, from == 1 ? 10 : 20, 5, 0);
    request.session = 0;
    request.kind = PacketKind::kPing;
    request.destination_id = 2;
    EXPECT_FALSE(medium_.transmit(request, SimTime()));
  }
  std::set<PacketName> names;
  for (const PacketOutcome& reply : replies_in(run())) names.insert(reply.packet->name());
  EXPECT_EQ(names.size(), 2u);
}

}  // namespace
}  // namespace halocline::channel_server
