// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/room_rules.h"

#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/layers/room_table.h"
#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

bool allowed(std::string_view file, std::string_view path) { return objection(file, path).empty(); }

TEST(Layers, TheTreeIsReadFromGit) { EXPECT_GT(sources_below(HALOCLINE_SOURCE_DIR).size(), 1000U); }

TEST(Layers, NothingIncludesAnExample) {
  for (const SourceFile& source : sources_below(HALOCLINE_SOURCE_DIR)) {
    for (const Include& include : includes_of(source.text))
      EXPECT_FALSE(include.path.starts_with("clients/examples/")) << source.path << ":" << include.line;
  }
}

TEST(Layers, TheTreeKeepsItsRules) { EXPECT_THAT(breaches(sources_below(HALOCLINE_SOURCE_DIR)), IsEmpty()); }

TEST(Layers, ExemptionsAreFew) { EXPECT_LE(exemptions().size(), 12U); }

TEST(Layers, NoRoomsIncludeEachOtherInACircleAtAnyDepth) {
  const std::vector<SourceFile> sources = sources_below(HALOCLINE_SOURCE_DIR);
  for (const int depth : {1, 2, 3, 4}) EXPECT_EQ(room_cycle(sources, depth), "") << depth;
}

TEST(RoomRules, OnlyTheBusIncludesLcm) {
  EXPECT_TRUE(allowed("bus/transport/transport.h", "lcm/lcm-cpp.hpp"));
  for (const char* file : {"core/units.h", "acoustics/sea/noise.cc", "bathymetry/terrain/terrain.cc",
                           "channel_server/channel_server_node.h", "vehicle_sim/main.cc",
                           "conductor/paced_time.h", "clients/modem/modem_client.h"}) {
    EXPECT_FALSE(allowed(file, "lcm/lcm-cpp.hpp")) << file;
  }
}

TEST(RoomRules, TheForeignVehicleKnowsLcmAndMessageTypesAlone) {
  EXPECT_TRUE(allowed("clients/examples/cpp/foreign_vehicle.cc", "lcm/lcm-cpp.hpp"));
  EXPECT_TRUE(allowed("clients/examples/cpp/foreign_vehicle.cc", "halocline/vehicle_state_t.hpp"));
  EXPECT_FALSE(allowed("clients/examples/cpp/foreign_vehicle.cc", "core/sim_time.h"));
  EXPECT_FALSE(allowed("clients/examples/cpp/foreign_vehicle.cc", "bus/bus.h"));
}

TEST(RoomRules, MessageTypesStayOutOfPureFiles) {
  EXPECT_FALSE(allowed("acoustics/sea/noise.h", "halocline/link_t.hpp"));
  EXPECT_FALSE(allowed("channel_server/links/link_table.h", "bus/messages/messages.h"));
  EXPECT_FALSE(allowed("channel_server/links/link_table.h", "lcmtypes/halocline/link_t.hpp"));
  EXPECT_TRUE(allowed("channel_server/messages/link_messages.cc", "halocline/link_t.hpp"));
}

TEST(RoomRules, PureFilesHaveNoClockThreadFileOrLog) {
  for (const char* header : {"chrono", "thread", "mutex", "fstream", "filesystem", "iostream", "random",
                             "ctime", "time.h", "unistd.h", "sys/time.h", "spdlog/spdlog.h", "lcm/lcm.h"}) {
    EXPECT_FALSE(allowed("vehicle_sim/dynamics/hull_forces.cc", header)) << header;
    EXPECT_FALSE(allowed("core/random.cc", header)) << header;
  }
  EXPECT_TRUE(allowed("vehicle_sim/dynamics/hull_forces.cc", "cmath"));
}

TEST(RoomRules, PureFilesUseNoneOfThatThroughAnAllowedHeader) {
  EXPECT_EQ(impure_name("acoustics/sea/noise.cc", "std::snprintf(text, 3, format);  // not fopen"), "");
  EXPECT_EQ(impure_name("acoustics/sea/noise.cc", "auto* file = std::fopen(path, mode);"), "fopen");
  EXPECT_EQ(impure_name("core/random.cc", "std::random_device device;"), "random_device");
  EXPECT_EQ(impure_name("bus/runtime/node_process.cc", "std::chrono::steady_clock::now();"), "");
}

