// SPDX-License-Identifier: BSD-3-Clause
// Vehicles of two tiles of the sea, with the programs of each tile on a host of its own, on a network that
// loses datagrams: with a multicast group a tile a host receives less, and the outcomes of packets and the
// link tables are the same. Runs inside a network namespace of its own (scripts/isolated).
#include "bus/runtime/tile_groups.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/node_identity.h"
#include "bus/transport/transport.h"
#include "core/sim_time.h"
#include "tests/integration/bus_listener.h"
#include "tests/integration/network_host.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using testing::Host;
using testing::Process;

constexpr std::size_t kVehicles = 10, kVehiclesOfTile = 5;

// What a program that takes every message, on a host of its own, receives.
class Listener : public testing::BusListener {
 public:
  Listener() : BusListener("listener") {
    bus::TileGroups::join_all(bus::effective_url(""), groups_);
    bus_.subscribe<packet_outcome_t>(bus::channels::kOutcome, [this](const packet_outcome_t& o) {
      outcomes[{o.source_id, o.departure_utime, o.receiver_id}] = {
          o.outcome, o.travel_time_s, o.range_m, o.transmission_loss_db, o.snr_db, o.success_probability};
    });
    bus_.subscribe<link_table_t>(bus::channels::kLinks,
                                 [this](std::string_view vehicle, const link_table_t& t) {
                                   if (t.num_peers == kVehiclesOfTile - 1)
                                     tables[std::string(vehicle)][t.utime] = t.peers.front().snr_db;
                                 });
  }

  using Packet = std::tuple<std::int32_t, std::int64_t, std::int32_t>;  // source, departure, receiver
  using Outcome = std::tuple<int, double, double, double, double, double>;
  std::map<Packet, Outcome> outcomes;
  std::map<std::string, std::map<std::int64_t, double>>
      tables;  // SNR of the first link once all are present, by vehicle and time

 private:
  bus::GroupMemberships groups_;
};

// Bytes of multicast that a host has received of groups that it has joined (proc(5), IpExt of
// /proc/net/netstat).
double multicast_bytes(const Host& host) {
  std::string command;
  for (const std::string& word : host.command({"/bin/cat", "/proc/net/netstat"})) command += word + " ";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  std::istringstream lines(text);
  std::string names, values;
  while (std::getline(lines, names) && std::getline(lines, values)) {
    std::istringstream name(names), value(values);
    for (std::string one, number; name >> one && value >> number;)
      if (one == "InMcastOctets") return std::stod(number);
  }
  ADD_FAILURE() << "no InMcastOctets in " << text;
  return 0;
}

struct HostRun {
  std::map<Listener::Packet, Listener::Outcome> outcomes;
  std::map<std::string, std::map<std::int64_t, double>> tables;
  double bytes_per_s = 0;  // received by the host of the second tile
  std::int64_t repaired = 0, lost = 0;
};

// The vehicles of each tile on a host of their own, with their channel server.
HostRun run_on(const std::vector<std::unique_ptr<Host>>& hosts, const std::string& tile_m) {
  std::vector<std::unique_ptr<Process>> processes;
  const auto start = [&](std::size_t host, const std::string& program, std::vector<std::string> more = {}) {
    std::vector<std::string> words{HALOCLINE_BIN_DIR "/halocline-" + program,
                                   HALOCLINE_TEST_DATA "/scenarios/two_tiles.toml", "--set",
                                   "bus.tile_m=" + tile_m};
    words.insert(words.end(), more.begin(), more.end());
    processes.push_back(std::make_unique<Process>(hosts.at(host)->command(words)));
  };
  Listener listener;
  start(0, "conductor");
  start(0, "bathymetry");
  start(0, "traffic");
  for (const std::size_t host : {0, 1}) {
    start(host, "vehicle-sim", {"--block", std::to_string(host) + "/2"});
    start(host, "channel-server", {"--shard", std::to_string(host) + "/2"});
  }
  EXPECT_TRUE(listener.listen_until(
      [&] { return listener.tables.size() == kVehicles && !listener.outcomes.empty(); }));
  const double before = multicast_bytes(*hosts.at(1));
  const SimTime begin = bus::steady_now();
  listener.listen_for(12);
  HostRun run;
  run.bytes_per_s = (multicast_bytes(*hosts.at(1)) - before) / (bus::steady_now() - begin).seconds();
  run.outcomes = listener.outcomes;
  run.tables = listener.tables;
  run.repaired = listener.counters().repaired;
  run.lost = listener.counters().lost;
  return run;
}

// Of what both have: how many, and how many of them are equal.
template <class Map>
std::pair<int, int> compared(const Map& one, const Map& other) {
  int common = 0, equal = 0;
  for (const auto& [key, value] : one) {
    const auto found = other.find(key);
    if (found == other.end()) continue;
    ++common;
    equal += found->second == value ? 1 : 0;
  }
  return {common, equal};
}

TEST(TileGroupsOnHosts, ReceiveLessAndChangeNoOutcome) {
  setenv("LCM_DEFAULT_URL", "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4194304", 1);
  const auto hosts = testing::hosts_on_a_bridge(2, 3);
  const HostRun whole = run_on(hosts, "0"), tiles = run_on(hosts, "10000");
  const auto [packets, equal_packets] = compared(whole.outcomes, tiles.outcomes);
  EXPECT_GT(packets, 20);
  EXPECT_EQ(equal_packets, packets);
  for (const auto& [vehicle, tables] : whole.tables) {
    const auto [common, equal] = compared(tables, tiles.tables.at(vehicle));
    EXPECT_GT(common, 20) << vehicle;
    EXPECT_EQ(equal, common) << vehicle;
  }
  for (const HostRun* run : {&whole, &tiles}) {
    EXPECT_GT(run->repaired, 0) << "nothing was lost: not much of a test";
    EXPECT_EQ(run->lost, 0);
  }
  // LINKS and SENSORS of the other tile make two fifths of all that is published.
  EXPECT_LT(tiles.bytes_per_s, 0.75 * whole.bytes_per_s);
  std::printf("received by the second host: %.0f bytes/s, with tiles %.0f\n", whole.bytes_per_s,
              tiles.bytes_per_s);
}

}  // namespace
}  // namespace halocline
