// SPDX-License-Identifier: BSD-3-Clause
// What hosts feel of the modem gateway: how long a command waits for its echo while a simulation runs, and
// what idle modem interfaces cost. To be run on a private bus (scripts/isolated). Aims on an idle machine: 5
// ms at the median, 20 % of a core.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "tests/clients/modem_gateway/host.h"
#include "tests/support/process.h"
#include "tests/support/working_folder.h"

namespace halocline::modem_gateway {
namespace {

using std::chrono::steady_clock;

constexpr int kFirstPort = 21'000;

// Vehicles on a grid, each with a modem interface; where `moves`, they run on and talk every ten seconds.
std::string scenario_of(int vehicles, bool moves) {
  std::ostringstream text;
  text << "[scenario]\nduration_s = 100000\n[terrain]\nkind = \"flat\"\n[terrain.flat]\ndepth_m = 200.0\n"
          "[environment]\nprofile = \"isovelocity\"\n[propagation]\nmodel = \"straight\"\n";
  for (int i = 1; i <= vehicles; ++i) {
    text << "[[vehicle]]\nname = \"v" << i << "\"\nid = " << i << "\nstart_ned_m = [" << 300.0 * (i % 5)
         << ", " << 300.0 * (i / 5) << ", 60.0]\n";
    if (!moves) text << "model = \"fixed\"\n";
    text << "[vehicle.modem]\nprofile = \"micromodem-psk-1\"\n";
    if (moves) text << "[vehicle.traffic]\nperiod_s = 10\nstart_s = " << 0.5 * i << "\n";
  }
  for (int i = 1; i <= vehicles; ++i)
    text << "[[modem_interface]]\nvehicle = \"v" << i
         << "\"\nkind = \"micromodem\"\nplace = \"tcp:" << kFirstPort + i << "\"\n";
  return text.str();
}

// Programs of a run in real time, and a host at each modem interface.
class Run {
 public:
  explicit Run(const std::vector<std::string>& programs, int vehicles, bool moves) {
    std::ofstream("modem_interfaces.toml") << scenario_of(vehicles, moves);
    for (const std::string& program : programs) start({program, "modem_interfaces.toml"});
    connect(vehicles);
  }
  // All in one process.
  explicit Run(int vehicles) {
    std::ofstream("modem_interfaces.toml") << scenario_of(vehicles, true);
    start({"halocline", "run", "modem_interfaces.toml", "--rate", "1", "--out", "run", "--no-csv",
           "--no-report", "--quiet"});
    connect(vehicles);
  }

  testing::Host& host(std::size_t i) { return *hosts_[i]; }
  // Of the program that was started last, seconds that it has computed.
  double cpu_s() const {
    std::ifstream in("/proc/" + std::to_string(processes_.back()->pid()) + "/stat");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    const std::vector<std::string> all{std::istream_iterator<std::string>(fields), {}};
    constexpr std::size_t kUser = 11, kSystem = 12;
    return (std::stod(all.at(kUser)) + std::stod(all.at(kSystem))) /
           static_cast<double>(::sysconf(_SC_CLK_TCK));
  }

 private:
  void start(std::vector<std::string> command) {
    command[0] = std::string(HALOCLINE_BIN_DIR) + "/" + command[0];
    processes_.push_back(std::make_unique<halocline::testing::Process>(command));
  }
  void connect(int vehicles) {
    for (int i = 1; i <= vehicles; ++i) {
      const std::string place = "tcp:" + std::to_string(kFirstPort + i);
      for (;;) {
        auto host = std::make_unique<testing::Host>(place);
        if (host->is_open()) {
          hosts_.push_back(std::move(host));
          break;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    }
    // Until simulation time passes at the last modem interface.
    std::string text;
    while (text.find("00:00:03Z") == std::string::npos) {
      hosts_.back()->write("$CCTMQ,0\r\n");
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      text = hosts_.back()->read();
    }
  }

  halocline::testing::TemporaryFolder folder_;
  std::vector<std::unique_ptr<halocline::testing::Process>> processes_;
  std::vector<std::unique_ptr<testing::Host>> hosts_;
};

// Seconds from a command to its echo.
double echo_s(testing::Host& host) {
  host.read();
  const auto begin = steady_clock::now();
  host.write("$CCCFG,CST,1\r\n");
  std::string text;
  while (text.find("CACFG,CST,1") == std::string::npos) {
    text += host.read();
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  return std::chrono::duration<double>(steady_clock::now() - begin).count();
}

void command_echo(benchmark::State& state, const std::vector<std::string>& programs) {
  constexpr int kVehicles = 20;
  const auto run =
      programs.empty() ? std::make_unique<Run>(kVehicles) : std::make_unique<Run>(programs, kVehicles, true);
  std::vector<double> all_s;
  for ([[maybe_unused]] const auto turn : state) {
    all_s.push_back(echo_s(run->host(all_s.size() % kVehicles)));
    state.SetIterationTime(all_s.back());
    std::this_thread::sleep_for(std::chrono::microseconds(7300));  // at other instants of the steps
  }
  std::sort(all_s.begin(), all_s.end());
  state.counters["median_ms"] = 1000 * all_s[all_s.size() / 2];
  state.counters["p99_ms"] = 1000 * all_s[all_s.size() * 99 / 100];
}
const std::vector<std::string> kAll{"halocline-conductor", "halocline-vehicle-sim",
                                    "halocline-channel-server", "halocline-traffic",
                                    "halocline-modem-gateway"};
BENCHMARK_CAPTURE(command_echo, separate_processes, kAll)->Iterations(1000)->UseManualTime();
BENCHMARK_CAPTURE(command_echo, one_process, {})->Iterations(1000)->UseManualTime();

// Modem interfaces with a host each that does nothing, of vehicles at 10 Hz.
void idle_interfaces(benchmark::State& state) {
  constexpr double kSeconds = 10;
  for ([[maybe_unused]] const auto turn : state) {
    const Run run({"halocline-conductor", "halocline-vehicle-sim", "halocline-channel-server",
                   "halocline-modem-gateway"},
                  static_cast<int>(state.range(0)), false);
    const double before_s = run.cpu_s();
    std::this_thread::sleep_for(std::chrono::duration<double>(kSeconds));
    state.SetIterationTime(kSeconds);
    state.counters["core_percent"] = 100 * (run.cpu_s() - before_s) / kSeconds;
  }
}
BENCHMARK(idle_interfaces)->ArgName("interfaces")->Arg(200)->Iterations(1)->UseManualTime();

}  // namespace
}  // namespace halocline::modem_gateway
