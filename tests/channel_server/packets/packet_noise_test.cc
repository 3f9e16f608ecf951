// SPDX-License-Identifier: BSD-3-Clause
// The noise of vehicles, and that which varies, in the receptions of packets.
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/sea/noise.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/packets/platform_noise.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using acoustics::NoiseSpectrum;
using halocline::testing::tolerance;
using testing::at_s;
using testing::for_s;

// 1 sends to 2, 750 m away; 3 is a ship without a modem, 300 m beside 2.
struct Sea {
  explicit Sea(std::vector<NoiseSource> noise, acoustics::NoiseVariation variation = {},
               Decibels receiver_loss = {})
      : fleet({for_s(0.05), for_s(5)}, modems(receiver_loss),
              {.noise = VehicleNoise(std::move(noise), for_s(0.05))}),
        propagation(testing::even_water()),
        medium(fleet, propagation, {.noise = variation}) {
    testing::move_steadily(fleet, 1, Vec3(0, 0, 50), Vec3::Zero(), 0, 60);
    testing::move_steadily(fleet, 2, Vec3(750, 0, 50), Vec3::Zero(), 0, 60);
    testing::move_steadily(fleet, 3, Vec3(750, 300, 5), Vec3(2, 0, 0), 0, 60);
  }
  static ConfiguredModems modems(Decibels receiver_loss) {
    ConfiguredModems modems{testing::quick_modem(), {}};
    modems.standard.modem.receiver_loss = receiver_loss;
    VehicleModem none = testing::quick_modem();
    none.fitted = false;
    modems.of_vehicle.emplace("v3", none);
    return modems;
  }
  void turn(VehicleId id, double turns_per_s) {
    for (int i = 0; i < 300; ++i)
      fleet.equipment().noise.add_rate(testing::name_of(id), at_s(i / 5.0), turns_per_s);
  }
  PacketOutcome send(double start_s = 10) {
    EXPECT_FALSE(medium.transmit(testing::request_of(1, start_s, 0, 8), at_s(start_s)));
    const auto outcomes = testing::outcomes_in(medium.advance_to(at_s(start_s + 5)));
    EXPECT_EQ(outcomes.size(), 1u);  // none at the ship
    return outcomes.front();
  }

  VehicleRegistry fleet;
  StraightPropagation propagation;
  PacketMedium medium;
};

NoiseSource propeller_of(VehicleId id, double level_db) {
  return {testing::name_of(id),    id, NoiseSpectrum({1e3}, {level_db}),
          NoiseDriver::kPropeller, 20, Decibels{10}};
}

NoiseSource ship(double level_db, NoiseDriver driver = NoiseDriver::kNone, double reference_mps = 2) {
  return {"v3", 3, NoiseSpectrum({1e3}, {level_db}), driver, reference_mps, Decibels{20}};
}

double power_of(Decibels level) { return to_power_ratio(level).value; }

double ambient_power() {
  const auto band = testing::quick_modem().modem.band();
  return acoustics::noise_power_over_band(band.low_hz, band.high_hz, testing::even_water().noise).value;
}

// 5 kHz of 60 dB re 1 uPa^2/Hz at 1 m, 10 dB less at the hydrophone: 10 log10(5000) + 50 dB.
TEST(OwnNoise, AStoppedPropellerGainsExactlyTheStatedDifference) {
  Sea turning({propeller_of(2, 60)}), stopped({propeller_of(2, 60)});
  turning.turn(2, 20);
  stopped.turn(2, 0);
  const PacketOutcome loud = turning.send(), quiet = stopped.send();
  const double own = 5000 * 1e5;
  EXPECT_NEAR(power_of(loud.budget.noise_level) / (ambient_power() + own), 1, tolerance(1e-12));
  EXPECT_NEAR(power_of(quiet.budget.noise_level) / ambient_power(), 1, tolerance(1e-12));
  const double stated_db = 10 * std::log10((ambient_power() + own) / ambient_power());
  EXPECT_GT(stated_db, 10);
  EXPECT_NEAR((loud.budget.noise_level - quiet.budget.noise_level).value, stated_db, tolerance(1e-9));
  EXPECT_NEAR((quiet.budget.snr - loud.budget.snr).value, stated_db, tolerance(1e-9));
}

TEST(OwnNoise, GrowsBy60DecibelsADecadeOfSpeed) {
  const NoiseSource noise = propeller_of(2, 60);
  const double at_reference = noise_power_at_1m(noise, 20, 2e4, 3e4);
  EXPECT_NEAR(10 * std::log10(noise_power_at_1m(noise, 40, 2e4, 3e4) / at_reference), 60 * std::log10(2),
              tolerance(1e-9));
  EXPECT_NEAR(noise_power_at_1m(noise, -20, 2e4, 3e4), at_reference, tolerance(1e-3));
  EXPECT_EQ(noise_power_at_1m(noise, 0, 2e4, 3e4), 0);
}

