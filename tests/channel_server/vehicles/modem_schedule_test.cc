#include "channel_server/vehicles/modem_schedule.h"

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
  schedule.announce(at_s(10), modem_of_level(180));
  EXPECT_EQ(level_at(schedule, 9.999), 170);
  EXPECT_EQ(level_at(schedule, 10), 180);
}

TEST(ModemSchedule, TheOrderOfAnnouncementsDoesNotMatter) {
  ModemSchedule schedule(modem_of_level(170));
  schedule.announce(at_s(20), modem_of_level(190));
  schedule.announce(at_s(10), modem_of_level(180));
  EXPECT_EQ(level_at(schedule, 15), 180);
  EXPECT_EQ(level_at(schedule, 25), 190);
}

TEST(ModemSchedule, ForgettingKeepsWhatStillHolds) {
  ModemSchedule schedule(modem_of_level(170));
  schedule.announce(at_s(10), modem_of_level(180));
  schedule.announce(at_s(20), modem_of_level(190));
  schedule.forget_before(at_s(30));
  EXPECT_EQ(level_at(schedule, 30), 190);
}

TEST(ModemSchedule, RepetitionsTakeNoMemory) {
  ModemSchedule schedule(modem_of_level(170));
  for (int i = 0; i < 1000; ++i) schedule.announce(at_s(i), modem_of_level(180));
  // Were repetitions kept, the announcement of second 0 would have made room for them.
  EXPECT_EQ(level_at(schedule, 0.5), 180);
}

}  // namespace
}  // namespace halocline::channel_server
