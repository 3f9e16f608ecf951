// SPDX-License-Identifier: BSD-3-Clause
// Messages per second through LCM as the bus uses it: published, walked, decoded, checked and handled.
//
// The udpm case needs a private loopback bus: scripts/bench gives it one. It sends in rounds that the receive
// buffer holds, waits for each round to be received, and fails when one message is lost.
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include "bus/bus.h"
#include "bus/transport/transport.h"

namespace halocline::bus {
namespace {

vehicle_state_t state() {
  vehicle_state_t message{};
  message.vehicle_id = 1;
  message.session = 1;
  message.orientation_wxyz[0] = 1;
  return message;
}

// One round: `count` states out, all of them in.
bool exchange(Bus& bus, lcm::LCM& lcm, std::int64_t count, std::int64_t& received) {
  vehicle_state_t message = state();
  const std::int64_t goal = received + count;
  for (std::int64_t i = 0; i < count; ++i) {
    message.sequence = goal - count + i;
    bus.publish("STATE.a", message);
  }
  while (received < goal) {
    if (lcm.handleTimeout(1000) <= 0) return false;
  }
  return true;
}

void run(benchmark::State& bench, const std::string& url) {
  const auto lcm = open_transport(url);
  Bus bus(*lcm, {"bench", 1});
  std::int64_t received = 0;
  bus.subscribe<vehicle_state_t>(channels::kState,
                                 [&](std::string_view, const vehicle_state_t&) { ++received; });
  for (auto _ : bench) {
    if (!exchange(bus, *lcm, bench.range(0), received)) return bench.SkipWithError("a message was lost");
  }
  bench.counters["messages"] = benchmark::Counter(static_cast<double>(received), benchmark::Counter::kIsRate);
  bench.counters["gaps"] = static_cast<double>(bus.counters().gaps);
}

void messages_through_memq(benchmark::State& bench) { run(bench, "memq://"); }
void messages_through_udpm(benchmark::State& bench) { run(bench, effective_url("")); }
BENCHMARK(messages_through_memq)->Arg(1)->Arg(100);
BENCHMARK(messages_through_udpm)->Arg(1)->Arg(100)->UseRealTime();

void check_and_decode_a_state(benchmark::State& bench) {
  const vehicle_state_t message = state();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  for (auto _ : bench) {
    vehicle_state_t decoded;
    benchmark::DoNotOptimize(misfit(wire_layout<vehicle_state_t>(), bytes.data(), bytes.size()));
    benchmark::DoNotOptimize(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())));
    benchmark::DoNotOptimize(problem_in(decoded));
  }
}
BENCHMARK(check_and_decode_a_state);

}  // namespace
}  // namespace halocline::bus
