// SPDX-License-Identifier: BSD-3-Clause
// A scenario with modem interfaces in lockstep in this process, and hosts that talk to it between its
// instants.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/messages/channels.h"
#include "bus/messages/message_codec.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/transport/event_log.h"
#include "clients/modem_gateway/gateway_node.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/waveform/live_sea.h"

namespace halocline::modem_gateway::testing {

// Shallow straight water, isovelocity, and the same at every hour: travel times are ranges over 1500 m/s.
inline constexpr const char* kStillWater = R"(
[scenario]
duration_s = 600
[terrain]
kind = "flat"
[terrain.flat]
depth_m = 200.0
[environment]
profile = "isovelocity"
isovelocity_mps = 1500.0
profile_spread_mps = 0.0
noise_spread_db = 0.0
wind_mps = 5.0
[propagation]
model = "straight"
slow_fading_db = 0.0
tidal_fading_db = 0.0
daily_fading_db = 0.0
[channel_server]
link_rate_hz = 0.1
)";

struct InterfaceVehicle {
  std::string name;
  int id;
  std::string profile;
  double north_m, east_m;
  std::string kind;          // of its modem interface; empty: none
  std::string options = {};  // of the modem interface
  std::string more = {};     // keys of the vehicle, besides
};

// Key of a vehicle whose modem answers pings to all.
inline constexpr const char* kTransponder = "transponder = true\n";

class InterfaceRun {
 public:
  // `lost`: share of what would be received that is lost.
  explicit InterfaceRun(const std::vector<InterfaceVehicle>& vehicles, double lost = 0.2) {
    bus::set_log_level(bus::LogLevel::kError);
    const std::string path =
        ::testing::TempDir() + "halocline-interfaces-" + std::to_string(getpid()) + ".toml";
    std::string text = kStillWater, interfaces;
    if (lost > 0) text += "[[extra_loss]]\nshare = " + std::to_string(lost) + "\n";
    for (const InterfaceVehicle& v : vehicles) {
      text += "[[vehicle]]\nname = \"" + v.name + "\"\nid = " + std::to_string(v.id) +
              "\nmodel = \"fixed\"\nstart_ned_m = [" + std::to_string(v.north_m) + ", " +
              std::to_string(v.east_m) + ", 60.0]\n" + v.more + "[vehicle.modem]\nprofile = \"" + v.profile +
              "\"\n";
      if (v.kind.empty()) continue;
      interfaces += "[[modem_interface]]\nvehicle = \"" + v.name + "\"\nkind = \"" + v.kind +
                    "\"\nplace = \"tcp:0\"\noptions = \"" + v.options + "\"\n";
    }
    std::ofstream(path) << text << interfaces;
    config_ = clients::load_scenario(path, {});
    std::filesystem::remove(path);
    nodes_ = std::make_unique<clients::Composition>(
        lcm_, config_, clients::Composition::kRun, nullptr, std::nullopt,
        clients::live_sea_maker(config_, clients::make_terrain(config_)));
    for (bus::Node* node : nodes_->nodes()) {
      if (auto* gateway = dynamic_cast<GatewayNode*>(node)) gateway_ = gateway;
    }
    runner_ = std::make_unique<bus::LockstepRunner>(nodes_->nodes());
    runner_->set_listener([this](SimTime, std::string_view channel, std::span<const std::uint8_t> message) {
      if (channel == bus::channels::kOutcome) {
        packet_outcome_t outcome{};
        ASSERT_EQ(bus::decode(message, outcome), "");
        outcomes.push_back(outcome);
      } else if (channel.starts_with("MODEM_EVENT.")) {
        events.emplace_back(std::string(channel.substr(12)), modem_event_t{});
        ASSERT_EQ(bus::decode(message, events.back().second), "");
      }
    });
  }

  GatewayNode& gateway() { return *gateway_; }
  SimTime now() const { return runner_->now(); }
  void run_until(SimTime end) { runner_->run_until(end); }

  std::vector<packet_outcome_t> outcomes;
  std::vector<std::pair<std::string, modem_event_t>> events;  // with the vehicle

 private:
  clients::ScenarioConfig config_;
  lcm::LCM lcm_{"memq://"};
  std::unique_ptr<clients::Composition> nodes_;
  GatewayNode* gateway_ = nullptr;
  std::unique_ptr<bus::LockstepRunner> runner_;
};

}  // namespace halocline::modem_gateway::testing
