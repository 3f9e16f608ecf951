// All programs as separate processes on udpm: they find each other, and each may die and return.
// Runs inside a network namespace of its own (scripts/isolated).
#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/integration/bus_ear.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::BusEar;
using testing::Process;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";

constexpr std::chrono::seconds kEnd{5};

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

bool all_heard(const BusEar& ear, const std::vector<std::string>& channels) {
  for (const std::string& channel : channels) {
    if (ear.heard(channel) == 0) return false;
  }
  return true;
}

bool whole_fleet_heard(const BusEar& ear) {
  for (const Service& service : services()) {
    if (!all_heard(ear, service.shown_by)) return false;
  }
  return ear.heard("RECEIVE.alpha") > 0 && ear.heard("RECEIVE.bravo") > 0;
}

TEST(SeparateProcesses, ExchangeAcousticMessages) {
  BusEar ear;
  ProcessFleet fleet;
  ASSERT_TRUE(ear.listen_until(15, [&] { return whole_fleet_heard(ear); }));
  EXPECT_TRUE(ear.listen_until(5, [&] {
    return !ear.tables.empty() && ear.tables.back().num_peers == 1 &&
           ear.tables.back().peers[0].multipath != link_t::MULTIPATH_UNKNOWN;
  }));
}

TEST(SeparateProcesses, StopOnSigtermWithAFarewellInStatus) {
  BusEar ear;
  ProcessFleet fleet;
  ASSERT_TRUE(ear.listen_until(15, [&] { return whole_fleet_heard(ear); }));
  for (const Service& service : services()) fleet.at(service.program).signal(SIGTERM);
  for (const Service& service : services())
    EXPECT_EQ(fleet.at(service.program).wait(kEnd), 0) << service.program;
  ear.listen(0.3);
  for (const char* node :
       {"conductor", "bathymetry", "vehicle-sim", "channel-server", "autopilot", "traffic"}) {
    EXPECT_EQ(ear.last_status[node].status_text.substr(0, 8), "stopped;") << node;
  }
}

struct Blow {
  std::string program;
  int signal;
};

class AfterABlow : public ::testing::TestWithParam<Blow> {};

// The bound of two seconds is the requirement's; while a process is away, the others' service goes on.
TEST_P(AfterABlow, ServiceResumesWithinTwoSecondsOfTheReturn) {
  const auto& [program, signal] = GetParam();
  BusEar ear;
  ProcessFleet fleet;
  ASSERT_TRUE(ear.listen_until(15, [&] { return whole_fleet_heard(ear); }));
  fleet.at(program).signal(signal);
  ASSERT_NE(fleet.at(program).wait(kEnd), -1);
  ear.listen(0.5);  // what was under way
  ear.clear();
  ear.listen(2.0);
  for (const Service& other : services()) {
    if (other.program == program) continue;
    EXPECT_TRUE(fleet.at(other.program).running()) << other.program;
    // Without vehicles there is no link to tell of, and nowhere to send from; all else goes on.
    const bool needs_vehicles =
        other.program != "halocline-conductor" && other.program != "halocline-bathymetry";
    const bool needs_server = other.program == "halocline-traffic";
    if (program == "halocline-vehicle-sim" && needs_vehicles) continue;
    if (program == "halocline-channel-server" && needs_server) continue;
    if (program == "halocline-traffic" && other.program == "halocline-channel-server") {
      EXPECT_GT(ear.heard("LINKS.alpha"), 0);
      continue;
    }
    EXPECT_TRUE(all_heard(ear, other.shown_by)) << other.program << " fell silent";
  }
  ear.clear();
  ear.tables.clear();
  fleet.start(program);
  EXPECT_TRUE(ear.listen_until(2.0, [&] {
    for (const Service& service : services()) {
      if (service.program == program && !all_heard(ear, service.shown_by)) return false;
    }
    return true;
  })) << program;
  ear.clear();
  EXPECT_TRUE(ear.listen_until(5.0, [&] { return whole_fleet_heard(ear); })) << "packets arrive again";
}

std::vector<Blow> blows() {
  std::vector<Blow> all;
  for (const Service& service : services()) {
    all.push_back({service.program, SIGKILL});
    all.push_back({service.program, SIGTERM});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(SeparateProcesses, AfterABlow, ::testing::ValuesIn(blows()), [](const auto& test) {
  std::string name =
      test.param.program.substr(10) + (test.param.signal == SIGKILL ? "_killed" : "_terminated");
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
});

}  // namespace
}  // namespace halocline
