// SPDX-License-Identifier: BSD-3-Clause
// What packets take from batteries, and what a modem does without power.
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem_power.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_power.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::for_s;

constexpr double kReceivingW = 2, kTransmitEfficiency = 0.25;

// Vehicles 1 and 2 with batteries, 3 without; 750 m from each other at most. A byte takes 0.21 s.
class PacketEnergy : public ::testing::Test {
 protected:
  PacketEnergy() {
    for (const VehicleId id : {1, 2, 3})
      testing::move_steadily(fleet_, id, Vec3(id == 1 ? 0 : 750, 10 * id, 50), Vec3::Zero(), 0, 60);
  }
  static VehicleModem modem() {
    VehicleModem modem = testing::quick_modem();
    modem.modem.packet_overhead = for_s(0.2);
    modem.when_busy = WhenBusy::kQueue;
    return modem;
  }
  void send(VehicleId from, double start_s, std::int64_t sequence, PacketKind kind = PacketKind::kData,
            std::size_t bytes = 1) {
    SendRequest request = testing::request_of(from, start_s, sequence, bytes);
    request.kind = kind;
    if (kind == PacketKind::kPing) request.destination_id = 2;
    EXPECT_FALSE(medium_.transmit(request, at_s(start_s)));
  }
  void report(VehicleId id, double at, bool is_empty) {
    fleet_.equipment().power.add_report(testing::name_of(id), at_s(at), is_empty);
  }
  void run(double until_s = 50) {
    for (const MediumEvent& event : medium_.advance_to(at_s(until_s))) events_.push_back(event);
  }
  std::vector<EnergyUse> uses() const {
    std::vector<EnergyUse> uses;
    for (const MediumEvent& event : events_) {
      if (const auto* use = std::get_if<EnergyUse>(&event.what)) uses.push_back(*use);
    }
    return uses;
  }
  OutcomeKind outcome_at(VehicleId receiver) const {
    for (const PacketOutcome& outcome : testing::outcomes_in(events_)) {
      if (outcome.receiver_id == receiver) return outcome.kind;
    }
    return OutcomeKind::kOutOfReach;
  }

  VehicleRegistry fleet_{{for_s(0.05), for_s(5)},
                         {modem(), {}},
                         {.power = VehiclePower({{"v1", 1, kTransmitEfficiency, kReceivingW},
                                                 {"v2", 2, kTransmitEfficiency, kReceivingW}},
                                                for_s(0.05))}};
  StraightPropagation propagation_{testing::even_water()};
  PacketMedium medium_{fleet_, propagation_, {for_s(10), for_s(60)}};
  std::vector<MediumEvent> events_;
};

TEST_F(PacketEnergy, ATransmissionTakesItsPowerAndAReceptionItsOwnOverTheDuration) {
  send(1, 10, 0);
  run();
  const double transmit_j = acoustics::transmit_power_w(modem().modem, kTransmitEfficiency) * 0.21;
  ASSERT_EQ(uses().size(), 2u);
  EXPECT_TRUE(uses()[0].is_transmission);
  EXPECT_EQ(uses()[0].vehicle, "v1");
  EXPECT_NEAR(uses()[0].energy_j, transmit_j, tolerance(1e-9));
  EXPECT_FALSE(uses()[1].is_transmission);
  EXPECT_EQ(uses()[1].vehicle, "v2");
  EXPECT_NEAR(uses()[1].energy_j, kReceivingW * 0.21, tolerance(1e-9));
  EXPECT_EQ(uses()[1].packet, uses()[0].packet);
  for (const PacketOutcome& outcome : testing::outcomes_in(events_)) {
    EXPECT_EQ(outcome.packet->energy_j, uses()[0].energy_j);
    EXPECT_EQ(outcome.receive_energy_j, outcome.receiver_id == 2 ? uses()[1].energy_j : 0);
  }
}

