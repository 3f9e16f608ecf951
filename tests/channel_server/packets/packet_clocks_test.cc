// SPDX-License-Identifier: BSD-3-Clause
// What packets tell vehicles whose clocks are wrong.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::for_s;

constexpr double kAnHour = 3600, kRange = 750;

// Vehicles 1 and 2 at rest, 750 m apart, after an hour; 1 sends what is asked for.
std::vector<PacketOutcome> outcomes_after_an_hour(std::vector<ClockOf> clocks, PacketKind kind) {
  VehicleModem modem = testing::quick_modem();
  modem.modem.packet_overhead = for_s(0.2);
  VehicleRegistry fleet({for_s(0.05), for_s(5)}, {modem, {}}, {VehicleClocks(clocks, 1, for_s(0.05))});
  testing::move_steadily(fleet, 1, Vec3(0, 0, 50), Vec3::Zero(), kAnHour - 1, kAnHour + 10);
  testing::move_steadily(fleet, 2, Vec3(kRange, 0, 50), Vec3::Zero(), kAnHour - 1, kAnHour + 10);
  StraightPropagation propagation(testing::even_water());
  PacketMedium medium(fleet, propagation, {});
  SendRequest request = testing::request_of(1, kAnHour, 0);
  request.kind = kind;
  request.destination_id = 2;
  EXPECT_FALSE(medium.transmit(request, at_s(kAnHour)));
  return testing::outcomes_in(medium.advance_to(at_s(kAnHour + 9)));
}

double two_way_range_m(const std::vector<ClockOf>& clocks) {
  const auto outcomes = outcomes_after_an_hour(clocks, PacketKind::kPing);
  EXPECT_EQ(outcomes.size(), 2u);
  return outcomes.back().two_way_travel_time_s * testing::kSpeedMps / 2;
}

PacketOutcome one_way(const std::vector<ClockOf>& clocks) {
  const auto outcomes = outcomes_after_an_hour(clocks, PacketKind::kData);
  EXPECT_EQ(outcomes.size(), 1u);
  return outcomes.front();
}

TEST(PacketClocks, WithoutClocksTheStampAndTheTravelTimeAreTrue) {
  const PacketOutcome outcome = one_way({});
  EXPECT_EQ(outcome.departure_stamp, outcome.packet->departure);
  EXPECT_EQ(outcome.measured_travel_time_s, outcome.travel_time_s);
}

TEST(PacketClocks, OnePartInAMillionForAnHourMovesAOneWayRangeBy5Metres40) {
  const PacketOutcome ahead = one_way({{"v2", 2, {.drift = 1e-6}}});
  const double range_m = ahead.measured_travel_time_s * testing::kSpeedMps;
  // 3600.5 s when the sound arrives; a millionth of half a second is 0.75 mm.
  EXPECT_NEAR(range_m - kRange, 5.4, tolerance(1e-3));
  EXPECT_NEAR(ahead.travel_time_s * testing::kSpeedMps, kRange, tolerance(1e-6));  // OUTCOME has the truth
  EXPECT_EQ(ahead.departure_stamp, at_s(kAnHour));
}

TEST(PacketClocks, ASendersClockThatIsAheadStampsLateAndMakesTheRangeShorter) {
  const PacketOutcome late = one_way({{"v1", 1, {.offset_s = 0.001, .drift = 1e-6}}});
  EXPECT_EQ((late.departure_stamp - at_s(kAnHour)).nanoseconds(), 4'600'000);
  EXPECT_NEAR(late.measured_travel_time_s * testing::kSpeedMps - kRange, -6.9, tolerance(1e-6));
}

TEST(PacketClocks, EqualClocksMeasureTheTruth) {
  const ClockSettings same{.offset_s = 2, .drift = 1e-6};
  EXPECT_NEAR(one_way({{"v1", 1, same}, {"v2", 2, same}}).measured_travel_time_s, 0.5, tolerance(1e-6));
}

// All that it moves is what both clocks gain from the ping to the answer, 1.3 s: the ping and the turnaround,
// 0.31 s, by the one that answers, and all of it by the one that measures. An offset moves nothing.
TEST(PacketClocks, ATwoWayRangeIsMovedByNoMoreThanThePartInAMillionOfItsOwnTime) {
  const double truth_m = two_way_range_m({});
  EXPECT_NEAR(truth_m, kRange, tolerance(1e-5));
  EXPECT_NEAR(two_way_range_m({{"v1", 1, {.offset_s = 10}}, {"v2", 2, {.offset_s = -10}}}), truth_m,
              tolerance(1e-5));
  const double own_m = two_way_range_m({{"v1", 1, {.drift = 1e-6}}}) - truth_m;
  EXPECT_NEAR(own_m, 1.31e-6 * testing::kSpeedMps / 2, tolerance(1e-5));
  const double others_m = two_way_range_m({{"v2", 2, {.drift = 1e-6}}}) - truth_m;
  EXPECT_NEAR(others_m, -0.31e-6 * testing::kSpeedMps / 2, tolerance(1e-5));
}

}  // namespace
}  // namespace halocline::channel_server
