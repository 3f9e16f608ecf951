// SPDX-License-Identifier: BSD-3-Clause
// How far from its instant a packet is delivered in real time: a channel server in a process of its own, over
// udpm.
//
// This program is the conductor and both vehicles; so simulation time is its own steady clock, and the error
// of a delivery is the instant at which RECEIVE is handled here less the utime that RECEIVE states. Run it on
// a private bus (scripts/isolated). Aim on an idle machine: 50 % within 0.2 ms, 99 % within 2 ms.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "bus/runtime/node_process.h"
#include "bus/transport/transport.h"
#include "core/sim_time.h"
#include "halocline/sweep/child_program.h"

namespace halocline {
namespace {

namespace channels = bus::channels;

constexpr const char* kScenario = R"([propagation]
model = "straight"
[modem]
packet_overhead_s = 0.01
bit_rate_bps = 20000.0
[[vehicle]]
name = "a"
id = 1
[[vehicle]]
name = "b"
id = 2
)";

class Relay {
 public:
  Relay()
      : lcm_(bus::open_transport(bus::effective_url("udpm://239.255.76.67:7667?ttl=0"))),
        bus_(*lcm_, {"bench", 1}) {
    scenario_ =
        (std::filesystem::temp_directory_path() / ("relay-" + std::to_string(getpid()) + ".toml")).string();
    std::ofstream(scenario_) << kScenario;
    const std::string server =
        std::filesystem::read_symlink("/proc/self/exe").parent_path().string() + "/halocline-channel-server";
    server_ = std::thread([this, server] {
      clients::run_program({{server, scenario_, "--log-level", "error"}, "/dev/null"},
                           [this] { return stop_.load(); });
    });
    bus_.subscribe<modem_receive_t>(channels::kReceive.of("b"), [this](const modem_receive_t& packet) {
      error_s_ = (bus::steady_now() - SimTime::from_utime(packet.utime)).seconds();
      arrived_ = packet.packet_sequence;
    });
    while (!deliver(1.0)) {
    }
  }
  ~Relay() {
    stop_ = true;
    server_.join();
    std::filesystem::remove(scenario_);
  }

  // Sends one packet and waits for it; false when it did not come in time.
  bool deliver(double timeout_s) {
    modem_send_t send{};
    send.utime = (bus::steady_now() + SimDuration::from_milliseconds(20)).to_utime();
    send.session = 1;
    send.packet_sequence = ++sequence_;
    send.source_id = 1;
    send.payload_size = 16;
    send.payload.resize(16);
    send_states();
    bus_.publish(channels::kSend.of("a"), send);
    const SimTime end = bus::steady_now() + SimDuration::from_seconds(timeout_s);
    while (arrived_ != sequence_ && bus::steady_now() < end) {
      send_states();
      lcm_->handleTimeout(5);
    }
    return arrived_ == sequence_;
  }
  double error_s() const { return error_s_; }

 private:
  // Ten times a second CLOCK and both states.
  void send_states() {
    const SimTime now = bus::steady_now();
    if (now < next_) return;
    next_ = now + SimDuration::from_milliseconds(100);
    sim_clock_t clock{};
    clock.utime = now.to_utime();
    clock.session = 1;
    clock.sequence = clocks_++;
    clock.clock_rate = 1;
    clock.clock_step_us = 100'000;
    bus_.publish(channels::kClock, clock);
    for (const int id : {1, 2}) {
      vehicle_state_t state{};
      state.utime = now.to_utime();
      state.vehicle_id = id;
      state.position_ned_m[0] = id * 50.0;
      state.position_ned_m[2] = 20;
      state.orientation_wxyz[0] = 1;
      bus_.publish(channels::kState.of(id == 1 ? "a" : "b"), state);
    }
  }

  std::unique_ptr<lcm::LCM> lcm_;
  bus::Bus bus_;
  std::string scenario_;
  std::atomic<bool> stop_{false};
  std::thread server_;
  SimTime next_;
  std::int64_t clocks_ = 0, sequence_ = 0, arrived_ = 0;
  double error_s_ = 0;
};

void delivery_error(benchmark::State& state) {
  Relay relay;
  std::vector<double> errors_us;
  std::int64_t lost = 0;
  for (auto _ : state) {
    if (relay.deliver(2)) {
      errors_us.push_back(std::abs(relay.error_s()) * 1e6);
      state.SetIterationTime(std::abs(relay.error_s()));
    } else {
      ++lost;
    }
  }
  std::sort(errors_us.begin(), errors_us.end());
  const auto percentile = [&](double share) {
    return errors_us.at(static_cast<std::size_t>(share * static_cast<double>(errors_us.size() - 1)));
  };
  state.counters["p50_us"] = percentile(0.5);
  state.counters["p99_us"] = percentile(0.99);
  state.counters["max_us"] = errors_us.back();
  state.counters["lost"] = static_cast<double>(lost);
}
BENCHMARK(delivery_error)->Iterations(400)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace halocline
