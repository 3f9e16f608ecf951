// SPDX-License-Identifier: BSD-3-Clause
// The log of a run as separate processes (scripts/run_distributed) has every message of every flow, from the
// first on, also where the bus loses, doubles and reorders datagrams: the numbers of its messages prove it.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/logs/flow_head.h"
#include "bus/logs/log_reader.h"
#include "bus/messages/channels.h"
#include "bus/messages/message_codec.h"
#include "tests/support/process.h"
#include "tests/support/working_folder.h"

namespace halocline {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::Process;

// By channel and session.
using Flow = std::pair<std::string, std::int64_t>;

struct Flows {
  explicit Flows(const std::string& path) {
    clients::LogReader log(path);
    for (clients::LoggedEvent event; log.next(event);) take(event);
  }
  void take(const clients::LoggedEvent& event) {
    EXPECT_FALSE(event.channel.starts_with(bus::channels::kRepair.prefix)) << event.channel;
    if (const auto heartbeat = bus::decoded<flow_heartbeat_t>(event.data)) {
      for (std::size_t i = 0; i < heartbeat->flow_channel.size(); ++i) {
        std::int64_t& last = announced[{heartbeat->flow_channel[i], heartbeat->flow_session[i]}];
        last = std::max(last, heartbeat->flow_last_sequence[i]);
      }
    }
    const bus::FlowType type = bus::flow_type_of(event.channel);
    const auto head = bus::flow_head(type, event.data);
    if (!head) return;
    const bool is_new = sequences[{event.channel, head->session}].insert(head->sequence).second;
    EXPECT_TRUE(is_new || type.is_packet_to_send) << event.channel << " has " << head->sequence << " twice";
  }
  // Numbers from 0 to the last that is there, or was announced, and are not there themselves.
  std::int64_t lacking() const {
    std::int64_t count = 0;
    for (const auto& [flow, present] : sequences) {
      const auto known = announced.find(flow);
      const std::int64_t last = std::max(*present.rbegin(), known == announced.end() ? 0 : known->second);
      count += last + 1 - static_cast<std::int64_t>(present.size());
    }
    for (const auto& [flow, last] : announced) count += sequences.contains(flow) ? 0 : last + 1;
    return count;
  }

  std::map<Flow, std::set<std::int64_t>> sequences;
  std::map<Flow, std::int64_t> announced;  // by heartbeats
};

class DistributedLog : public ::testing::Test {
 protected:
  static std::vector<std::string> distributed(const std::vector<std::string>& environment,
                                              const std::vector<std::string>& options) {
    std::vector<std::string> words{"/usr/bin/env", "HALOCLINE_BIN=" HALOCLINE_BIN_DIR};
    words.insert(words.end(), environment.begin(), environment.end());
    words.insert(words.end(), {HALOCLINE_SOURCE_DIR "/scripts/run_distributed",
                               HALOCLINE_TEST_DATA "/scenarios/ten_vehicles.toml", "--log",
                               std::filesystem::current_path().string() + "/run.lcmlog"});
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  static const std::vector<std::string>& lossy() {
    static const std::vector<std::string> environment{
        "LD_PRELOAD=" HALOCLINE_LOSSY_UDP, "HALOCLINE_UDP_LOSS=0.05", "HALOCLINE_UDP_DOUBLING=0.05",
        "HALOCLINE_UDP_REORDERING=0.05"};
    return environment;
  }
  static void expect_whole(const Process& run) {
    const Flows flows("run.lcmlog");
    EXPECT_EQ(flows.lacking(), 0);
    EXPECT_GT(flows.sequences.size(), 40u);
    EXPECT_THAT(run.output(), HasSubstr("run.lcmlog; it lacks none\n"));
  }
  testing::TemporaryFolder folder_;
};

TEST_F(DistributedLog, HasEveryMessageOfEveryFlow) {
  Process run(distributed({}, {"--duration", "10"}));
  EXPECT_EQ(run.wait(120s), 0) << run.output();
  expect_whole(run);
}

TEST_F(DistributedLog, HasThemOnABusThatLosesDatagrams) {
  Process run(distributed(lossy(), {"--duration", "10"}));
  EXPECT_EQ(run.wait(120s), 0) << run.output();
  expect_whole(run);
}

TEST_F(DistributedLog, HasThemThoughTheRecorderIsKilled) {
  Process run(distributed({}, {"--duration", "600"}));
  const auto pid_of_recorder = [&] {
    const std::string output = run.output();
    std::smatch found;
    static const std::regex line("halocline-recorder: process ([0-9]+)");
    return std::regex_search(output, found, line) ? std::stoi(found[1]) : 0;
  };
  const auto come = [&](const auto& condition) {
    for (int i = 0; i < 3000 && !condition(); ++i) std::this_thread::sleep_for(20ms);
    return condition();
  };
  ASSERT_TRUE(come([&] { return pid_of_recorder() != 0; })) << run.output();
  const auto states = [] { return Flows("run.lcmlog").sequences.size(); };
  ASSERT_TRUE(come([&] { return std::filesystem::file_size("run.lcmlog") > 100'000; }));
  const std::size_t flows_before = states();
  kill(pid_of_recorder(), SIGKILL);
  ASSERT_TRUE(
      come([&] { return run.output().find("recorder ended with exit code 137") != std::string::npos; }));
  const auto bytes = std::filesystem::file_size("run.lcmlog");
  ASSERT_TRUE(come([&] { return std::filesystem::file_size("run.lcmlog") > bytes + 100'000; }));
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait(60s), 0) << run.output();
  EXPECT_GE(states(), flows_before);
  expect_whole(run);
}

TEST_F(DistributedLog, IsWrittenByTheRecorderThatWasChosen) {
  Process run(distributed({}, {"--duration", "2", "--recorder", "lcm-logger"}));
  EXPECT_EQ(run.wait(120s), 0) << run.output();
  EXPECT_THAT(run.output(), ::testing::Not(HasSubstr("halocline-recorder")));
  clients::LogReader log("run.lcmlog");
  clients::LoggedEvent event;
  EXPECT_TRUE(log.next(event));
  Process wrong(distributed({}, {"--recorder", "pencil", "--force"}));
  EXPECT_EQ(wrong.wait(), 2);
  EXPECT_THAT(wrong.output(),
              HasSubstr("--recorder is 'pencil'; allowed are halocline-recorder and lcm-logger"));
}

}  // namespace
}  // namespace halocline
