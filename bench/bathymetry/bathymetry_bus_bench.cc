// SPDX-License-Identifier: BSD-3-Clause
// Round trips to the bathymetry service: a batch of rays out, its reply back, over memq and over udpm on
// loopback.
//
// The service runs in a thread of its own with its own lcm::LCM, as in a process of its own; memq has one
// queue, so there client and service take turns in one thread. Rays are those of the mix of
// bathymetry_bench.cc. Run it on a private bus (scripts/isolated). Targets over udpm: 99 % of round trips
// within 150 us for 1 ray, 350 us for 512.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "bathymetry/bathymetry_node.h"
#include "bathymetry/ray_service.h"
#include "bus/messages/channels.h"
#include "bus/runtime/node_process.h"
#include "bus/runtime/time_source.h"
#include "bus/transport/transport.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "tests/bathymetry/ray_queries.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"

namespace halocline::bathymetry {
namespace {

using Clock = std::chrono::steady_clock;

const std::shared_ptr<const Terrain>& rugged_terrain() {
  static const auto terrain = std::make_shared<const Terrain>(testing::rugged_grid(2048));
  return terrain;
}

RayBatch draw_batch(std::size_t rays) {
  RayBatch batch;
  for (std::uint64_t n = 0; n < rays; ++n) {
    const auto draw = [&](std::uint32_t what, double low, double high) {
      return low +
             (high - low) * uniform_at({.seed = 1, .purpose = purpose_of("bench"), .who = what, .which = n});
    };
    const double x = draw(0, 0, 20'000), y = draw(1, 0, 20'000), azimuth = draw(2, -3.1416, 3.1416);
    const double down = n % 3 == 0 ? 1.5 : n % 3 == 1 ? 0.7854 : draw(3, -0.035, 0.035);
    batch.rays.push_back(
        {{x, y, rugged_terrain()->depth_at(x, y).z_m - draw(5, 5, 250)},
         {std::cos(azimuth) * std::cos(down), std::sin(azimuth) * std::cos(down), std::sin(down)},
         n % 3 == 0 ? 500.0 : 10'000.0});
  }
  return batch;
}

// Its own time is the wall's: the service answers at once, whatever the time.
class SteadyTime : public bus::TimeSource {
 public:
  std::optional<SimTime> now(SimTime steady) override { return steady; }
  SimTime steady_at(SimTime sim) const override { return sim; }
};

// Publishes a query and waits; a lost one is published again and counted.
class Client {
 public:
  explicit Client(lcm::LCM& lcm) : lcm_(lcm), bus_(lcm, {"bench", 1}) {
    bus_.subscribe<ray_reply_t>(bus::channels::kRayReply.of("bench"),
                                [this](const ray_reply_t& reply) { answered_ = reply.request_id; });
  }
  void query(const RayBatch& batch) {
    bus_.publish(bus::channels::kRayQuery, to_message({0, "bench", ++request_}, batch, Vec3::Zero()));
  }
  bool await(int milliseconds) {
    while (answered_ != request_) {
      if (lcm_.handleTimeout(milliseconds) <= 0) return false;
    }
    return true;
  }

 private:
  lcm::LCM& lcm_;
  bus::Bus bus_;
  std::int64_t request_ = 0, answered_ = 0;
};

void report(benchmark::State& state, std::vector<double>& microseconds, std::int64_t lost) {
  std::sort(microseconds.begin(), microseconds.end());
  const auto percentile = [&](double share) {
    return microseconds[static_cast<std::size_t>(share * static_cast<double>(microseconds.size() - 1))];
  };
  state.counters["p50_us"] = percentile(0.5);
  state.counters["p99_us"] = percentile(0.99);
  state.counters["lost"] = static_cast<double>(lost);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void round_trip_udpm(benchmark::State& state) {
  const std::string url = bus::effective_url("udpm://239.255.76.67:7667?ttl=0");
  std::atomic<bool> stop{false};
  const auto service_lcm = bus::open_transport(url);
  BathymetryNode node(*service_lcm, {"bathymetry", 1}, rugged_terrain(), "bench");
  std::thread service([&] {
    SteadyTime time;
    bus::run_node(*service_lcm, node, time, [&] { return stop.load(); });
  });
  const auto client_lcm = bus::open_transport(url);
  Client client(*client_lcm);
  const RayBatch batch = draw_batch(static_cast<std::size_t>(state.range(0)));
  std::vector<double> microseconds;
  std::int64_t lost = 0;
  client.query(batch);
  client.await(200);
  for (auto _ : state) {
    const auto start = Clock::now();
    client.query(batch);
    lost += !client.await(200);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    microseconds.push_back(seconds * 1e6);
    state.SetIterationTime(seconds);
  }
  stop = true;
  service.join();
  report(state, microseconds, lost);
}
BENCHMARK(round_trip_udpm)->ArgName("rays")->Arg(1)->Arg(144)->Arg(512)->Arg(1024)->UseManualTime();

void round_trip_memq(benchmark::State& state) {
  const auto lcm = bus::open_transport("memq://");
  BathymetryNode node(*lcm, {"bathymetry", 1}, rugged_terrain(), "bench");
  Client client(*lcm);
  const RayBatch batch = draw_batch(static_cast<std::size_t>(state.range(0)));
  std::vector<double> microseconds;
  for (auto _ : state) {
    const auto start = Clock::now();
    client.query(batch);
    lcm->handleTimeout(0);  // the query reaches the service
    node.step({SimTime(), SimTime(), true});
    client.await(0);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    microseconds.push_back(seconds * 1e6);
    state.SetIterationTime(seconds);
  }
  report(state, microseconds, 0);
}
BENCHMARK(round_trip_memq)->ArgName("rays")->Arg(1)->Arg(144)->Arg(512)->Arg(1024)->UseManualTime();

}  // namespace
}  // namespace halocline::bathymetry
