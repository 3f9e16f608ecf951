// SPDX-License-Identifier: BSD-3-Clause
// Whole scenarios run in this process, into logs of the test's own.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/logs/channel_types.h"
#include "bus/logs/log_reader.h"
#include "bus/transport/event_log.h"
#include "core/sim_time.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"
#include "simulation/embedded_run.h"
#include "simulation/replay_node.h"

namespace halocline::clients::testing {

class EmbeddedTest : public ::testing::Test {
 protected:
  EmbeddedTest() {
    bus::set_log_level(bus::LogLevel::kSilent);
    std::filesystem::create_directories(folder_);
  }
  ~EmbeddedTest() override { std::filesystem::remove_all(folder_); }

  ScenarioConfig load(const std::string& name, const std::vector<std::string>& overrides) {
    return load_scenario(std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/" + name + ".toml", overrides);
  }
  // Overrides of a sea that changes over minutes alone.
  static std::vector<std::string> still_sea() {
    return {"environment.noise_spread_db=0", "environment.profile_spread_mps=0",
            "propagation.slow_fading_db=0", "propagation.tidal_fading_db=0", "propagation.daily_fading_db=0"};
  }
  ScenarioConfig load_text(const std::string& text) {
    std::ofstream(folder_ + "/scenario.toml") << text;
    return load_scenario(folder_ + "/scenario.toml", {});
  }
  std::string log_path(const std::string& name) const { return folder_ + "/" + name + ".lcm"; }

  using MakeNode = std::function<std::unique_ptr<bus::Node>(lcm::LCM&)>;

  // Runs the scenario to its end, with one node more where `make_guest` is given, and returns the log's path.
  std::string run(
      const ScenarioConfig& config, const std::string& name,
      const std::function<bool()>& should_stop = [] { return false; }, const MakeNode& make_guest = {}) {
    lcm::LCM lcm("memq://");
    Composition all(lcm, config, Composition::kRun);
    const auto guest = make_guest ? make_guest(lcm) : nullptr;
    std::vector<bus::Node*> nodes = all.nodes();
    if (guest) nodes.push_back(guest.get());
    EmbeddedRun settings{.end = SimTime() + config.scenario.duration, .log_path = log_path(name)};
    settings.quiet = true;
    settings.threads = all.threads();
    settings.should_stop = should_stop;
    run_embedded(nodes, settings);
    return settings.log_path;
  }
  std::string replay(const ScenarioConfig& config, const std::string& original, const std::string& name) {
    LogReader log(original);
    Recording recording = read_recording(log, config.scenario, played_in(config));
    EmbeddedRun settings{.end = recording.end, .log_path = log_path(name)};
    settings.quiet = true;
    lcm::LCM lcm("memq://");
    ReplayNode recorded(lcm, {"replay", 1}, std::move(recording));
    Composition nodes(lcm, config, Composition::kReplay, &recorded);
    run_embedded(nodes.nodes(), settings);
    return settings.log_path;
  }

  static std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
  }
  // All sound messages of one type, with their channels.
  template <class Message>
  static std::vector<std::pair<std::string, Message>> messages_in(const std::string& path) {
    std::vector<std::pair<std::string, Message>> messages;
    LogReader log(path);
    for (LoggedEvent event; log.next(event);) {
      with_type_of(event.channel, [&]<class Found>() {
        if constexpr (std::is_same_v<Found, Message>) {
          Message message;
          if (decode_checked(event.data, message)) messages.emplace_back(event.channel, message);
        }
      });
    }
    return messages;
  }

 private:
  std::string folder_ = ::testing::TempDir() + "halocline-run-" + std::to_string(getpid());
};

}  // namespace halocline::clients::testing
