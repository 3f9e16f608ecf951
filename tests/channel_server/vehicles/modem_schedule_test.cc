// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/modem_schedule.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

VehicleModem modem_of_level(double level_db) {
  VehicleModem modem;
  modem.modem.source_level = {level_db};
  return modem;
}

double level_at(const ModemSchedule& schedule, double time_s) {
  return schedule.at(at_s(time_s)).modem.source_level.value;
}

TEST(ModemSchedule, TheConfiguredModemHoldsUntilAnotherIsAnnounced) {
  ModemSchedule schedule(modem_of_level(170));
  schedule.set(at_s(10), modem_of_level(180));
  EXPECT_EQ(level_at(schedule, 9.999), 170);
  EXPECT_EQ(level_at(schedule, 10), 180);
}

TEST(ModemSchedule, TheOrderOfAnnouncementsDoesNotMatter) {
  ModemSchedule schedule(modem_of_level(170));
  schedule.set(at_s(20), modem_of_level(190));
  schedule.set(at_s(10), modem_of_level(180));
  EXPECT_EQ(level_at(schedule, 15), 180);
  EXPECT_EQ(level_at(schedule, 25), 190);
}

TEST(ModemSchedule, ForgettingKeepsWhatStillHolds) {
  ModemSchedule schedule(modem_of_level(170));
  schedule.set(at_s(10), modem_of_level(180));
  schedule.set(at_s(20), modem_of_level(190));
  schedule.forget_before(at_s(30));
  EXPECT_EQ(level_at(schedule, 30), 190);
}

// Of six announcements, some alike: at every instant what was announced for the latest instant before holds,
// in all 720 orders.
TEST(ModemSchedule, NoOrderOfRepetitionsMatters) {
  const std::vector<double> levels{180, 180, 190, 180, 180, 170};
  std::vector<std::size_t> order{0, 1, 2, 3, 4, 5};
  do {
    Schedule<double> schedule(170);
    for (const std::size_t i : order) schedule.set(at_s(10.0 * static_cast<double>(i + 1)), levels[i]);
    EXPECT_EQ(schedule.at(at_s(5)), 170);
    for (std::size_t i = 0; i < levels.size(); ++i)
      EXPECT_EQ(schedule.at(at_s(10.0 * static_cast<double>(i + 1) + 5)), levels[i]);
    std::vector<double> visited;
    schedule.visit_during(at_s(5), at_s(100), [&](double level, SimTime) { visited.push_back(level); });
    EXPECT_EQ(visited, (std::vector<double>{170, 180, 190, 180, 170}));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(ModemSchedule, RepetitionsMakeRoomFirst) {
  ModemSchedule schedule(modem_of_level(170));
  for (int i = 0; i < 1000; ++i) schedule.set(at_s(i), modem_of_level(180));
  EXPECT_EQ(level_at(schedule, 0.5), 180);
}

}  // namespace
}  // namespace halocline::channel_server
