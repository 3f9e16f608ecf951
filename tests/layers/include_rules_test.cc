#include "tests/layers/include_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace halocline::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> paths_in(std::string_view source) {
  std::vector<std::string> paths;
  for (const Include& include : includes_of(source)) paths.push_back(include.path);
  return paths;
}

bool allowed(std::string_view file, std::string_view path) { return objection(file, path).empty(); }

TEST(Layers, TheTreeKeepsItsRules) { EXPECT_THAT(breaches(sources_below(HALOCLINE_SOURCE_DIR)), IsEmpty()); }

TEST(Layers, NoFoldersIncludeEachOtherInACircle) {
  EXPECT_EQ(folder_cycle(sources_below(HALOCLINE_SOURCE_DIR)), "");
}

TEST(Layers, TheTreeIsThere) { EXPECT_GT(sources_below(HALOCLINE_SOURCE_DIR).size(), 50u); }

TEST(IncludeScan, ReadsQuotesAndBrackets) {
  EXPECT_THAT(paths_in("#include \"bus/bus.h\"\n#include <lcm/lcm-cpp.hpp>\n"),
              ElementsAre("bus/bus.h", "lcm/lcm-cpp.hpp"));
}

TEST(IncludeScan, ReadsEverySpelling) {
  for (const char* line : {"  #include <lcm/lcm.h>", "# include <lcm/lcm.h>", "#\tinclude<lcm/lcm.h>",
                           "#include/**/<lcm/lcm.h>", "/* why */ #include <lcm/lcm.h>  // for a clock",
                           "#include \\\n  <lcm/lcm.h>", "#\\\ninclude <lcm/lcm.h>", "%:include <lcm/lcm.h>",
                           "#import <lcm/lcm.h>", "#include <lcm/lcm.h>\r"}) {
    EXPECT_THAT(paths_in(line), ElementsAre("lcm/lcm.h")) << line;
  }
}

TEST(IncludeScan, LeavesCommentsOut) {
  EXPECT_THAT(paths_in("// #include <thread>\n/* #include <thread>\n#include <chrono>\n*/\nint a;  /**/\n"),
              IsEmpty());
}

TEST(IncludeScan, CountsLinesThroughComments) {
  const auto includes =
      includes_of("/* one\ntwo */\n\n#include <lcm/lcm.h>\n#include \\\n <a>\n#include <b>\n");
  ASSERT_EQ(includes.size(), 3u);
  EXPECT_EQ(includes[0].line, 4);
  EXPECT_EQ(includes[1].line, 5);
  EXPECT_EQ(includes[2].line, 7);
}

TEST(IncludeScan, SurvivesAnUnfinishedCommentAndAnUnfinishedPath) {
  EXPECT_THAT(paths_in("#include <a"), ElementsAre("<a"));
  EXPECT_THAT(paths_in("/*"), IsEmpty());
  EXPECT_THAT(paths_in("//"), IsEmpty());
  EXPECT_THAT(paths_in("#include"), IsEmpty());
}

TEST(IncludeRules, OnlyTheBusIncludesLcm) {
  EXPECT_TRUE(allowed("bus/transport.h", "lcm/lcm-cpp.hpp"));
  for (const char* file : {"core/units.h", "acoustics/sea/noise.cc", "bathymetry/terrain/terrain.cc",
                           "channel_server/channel_server_node.h", "vehicle_sim/main.cc",
                           "conductor/paced_time.h", "clients/modem/modem_client.h"}) {
    EXPECT_FALSE(allowed(file, "lcm/lcm-cpp.hpp")) << file;
  }
}

TEST(IncludeRules, TheForeignVehicleKnowsLcmAndMessageTypesAlone) {
  EXPECT_TRUE(allowed("clients/foreign_vehicle/main.cc", "lcm/lcm-cpp.hpp"));
  EXPECT_TRUE(allowed("clients/foreign_vehicle/main.cc", "halocline/vehicle_state_t.hpp"));
  EXPECT_FALSE(allowed("clients/foreign_vehicle/main.cc", "core/sim_time.h"));
  EXPECT_FALSE(allowed("clients/foreign_vehicle/main.cc", "bus/bus.h"));
}

TEST(IncludeRules, MessageTypesStayOutOfPureFiles) {
  EXPECT_FALSE(allowed("acoustics/sea/noise.h", "halocline/link_t.hpp"));
  EXPECT_FALSE(allowed("channel_server/links/link_table.h", "bus/messages.h"));
  EXPECT_FALSE(allowed("channel_server/links/link_table.h", "lcmtypes/halocline/link_t.hpp"));
  EXPECT_TRUE(allowed("channel_server/link_messages.cc", "halocline/link_t.hpp"));
}

TEST(IncludeRules, PureFilesHaveNoClockThreadFileOrLog) {
  for (const char* header : {"chrono", "thread", "mutex", "fstream", "filesystem", "iostream", "random",
                             "ctime", "time.h", "unistd.h", "sys/time.h", "spdlog/spdlog.h", "lcm/lcm.h"}) {
    EXPECT_FALSE(allowed("vehicle_sim/dynamics/hull_forces.cc", header)) << header;
    EXPECT_FALSE(allowed("core/random.cc", header)) << header;
  }
  EXPECT_TRUE(allowed("vehicle_sim/dynamics/hull_forces.cc", "cmath"));
}

TEST(IncludeRules, PureFilesUseNoneOfThatThroughAnAllowedHeader) {
  EXPECT_EQ(impure_name("acoustics/sea/noise.cc", "std::snprintf(text, 3, format);  // not fopen"), "");
  EXPECT_EQ(impure_name("acoustics/sea/noise.cc", "auto* file = std::fopen(path, mode);"), "fopen");
  EXPECT_EQ(impure_name("core/random.cc", "std::random_device device;"), "random_device");
  EXPECT_EQ(impure_name("bus/runtime/node_process.cc", "std::chrono::steady_clock::now();"), "");
}

