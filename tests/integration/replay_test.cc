// SPDX-License-Identifier: BSD-3-Clause
// A recorded run through another sea: the same scenario repeats every number; each change moves what it
// must; a log from sea, or a damaged one, is replayed as far as it can be read.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/logs/log_reader.h"
#include "core/random.h"
#include "runs/analysis/comparison.h"
#include "simulation/composition.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class ReplayTest : public testing::EmbeddedTest {
 protected:
  static constexpr const char* kShort = "scenario.duration_s=45";

  ScenarioConfig harbour(std::vector<std::string> overrides = {}) {
    overrides.emplace_back(kShort);
    return load("harbour", overrides);
  }
  static LoggedOutcomes outcomes(const std::string& path, std::int64_t zero_us = 0) {
    LogReader log(path);
    return outcomes_of(log, zero_us);
  }
  static Comparison compared(const std::string& before, const std::string& after) {
    return {outcomes(before), outcomes(after)};
  }
  Comparison replayed_with(const std::vector<std::string>& overrides) {
    const std::string original = run(harbour(), "original");
    return compared(original, replay(harbour(overrides), original, "again"));
  }
  static std::set<std::string> moved(const Comparison& comparison) {
    std::set<std::string> names;
    for (const auto& row : comparison.rows()) names.insert(row.moved.begin(), row.moved.end());
    return names;
  }
  // Copies the log's events that `keep` wants, changed by it.
  template <class Keep>
  std::string filtered(const std::string& path, const std::string& name, const Keep& keep) {
    lcm::LogFile out(log_path(name), "w");
    LogReader log(path);
    for (LoggedEvent event; log.next(event);) {
      if (!keep(event)) continue;
      lcm::LogEvent written;
      written.eventnum = 0;
      written.timestamp = event.stamp_us;
      written.channel = event.channel;
      written.datalen = static_cast<std::int32_t>(event.data.size());
      written.data = event.data.data();
      out.writeEvent(&written);
    }
    return log_path(name);
  }
};

TEST_F(ReplayTest, TheSameLogAndScenarioRepeatEveryNumberOfEveryOutcome) {
  for (const char* name : {"harbour", "seamount"}) {
    const ScenarioConfig config = load(name, {kShort});
    const std::string original = run(config, "original");
    const Comparison comparison = compared(original, replay(config, original, "again"));
    EXPECT_GT(comparison.rows().size(), 6u) << name;
    EXPECT_EQ(comparison.identical(), static_cast<std::int64_t>(comparison.rows().size())) << name;
  }
}

// Bubbles take from every bounce at the surface. One link may gain: where calm paths cancel, a rough surface
// fills the null.
TEST_F(ReplayTest, WindMovesTheNoiseAndTheSurface) {
  const Comparison comparison = replayed_with({"environment.wind_mps=14"});
  int weaker = 0;
  double change_db = 0;
  for (const auto& row : comparison.rows()) {
    ASSERT_TRUE(row.before && row.after);
    EXPECT_GT(row.after->noise_level_db, row.before->noise_level_db + 1);  // 4 to 14 m/s in a harbour
    change_db += row.after->received_level_db - row.before->received_level_db;
    weaker += row.after->received_level_db < row.before->received_level_db - 0.1 ? 1 : 0;
  }
  EXPECT_GT(weaker, static_cast<int>(comparison.rows().size()) / 2);
  EXPECT_LT(change_db / static_cast<double>(comparison.rows().size()), -0.1);
}

TEST_F(ReplayTest, AnotherProfileMovesTravelTimesByItsSpeedOfSound) {
  // Fresh water of one temperature: 1447 m/s at 10 degrees (Del Grosso and Mader 1972), where the harbour has
  // 1510 to 1520.
  const Comparison comparison =
      replayed_with({"environment.water_rows=[[0.0, 10.0, 0.0], [20.0, 10.0, 0.0]]"});
  int compared_times = 0;
  for (const auto& row : comparison.rows()) {
    ASSERT_TRUE(row.before && row.after);
    if (row.before->num_paths == 0 || row.after->num_paths == 0 || row.before->range_m < 100) continue;
    EXPECT_NEAR(row.after->travel_time_s / row.before->travel_time_s, 1515.0 / 1447.5, 0.02);
    ++compared_times;
  }
  EXPECT_GT(compared_times, 10);
}

TEST_F(ReplayTest, TheBottomMovesLevelsAndNeitherNoiseNorDraws) {
  const auto names = moved(replayed_with({"propagation.sediment=\"SiltyClay\""}));
  EXPECT_TRUE(names.contains("level"));
  EXPECT_FALSE(names.contains("noise"));
  EXPECT_FALSE(names.contains("draws"));
  EXPECT_FALSE(names.contains("duration"));
}

