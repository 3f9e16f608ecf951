// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/tile_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/frames.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=1";

TileGroups tiles_of(const std::vector<Vec3>& starts, const std::string& url = kUrl) {
  Scenario scenario;
  scenario.tile_m = 1000;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    VehicleEntry& vehicle = scenario.vehicles.emplace_back();
    vehicle.name = "v" + std::to_string(i);
    vehicle.start_ned_m = starts[i];
  }
  return {url, scenario};
}

TEST(TileGroups, AVehicleHasTheGroupOfTheTileThatItStartsIn) {
  const TileGroups tiles =
      tiles_of({{0, 0, 10}, {999, 999, 10}, {1000, 0, 10}, {0, 1000, 10}, {-1, -1, 10}, {8000, -8000, 10}});
  EXPECT_EQ(tiles.group_of("LINKS.v0"), 1);
  EXPECT_EQ(tiles.group_of("LINKS.v1"), 1);
  EXPECT_EQ(tiles.group_of("LINKS.v2"), 9);
  EXPECT_EQ(tiles.group_of("LINKS.v3"), 2);
  EXPECT_EQ(tiles.group_of("LINKS.v4"), TileGroups::kCount);
  EXPECT_EQ(tiles.group_of("LINKS.v5"), 1);  // eight apart
}

TEST(TileGroups, RepairsGoWhereTheirChannelDoesAndAllElseGoesToTheGroupOfTheBus) {
  const TileGroups tiles = tiles_of({{0, 0, 10}});
  for (const char* channel : {"SENSORS.v0", "COMMAND.v0", "REPAIR.LINKS.v0"})
    EXPECT_EQ(tiles.group_of(channel), 1) << channel;
  for (const char* channel :
       {"STATE.v0", "SEND.v0", "OUTCOME", "CLOCK", "LINKS.other", "LINKS.", "REPAIR.STATE.v0"})
    EXPECT_EQ(tiles.group_of(channel), 0) << channel;
}

TEST(TileGroups, WhoSubscribesToAVehicleReceivesItsTileAndWhoSubscribesToAFamilyAll) {
  const TileGroups tiles = tiles_of({{0, 0, 10}, {1000, 0, 10}, {0, 1000, 10}});
  EXPECT_THAT(tiles.groups_of({{"SENSORS\\.v1"}, {"STATE\\..*"}, {"CLOCK"}}), ElementsAre(9));
  EXPECT_THAT(tiles.groups_of({{"STATE\\..*"}, {"LINKS\\.other"}}), IsEmpty());
  EXPECT_THAT(tiles.groups_of({{"LINKS\\..*"}}), ElementsAre(1, 2, 9));
  EXPECT_THAT(tiles.groups_of({{".*"}}), ElementsAre(1, 2, 9));
  EXPECT_THAT(tiles.groups_of({{"S[A-Z]+.*"}}), ElementsAre(1, 2, 9));
}

TEST(TileGroups, AGroupHasTheAddressOfTheBusPlusItsNumberOnTheSamePort) {
  const TileGroups tiles = tiles_of({{0, 0, 10}});
  EXPECT_EQ(tiles.url_of(1), "udpm://239.255.76.68:7667?ttl=1");
  EXPECT_EQ(tiles_of({}, "udpm://239.0.0.250:7?ttl=0").url_of(9), "udpm://239.0.1.3:7?ttl=0");
}

TEST(TileGroups, AUrlWithoutRoomForThemIsRefused) {
  for (const char* url : {"memq://", "udpm://", "udpm://239.255.255.250:7667", "udpm://10.0.0.1:7667"})
    EXPECT_THROW(tiles_of({}, url), InvalidArgument) << url;
}

}  // namespace
}  // namespace halocline::bus
