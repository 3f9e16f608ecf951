// SPDX-License-Identifier: BSD-3-Clause
// Packets of ends that waves leave out of the water.
#include <optional>

#include <gtest/gtest.h>

#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/surface_ends.h"
#include "tests/channel_server/scripted_water.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::for_s;
using testing::path;

// The scripted water in a gale, its vehicles at half a metre.
class WindyPropagation : public testing::ScriptedPropagation {
 public:
  WindyPropagation() { water_.noise.wind_mps = 14; }
  const acoustics::Environment& environment(SimTime) const override { return water_; }

 private:
  acoustics::Environment water_ = testing::even_water();
};

class OutOfWater : public testing::ScriptedWater {
 protected:
  OutOfWater() {
    for (VehicleId id = 5; id <= 7; ++id)
      testing::move_steadily(fleet, id, {1000.0 * id, 0, 0.5}, Vec3::Zero(), 0, 120);
    for (VehicleId from = 1; from <= 7; ++from) {
      for (VehicleId to = 1; to <= 7; ++to) windy_.set(from, to, {path(0.1, 120)});
    }
  }
  // Counts the outcomes of 50 packets from `source` at `receiver`.
  std::map<OutcomeKind, int> outcomes(const std::optional<SurfaceEnds>& ends, VehicleId source,
                                      VehicleId receiver) {
    MediumRule rule{for_s(10), for_s(200)};
    rule.near_surface = ends;
    PacketMedium sea(fleet, windy_, rule);
    for (int i = 0; i < 50; ++i)
      EXPECT_FALSE(sea.transmit(testing::request_of(source, 1 + 2 * i, i), SimTime()));
    std::map<OutcomeKind, int> counts;
    for (const PacketOutcome& end : testing::outcomes_in(sea.advance_to(at_s(110))))
      if (end.receiver_id == receiver) ++counts[end.kind];
    return counts;
  }

  WindyPropagation windy_;
};

TEST_F(OutOfWater, SendsAndHearsNothingForItsShareOfTheTime) {
  const SurfaceEnds ends{.seed = 3};
  const auto deep = outcomes(ends, 1, 2), up = outcomes(ends, 1, 5), down = outcomes(ends, 5, 1);
  EXPECT_EQ(deep.at(OutcomeKind::kReceived), 50);
  // 0.325 of 50 packets, two seconds apart in waves of seven: a spread of 4.
  EXPECT_NEAR(up.at(OutcomeKind::kOutOfWater), 16, 12);
  EXPECT_NEAR(down.at(OutcomeKind::kOutOfWater), 16, 12);
  EXPECT_EQ(up.at(OutcomeKind::kReceived) + up.at(OutcomeKind::kOutOfWater), 50);
}

TEST_F(OutOfWater, EveryPacketFailsJustWhenTheEndIsOutAtItsMiddle) {
  const SurfaceEnds ends{.seed = 3};
  MediumRule rule{for_s(10), for_s(200)};
  rule.near_surface = ends;
  PacketMedium sea(fleet, windy_, rule);
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(sea.transmit(testing::request_of(5, 1 + 2 * i, i), SimTime()));
  for (const PacketOutcome& end : testing::outcomes_in(sea.advance_to(at_s(110)))) {
    if (end.receiver_id != 1) continue;
    const SimTime middle =
        end.packet->departure + SimDuration::from_seconds(end.packet->timing.duration.seconds() / 2);
    const bool under = ends.is_under_water(5, 0.5, windy_.environment(middle), middle);
    EXPECT_EQ(end.kind, under ? OutcomeKind::kReceived : OutcomeKind::kOutOfWater);
  }
}

TEST_F(OutOfWater, FloatingEndsAndAStillMediumKnowNoWaves) {
  EXPECT_EQ(outcomes(SurfaceEnds{.seed = 3, .floating = {5, 6}}, 5, 6).at(OutcomeKind::kReceived), 50);
  EXPECT_EQ(outcomes(std::nullopt, 5, 6).at(OutcomeKind::kReceived), 50);
}

// 5 and 1 send at once: where 5 is out of the water, 2 receives the packet of 1 undisturbed.
TEST_F(OutOfWater, ASenderOutOfTheWaterDisturbsNobody) {
  const SurfaceEnds ends{.seed = 3};
  MediumRule rule{for_s(10), for_s(200)};
  rule.near_surface = ends;
  PacketMedium sea(fleet, windy_, rule);
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(sea.transmit(testing::request_of(5, 1 + 2 * i, i), SimTime()));
    EXPECT_FALSE(sea.transmit(testing::request_of(1, 1 + 2 * i, i), SimTime()));
  }
  int disturbed = 0, undisturbed = 0;
  for (const PacketOutcome& end : testing::outcomes_in(sea.advance_to(at_s(110)))) {
    if (end.receiver_id != 2 || end.packet->request.source_id != 1) continue;
    const SimTime middle =
        end.packet->departure + SimDuration::from_seconds(end.packet->timing.duration.seconds() / 2);
    const bool silent = !ends.is_under_water(5, 0.5, windy_.environment(middle), middle);
    (silent ? undisturbed : disturbed) += 1;
    EXPECT_EQ(end.statistics.interference == kSilence, silent);
  }
  EXPECT_GT(disturbed, 0);
  EXPECT_GT(undisturbed, 0);
}

}  // namespace
}  // namespace halocline::channel_server