TEST(OwnNoise, MayBeHeardByTheVehicleAlone) {
  NoiseSource of_sender = propeller_of(1, 120), of_receiver = propeller_of(2, 60);
  of_sender.is_heard_by_others = of_receiver.is_heard_by_others = false;
  Sea sea({of_sender, of_receiver});
  sea.turn(1, 20);
  sea.turn(2, 20);
  EXPECT_NEAR(power_of(sea.send().budget.noise_level) / (ambient_power() + 5000 * 1e5), 1, tolerance(1e-12));
}

TEST(AmbientNoise, RisesByNight) {
  const acoustics::NoiseVariation reef{.day_night_db = 4, .noon_s = -12 * 3600};
  const double level_db = Sea({}, reef).send().budget.noise_level.value;
  EXPECT_NEAR(level_db - to_decibels({ambient_power()}).value, 4, 1e-6);
}

TEST(OwnNoise, IsThatOfTheLatestTurnRateKnownALagBefore) {
  VehicleNoise noise({propeller_of(2, 60)}, for_s(0.05));
  noise.add_rate("v2", at_s(10), 20);
  noise.add_rate("v2", at_s(12), -30);
  noise.add_rate("v9", at_s(12), 99);
  EXPECT_EQ(noise.rate_at(2, at_s(9), at_s(20)), 0);
  EXPECT_EQ(noise.rate_at(2, at_s(11), at_s(11)), 20);
  EXPECT_EQ(noise.rate_at(2, at_s(12), at_s(12.04)), 20);
  EXPECT_EQ(noise.rate_at(2, at_s(12), at_s(12.05)), 30);
  noise.forget_before(at_s(12.5));
  EXPECT_EQ(noise.rate_at(2, at_s(12.5), at_s(13)), 30);
}

TEST(OwnNoise, OfTheSenderIsHeardByTheReceiver) {
  Sea turning({propeller_of(1, 120)});
  turning.turn(1, 20);
  const PacketOutcome outcome = turning.send();
  ASSERT_EQ(outcome.statistics.colliders.size(), 1u);
  EXPECT_EQ(outcome.statistics.colliders[0].source_id, 1);
  EXPECT_TRUE(outcome.statistics.colliders[0].is_noise);
}

// Over the same way as the packet, from the same place: the noise arrives with the packet's own transmission
// loss.
TEST(ShipNoise, ComesWithTheTransmissionLossOfItsLink) {
  Sea with_noise({propeller_of(1, 120)});
  with_noise.turn(1, 20);
  const PacketOutcome outcome = with_noise.send();
  const double sent_db = 120 + 10 * std::log10(5000.0);
  EXPECT_NEAR(outcome.statistics.interference.value, sent_db - outcome.budget.transmission_loss.value,
              tolerance(1e-6));
}

// Tables add it to the noise N of SINR = S / (N 10^(loss / 10)), and packets do alike.
TEST(ShipNoise, MeetsTheReceiversLossAsTheSeasNoiseDoes) {
  Sea with_noise({propeller_of(1, 80)}, {}, Decibels{3});
  with_noise.turn(1, 20);
  const PacketOutcome outcome = with_noise.send();
  const double level_db = 80 + 10 * std::log10(5000.0) - outcome.budget.transmission_loss.value;
  const Decibels noise = to_decibels({ambient_power() + power_of(Decibels{level_db})});
  EXPECT_GT(power_of(Decibels{level_db}), ambient_power());
  EXPECT_NEAR(outcome.statistics.sinr.value, (outcome.budget.received_level - noise).value - 3,
              tolerance(1e-6));
}

TEST(ShipNoise, AJammerLosesThePacketAndIsNamed) {
  const PacketOutcome lost = Sea({ship(150)}).send();
  EXPECT_EQ(lost.kind, OutcomeKind::kCollided);
  ASSERT_EQ(lost.statistics.colliders.size(), 1u);
  EXPECT_EQ(lost.statistics.colliders[0].source_id, 3);
  EXPECT_TRUE(lost.statistics.colliders[0].is_noise);
  EXPECT_EQ(Sea({ship(60)}).send().kind, OutcomeKind::kReceived);
}

// The ship makes 2 m/s over ground: at its reference, and at half of it.
TEST(ShipNoise, FollowsItsSpeedOverGround) {
  const double at_reference = Sea({ship(110, NoiseDriver::kSpeed, 2)}).send().statistics.interference.value;
  const double at_half = Sea({ship(110, NoiseDriver::kSpeed, 4)}).send().statistics.interference.value;
  EXPECT_NEAR(at_reference - at_half, 60 * std::log10(2), tolerance(1e-9));
}

