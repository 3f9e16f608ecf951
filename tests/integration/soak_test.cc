// SPDX-License-Identifier: BSD-3-Clause
// Long runs need no more memory than short ones: hours of simulated time, as fast as they compute, with
// the bytes in use compared between the first half and the second. Not a test of time.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "bus/logs/log_recorder.h"
#include "bus/logs/log_series.h"
#include "bus/runtime/lockstep_runner.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class SoakTest : public testing::EmbeddedTest {
 protected:
  static double heap_bytes() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
  }
  // Largest use at any of the instants examined, every 60 s, from one to the other.
  double max_in_use(bus::LockstepRunner& runner, bus::LogRecorder& log, double from_s, double to_s) {
    double most = 0;
    for (double t = from_s; t <= to_s; t += 60) {
      runner.run_until(SimTime::from_seconds(t));
      log.flush();
      most = std::max(most, heap_bytes());
    }
    return most;
  }
  struct Use {
    double first_half = 0, second_half = 0;
  };
  // After `settled_s`, for which caches fill, two halves of equal length. The log rotates and is deleted
  // behind it.
  Use bytes_in_use(const ScenarioConfig& config, double settled_s, double half_s) {
    lcm::LCM lcm("memq://");
    Composition all(lcm, config, Composition::kRun);
    bus::LockstepRunner runner(all.nodes());
    bus::LogRecorder recorder(log_path("soak"), {2'000'000, SimDuration(), 2});
    runner.set_listener([&](SimTime at, std::string_view channel, std::span<const std::uint8_t> message) {
      recorder.record(at, channel, message);
    });
    max_in_use(runner, recorder, 60, settled_s);
    Use use;
    use.first_half = max_in_use(runner, recorder, settled_s + 60, settled_s + half_s);
    use.second_half = max_in_use(runner, recorder, settled_s + half_s + 60, settled_s + 2 * half_s);
    EXPECT_GT(recorder.parts(), 10);
    EXPECT_EQ(bus::parts_of_log(log_path("soak")).size(), 2u);
    return use;
  }
};

// What is kept of the latest thousand packets (modem clients) fills within the time to settle: every vehicle
// sends once a second.
std::vector<std::string> busy(int vehicles) {
  std::vector<std::string> overrides{"propagation.model=\"straight\""};
  for (int i = 0; i < vehicles; ++i)
    overrides.push_back("vehicle." + std::to_string(i) + ".traffic.period_s=1.0");
  return overrides;
}

// Over 100 messages a simulated second: a byte kept of each would be 0.3 MB a half.
constexpr double kMaxGrowth_bytes = 100'000;

TEST_F(SoakTest, HoursOfAHarbourNeedNoMoreMemoryInTheirSecondHalf) {
  const Use use = bytes_in_use(load("harbour", busy(5)), 3600, 3600);
  EXPECT_LT(use.second_half - use.first_half, kMaxGrowth_bytes)
      << use.first_half << " to " << use.second_half;
}

// What was found along rays is forgotten (LinkSearches::kKept); the rest of an hour fills what is bounded.
// The heap's own bytes grow in steps of its caches: 2 % of what is in use.
TEST_F(SoakTest, HoursAlongRaysNeedNoMoreMemoryThanTheFirst) {
  const Use use = bytes_in_use(load("harbour", {}), 3600, 3600);
  EXPECT_LT(use.second_half, 1.02 * use.first_half) << use.first_half << " to " << use.second_half;
}

TEST_F(SoakTest, HoursOfRangesAndPositionsNeedNoMoreMemoryInTheirSecondHalf) {
  const Use use = bytes_in_use(load("ranging", busy(0)), 7200, 7200);
  EXPECT_LT(use.second_half - use.first_half, kMaxGrowth_bytes)
      << use.first_half << " to " << use.second_half;
}

}  // namespace
}  // namespace halocline::clients
