// SPDX-License-Identifier: BSD-3-Clause
// A run of the default scenario as separate processes (scripts/run_distributed), each of which is killed once
// and started again by the script: every vehicle goes on from where it was. Checked on the recorded log.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/logs/log_reader.h"
#include "bus/messages/channels.h"
#include "bus/messages/message_codec.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::Process;

constexpr double kMargin_m = 1;  // of a position beyond speed times gap

// Programs, each with the messages by which its service shows.
const std::vector<std::pair<std::string, std::vector<std::string>>>& programs() {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> all{
      {"bathymetry", {"STATUS.bathymetry"}},
      {"vehicle-sim", {"SENSORS.auv-1", "SENSORS.auv-2", "SENSORS.auv-3"}},
      {"channel-server", {"LINKS.auv-1", "LINKS.auv-2"}},
      {"autopilot", {"COMMAND.auv-1", "COMMAND.auv-2", "COMMAND.auv-3"}},
      {"traffic", {"STATUS.traffic"}},
      {"localiser", {"STATUS.localiser"}},
      {"conductor", {"CLOCK"}}};
  return all;
}

std::int64_t wall_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Looks every `period_s` while the process runs; false when `condition` never holds.
bool wait_until(Process& process, double period_s, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + testing::kHangLimit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end || !process.running()) return false;
    wait(period_s);
  }
  return true;
}

// Waits until the process has written `text`.
bool wait_for_output(Process& process, const std::string& text) {
  return wait_until(process, 0.005, [&] { return process.output().find(text) != std::string::npos; });
}

// A run that is recorded while its processes are killed in turn.
class KilledProcesses : public ::testing::Test {
 protected:
  KilledProcesses()
      : log_(::testing::TempDir() + "halocline-killed-" + std::to_string(getpid()) + ".lcmlog") {}
  ~KilledProcesses() override { std::filesystem::remove(log_); }

  void run_and_kill() {
    Process run({"/usr/bin/env", "HALOCLINE_BIN=" HALOCLINE_BIN_DIR,
                 HALOCLINE_SOURCE_DIR "/scripts/run_distributed", "scenarios/seamount.toml", "--log", log_});
    ASSERT_TRUE(wait_for_output(run, "their journals")) << run.output();
    wait(6);
    for (const auto& [program, channels] : programs()) {
      const std::regex line("halocline-" + program + ": process ([0-9]+)");
      std::smatch found;
      const std::string output = run.output();
      ASSERT_TRUE(std::regex_search(output, found, line)) << output;
      kill(std::stoi(found[1]), SIGKILL);
      ASSERT_TRUE(wait_for_output(run, program + " ended with exit code 137; starting it again"))
          << run.output();
      const std::int64_t restarted_us = wall_us();
      EXPECT_TRUE(wait_until(run, 0.5, [&, &channels = channels] { return serves(channels, restarted_us); }))
          << "after the restart of " << program;
      wait(1);
    }
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(), 0) << run.output();
    output_ = run.output();
  }

  // Whether all of `channels`, and the states of all vehicles, were recorded after this instant of the wall
  // clock.
  bool serves(const std::vector<std::string>& channels, std::int64_t after_us) const {
    std::set<std::string> awaited{channels.begin(), channels.end()};
    awaited.insert({"STATE.auv-1", "STATE.auv-2", "STATE.auv-3"});
    clients::LogReader log(log_);
    for (clients::LoggedEvent event; !awaited.empty() && log.next(event);)
      if (event.stamp_us > after_us) awaited.erase(event.channel);
    return awaited.empty();
  }

  void read_log() {
    clients::LogReader log(log_);
    for (clients::LoggedEvent event; log.next(event);) {
      if (!event.channel.starts_with(bus::channels::kState.prefix)) continue;
      const auto state = bus::decoded<vehicle_state_t>(event.data);
      ASSERT_TRUE(state.has_value()) << event.channel;
      states_[event.channel].push_back(*state);
    }
  }

  std::string log_, output_;
  std::map<std::string, std::vector<vehicle_state_t>> states_;
};

double speed_mps(const vehicle_state_t& s) {
  return Eigen::Map<const Eigen::Vector3d>(s.velocity_ned_mps).norm();
}

TEST_F(KilledProcesses, EveryVehicleGoesOnFromWhereItWas) {
  run_and_kill();
  if (HasFatalFailure()) return;
  read_log();
  ASSERT_EQ(states_.size(), 3u);
  for (const auto& [channel, states] : states_) {
    for (std::size_t i = 1; i < states.size(); ++i) {
      const vehicle_state_t &a = states[i - 1], &b = states[i];
      const double gap_s = static_cast<double>(b.utime - a.utime) * 1e-6;
      EXPECT_GT(gap_s, 0) << channel << " at " << a.utime;
      EXPECT_EQ(b.session, a.session) << channel << " at " << b.utime;
      const double moved_m = (Eigen::Map<const Eigen::Vector3d>(b.position_ned_m) -
                              Eigen::Map<const Eigen::Vector3d>(a.position_ned_m))
                                 .norm();
      EXPECT_LT(moved_m, std::max(speed_mps(a), speed_mps(b)) * gap_s + kMargin_m)
          << channel << " from " << a.utime << " to " << b.utime;
    }
    const double way_m = (Eigen::Map<const Eigen::Vector3d>(states.back().position_ned_m) -
                          Eigen::Map<const Eigen::Vector3d>(states.front().position_ned_m))
                             .norm();
    EXPECT_GT(way_m, 20) << channel << ": a vehicle set back to its start would not have been noticed";
  }
  if (HasFailure()) std::printf("%s\n", output_.c_str());
}

}  // namespace
}  // namespace halocline
