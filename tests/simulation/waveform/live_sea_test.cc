// SPDX-License-Identifier: BSD-3-Clause
// Modems of waveforms (UASP2) in a run, against `halocline waveform` of the same run.
#include "simulation/waveform/live_sea.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

#include "bus/runtime/lockstep_runner.h"
#include "bus/transport/event_log.h"
#include "clients/modem_gateway/gateway_node.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/vehicle_track.h"
#include "simulation/waveform/received_waveform.h"
#include "tests/clients/modem_gateway/host.h"
#include "tests/clients/modem_gateway/waveform_host.h"

namespace halocline::clients {
namespace {

using acoustics::Samples;
using modem_gateway::testing::Host;
using modem_gateway::testing::rms;
using modem_gateway::testing::sweep;

// Under way along echoes of surface and bottom.
constexpr const char* kScenario = R"(
[scenario]
seed = 11
duration_s = 60
[terrain]
kind = "flat"
[terrain.flat]
depth_m = 120.0
[modem]
profile = "micromodem-psk-1"
[[vehicle]]
name = "alpha"
id = 1
start_ned_m = [0.0, 0.0, 30.0]
heading_deg = 90.0
speed_mps = 1.5
[vehicle.mission]
waypoints = [[0.0, 800.0, 30.0]]
speed_mps = 1.5
[[vehicle]]
name = "bravo"
id = 2
start_ned_m = [300.0, 0.0, 40.0]
[vehicle.mission]
waypoints = [[1500.0, 0.0, 40.0]]
speed_mps = 1.5
[[vehicle]]
name = "buoy"
id = 3
model = "fixed"
start_ned_m = [600.0, 200.0, 20.0]
[[modem_interface]]
vehicle = "alpha"
kind = "uasp2"
place = "tcp:0"
[[modem_interface]]
vehicle = "bravo"
kind = "uasp2"
place = "tcp:0"
[[modem_interface]]
vehicle = "buoy"
kind = "uasp2"
place = "tcp:0"
options = "output_rate=192000"
)";

ScenarioConfig load() {
  bus::set_log_level(bus::LogLevel::kSilent);
  const std::string path = ::testing::TempDir() + "halocline-live-" + std::to_string(getpid()) + ".toml";
  std::ofstream(path) << kScenario;
  ScenarioConfig config = load_scenario(path, {});
  std::filesystem::remove(path);
  return config;
}

class LiveSeaTest : public ::testing::Test {
 protected:
  explicit LiveSeaTest() {
    for (bus::Node* node : nodes_.nodes()) {
      if (auto* gateway = dynamic_cast<modem_gateway::GatewayNode*>(node)) gateway_ = gateway;
    }
    run_until(1);
    for (std::size_t i = 0; i < 3; ++i) hosts_.push_back(std::make_unique<Host>(gateway_->place_of(i)));
  }
  void run_until(double end_s) {
    while (now_s_ < end_s - 1e-9) {
      now_s_ += 0.05;
      runner_.run_until(SimTime::from_seconds(now_s_));
      port_.take(heard_);
    }
  }
  void play(std::size_t host, const std::vector<double>& samples, double at_s) {
    for (const std::string& line : modem_gateway::testing::odata(samples)) {
      hosts_[host]->write(line);
      run_until(now_s_ + 0.05);
    }
    hosts_[host]->write(modem_gateway::testing::ostart(at_s));
  }
  void stream(std::size_t host) { hosts_[host]->write(port_.istart()); }
  // What `halocline waveform` finds, at the samples that were heard.
  Samples expected(const std::string& receiver, const std::vector<std::pair<std::string, Samples>>& sounds) {
    std::vector<SentWaveform> sent;
    const auto modems = make_modems(config_.channel_server);
    for (const auto& [vehicle, sound] : sounds)
      sent.push_back({vehicle, sound, modems.of(vehicle).modem.source_level});
    return received_waveform(config_, terrain_, record_run(config_, terrain_, SimTime::from_seconds(now_s_)),
                             sent, {.receiver = receiver, .begin_s = heard_.begin_s, .tail_s = 0.2});
  }

  ScenarioConfig config_ = load();
  bathymetry::PreparedTerrain terrain_ = make_terrain(config_);
  lcm::LCM lcm_{"memq://"};
  Composition nodes_{lcm_, config_, Composition::kRun, nullptr, terrain_, live_sea_maker(config_, terrain_)};
  bus::LockstepRunner runner_{nodes_.nodes()};
  modem_gateway::GatewayNode* gateway_ = nullptr;
  std::vector<std::unique_ptr<Host>> hosts_;
  modem_gateway::testing::DataPort port_;
  Samples heard_{0, 96'000, {}};
  double now_s_ = 0;
};

// Noise and echoes, sample by sample: where one is a sample late or 0.1 dB (1.2 %) off, a sweep up to 30 kHz
// differs by more.
TEST_F(LiveSeaTest, WhatAHostHearsOfAnotherIsWhatTheCommandFindsAfterwards) {
  stream(1);
  const std::vector<double> sound = sweep(96'000, 0.5);
  play(0, sound, 4);
  run_until(6);
  const Samples offline = expected("bravo", {{"alpha", {4, 96'000, sound}}});
  const std::size_t count = std::min(offline.values.size(), heard_.values.size());
  ASSERT_GT(static_cast<double>(count) / 96'000, 3.5);
  std::vector<double> difference,
      common(offline.values.begin(), offline.values.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t n = 0; n < count; ++n) difference.push_back(heard_.values[n] - offline.values[n]);
  EXPECT_LT(rms(difference), 1e-3 * rms(common));
  // There is a sound in it.
  const auto loudest = std::max_element(common.begin(), common.end());
  const double at_s = heard_.begin_s + static_cast<double>(loudest - common.begin()) / 96'000;
  EXPECT_GT(at_s, 4 + 250.0 / 1550);
  EXPECT_LT(at_s, 5.2);
  EXPECT_GT(*loudest, 20 * rms({common.begin(), common.begin() + 96'000}));
}

TEST_F(LiveSeaTest, SoundsOfSeveralHostsAddUpAndRatesMayDiffer) {
  stream(1);
  const std::vector<double> one = sweep(96'000, 0.2), other = sweep(192'000, 0.2);
  play(0, one, 4);
  play(2, other, 4.1);
  run_until(6);
  // At the receiver's rate the same sweep, but for its last sample.
  const Samples offline = expected("bravo", {{"alpha", {4, 96'000, one}}, {"buoy", {4.1, 96'000, one}}});
  const std::size_t count = std::min(offline.values.size(), heard_.values.size());
  std::vector<double> difference,
      common(offline.values.begin(), offline.values.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t n = 0; n < count; ++n) difference.push_back(heard_.values[n] - offline.values[n]);
  EXPECT_LT(rms(difference), 0.02 * rms(common));
}

TEST(LiveSea, AGatewayWithoutTheWaterRefusesTheModemInterface) {
  const ScenarioConfig config = load();
  lcm::LCM lcm("memq://");
  EXPECT_THROW(Composition(lcm, config, Composition::kRun), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
