// SPDX-License-Identifier: BSD-3-Clause
// What the monitor costs beside a fleet: its share of a core, with pages open.
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

#include "tests/viewer/monitor_program.h"

namespace halocline::monitor {
namespace {

// Seconds that a process has computed.
double cpu_s(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::vector<std::string> all{std::istream_iterator<std::string>(fields), {}};
  constexpr std::size_t kUser = 11, kSystem = 12;
  return (std::stod(all[kUser]) + std::stod(all[kSystem])) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

// Vehicles at 10 Hz on the bus for ten seconds, and so many pages that read what comes.
void monitor_beside_a_fleet(benchmark::State& state) {
  constexpr double kSeconds = 10;
  for ([[maybe_unused]] const auto turn : state) {
    testing::Program program;
    const testing::Fleet fleet(static_cast<int>(state.range(0)));
    std::vector<std::unique_ptr<testing::Page>> pages;
    for (int i = 0; i < state.range(1); ++i) pages.push_back(std::make_unique<testing::Page>(program.port()));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double before_s = cpu_s(program.process().pid());
    double frames = 0;
    const auto begin = std::chrono::steady_clock::now();
    const auto passed_s = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    while (passed_s() < kSeconds) {
      if (pages.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
      for (const auto& page : pages) frames += page->next_frame_s() >= 0 ? 1 : 0;
    }
    const double whole_s = passed_s();
    state.SetIterationTime(whole_s);
    state.counters["core_percent"] = 100 * (cpu_s(program.process().pid()) - before_s) / whole_s;
    state.counters["frames_a_second"] =
        pages.empty() ? 0 : frames / whole_s / static_cast<double>(pages.size());
    state.counters["resident_mb"] = program.resident_mb();
  }
}
BENCHMARK(monitor_beside_a_fleet)
    ->ArgNames({"vehicles", "pages"})
    ->Args({3, 1})
    ->Args({100, 0})
    ->Args({100, 1})
    ->Args({100, 4})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace halocline::monitor

BENCHMARK_MAIN();