TEST(IncludeRules, OnlyNamedReadersReadFiles) {
  EXPECT_TRUE(allowed("bathymetry/rasters/raster_source.cc", "gdal_priv.h"));
  EXPECT_TRUE(allowed("bathymetry/terrain_loader.cc", "filesystem"));
  EXPECT_TRUE(allowed("acoustics/sea/profile_reader.cc", "fstream"));
  EXPECT_FALSE(allowed("bathymetry/terrain/terrain.cc", "gdal_priv.h"));
  EXPECT_FALSE(allowed("acoustics/sea/environment.cc", "fstream"));
}

TEST(IncludeRules, FoldersStandOnThoseBelow) {
  EXPECT_FALSE(allowed("core/units.h", "acoustics/sea/noise.h"));
  EXPECT_FALSE(allowed("acoustics/sea/noise.h", "bathymetry/terrain/terrain.h"));
  EXPECT_FALSE(allowed("acoustics/sea/noise.h", "bus/config/config.h"));
  EXPECT_FALSE(allowed("bus/bus.h", "acoustics/sea/noise.h"));
  EXPECT_FALSE(allowed("vehicle_sim/world/vehicle_world.cc", "bathymetry/terrain/ray_trace.h"));
  EXPECT_FALSE(allowed("channel_server/medium.cc", "bathymetry/terrain/terrain.h"));
  EXPECT_TRUE(allowed("vehicle_sim/world/vehicle_world.cc", "bathymetry/terrain/terrain.h"));
  EXPECT_TRUE(allowed("channel_server/medium.cc", "acoustics/sea/noise.h"));
}

TEST(IncludeRules, NodesStandOnTheirOwnPurePartAlone) {
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

TEST(IncludeRules, PureFilesKnowNoNodeOfTheirOwnFolder) {
  EXPECT_FALSE(allowed("bathymetry/terrain/terrain.cc", "bathymetry/bathymetry_config.h"));
  EXPECT_FALSE(allowed("bathymetry/terrain/terrain.cc", "bathymetry/bathymetry_node.h"));
}

TEST(IncludeRules, OnlyTheCommandIncludesOtherProcessesNodes) {
  EXPECT_TRUE(allowed("clients/command/run.cc", "bathymetry/bathymetry_node.h"));
  EXPECT_FALSE(allowed("clients/modem/modem_client.h", "channel_server/channel_server_node.h"));
  EXPECT_FALSE(allowed("clients/autopilot/autopilot_node.h", "vehicle_sim/vehicle_sim_node.h"));
}

TEST(IncludeRules, NobodyIncludesAMain) {
  for (const char* file :
       {"clients/command/run.cc", "tests/bus/bus_test.cc", "bathymetry/bathymetry_node.cc"}) {
    EXPECT_FALSE(allowed(file, "bathymetry/main.cc")) << file;
    EXPECT_FALSE(allowed(file, "bathymetry/main.h")) << file;
    EXPECT_FALSE(allowed(file, "bathymetry/terrain/terrain.cc")) << file;
  }
}

TEST(IncludeRules, PathsStartAtTheRoot) {
  EXPECT_FALSE(allowed("acoustics/sea/noise.cc", "../bus/bus.h"));
  EXPECT_FALSE(allowed("acoustics/sea/noise.cc", "noise.h"));
}

TEST(IncludeRules, AMacroInPlaceOfAPathIsRefused) {
  EXPECT_FALSE(allowed("acoustics/sea/noise.cc", "LCM_HEADER"));
  EXPECT_FALSE(allowed("clients/modem/modem_client.h", "LCM_HEADER"));
}

TEST(IncludeRules, ProgramsKnowNoTests) {
  EXPECT_FALSE(allowed("clients/command/run.cc", "tests/support/csv.h"));
  EXPECT_FALSE(allowed("bus/bus.cc", "gtest/gtest.h"));
}

TEST(IncludeRules, AnUnknownFolderHasNoRule) {
  EXPECT_THAT(objection("plugins/a.cc", "cmath"), HasSubstr("no rule"));
}

TEST(IncludeRules, ABreachNamesFileLineAndReason) {
  const std::vector<SourceFile> tree{{"acoustics/sea/noise.cc", "\n# include <lcm/lcm-cpp.hpp>\n"},
                                     {"bus/bus.cc", "#include <lcm/lcm-cpp.hpp>\n"}};
  EXPECT_THAT(breaches(tree),
              ElementsAre("acoustics/sea/noise.cc:2: includes lcm/lcm-cpp.hpp: a pure file knows no LCM"));
}

TEST(IncludeRules, ACircleOfFoldersIsFound) {
  const std::vector<SourceFile> tree{{"core/a.h", "#include \"bus/b.h\"\n"},
                                     {"bus/b.h", "#include \"clients/c.h\"\n"},
                                     {"clients/c.h", "#include \"core/a.h\"\n"}};
  EXPECT_EQ(folder_cycle(tree), "bus -> clients -> core -> bus");
}

TEST(IncludeRules, AFolderThatIsOnlyStoodOnMakesNoCircle) {
  const std::vector<SourceFile> tree{{"bus/b.h", "#include \"core/a.h\"\n"},
                                     {"clients/c.h", "#include \"core/a.h\"\n#include \"bus/b.h\"\n"}};
  EXPECT_EQ(folder_cycle(tree), "");
}

}  // namespace
}  // namespace halocline::layers
