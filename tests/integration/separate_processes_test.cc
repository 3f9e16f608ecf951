// SPDX-License-Identifier: BSD-3-Clause
// All programs as separate processes on udpm: they find each other, and each may be killed and return.
// Runs inside a network namespace of its own (scripts/isolated).
#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/integration/bus_monitor.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::BusMonitor;
using testing::Process;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";

// A program and the channels that show its service.
struct Service {
  std::string program;
  std::vector<std::string> shown_by;
};

const std::vector<Service>& services() {
  static const std::vector<Service> all{
      {"halocline-conductor", {"CLOCK"}},
      {"halocline-bathymetry", {"STATUS.bathymetry"}},
      {"halocline-vehicle-sim", {"STATE.alpha", "STATE.bravo", "SENSORS.alpha", "SENSORS.bravo"}},
      {"halocline-channel-server", {"LINKS.alpha", "LINKS.bravo", "RECEIPT.alpha"}},
      {"halocline-autopilot", {"COMMAND.alpha", "COMMAND.bravo"}},
      {"halocline-localiser", {"ESTIMATE.alpha"}},
      {"halocline-traffic", {"SEND.alpha", "SEND.bravo"}}};
  return all;
}

class ProcessFleet {
 public:
  ProcessFleet() {
    for (const Service& service : services()) start(service.program);
  }
  void start(const std::string& program) {
    processes_[program] =
        std::make_unique<Process>(std::vector<std::string>{HALOCLINE_BIN_DIR "/" + program, kScenario});
  }
  Process& at(const std::string& program) { return *processes_.at(program); }

 private:
  std::map<std::string, std::unique_ptr<Process>> processes_;
};

bool all_received(const BusMonitor& monitor, const std::vector<std::string>& channels) {
  for (const std::string& channel : channels) {
    if (monitor.received(channel) == 0) return false;
  }
  return true;
}

bool whole_fleet_received(const BusMonitor& monitor) {
  for (const Service& service : services()) {
    if (!all_received(monitor, service.shown_by)) return false;
  }
  return monitor.received("RECEIVE.alpha") > 0 && monitor.received("RECEIVE.bravo") > 0;
}

TEST(SeparateProcesses, ExchangeAcousticMessages) {
  BusMonitor monitor;
  ProcessFleet fleet;
  ASSERT_TRUE(monitor.wait_until([&] { return whole_fleet_received(monitor); }));
  EXPECT_TRUE(monitor.wait_until([&] {
    return !monitor.tables.empty() && monitor.tables.back().num_peers == 1 &&
           monitor.tables.back().peers[0].multipath != link_t::MULTIPATH_UNKNOWN;
  }));
}

TEST(SeparateProcesses, StopOnSigtermWithALastStatus) {
  BusMonitor monitor;
  ProcessFleet fleet;
  ASSERT_TRUE(monitor.wait_until([&] { return whole_fleet_received(monitor); }));
  for (const Service& service : services()) fleet.at(service.program).signal(SIGTERM);
  for (const Service& service : services()) EXPECT_EQ(fleet.at(service.program).wait(), 0) << service.program;
  for (const char* node :
       {"conductor", "bathymetry", "vehicle-sim", "channel-server", "autopilot", "traffic"}) {
    EXPECT_TRUE(monitor.wait_until([&] {
      return monitor.last_status[node].status_text.starts_with("stopped;");
    })) << node;
  }
}

struct Interruption {
  std::string program;
  int signal;
};
std::ostream& operator<<(std::ostream& out, const Interruption& interruption) {
  return out << interruption.program << " by signal " << interruption.signal;
}

class AfterAnInterruption : public ::testing::TestWithParam<Interruption> {};

// Channels of `other` while `absent` is unavailable: without vehicles there are no links and no
// transmissions; without a channel server traffic may have nothing to repeat; all else goes on.
std::vector<std::string> shown_without(const std::string& absent, const Service& other) {
  const bool needs_vehicles =
      other.program != "halocline-conductor" && other.program != "halocline-bathymetry";
  if (absent == "halocline-vehicle-sim" && needs_vehicles) return {};
  if (absent == "halocline-channel-server" && other.program == "halocline-traffic") return {};
  if (absent == "halocline-traffic" && other.program == "halocline-channel-server") return {"LINKS.alpha"};
  return other.shown_by;
}

// While a process is unavailable, the others' service goes on.
TEST_P(AfterAnInterruption, ServiceResumesWhenItReturns) {
  const auto& [program, signal] = GetParam();
  BusMonitor monitor;
  ProcessFleet fleet;
  ASSERT_TRUE(monitor.wait_until([&] { return whole_fleet_received(monitor); }));
  fleet.at(program).signal(signal);
  ASSERT_NE(fleet.at(program).wait(), -1);
  monitor.dispatch_for(0.5);  // what was under way
  monitor.clear();
  for (const Service& other : services()) {
    if (other.program == program) continue;
    EXPECT_TRUE(fleet.at(other.program).running()) << other.program;
    const auto channels = shown_without(program, other);
    EXPECT_TRUE(monitor.wait_until([&] { return all_received(monitor, channels); }))
        << other.program << " publishes nothing";
  }
  monitor.clear();
  monitor.tables.clear();
  fleet.start(program);
  EXPECT_TRUE(monitor.wait_until([&] {
    for (const Service& service : services()) {
      if (service.program == program && !all_received(monitor, service.shown_by)) return false;
    }
    return true;
  })) << program;
  monitor.clear();
  EXPECT_TRUE(monitor.wait_until([&] { return whole_fleet_received(monitor); })) << "packets arrive again";
}

std::vector<Interruption> interruptions() {
  std::vector<Interruption> all;
  for (const Service& service : services()) {
    all.push_back({service.program, SIGKILL});
    all.push_back({service.program, SIGTERM});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(SeparateProcesses, AfterAnInterruption, ::testing::ValuesIn(interruptions()),
                         [](const auto& test) {
                           std::string name = test.param.program.substr(10) +
                                              (test.param.signal == SIGKILL ? "_killed" : "_terminated");
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace halocline
