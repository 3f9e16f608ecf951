// SPDX-License-Identifier: BSD-3-Clause
// A recorded log, played by LCM's own lcm-logplayer into a lone channel server, gives the link tables and
// outcomes of the original run.
// Runs inside a network namespace of its own (scripts/isolated).
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/integration/bus_monitor.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::BusMonitor;
using testing::Process;
using Bytes = std::vector<std::uint8_t>;
// What names a message whoever publishes it, and its bytes without the publisher's own numbers.
using Tables = std::map<std::pair<std::int32_t, std::int64_t>, Bytes>;
using Outcomes = std::map<std::tuple<std::int64_t, std::int64_t, std::int32_t>, Bytes>;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";

template <class Message>
Bytes bytes_without_publisher(Message message) {
  message.session = 0;
  message.sequence = 0;
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

struct Answers {
  Tables tables;
  Outcomes outcomes;
  std::int64_t last_state_utime = 0;

  void add(const link_table_t& t) { tables[{t.vehicle_id, t.utime}] = bytes_without_publisher(t); }
  void add(const packet_outcome_t& o) {
    outcomes[{o.send_session, o.packet_sequence, o.receiver_id}] = bytes_without_publisher(o);
  }
};

struct Original {
  Answers answers;
  std::int64_t server_session = 0;
};

Original read_log(const std::string& path) {
  Original original;
  lcm::LogFile log(path, "r");
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    link_table_t table;
    packet_outcome_t outcome;
    vehicle_state_t state;
    if (table.decode(event->data, 0, event->datalen) > 0) {
      original.answers.add(table);
      original.server_session = table.session;
    } else if (outcome.decode(event->data, 0, event->datalen) > 0) {
      original.answers.add(outcome);
    } else if (state.decode(event->data, 0, event->datalen) > 0) {
      original.answers.last_state_utime = state.utime;
    }
  }
  return original;
}

// What the new server published, and so not what the log holds of the old one.
Answers replayed_answers(const BusMonitor& monitor, const Original& original) {
  Answers replayed;
  for (const auto& table : monitor.tables) {
    if (table.session != original.server_session) replayed.add(table);
  }
  for (const auto& outcome : monitor.outcomes) {
    if (outcome.session != original.server_session) replayed.add(outcome);
  }
  return replayed;
}

// Time in the messages ends with the last state: what was decided after it is never reached again.
Outcomes outcomes_to_come(const Original& original) {
  Outcomes to_come = original.answers.outcomes;
  std::erase_if(to_come, [&](const auto& entry) {
    packet_outcome_t outcome;
    outcome.decode(entry.second.data(), 0, static_cast<int>(entry.second.size()));
    return outcome.utime > original.answers.last_state_utime;
  });
  return to_come;
}

bool holds_all(const Outcomes& found, const Outcomes& wanted) {
  return std::all_of(wanted.begin(), wanted.end(),
                     [&](const auto& entry) { return found.contains(entry.first); });
}

class LogPlayer : public ::testing::TestWithParam<double> {};

TEST_P(LogPlayer, GivesTheTablesAndOutcomesOfTheOriginalRun) {
  // Of this process alone: the speeds are tested side by side.
  const std::string folder = ::testing::TempDir() + "logplayer-" + std::to_string(getpid());
  const std::string log = folder + ".lcm";
  Process run({HALOCLINE_BIN_DIR "/halocline", "run", kScenario, "--quiet", "--log", log, "--out", folder});
  ASSERT_EQ(run.wait(), 0) << run.output();
  const Original original = read_log(log);
  ASSERT_GE(original.answers.tables.size(), 20u);
  ASSERT_GE(original.answers.outcomes.size(), 15u);

  BusMonitor monitor;
  Process bathymetry({HALOCLINE_BIN_DIR "/halocline-bathymetry", kScenario});
  Process server({HALOCLINE_BIN_DIR "/halocline-channel-server", kScenario, "--time-source", "messages"});
  ASSERT_TRUE(monitor.wait_until([&] { return monitor.last_status.size() == 2; }));
  Process player({"/usr/bin/lcm-logplayer", "--lcm-url=" + bus::effective_url(""),
                  "--speed=" + std::to_string(GetParam()), log});
  ASSERT_TRUE(monitor.wait_until([&] { return !player.running(); }));
  ASSERT_EQ(player.wait(), 0) << player.output();
  const Outcomes wanted = outcomes_to_come(original);
  Answers replayed;
  EXPECT_TRUE(monitor.wait_until([&] {
    replayed = replayed_answers(monitor, original);
    return replayed.tables.size() >= original.answers.tables.size() && holds_all(replayed.outcomes, wanted);
  }));
  EXPECT_EQ(replayed.tables, original.answers.tables);
  for (const auto& [key, bytes] : wanted) {
    const auto found = replayed.outcomes.find(key);
    ASSERT_NE(found, replayed.outcomes.end());
    EXPECT_EQ(found->second, bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, LogPlayer, ::testing::Values(1.0, 10.0), [](const auto& test) {
  return "Times" + std::to_string(static_cast<int>(test.param));
});

}  // namespace
}  // namespace halocline