TEST_F(PacketEnergy, AnAnswerToAPingTakesEnergyToo) {
  send(1, 10, 0, PacketKind::kPing);
  run();
  int by_2 = 0;
  for (const EnergyUse& use : uses()) by_2 += use.is_transmission && use.vehicle == "v2";
  EXPECT_EQ(by_2, 1);
  EXPECT_EQ(uses().size(), 4u);  // each of the two packets is sent and received
}

TEST_F(PacketEnergy, WithoutABatteryNothingIsCounted) {
  send(3, 10, 0);
  run();
  ASSERT_EQ(uses().size(), 2u);
  for (const EnergyUse& use : uses()) EXPECT_FALSE(use.is_transmission);
  EXPECT_EQ(testing::outcomes_in(events_).front().packet->energy_j, 0);
}

TEST_F(PacketEnergy, AnEmptyBatteryRefusesFromALagLaterOn) {
  report(1, 10, true);
  send(1, 10.04, 0);
  send(1, 11, 1);
  report(1, 20, false);
  send(1, 21, 2);
  run();
  const auto receipts = testing::receipts_in(events_);
  ASSERT_EQ(receipts.size(), 3u);
  EXPECT_EQ(receipts[0].result, SendResult::kAccepted);
  EXPECT_EQ(receipts[1].result, SendResult::kNoModem);
  EXPECT_EQ(receipts[2].result, SendResult::kAccepted);
}

TEST_F(PacketEnergy, WhatReachesAVehicleWithoutPowerIsLostForThat) {
  report(2, 5, true);
  send(1, 10, 0);
  run();
  EXPECT_EQ(outcome_at(2), OutcomeKind::kNoPower);
  EXPECT_EQ(outcome_at(3), OutcomeKind::kReceived);
  EXPECT_EQ(uses().size(), 1u);
}

TEST_F(PacketEnergy, PowerThatGoesDuringAPacketLosesIt) {
  send(1, 10, 0);         // at vehicle 2 from 10.5 to 10.71
  report(2, 10.6, true);  // without power from 10.65 on
  run();
  EXPECT_EQ(outcome_at(2), OutcomeKind::kNoPower);
  EXPECT_EQ(uses().size(), 2u);  // it followed the packet
}

TEST_F(PacketEnergy, WithoutPowerAPingIsNotAnsweredAndAQueueIsNotSent) {
  report(2, 10.75, true);  // after the ping, before its answer at 10.81
  send(1, 10, 0, PacketKind::kPing);
  send(1, 20, 1, PacketKind::kData, 64);  // until 20.84
  send(1, 20.1, 2);                       // waits
  report(1, 20.5, true);
  run();
  for (const PacketOutcome& outcome : testing::outcomes_in(events_)) {
    EXPECT_NE(outcome.packet->request.kind, PacketKind::kPingReply);
    EXPECT_NE(outcome.packet->request.packet_sequence, 2);
  }
  EXPECT_EQ(testing::receipts_in(events_)[2].result, SendResult::kQueued);
}

TEST(VehiclePower, TheOrderOfReportsAndWhatIsForgottenDoNotMatter) {
  VehiclePower forth({{"auv", 7, 0.5, 1}}, for_s(0.05)), back({{"auv", 7, 0.5, 1}}, for_s(0.05));
  for (int i = 0; i < 10; ++i) {
    forth.add_report("auv", at_s(i), i >= 4 && i < 7);
    back.add_report("auv", at_s(9 - i), 9 - i >= 4 && 9 - i < 7);
  }
  back.forget_before(at_s(3.5));
  for (double t = 3.5; t < 10; t += 0.25) {
    EXPECT_EQ(forth.has_power(7, at_s(t)), back.has_power(7, at_s(t)));
    EXPECT_EQ(forth.has_power(7, at_s(t)), t < 4.05 || t >= 7.05) << t;
  }
  EXPECT_TRUE(forth.has_power(8, at_s(5)));
}

}  // namespace
}  // namespace halocline::channel_server
