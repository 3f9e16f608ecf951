// SPDX-License-Identifier: BSD-3-Clause
// How fast logs are read and replayed, and how many packets go through one channel server on a bus.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "bench/simulation/recorded_run.h"
#include <benchmark/benchmark.h>

#include "bus/logs/log_reader.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/transport/event_log.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/channel_server_node.h"
#include "core/sim_time.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"
#include "simulation/embedded_run.h"
#include "simulation/replay_node.h"

namespace halocline::clients {
namespace {

ScenarioConfig scenario(const char* name) {
  return load_scenario(std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/" + name + ".toml",
                       {"scenario.duration_s=120"});
}

// Items are seconds of the log; terrain and water are made before.
void replay(benchmark::State& state, const char* name) {
  const ScenarioConfig config = scenario(name);
  const std::string path = recorded(config);
  for (auto _ : state) {
    state.PauseTiming();
    lcm::LCM lcm("memq://");
    LogReader log(path);
    ReplayNode node(lcm, {"replay", 1}, read_recording(log, config.scenario, played_in(config)));
    Composition nodes(lcm, config, Composition::kReplay, &node);
    EmbeddedRun run{.end = SimTime() + config.scenario.duration, .log_path = temporary("-again.lcm")};
    run.quiet = true;
    state.ResumeTiming();
    run_embedded(nodes.nodes(), run);
  }
  state.SetItemsProcessed(state.iterations() * 120);
  std::filesystem::remove(temporary("-again.lcm"));
}
BENCHMARK_CAPTURE(replay, seamount, "seamount")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, harbour, "harbour")->Unit(benchmark::kMillisecond);

// Items are events.
void read_log(benchmark::State& state) {
  const std::string path = recorded(scenario("harbour"));
  std::int64_t events = 0;
  for (auto _ : state) {
    LogReader log(path);
    for (LoggedEvent event; log.next(event);) ++events;
    state.SetBytesProcessed(state.bytes_processed() + log.bytes());
  }
  state.SetItemsProcessed(events);
}
BENCHMARK(read_log)->Unit(benchmark::kMillisecond);

// Every vehicle lies still, publishes its state five times a second and broadcasts once a second for a
// minute.
Recording chatter(int vehicles) {
  Recording recording;
  recording.end = SimTime::from_seconds(60);
  for (int tick = 0; tick < 300; ++tick) {
    for (int i = 1; i <= vehicles; ++i) {
      vehicle_state_t at{};
      at.utime = tick * 200'000;
      at.vehicle_id = i;
      at.position_ned_m[0] = (i * 733) % 3000;
      at.position_ned_m[1] = (i * 1151) % 3000;
      at.position_ned_m[2] = 30 + (i * 17) % 80;
      at.orientation_wxyz[0] = 1;
      recording.events.push_back({SimTime::from_utime(at.utime), "STATE.auv-" + std::to_string(i), at});
      if (tick % 5 != 1) continue;
      modem_send_t send{};
      send.utime = at.utime + 1'000'000 * i / (vehicles + 1);
      send.packet_sequence = tick;
      send.source_id = i;
      send.payload_size = 32;
      send.payload.resize(32);
      recording.events.push_back({SimTime::from_utime(at.utime), "SEND.auv-" + std::to_string(i), send});
    }
  }
  return recording;
}

// Straight paths, few tables. Items are packets; each has an outcome at every other vehicle.
void packets_through_a_channel_server(benchmark::State& state) {
  bus::set_log_level(bus::LogLevel::kSilent);
  const auto vehicles = static_cast<int>(state.range(0));
  channel_server::ChannelServerConfig config;
  config.propagation.model = channel_server::PropagationModel::kStraight;
  config.rules.link_period = SimDuration::from_seconds(10);
  config.modem.modem.bit_rate_bps = 10'000;  // a packet ends long before its sender's next
  const Recording recording = chatter(vehicles);
  std::int64_t outcomes = 0;
  for (auto _ : state) {
    lcm::LCM lcm("memq://");
    ReplayNode node(lcm, {"replay", 1}, recording);
    const auto server = channel_server::make_channel_server(lcm, {"channel-server", 1}, config, {});
    bus::LockstepRunner runner({&node, server.get()});
    runner.set_listener([&](SimTime, std::string_view channel, std::span<const std::uint8_t>) {
      outcomes += channel == bus::channels::kOutcome ? 1 : 0;
    });
    runner.run_until(recording.end);
  }
  state.SetItemsProcessed(state.iterations() * vehicles * 60);
  state.counters["outcomes"] = benchmark::Counter(static_cast<double>(outcomes), benchmark::Counter::kIsRate);
}
BENCHMARK(packets_through_a_channel_server)
    ->ArgName("vehicles")
    ->Arg(3)
    ->Arg(20)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halocline::clients
