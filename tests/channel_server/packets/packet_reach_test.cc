// SPDX-License-Identifier: BSD-3-Clause
// Missions of 100 vehicles, and of 30 in an ocean's field, with and without reach: what is out of reach is
// counted, and nothing else changes.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/warming_sea.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::name_of;

struct ReachSea {
  bool fades = false;
  bool has_field = false;
  VehicleId vehicles() const { return has_field ? 30 : 100; }
  int packets() const { return has_field ? 30 : 400; }
  double packets_per_s() const { return has_field ? 1 : 6; }
  double box_m() const { return has_field ? 5000 : 30'000; }
  double deepest_m() const { return has_field ? 110 : 100; }
};

double draw(std::uint32_t what, std::uint64_t which) {
  return uniform_at({.seed = 11, .who = what, .which = which});
}

// Carries 2 to 3 km; at 100 kHz, in the smaller box, 1 km.
VehicleModem short_modem(bool is_high = false) {
  VehicleModem modem = testing::quick_modem();
  modem.modem.source_level = Decibels{is_high ? 160.0 : 145.0};
  if (is_high) modem.modem.centre_frequency_hz = 100'000;
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

// Along rays through a field, over a level bottom at 120 m that everybody knows.
class RaysThroughField : public Propagation {
 public:
  RaysThroughField(const std::shared_ptr<const EnvironmentTimeline>& waters,
                   const acoustics::FadingModel& fading)
      : rays_(waters, std::make_shared<SeabedMap>(SeabedRule{}), model_of(fading)) {}

  Reception reception(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return rays_.reception_over(at, from, to, bottom_);
  }
  std::optional<acoustics::LeastLoss> least_loss(SimTime at, double frequency_hz,
                                                 double deepest_end_m) const override {
    return rays_.least_loss(at, frequency_hz, deepest_end_m);
  }
  const acoustics::Environment& environment(SimTime at) const override { return rays_.environment(at); }

 private:
  static RayModel model_of(const acoustics::FadingModel& fading) {
    RayModel model;
    model.speed_tolerance_mps = 0.02;
    model.fading = fading;
    return model;
  }

  RayPropagation rays_;
  std::shared_ptr<const SeabedProfile> bottom_ =
      std::make_shared<const SeabedProfile>(SeabedProfile::flat(120));
};

std::unique_ptr<Propagation> propagation_of(const ReachSea& sea,
                                            const std::shared_ptr<const EnvironmentTimeline>& waters) {
  const acoustics::FadingModel fading{.enabled = sea.fades};
  if (sea.has_field) return std::make_unique<RaysThroughField>(waters, fading);
  return std::make_unique<StraightPropagation>(waters, fading);
}

Mission mission_of(const ReachSea& sea, bool by_level, int shards = 1) {
  const acoustics::FadingModel fading{.enabled = sea.fades};
  const auto waters = std::make_shared<EnvironmentTimeline>(sea.has_field ? testing::warming_sea(2, 0.8)
                                                                          : testing::even_water());
  Mission mission;
  for (int shard = 0; shard < shards; ++shard) {
    VehicleRegistry fleet({for_s(0.05), for_s(1000)}, {short_modem(sea.has_field), {}});
    const auto propagation = propagation_of(sea, waters);
    ReachModel reach(waters, *propagation, {.by_level = by_level, .fading = fading});
    PacketMedium medium(
        fleet, *propagation,
        {.max_lateness = for_s(10), .max_earliness = for_s(1000), .fading = fading, .shard = {shard, shards}},
        &reach);
    for (VehicleId id = 1; id <= sea.vehicles(); ++id) {
      const auto which = static_cast<std::uint64_t>(id);
      const Vec3 start(sea.box_m() * (draw(0, which) - 0.5), sea.box_m() * (draw(1, which) - 0.5),
                       sea.deepest_m() * draw(2, which));
      fleet.reserve(name_of(id), id);
      EXPECT_EQ(
          fleet.add_state(name_of(id), id,
                          testing::state_at(0, start, {4 * draw(3, which) - 2, 4 * draw(4, which) - 2, 0})),
          "");
    }
    for (int i = 0; i < sea.packets(); ++i) {
      const auto which = static_cast<std::uint64_t>(i);
      SendRequest request = testing::request_of(1 + static_cast<VehicleId>(sea.vehicles() * draw(5, which)),
                                                1 + i / sea.packets_per_s(), i, 16);
      if (i % 3 == 0) request.destination_id = 1 + static_cast<VehicleId>(sea.vehicles() * draw(6, which));
      EXPECT_FALSE(medium.transmit(request, SimTime()));
    }
    for (PacketOutcome& outcome :
         testing::outcomes_in(medium.advance_to(at_s(1 + sea.packets() / sea.packets_per_s() + 60)))) {
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

class PacketReach : public ::testing::TestWithParam<ReachSea> {};

void expect_no_other_outcome(const ReachSea& sea, std::size_t least_received) {
  const Mission all = mission_of(sea, false), within = mission_of(sea, true);
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
  EXPECT_GT(received, least_received);
  EXPECT_GT(lost, all.outcomes.size() / 4);
}

TEST_P(PacketReach, ChangesNoOutcomeOfThoseWithinIt) { expect_no_other_outcome(GetParam(), 200); }

TEST(PacketReachInAField, ChangesNoOutcomeOfThoseWithinIt) {
  expect_no_other_outcome({.fades = true, .has_field = true}, 8);
}

TEST_P(PacketReach, EveryPacketHasOneOutcomeAtEveryReceiver) {
  const Mission mission = mission_of(GetParam(), true);
  EXPECT_GT(mission.receivers.size(), 250u);  // a busy modem refuses
  for (const auto& [name, receivers] : mission.receivers) EXPECT_EQ(receivers, GetParam().vehicles() - 1u);
}

TEST_P(PacketReach, SeveralServersCountTheSame) {
  const Mission one = mission_of(GetParam(), true), three = mission_of(GetParam(), true, 3);
  EXPECT_EQ(one.out_of_reach, three.out_of_reach);
  ASSERT_EQ(one.outcomes.size(), three.outcomes.size());
  for (const auto& [place, outcome] : one.outcomes) {
    EXPECT_EQ(outcome.kind, three.outcomes.at(place).kind);
    EXPECT_EQ(outcome.statistics.sinr, three.outcomes.at(place).statistics.sinr);
  }
}

INSTANTIATE_TEST_SUITE_P(Seas, PacketReach, ::testing::Values(ReachSea{}, ReachSea{.fades = true}),
                         [](const auto& sea) { return sea.param.fades ? "Fading" : "Still"; });

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
