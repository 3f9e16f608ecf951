// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/recording.h"

#include <cstdint>
#include <sstream>
#include <utility>
#include <vector>

#include "bus/config/scenario.h"
#include "bus/logs/log_reader.h"
#include "core/sim_time.h"
#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using testing::clock_at;
using testing::state_at;
using testing::TemporaryLog;

constexpr std::int64_t kUnix_us = 1'700'000'000'250'000;

Recording recording_of(TemporaryLog& file, const bus::Scenario& scenario = {}) {
  LogReader log(file.path());
  return read_recording(log, scenario);
}

modem_send_t send_at(std::int64_t utime) {
  modem_send_t send{};
  send.utime = utime;
  send.source_id = 1;
  return send;
}

TEST(Recording, OfALockstepRunKeepsItsStampsAndOrder) {
  TemporaryLog file;
  file.add(0, "CLOCK", clock_at(0));
  file.add(0, "SEND.auv-1", send_at(5'000'000));  // announced early
  file.add(0, "STATE.auv-1", state_at(0));
  const Recording recording = recording_of(file);
  EXPECT_TRUE(recording.stamped_with_simulation_time);
  ASSERT_EQ(recording.events.size(), 2u);
  EXPECT_EQ(recording.events[0].channel, "SEND.auv-1");
  EXPECT_EQ(recording.events[0].at, SimTime());
}

TEST(Recording, OfAWallClockLogGoesByTheMessagesTime) {
  TemporaryLog file;
  constexpr std::int64_t kWall = 1'700'000'000'000'000;
  file.add(kWall, "CLOCK", clock_at(2'000'000));
  file.add(kWall + 10, "STATE.auv-1", state_at(2'100'000));
  file.add(kWall + 20, "STATE.auv-2", state_at(2'000'000));
  const Recording recording = recording_of(file);
  EXPECT_FALSE(recording.stamped_with_simulation_time);
  ASSERT_EQ(recording.events.size(), 2u);
  EXPECT_EQ(recording.events[0].channel, "STATE.auv-2");
  EXPECT_EQ(recording.end, SimTime::from_utime(2'100'000));
}