TEST_F(ReplayTest, TheModemMovesDurationsAndLevels) {
  const Comparison comparison = replayed_with({"modem.source_level_db=178", "modem.bit_rate_bps=1000"});
  for (const auto& row : comparison.rows()) {
    if (!row.before || !row.after || row.any().source_id == 5)
      continue;  // the visitor brings a level of its own
    EXPECT_GT(row.after->duration_s, row.before->duration_s);
    EXPECT_NEAR(row.after->received_level_db - row.before->received_level_db, 10, 0.3);
  }
}

// Fading is drawn, too: what is received moves, its mean level does not. Where the sea differs from hour to
// hour, the seed draws which hours these are: noise and level move as well.
TEST_F(ReplayTest, TheSeedMovesDrawsAndFadingAndNothingElseOfAStillSea) {
  const std::string original = run(harbour(still_sea()), "original");
  std::vector<std::string> other_seed = still_sea();
  other_seed.emplace_back("scenario.seed=8");
  const auto names = moved(compared(original, replay(harbour(other_seed), original, "again")));
  EXPECT_TRUE(names.contains("draws"));
  for (const char* of_water : {"level", "noise", "paths", "range", "duration", "doppler", "cutoff"})
    EXPECT_FALSE(names.contains(of_water)) << of_water;
}
TEST_F(ReplayTest, TheSeedMovesTheHoursOfTheSea) {
  const auto names = moved(replayed_with({"scenario.seed=8"}));
  for (const char* of_hours : {"draws", "level", "noise"}) EXPECT_TRUE(names.contains(of_hours)) << of_hours;
  for (const char* of_vehicles : {"range", "duration", "cutoff"})
    EXPECT_FALSE(names.contains(of_vehicles)) << of_vehicles;
}

TEST_F(ReplayTest, AMissionFromSeaWithUnixTimesAndNothingButStatesAndTransmissionsGivesTheOutcomesOfTheRun) {
  // A log as a recorder at sea leaves it: no CLOCK, no answers, Unix stamps in microseconds. Without SENSORS
  // nothing tells how fast propellers turn.
  constexpr std::int64_t kZero_us = 1'700'000'000'000'000;
  const auto silent = [&] {
    ScenarioConfig config = harbour();
    for (auto& vehicle : config.channel_server.vehicles) vehicle.own_noise = false;
    return config;
  };
  const std::string original = run(silent(), "original");
  const std::string at_sea = filtered(original, "at-sea", [&](LoggedEvent& event) {
    const auto move = [&]<class Message>(Message message) {
      EXPECT_TRUE(decode_checked(event.data, message));
      message.utime += kZero_us;
      message.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
    };
    event.stamp_us += kZero_us + 1234;
    if (family_of(event.channel) == "STATE") return move(vehicle_state_t{}), true;
    if (family_of(event.channel) == "SEND") return move(modem_send_t{}), true;
    return false;
  });
  const std::string again = replay(silent(), at_sea, "again");
  const Comparison comparison = compared(original, again);
  EXPECT_GT(comparison.rows().size(), 20u);
  for (const auto& row : comparison.rows()) {
    if (row.any().utime > 44'000'000) continue;  // the recording's end
    EXPECT_EQ(row.outcome_after, row.outcome_before);
  }
  EXPECT_FALSE(compared(at_sea, again).anything_before());
}

TEST_F(ReplayTest, ADamagedLogReplaysWithAllThatIsSound) {
  const std::string original = run(harbour(), "original");
  std::string bytes = bytes_of(original);
  for (std::uint64_t i = 0; i < 40; ++i) {
    const DrawAddress address{.seed = 3, .purpose = purpose_of("replay-test"), .who = 0, .which = i};
    bytes[bits_at(address) % bytes.size()] ^= 0x55;
  }
  bytes.resize(bytes.size() - 17);
  const std::string damaged = log_path("damaged");
  std::ofstream(damaged, std::ios::binary) << bytes;
  LogReader whole(original), rest(damaged);
  std::int64_t events = 0, left = 0;
  for (LoggedEvent event; whole.next(event);) ++events;
  for (LoggedEvent event; rest.next(event);) ++left;
  EXPECT_GE(left, events - 41);
  EXPECT_TRUE(rest.truncated());
  const Comparison comparison = compared(original, replay(harbour(), damaged, "again"));
  EXPECT_GT(comparison.rows().size(), 20u);
  EXPECT_LT(comparison.changed(), static_cast<std::int64_t>(comparison.rows().size()) / 5);
}

}  // namespace
}  // namespace halocline::clients
