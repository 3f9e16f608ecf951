// SPDX-License-Identifier: BSD-3-Clause
// A hub and stations on a ring round it, in lockstep in this process, without capture: the water that
// textbooks assume.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/messages/channels.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/transport/event_log.h"
#include "core/sim_time.h"
#include "simulation/composition.h"

namespace halocline::networks::testing {

inline constexpr const char* kModem = "bit_rate_bps = 1000.0\nmax_payload_bytes = 32768\n";

struct Ring {
  std::string mac = "aloha", settings = {};  // of [network], besides
  int stations = 50;
  double radius_m = 75;        // 0.05 s to the hub, 0.1 s from side to side
  double packet_s = 1;         // the hub's packets have this duration
  double load = 0.5;           // packets offered in a packet's duration, by all stations together
  int packets = 4000;          // offered in all, on average
  std::string modem = kModem;  // keys of [modem], besides
  std::uint64_t seed = 1;
  double nearest_m = 0;  // above 0: stations lie from here to radius_m, not all at radius_m
};

// Requests and tones are no longer, data are.
inline constexpr double kLongestControl_s = 0.1;

// What a run came to.
struct Results {
  std::int64_t offered = 0, sent = 0, delivered = 0, dropped = 0;
  double duration_s = 0, packet_s = 0;
  std::map<int, std::int64_t> outcomes;  // at the hub, of data for it
  std::vector<double> delays_s;
  std::vector<int> hops;

  double g() const { return static_cast<double>(sent) * packet_s / duration_s; }
  double attempts() const { return static_cast<double>(offered) * packet_s / duration_s; }
  double s() const { return static_cast<double>(delivered) * packet_s / duration_s; }
  double share() const { return static_cast<double>(delivered) / static_cast<double>(sent); }
};

inline constexpr const char* kWater = R"(
[scenario]
duration_s = {duration}
seed = {seed}
[time]
clock_period_s = 60.0
[terrain]
kind = "flat"
[terrain.flat]
depth_m = 100.0
[environment]
profile = "isovelocity"
isovelocity_mps = 1500.0
[propagation]
model = "straight"
fading = "none"
[modem]
center_frequency_hz = 5000.0
bandwidth_hz = 1000.0
error_model = "bfsk"
{modem}
[channel_server]
link_rate_hz = 0.017
state_timeout_s = 100.0
reach = "none"
[vehicle_sim]
state_rate_hz = 0.1
sensor_rate_hz = 0.1
)";

inline std::string vehicle(const std::string& name, int id, double north_m, double east_m,
                           const std::string& keys = "") {
  return fmt::format(
      "[[vehicle]]\nname = \"{}\"\nid = {}\nmodel = \"fixed\"\nstart_ned_m = [{:.3f}, {:.3f}, 50.0]\n{}\n",
      name, id, north_m, east_m, keys);
}

inline std::string scenario_of(const Ring& ring) {
  const int data_bytes = static_cast<int>(std::lround(ring.packet_s * 1000 / 8)) - 21;
  const double interval_s = ring.stations * ring.packet_s / ring.load;
  std::string text = fmt::format(kWater, fmt::arg("duration", ring.packets * ring.packet_s / ring.load),
                                 fmt::arg("seed", ring.seed), fmt::arg("modem", ring.modem));
  text += fmt::format("[network]\nmac = \"{}\"\ninterval_s = {}\ndata_bytes = {}\n{}\n", ring.mac, interval_s,
                      data_bytes, ring.settings);
  text += vehicle("hub", 1, 0, 0);
  for (int i = 0; i < ring.stations; ++i) {
    const double angle = 2 * std::numbers::pi * i / ring.stations;
    const double share =
        ring.stations > 1 ? static_cast<double>(i * 7 % ring.stations) / (ring.stations - 1) : 0;
    const double range_m =
        ring.nearest_m > 0 ? ring.nearest_m * std::pow(ring.radius_m / ring.nearest_m, share) : ring.radius_m;
    text += vehicle("s" + std::to_string(i), i + 2, range_m * std::cos(angle), range_m * std::sin(angle),
                    "[vehicle.network]\ndestination = \"hub\"");
  }
  return text;
}

inline Results run_text(const std::string& text) {
  bus::set_log_level(bus::LogLevel::kSilent);
  static int number = 0;
  const auto folder = std::filesystem::path(::testing::TempDir());
  const std::string file = folder / fmt::format("network-{}-{}.toml", getpid(), ++number);
  std::ofstream(file) << text;
  const clients::ScenarioConfig config = clients::load_scenario(file, {});
  std::filesystem::remove(file);
  lcm::LCM lcm("memq://");
  clients::Composition all(lcm, config, clients::Composition::kRun);
  Results results;
  results.duration_s = config.scenario.duration.seconds();
  bus::LockstepRunner runner(all.nodes());
  runner.set_listener([&](SimTime, std::string_view channel, std::span<const std::uint8_t> bytes) {
    if (channel.starts_with(bus::channels::kNetworkEvent.prefix)) {
      network_event_t m;
      ASSERT_EQ(bus::decode(bytes, m), "");
      results.offered += m.network_event == network_event_t::OFFERED;
      results.dropped += m.network_event == network_event_t::DROPPED;
      if (m.network_event != network_event_t::DELIVERED) return;
      ++results.delivered;
      results.delays_s.push_back(static_cast<double>(m.utime - m.offered_utime) * 1e-6);
      results.hops.push_back(m.hop_count);
    } else if (channel.starts_with(bus::channels::kReceipt.prefix)) {
      modem_receipt_t m;
      ASSERT_EQ(bus::decode(bytes, m), "");
      if (m.receipt_result != modem_receipt_t::ACCEPTED) return;
      ++results.sent;
      results.packet_s = std::max(results.packet_s, m.duration_s);
    } else if (channel == bus::channels::kOutcome) {
      packet_outcome_t m;
      ASSERT_EQ(bus::decode(bytes, m), "");
      if (m.receiver_id == 1 && m.destination_id == 1 && m.duration_s > kLongestControl_s)
        ++results.outcomes[m.outcome];
    }
  });
  runner.run_until(SimTime() + config.scenario.duration);
  runner.stop();
  return results;
}

inline Results run(const Ring& ring) { return run_text(scenario_of(ring)); }

}  // namespace halocline::networks::testing
