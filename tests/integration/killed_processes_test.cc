// SPDX-License-Identifier: BSD-3-Clause
// A run of the default scenario as separate processes (scripts/run_distributed), each of which is killed once and
// started again by the script: every vehicle goes on from where it was. Checked on the recorded log.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/channels.h"
#include "bus/logs/log_reader.h"
#include "bus/message_codec.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using std::chrono::milliseconds;
using testing::Process;

constexpr double kResumedWithin_s = 2;
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

// How many runnable processes share a core: what takes a time on an idle machine takes so many times as long here.
double slowness() {
  double load = 0;
  getloadavg(&load, 1);
  return std::max(1.0, load / std::max(1u, std::thread::hardware_concurrency()));
}

std::int64_t wall_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Waits until the process has written `text`; false when it has not within `limit`.
bool wait_for_output(Process& process, const std::string& text, milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (process.output().find(text) == std::string::npos) {
    if (std::chrono::steady_clock::now() > end || !process.running()) return false;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return true;
}

struct Restart {
  std::string program;
  std::int64_t at_us = 0;  // wall clock
  double allowed_s = 0;
};

// A run that is recorded while its processes are killed in turn.
class KilledProcesses : public ::testing::Test {
 protected:
  KilledProcesses()
      : log_(::testing::TempDir() + "halocline-killed-" + std::to_string(getpid()) + ".lcmlog") {}
  ~KilledProcesses() override { std::filesystem::remove(log_); }

  void run_and_kill() {
    Process run({"/usr/bin/env", "HALOCLINE_BIN=" HALOCLINE_BIN_DIR,
                 HALOCLINE_SOURCE_DIR "/scripts/run_distributed", "scenarios/seamount.toml", "--log", log_});
    ASSERT_TRUE(wait_for_output(run, "their journals", std::chrono::seconds(60))) << run.output();
    wait(6 * slowness());
    for (const auto& [program, channels] : programs()) {
      const std::regex line("halocline-" + program + ": process ([0-9]+)");
      std::smatch found;
      const std::string output = run.output();
      ASSERT_TRUE(std::regex_search(output, found, line)) << output;
      kill(std::stoi(found[1]), SIGKILL);
      const bool is_back = wait_for_output(run, program + " ended with exit code 137; starting it again",
                                           std::chrono::seconds(30));
      ASSERT_TRUE(is_back) << run.output();
      restarts_.push_back({program, wall_us(), kResumedWithin_s * slowness()});
      wait(restarts_.back().allowed_s + 1);
    }
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(std::chrono::seconds(60)), 0) << run.output();
    output_ = run.output();
  }

  void read_log() {
    clients::LogReader log(log_);
    for (clients::LoggedEvent event; log.next(event);) {
      seen_us_[event.channel].push_back(event.stamp_us);
      if (!event.channel.starts_with(bus::channels::kState.prefix)) continue;
      const auto state = bus::decoded<vehicle_state_t>(event.data);
      ASSERT_TRUE(state.has_value()) << event.channel;
      states_[event.channel].push_back(*state);
    }
  }

  bool was_published(const std::string& channel, std::int64_t after_us, double within_s) const {
    const auto seen = seen_us_.find(channel);
    if (seen == seen_us_.end()) return false;
    const auto first = std::upper_bound(seen->second.begin(), seen->second.end(), after_us);
    return first != seen->second.end() && static_cast<double>(*first - after_us) < within_s * 1e6;
  }

  std::string log_, output_;
  std::vector<Restart> restarts_;
  std::map<std::string, std::vector<std::int64_t>> seen_us_;  // stamps by channel
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
  for (const auto& [program, at_us, allowed_s] : restarts_) {
    for (const auto& [channel, states] : states_)
      EXPECT_TRUE(was_published(channel, at_us, allowed_s)) << channel << " after the restart of " << program;
    const auto shown =
        std::find_if(programs().begin(), programs().end(), [&](const auto& p) { return p.first == program; });
    for (const std::string& channel : shown->second)
      EXPECT_TRUE(was_published(channel, at_us, allowed_s)) << channel << " after the restart of " << program;
  }
  if (HasFailure()) std::printf("%s\n", output_.c_str());
}

}  // namespace
}  // namespace halocline