TEST(RoomRules, OnlyNamedReadersReadFiles) {
  EXPECT_TRUE(allowed("bathymetry/rasters/gdal_raster_source.cc", "gdal_priv.h"));
  EXPECT_TRUE(allowed("bathymetry/rasters/raster_loader.cc", "filesystem"));
  EXPECT_TRUE(allowed("acoustics/sea/profile_reader.cc", "fstream"));
  EXPECT_FALSE(allowed("bathymetry/terrain/terrain.cc", "gdal_priv.h"));
  EXPECT_FALSE(allowed("acoustics/sea/environment.cc", "fstream"));
}

TEST(RoomRules, FoldersStandOnThoseBelow) {
  EXPECT_FALSE(allowed("core/units.h", "acoustics/sea/noise.h"));
  EXPECT_FALSE(allowed("acoustics/sea/noise.h", "bathymetry/terrain/terrain.h"));
  EXPECT_FALSE(allowed("acoustics/sea/noise.h", "bus/config/config.h"));
  EXPECT_FALSE(allowed("bus/bus.h", "acoustics/sea/noise.h"));
  EXPECT_FALSE(allowed("vehicle_sim/world/vehicle_world.cc", "bathymetry/terrain/grid_trace.h"));
  EXPECT_FALSE(allowed("channel_server/packets/packet_medium.cc", "bathymetry/terrain/terrain.h"));
  EXPECT_TRUE(allowed("vehicle_sim/world/vehicle_world.cc", "bathymetry/terrain/terrain.h"));
  EXPECT_TRUE(allowed("channel_server/packets/packet_medium.cc", "acoustics/sea/noise.h"));
}

TEST(RoomRules, NodesStandOnTheirOwnPurePartAlone) {
  EXPECT_TRUE(allowed("bathymetry/bathymetry_node.cc", "bathymetry/terrain/terrain.h"));
  EXPECT_TRUE(allowed("bathymetry/bathymetry_node.cc", "bus/runtime/node.h"));
  EXPECT_TRUE(allowed("channel_server/channel_server_node.cc", "acoustics/modem/modem.h"));
  EXPECT_FALSE(allowed("channel_server/channel_server_node.cc", "vehicle_sim/dynamics/vehicle_model.h"));
  EXPECT_FALSE(allowed("vehicle_sim/vehicle_sim_node.cc", "channel_server/channel_server_node.h"));
  EXPECT_FALSE(allowed("conductor/main.cc", "bathymetry/bathymetry_node.h"));
  EXPECT_TRUE(allowed("vehicle_sim/main.cc", "bathymetry/bathymetry_config.h"));  // makes the same terrain
  EXPECT_FALSE(allowed("vehicle_sim/vehicle_sim_node.cc", "bathymetry/bathymetry_config.h"));
  EXPECT_FALSE(allowed("vehicle_sim/main.cc", "bathymetry/bathymetry_node.h"));
}

TEST(RoomRules, PureFilesKnowNoNodeOfTheirOwnFolder) {
  EXPECT_FALSE(allowed("bathymetry/terrain/terrain.cc", "bathymetry/bathymetry_config.h"));
  EXPECT_FALSE(allowed("bathymetry/terrain/terrain.cc", "bathymetry/bathymetry_node.h"));
}

TEST(RoomRules, OnlyTheCommandIncludesOtherProcessesNodes) {
  EXPECT_TRUE(allowed("simulation/composition.cc", "bathymetry/bathymetry_node.h"));
  EXPECT_FALSE(allowed("clients/modem/modem_client.h", "channel_server/channel_server_node.h"));
  EXPECT_FALSE(allowed("clients/onboard/autopilot/autopilot_node.h", "vehicle_sim/vehicle_sim_node.h"));
}

