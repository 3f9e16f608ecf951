// A mission of 100 vehicles with and without reach: what is out of reach is counted, and nothing else changes.
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::name_of;

constexpr VehicleId kVehicles = 100;
constexpr int kPackets = 400;
constexpr double kPacketsPerSecond = 6, kBoxM = 30'000;

double draw(std::uint32_t what, std::uint64_t which) {
  return uniform_at({.seed = 11, .who = what, .which = which});
}

// Carries 2 to 3 km.
VehicleModem short_modem() {
  VehicleModem modem = testing::quick_modem();
  modem.modem.source_level = Decibels{145};
  modem.modem.min_receivable_level = Decibels{-200};
  modem.modem.packet_overhead = for_s(0.2);
  modem.modem.preamble = for_s(0.1);
  return modem;
}

using Place = std::pair<PacketName, VehicleId>;

struct Mission {
  std::map<Place, PacketOutcome> outcomes;
  std::map<PacketName, std::size_t> out_of_reach, receivers;  // summed up; all
};

Mission mission_of(bool by_level, bool fades, int shards = 1) {
  const acoustics::FadingModel fading{.enabled = fades};
  const auto waters = std::make_shared<EnvironmentTimeline>(testing::even_water());
  Mission mission;
  for (int shard = 0; shard < shards; ++shard) {
    VehicleRegistry fleet({for_s(0.05), for_s(1000)}, {short_modem(), {}});
    StraightPropagation propagation(waters, fading);
    ReachModel reach(waters, propagation, {.by_level = by_level, .fading = fading});
    PacketMedium medium(
        fleet, propagation,
        {.max_lateness = for_s(10), .max_earliness = for_s(1000), .fading = fading, .shard = {shard, shards}},
        &reach);
    for (VehicleId id = 1; id <= kVehicles; ++id) {
      const auto which = static_cast<std::uint64_t>(id);
      const Vec3 start(kBoxM * draw(0, which), kBoxM * draw(1, which), 100 * draw(2, which));
      EXPECT_EQ(
          fleet.add_state(name_of(id), id,
                          testing::state_at(0, start, {4 * draw(3, which) - 2, 4 * draw(4, which) - 2, 0})),
          "");
    }
    for (int i = 0; i < kPackets; ++i) {
      const auto which = static_cast<std::uint64_t>(i);
      SendRequest request = testing::request_of(1 + static_cast<VehicleId>(kVehicles * draw(5, which)),
                                                1 + i / kPacketsPerSecond, i, 16);
      if (i % 3 == 0) request.destination_id = 1 + static_cast<VehicleId>(kVehicles * draw(6, which));
      EXPECT_FALSE(medium.transmit(request, SimTime()));
    }
    for (PacketOutcome& outcome :
         testing::outcomes_in(medium.advance_to(at_s(1 + kPackets / kPacketsPerSecond + 60)))) {
      const PacketName name = outcome.packet->name();
      mission.receivers[name] += outcome.receivers;
      if (outcome.receiver_id == 0) {
        EXPECT_EQ(outcome.kind, OutcomeKind::kOutOfReach);
        EXPECT_TRUE(mission.out_of_reach.emplace(name, outcome.receivers).second);
      } else {
        EXPECT_EQ(outcome.receivers, 1u);
        EXPECT_TRUE(mission.outcomes.emplace(Place{name, outcome.receiver_id}, std::move(outcome)).second);
      }
    }
  }
  return mission;
}

class PacketReach : public ::testing::TestWithParam<bool> {};

TEST_P(PacketReach, ChangesNoOutcomeOfThoseWithinIt) {
  const Mission all = mission_of(false, GetParam()), within = mission_of(true, GetParam());
  std::size_t lost = 0, received = 0;
  for (const auto& [place, outcome] : all.outcomes) {
    const auto same = within.outcomes.find(place);
    if (same == within.outcomes.end() || same->second.kind == OutcomeKind::kOutOfReach) {
      ++lost;
      EXPECT_NE(outcome.kind, OutcomeKind::kReceived) << outcome.budget.range_m;
      EXPECT_EQ(outcome.statistics.success_probability, 0);  // it was not acquired
      continue;
    }
    received += outcome.kind == OutcomeKind::kReceived ? 1 : 0;
    EXPECT_EQ(outcome.kind, same->second.kind);
    EXPECT_EQ(outcome.travel_time_s, same->second.travel_time_s);
    EXPECT_EQ(outcome.budget.received_level, same->second.budget.received_level);
    // What is left out takes less than 0.004 dB each off a ratio, with its fading 0.04 dB.
    EXPECT_NEAR(outcome.statistics.sinr.value, same->second.statistics.sinr.value, 0.1);
  }
  EXPECT_GT(received, 200u);
  EXPECT_GT(lost, all.outcomes.size() / 4);
}

TEST_P(PacketReach, EveryPacketHasOneOutcomeAtEveryReceiver) {
  const Mission mission = mission_of(true, GetParam());
  EXPECT_GT(mission.receivers.size(), 250u);  // a busy modem refuses
  for (const auto& [name, receivers] : mission.receivers) EXPECT_EQ(receivers, kVehicles - 1u);
}

TEST_P(PacketReach, SeveralServersCountTheSame) {
  const Mission one = mission_of(true, GetParam()), three = mission_of(true, GetParam(), 3);
  EXPECT_EQ(one.out_of_reach, three.out_of_reach);
  ASSERT_EQ(one.outcomes.size(), three.outcomes.size());
  for (const auto& [place, outcome] : one.outcomes) {
    EXPECT_EQ(outcome.kind, three.outcomes.at(place).kind);
    EXPECT_EQ(outcome.statistics.sinr, three.outcomes.at(place).statistics.sinr);
  }
}

INSTANTIATE_TEST_SUITE_P(Seas, PacketReach, ::testing::Bool(),
                         [](const auto& fades) { return fades.param ? "Fading" : "Still"; });

TEST(PacketOutOfReach, ItsDestinationHasAnOutcomeOfItsOwn) {
  const auto waters = std::make_shared<EnvironmentTimeline>(testing::even_water());
  VehicleRegistry fleet({for_s(0.05), for_s(100)}, {short_modem(), {}});
  StraightPropagation propagation(waters);
  ReachModel reach(waters, propagation, {});
  PacketMedium medium(fleet, propagation, {}, &reach);
  for (VehicleId id = 1; id <= 4; ++id)
    EXPECT_EQ(fleet.add_state(name_of(id), id, testing::state_at(0, {40'000.0 * (id - 1), 0, 50})), "");
  SendRequest request = testing::request_of(1, 1, 0);
  request.destination_id = 3;
  EXPECT_FALSE(medium.transmit(request, SimTime()));
  const auto outcomes = testing::outcomes_in(medium.advance_to(at_s(100)));
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_EQ(outcomes[0].receiver_id, 3);
  EXPECT_EQ(outcomes[0].receiver, "v3");
  EXPECT_NEAR(outcomes[0].budget.range_m, 80'000, 1e-6);
  EXPECT_EQ(outcomes[1].receiver_id, 0);
  EXPECT_EQ(outcomes[1].receivers, 2u);
  EXPECT_EQ(medium.packets_in_flight(), 0u);
}

}  // namespace
}  // namespace halocline::channel_server
