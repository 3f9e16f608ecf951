// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/read_timeline.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "bus/config/config.h"
#include "bus/logs/log_series.h"
#include "core/sim_time.h"
#include "runs/analysis/outcome_summary.h"
#include "runs/analysis/run_files.h"
#include "tests/bus/logs/log_fixture.h"
#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using testing::clock_at;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kSecond;
using testing::outcome;
using testing::state;
using testing::TemporaryLog;

constexpr std::int64_t kUnix = 1'700'000'000 * kSecond;

TEST(LoggedTimeline, ItsLedgerIsThatOfTheOutcomesCommand) {
  TemporaryLog file;
  for (std::int64_t i = 0; i < 300; ++i) {
    const packet_outcome_t o = outcome(1, static_cast<std::int32_t>(2 + i % 3), i / 2, i / 2 * 10 * kSecond,
                                       static_cast<std::int8_t>(i % 14));
    file.add(o.utime, "OUTCOME", o);
    if (i % 7 == 0) file.add(o.utime, "OUTCOME", o);  // again
  }
  LogReader reader(file.path());
  const OutcomeSummary summary = summary_of(reader, 60 * kSecond);
  const LoggedTimeline log = read_timeline({file.path()});
  const RunTimeline& timeline = log.timeline;
  EXPECT_THAT(log.remarks,
              Contains(HasSubstr("43 outcomes are in the log more than once; each counts once")));
  EXPECT_EQ(timeline.ledger().total(), summary.total());
  EXPECT_EQ(timeline.ledger().by_pair(), summary.by_pair());
  EXPECT_EQ(timeline.ledger().by_window(), summary.by_window());
  EXPECT_EQ(timeline.ledger().by_propagation(), summary.by_propagation());
  EXPECT_EQ(timeline.repeated_outcomes(), summary.repeated());
}

TEST(LoggedTimeline, ARecordingInUnixTimeBeginsAtZero) {
  TemporaryLog file;
  for (std::int64_t s = 0; s < 10; ++s) file.add(kUnix + s, "STATE.a", state(1, kUnix + s * kSecond, 0));
  file.add(kUnix, "STATE.b", state(2, 0, 0));  // no clock
  const LoggedTimeline log = read_timeline({file.path()});
  EXPECT_EQ(log.timeline.end(), SimTime::from_seconds(9));
  EXPECT_THAT(log.remarks, Contains(HasSubstr("Times are moved: 0 is the recording's 1700000000 s")));
  EXPECT_THAT(log.remarks, Contains(HasSubstr("1 messages carry the time of another clock")));
}

TEST(LoggedTimeline, ALogStampedWithSimulationTimeIsTakenAsItIs) {
  TemporaryLog file;
  for (std::int64_t s = 0; s < 10; ++s) {
    file.add(s * kSecond, "CLOCK", clock_at(s * kSecond));
    file.add(s * kSecond, "STATE.a", state(1, s * kSecond, 0));
  }
  const LoggedTimeline log = read_timeline({file.path()});
  EXPECT_EQ(log.timeline.end(), SimTime::from_seconds(9));
  EXPECT_THAT(log.remarks, IsEmpty());
}

TEST(LoggedTimeline, DamageAndWhatIsForeignAreRemarked) {
  TemporaryLog file;
  file.add(0, "STATE.a", state(1, 0, 0));
  file.add_bytes(0, "CAMERA", {1, 2, 3});
  file.add_bytes(0, "STATE.a", {1, 2, 3});
  file.add(9, "STATE.a", state(1, kSecond, 0));
  std::string bytes = file.bytes();
  file.replace_bytes(bytes.substr(0, bytes.size() - 20));
  const LoggedTimeline log = read_timeline({file.path()});
  EXPECT_EQ(log.timeline.vehicles().size(), 1u);
  EXPECT_EQ(log.remarks.size(), 3u);
}

TEST(LoggedTimeline, TheConfigurationBesideTheLogIsTheScenariosText) {
  TemporaryLog file;
  file.add(0, "STATE.a", state(1, 0, 0));
  std::ofstream(config_beside(file.path())) << "[scenario]\n";
  EXPECT_EQ(read_timeline({file.path()}).timeline.scenario().toml, "[scenario]\n");
  std::filesystem::remove(config_beside(file.path()));
}

TEST(LoggedTimeline, TheConfigurationOfAPartIsBesideTheFirst) {
  TemporaryLog file(".0002");
  file.add(0, "STATE.a", state(1, 0, 0));
  const std::string first = config_beside(bus::first_part_of_log(file.path()));
  ASSERT_NE(first, config_beside(file.path()));
  std::ofstream(first) << "[scenario]\nname = \"first\"\n";
  EXPECT_EQ(read_timeline({file.path()}).timeline.scenario().toml, "[scenario]\nname = \"first\"\n");
  EXPECT_EQ(recorded_configuration({file.path()}, {}).path(), first);
  std::ofstream(config_beside(file.path())) << "[scenario]\n";
  EXPECT_EQ(read_timeline({file.path()}).timeline.scenario().toml, "[scenario]\n");
  std::filesystem::remove(config_beside(file.path()));
  std::filesystem::remove(first);
}

}  // namespace
}  // namespace halocline::clients