TEST(RoomRules, NoFileIncludesAMain) {
  for (const char* file :
       {"simulation/composition.cc", "tests/bus/bus_test.cc", "bathymetry/bathymetry_node.cc"}) {
    EXPECT_FALSE(allowed(file, "bathymetry/main.cc")) << file;
    EXPECT_FALSE(allowed(file, "bathymetry/main.h")) << file;
    EXPECT_FALSE(allowed(file, "bathymetry/terrain/terrain.cc")) << file;
  }
}

TEST(RoomRules, PathsStartAtTheRoot) {
  EXPECT_FALSE(allowed("acoustics/sea/noise.cc", "../bus/bus.h"));
  EXPECT_FALSE(allowed("acoustics/sea/noise.cc", "noise.h"));
}

TEST(RoomRules, AMacroInPlaceOfAPathIsRefused) {
  EXPECT_FALSE(allowed("acoustics/sea/noise.cc", "LCM_HEADER"));
  EXPECT_FALSE(allowed("clients/modem/modem_client.h", "LCM_HEADER"));
}

TEST(RoomRules, ProgramsKnowNoTests) {
  EXPECT_FALSE(allowed("simulation/composition.cc", "tests/support/csv.h"));
  EXPECT_FALSE(allowed("bus/bus.cc", "gtest/gtest.h"));
}

TEST(RoomRules, AnUnknownFolderHasNoRule) {
  EXPECT_THAT(objection("plugins/a.cc", "cmath"), HasSubstr("no rule"));
}

TEST(RoomRules, ABreachNamesFileLineAndReason) {
  const std::vector<SourceFile> tree{{"acoustics/sea/noise.cc", "\n# include <lcm/lcm-cpp.hpp>\n"},
                                     {"bus/bus.cc", "#include <lcm/lcm-cpp.hpp>\n"}};
  EXPECT_THAT(breaches(tree),
              ElementsAre("acoustics/sea/noise.cc:2: includes lcm/lcm-cpp.hpp: a pure file knows no LCM"));
}

TEST(RoomRules, EveryElementOfAPathIsChecked) {
  EXPECT_FALSE(allowed("acoustics/sea/noise.cc", "acoustics/rays/search/eigenray_search.h"));
  EXPECT_FALSE(allowed("bus/bus.cc", "bus/runtime/node.h"));
  EXPECT_FALSE(allowed("channel_server/packets/packet_medium.cc", "channel_server/links/link_table.h"));
  EXPECT_TRUE(allowed("acoustics/link/link_budget.cc", "acoustics/rays/search/eigenray_search.h"));
  EXPECT_THAT(objection("acoustics/ice/ice.cc", "cmath"), HasSubstr("no rule"));
}

TEST(RoomRules, AnObjectionStatesTheReasonOfTheRoom) {
  EXPECT_EQ(objection("bathymetry/terrain/terrain.cc", "acoustics/sea/noise.h"),
            "not a room to stand on: the terrain is a function of position alone");
}

TEST(RoomRules, ACircleOfRoomsIsFoundAtItsDepth) {
  const std::vector<SourceFile> tree{{"core/a.h", "#include \"bus/b.h\"\n"},
                                     {"bus/b.h", "#include \"clients/c.h\"\n"},
                                     {"clients/c.h", "#include \"core/a.h\"\n"}};
  EXPECT_EQ(room_cycle(tree, 1), "bus -> clients -> core -> bus");
  const std::vector<SourceFile> rooms{{"bus/logs/a.h", "#include \"bus/config/b.h\"\n"},
                                      {"bus/config/b.h", "#include \"bus/logs/a.h\"\n"}};
  EXPECT_EQ(room_cycle(rooms, 1), "");
  EXPECT_EQ(room_cycle(rooms, 2), "bus/config -> bus/logs -> bus/config");
}

TEST(RoomRules, ARoomThatIsOnlyStoodOnMakesNoCircle) {
  const std::vector<SourceFile> tree{{"bus/b.h", "#include \"core/a.h\"\n"},
                                     {"clients/c.h", "#include \"core/a.h\"\n#include \"bus/b.h\"\n"}};
  EXPECT_EQ(room_cycle(tree, 1), "");
}

}  // namespace
}  // namespace halocline::layers
