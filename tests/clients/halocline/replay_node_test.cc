#include "clients/halocline/replay_node.h"

#include "bus/lockstep_runner.h"
#include "tests/clients/halocline/log_fixture.h"

namespace halocline::clients {
namespace {

using testing::clock_at;
using testing::state_at;
using testing::TemporaryLog;

Recording recording_of(TemporaryLog& file) {
  LogReader log(file.path());
  return read_recording(log);
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

TEST(ReplayNode, PublishesEachMessageAtItsTime) {
  TemporaryLog file;
  file.add(0, "CLOCK", clock_at(0));
  for (const std::int64_t utime : {100'000, 100'000, 250'000})
    file.add(utime, "STATE.auv-1", state_at(utime));
  lcm::LCM lcm("memq://");
  ReplayNode node(lcm, {"replay", 1}, recording_of(file));
  bus::LockstepRunner runner(lcm, {&node});
  bus::Bus ear(lcm, {"ear", 1});
  std::vector<SimTime> heard;
  ear.subscribe<vehicle_state_t>(bus::channels::kState, [&](std::string_view, const vehicle_state_t&) {
    heard.push_back(runner.now());
  });
  runner.run_until(SimTime::from_seconds(1));
  EXPECT_EQ(heard, (std::vector<SimTime>{SimTime::from_utime(100'000), SimTime::from_utime(100'000),
                                         SimTime::from_utime(250'000)}));
}

}  // namespace
}  // namespace halocline::clients