TEST(Recording, ChangesOfTheWaterArePlayed) {
  TemporaryLog file;
  environment_change_t change{};
  change.utime = 2'000'000;
  change.session = 5;
  change.sets_wind = 1;
  change.wind_speed_mps = 12;
  file.add(0, "CLOCK", clock_at(0));
  file.add(500'000, "SET_ENVIRONMENT", change);  // announced early
  const Recording recording = recording_of(file);
  ASSERT_EQ(recording.events.size(), 1u);
  EXPECT_EQ(recording.events[0].channel, "SET_ENVIRONMENT");
  EXPECT_EQ(recording.events[0].at, SimTime::from_utime(500'000));
  EXPECT_EQ(std::get<environment_change_t>(recording.events[0].message).wind_speed_mps, 12);
}

TEST(Recording, AnswersAreNotPlayed) {
  TemporaryLog file;
  file.add(0, "STATE.auv-1", state_at(0));
  file.add(0, "LINKS.auv-1", link_table_t{});
  file.add(0, "RECEIPT.auv-1", modem_receipt_t{});
  file.add_bytes(0, "LCM_SELF_TEST", {1});
  const Recording recording = recording_of(file);
  EXPECT_EQ(recording.events.size(), 1u);
  EXPECT_EQ(recording.ignored, 3);
}

TEST(Recording, OfARunStampedInUnixTimeIsMovedToItsFirstSecond) {
  TemporaryLog file;
  file.add(kUnix_us, "STATE.auv-1", state_at(kUnix_us));
  file.add(kUnix_us + 10, "SEND.auv-1", send_at(kUnix_us + 2'000'000));
  file.add(kUnix_us + 5'000'000, "STATE.auv-1", state_at(kUnix_us + 5'000'000));
  const Recording recording = recording_of(file);
  EXPECT_EQ(recording.zero, SimDuration::from_seconds(1'700'000'000));
  ASSERT_EQ(recording.events.size(), 3u);
  EXPECT_EQ(recording.events[0].at, SimTime::from_utime(250'000));
  EXPECT_EQ(std::get<vehicle_state_t>(recording.events[0].message).utime, 250'000);
  EXPECT_EQ(std::get<modem_send_t>(recording.events[1].message).utime, 2'250'000);
  EXPECT_EQ(recording.end, SimTime::from_utime(5'250'000));
}

TEST(Recording, OfOurOwnLongRunIsNotMoved) {
  TemporaryLog file;
  constexpr std::int64_t kLate_us = 90'000'000'000;  // the newest part of a rotated log
  file.add(kLate_us, "CLOCK", clock_at(kLate_us));
  file.add(kLate_us, "STATE.auv-1", state_at(kLate_us));
  const Recording recording = recording_of(file);
  EXPECT_EQ(recording.zero, SimDuration());
  EXPECT_EQ(recording.events[0].at, SimTime::from_utime(kLate_us));
}

TEST(Recording, TransmissionsWithoutATimeStartWhenTheyWereLogged) {
  TemporaryLog file;
  file.add(kUnix_us, "STATE.auv-1", state_at(kUnix_us));
  file.add(kUnix_us + 3'000'000, "STATE.auv-1", state_at(kUnix_us + 3'000'000));
  file.add(kUnix_us + 3'100'000, "SEND.auv-1", send_at(0));
  file.add(kUnix_us + 4'000'000, "STATE.auv-1", state_at(kUnix_us + 4'000'000));
  const Recording recording = recording_of(file);
  EXPECT_EQ(recording.without_time, 1);
  EXPECT_EQ(recording.events[2].channel, "SEND.auv-1");
  EXPECT_EQ(recording.events[2].at, SimTime::from_utime(3'250'000));
  EXPECT_EQ(std::get<modem_send_t>(recording.events[2].message).utime, 3'250'000);
}

TEST(Recording, WhereNoStateHasATimeAllGoByTheStamps) {
  TemporaryLog file;
  for (const std::int64_t s : {0, 1, 2}) file.add(kUnix_us + s * 1'000'000, "STATE.auv-1", state_at(0));
  const Recording recording = recording_of(file);
  EXPECT_EQ(recording.without_time, 3);
  EXPECT_EQ(recording.events[2].at, SimTime::from_utime(2'250'000));
}

TEST(Recording, VehiclesWithoutIdsGetTheScenariosOrFreeOnes) {
  TemporaryLog file;
  vehicle_state_t state = state_at(1);
  for (const auto& [vehicle, id] :
       std::vector<std::pair<std::string, int>>{{"known", 0}, {"given", 1}, {"new", 0}}) {
    state.vehicle_id = id;
    file.add(1, "STATE." + vehicle, state);
  }
  modem_send_t send = send_at(1);
  send.source_id = 0;
  file.add(2, "SEND.new", send);
  bus::Scenario scenario;
  scenario.vehicles = {{.name = "known", .id = 2}};
  const Recording recording = recording_of(file, scenario);
  ASSERT_EQ(recording.events.size(), 4u);
  EXPECT_EQ(std::get<vehicle_state_t>(recording.events[0].message).vehicle_id, 2);
  EXPECT_EQ(std::get<vehicle_state_t>(recording.events[2].message).vehicle_id, 3);
  EXPECT_EQ(std::get<modem_send_t>(recording.events[3].message).source_id, 3);
  std::ostringstream text;
  print_repairs(text, recording);
  EXPECT_NE(text.str().find("known=2 new=3"), std::string::npos) << text.str();
}

TEST(Recording, StatesWithoutAnOrientationAreTakenAsLevel) {
  TemporaryLog file;
  vehicle_state_t state = state_at(1);
  state.orientation_wxyz[0] = 0;
  file.add(1, "STATE.auv-1", state);
  const Recording recording = recording_of(file);
  ASSERT_EQ(recording.events.size(), 1u);
  EXPECT_EQ(recording.without_orientation, 1);
  EXPECT_EQ(std::get<vehicle_state_t>(recording.events[0].message).orientation_wxyz[0], 1);
}

TEST(Recording, DamagedStampsNeitherDelayNorReorderWhatComesAfter) {
  TemporaryLog file;
  constexpr std::int64_t kFar = std::int64_t{1} << 58;
  for (const std::int64_t stamp : {0, 1'000'000, -5, 3'000'000, 4'000'000, 5'000'000}) {
    file.add(stamp == 3'000'000 ? kFar : stamp, "CLOCK", clock_at(stamp));
    file.add(stamp, "STATE.auv-1", state_at(stamp));
  }
  file.add(kFar, "STATUS.x", node_status_t{});
  const Recording recording = recording_of(file);
  EXPECT_EQ(recording.end, SimTime::from_utime(5'000'000));
  ASSERT_EQ(recording.events.size(), 6u);
  EXPECT_EQ(recording.events[2].at, SimTime::from_utime(1'000'000));  // the one stamped -5
  EXPECT_EQ(recording.events[3].at, SimTime::from_utime(3'000'000));
}

}  // namespace
}  // namespace halocline::clients
