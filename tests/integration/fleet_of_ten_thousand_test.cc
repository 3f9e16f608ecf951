// SPDX-License-Identifier: BSD-3-Clause
// As many vehicles as one process is asked for: docs/reliability.md, limits.
#include <cstdint>
#include <ctime>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "bus/messages/messages.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class FleetOfTenThousand : public testing::EmbeddedTest {
 protected:
  static constexpr int kSide = 100;
  static constexpr double kApartM = 1000;

  // A square kilometre each, in level water, with a modem that carries 2 km.
  ScenarioConfig config(int side = kSide) {
    const std::string path = log_path("fleet") + ".toml";
    {
      std::ofstream file(path);
      file << "[scenario]\nduration_s = 1\n[terrain]\nkind = 'flat'\nsize_north_m = 102e3\nsize_east_m = "
              "102e3\n"
              "spacing_m = 100\n[propagation]\nmodel = 'straight'\n[modem]\nprofile = 'micromodem-fsk'\n"
              "source_level_db = 132\n";
      for (int i = 0; i < side * side; ++i) {
        file << "[[vehicle]]\nname = 'auv-" << i + 1 << "'\nid = " << i + 1
             << "\nspeed_mps = 1.5\nstart_ned_m = [" << kApartM * (i / side - side / 2) << ", "
             << kApartM * (i % side - side / 2) << ", 20]\n";
      }
    }
    return load_scenario(path, {});
  }
};

// Processor time of this process, s.
double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// From the file to the end of the first second it costs what ten times as many vehicles may, and half as much
// again.
TEST_F(FleetOfTenThousand, StartsAndEveryVehicleIsThere) {
  const double begin_s = processor_s();
  run(config(32), "tenth");
  const double tenth_s = processor_s() - begin_s;
  const std::string log = run(config(), "fleet");
  EXPECT_LT((processor_s() - begin_s - tenth_s) / tenth_s, 15);
  std::set<std::int32_t> moved;
  for (const auto& [channel, state] : messages_in<vehicle_state_t>(log)) moved.insert(state.vehicle_id);
  EXPECT_EQ(moved.size(), 10'000u);
  // Each has rows of its eight neighbours, fewer at the edge, and knows of all others that they are out of
  // reach or further away.
  std::map<std::int32_t, std::set<std::int32_t>> peers;
  std::map<std::int32_t, int> others;
  for (const auto& [channel, table] : messages_in<link_table_t>(log)) {
    if (table.utime == 1'000'000) others[table.vehicle_id] = table.num_out_of_reach;
    for (const link_t& row : table.peers) peers[table.vehicle_id].insert(row.receiver_id);
  }
  EXPECT_EQ(peers.size(), 10'000u);
  for (const auto& [vehicle, of_vehicle] : peers) {
    for (const int neighbour : {vehicle - kSide, vehicle + kSide})
      if (neighbour >= 1 && neighbour <= kSide * kSide)
        EXPECT_TRUE(of_vehicle.contains(neighbour)) << vehicle;
    EXPECT_EQ(static_cast<int>(of_vehicle.size()) + others[vehicle], kSide * kSide - 1) << vehicle;
  }
}

}  // namespace
}  // namespace halocline::clients