// Of three parts, each by its formula.
TEST(ShipNoise, InTablesAddsItsMeanToTheAmbientAndTheOwn) {
  Sea sea({propeller_of(2, 60), ship(110)});
  sea.turn(2, 20);
  PlatformNoise sounds(sea.fleet, sea.propagation, nullptr, {}, {}, 1);
  ASSERT_TRUE(sounds.differ());
  const acoustics::Modem& modem = testing::quick_modem().modem;
  const auto here = sea.fleet.placement(2, at_s(10), at_s(10));
  ASSERT_TRUE(here);
  const NoiseQuery query{
      {2, here->position_ned_m, here->velocity_ned_mps, &modem}, modem.band(), at_s(10), at_s(10)};
  EXPECT_TRUE(sounds.is_ready(query));
  // The ship is 303 m away and makes 2 m/s across that line: by the time that sound takes, 0.2 s, its range
  // changes by 3 mm.
  acoustics::Modem noise = modem;
  noise.source_level = Decibels{110 + 10 * std::log10(5000.0)};
  const double loss_db =
      sea.propagation.reception(at_s(10), {3, Vec3(770, 300, 5), Vec3::Zero(), &noise}, query.receiver)
          .budget.transmission_loss.value;
  const double by_parts =
      ambient_power() + 5000 * 1e5 + power_of(Decibels{noise.source_level.value - loss_db});
  EXPECT_NEAR((sounds.mean_level(query) - to_decibels({by_parts})).value, 0, tolerance(0.02));
  EXPECT_GT(by_parts, 1.5 * (ambient_power() + 5000 * 1e5));
}

TEST(ShipNoise, BeyondItsReachIsNotHeard) {
  Sea sea({ship(110)});
  ReachModel reach(std::make_shared<EnvironmentTimeline>(testing::even_water()), sea.propagation, {});
  PacketMedium near(sea.fleet, sea.propagation, {}, &reach);
  testing::move_steadily(sea.fleet, 4, Vec3(20'000, 0, 50), Vec3::Zero(), 0, 60);
  EXPECT_FALSE(near.transmit(testing::request_of(1, 10, 0, 8), at_s(10)));
  for (const PacketOutcome& outcome : testing::outcomes_in(near.advance_to(at_s(40))))
    EXPECT_EQ(outcome.statistics.colliders.size(), outcome.receiver_id == 2 ? 1u : 0u) << outcome.receiver_id;
}

TEST(ShipNoise, AVehicleWithoutAModemSendsNothing) {
  Sea sea({ship(60)});
  EXPECT_FALSE(sea.medium.transmit(testing::request_of(3, 10, 0, 8), at_s(10)));
  const auto receipts = testing::receipts_in(sea.medium.advance_to(at_s(15)));
  ASSERT_EQ(receipts.size(), 1u);
  EXPECT_EQ(receipts[0].result, SendResult::kNoModem);
}

TEST(VaryingNoise, MovesTheLevelByItsOffset) {
  const acoustics::NoiseVariation variation{.spread_db = 3};
  const PacketOutcome outcome = Sea({}, variation).send();
  const SimTime arrival = at_s(10 + 750 / testing::kSpeedMps);
  EXPECT_NEAR((outcome.budget.noise_level - to_decibels({ambient_power()})).value,
              noise_offset(variation, 1, arrival).value, tolerance(1e-9));
}

// Gaussian at the noise's own level: as much again, as interference.
TEST(VaryingNoise, ImpulsesOfExponentTwoAreSteadyNoise) {
  const PacketOutcome outcome =
      Sea({}, {.burst_exponent = 2, .burst_level = Decibels{0}, .burst = for_s(0.03)}).send();
  EXPECT_NEAR(power_of(outcome.statistics.interference) / ambient_power(), 1, tolerance(1e-9));
  EXPECT_TRUE(outcome.statistics.colliders.empty());
  EXPECT_NEAR(outcome.statistics.sinr.value, outcome.budget.snr.value - 10 * std::log10(2.0),
              tolerance(1e-9));
}

TEST(VaryingNoise, ALoudImpulseSpoilsBitsAndIsNoCollision) {
  const PacketOutcome outcome =
      Sea({}, {.burst_exponent = 1.5, .burst_level = Decibels{80}, .burst = for_s(0.01)}).send();
  EXPECT_EQ(outcome.kind, OutcomeKind::kBitErrors);
}

}  // namespace
}  // namespace halocline::channel_server
