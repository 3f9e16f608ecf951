// SPDX-License-Identifier: BSD-3-Clause
#include "bus/config/scenario.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/transport/node_identity.h"

namespace halocline::bus {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Scenario read(const std::string& text) {
  auto file = ConfigFile::parse(text, "s.toml");
  Scenario scenario;
  file.read([&](ConfigVisitor& v) { visit(v, scenario); });
  file.check(true);
  return scenario;
}

std::string errors_of(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigErrors& errors) {
    return errors.what();
  }
  return "";
}

TEST(Scenario, ReadsItsVehicles) {
  const Scenario scenario = read(R"(
    [scenario]
    name = "two"
    seed = 42
    duration_s = 12.5
    [time]
    rate = 4
    clock_period_s = 0.05
    [[vehicle]]
    name = "alpha"
    id = 1
    start_ned_m = [1, 2, 3]
    heading_deg = 180
    [[vehicle]]
    name = "bravo"
    id = 7
    model = "fixed"
  )");
  EXPECT_EQ(scenario.seed, 42u);
  EXPECT_EQ(scenario.duration, SimDuration::from_milliseconds(12'500));
  EXPECT_EQ(scenario.clock_period, SimDuration::from_milliseconds(50));
  EXPECT_EQ(scenario.rate, 4);
  ASSERT_NE(scenario.find("bravo"), nullptr);
  EXPECT_EQ(scenario.find("bravo")->id, 7);
  EXPECT_EQ(scenario.find("charlie"), nullptr);
  EXPECT_NEAR(scenario.vehicles[0].heading_rad, 3.141592653589793, 1e-15);
}

TEST(ScenarioNames, AreSafeForFilesAndTerminals) {
  for (const char* name : {"../../x", ".hidden", "a/b", "", "-rf", " a", "a ", "\\u001b[2J", "\\n"})
    EXPECT_THAT(errors_of("[scenario]\nname = \"" + std::string(name) + "\""),
                HasSubstr("s.toml:2: scenario.name"))
        << name;
  EXPECT_THAT(errors_of("[scenario]\nname = \"" + std::string(65, 'a') + "\""), HasSubstr("1 to 64"));
  EXPECT_THAT(errors_of("[scenario]\ndescription = \"\\u001b[2J\""), HasSubstr("control characters"));
  for (const char* name : {"a", "ocean_observatory", "Figure 4.1-b"})
    EXPECT_EQ(errors_of("[scenario]\nname = \"" + std::string(name) + "\""), "") << name;
}

TEST(Scenario, TheHostsToAcceptAreAddresses) {
  EXPECT_EQ(read("[bus]\naccept = \"10.0.3.7, 10.0.4.0/24\"").accept, "10.0.3.7, 10.0.4.0/24");
  EXPECT_THAT(errors_of("[bus]\naccept = \"ship\""), HasSubstr("s.toml:2: bus.accept"));
}

TEST(Scenario, AVehicleNeedsANameAndAnId) {
  EXPECT_THAT(errors_of("[[vehicle]]\nid = 1"), HasSubstr("vehicle[0].name is missing"));
  EXPECT_THAT(errors_of("[[vehicle]]\nname = 'a'"), HasSubstr("vehicle[0].id is missing"));
  EXPECT_THAT(errors_of("[[vehicle]]\nname = 'Not Valid'\nid = 1"), HasSubstr("s.toml:2: vehicle[0].name"));
  EXPECT_THAT(errors_of("[[vehicle]]\nname = 'a'\nid = 0"), HasSubstr("s.toml:3: vehicle[0].id is 0"));
}

TEST(Scenario, NamesAndIdsAreUnique) {
  const std::string errors =
      errors_of("[[vehicle]]\nname='a'\nid=1\n[[vehicle]]\nname='a'\nid=2\n[[vehicle]]\nname='c'\nid=1");
  EXPECT_THAT(errors, HasSubstr("s.toml:5: vehicle[1].name is 'a'; an earlier vehicle has this name"));
  EXPECT_THAT(errors, HasSubstr("s.toml:9: vehicle[2].id is 1; an earlier vehicle has this id"));
}

TEST(Scenario, AnEmptyRunAndAStandingClockAreErrors) {
  EXPECT_THAT(errors_of("[scenario]\nduration_s = 0"), HasSubstr("duration_s is 0"));
  EXPECT_THAT(errors_of("[time]\nrate = 0"), HasSubstr("time.rate is 0"));
  EXPECT_THAT(errors_of("[scenario]\nseed = -1"), HasSubstr("scenario.seed is -1"));
}

TEST(Scenario, ReadsItsTideAndHowModemsAreHeld) {
  const Scenario scenario = read(R"(
    [scenario]
    sea_surface_z_m = -0.5
    [[tide]]
    amplitude_m = 1.5
    phase_deg = 180
    [[tide]]
    amplitude_m = 0.2
    period_s = 86400
    [[vehicle]]
    name = "alpha"
    id = 1
    start_ned_m = [0, 0, 3]
    mount = "floating"
    [[vehicle]]
    name = "bravo"
    id = 2
    model = "fixed"
    start_ned_m = [0, 0, 3]
    mount = "fixed"
  )");
  ASSERT_EQ(scenario.tide.constituents.size(), 2u);
  EXPECT_EQ(scenario.tide.constituents[0].period_s, kLunarSemidiurnalS);
  EXPECT_NEAR(scenario.tide.constituents[0].phase_rad, 3.14159265, 1e-8);
  EXPECT_EQ(scenario.tide.constituents[1].period_s, 86'400);
  EXPECT_NEAR(scenario.surface_z_m(0), -0.5 + 1.5 - 0.2, 1e-12);  // low water of M2
  EXPECT_EQ(scenario.vehicles[0].mount, Mount::kFloating);
  EXPECT_EQ(scenario.vehicles[1].mount, Mount::kFixed);
  EXPECT_NEAR(scenario.start_ned_m(scenario.vehicles[0]).z(), 3 + 1.3, 1e-12);
  EXPECT_EQ(scenario.start_ned_m(scenario.vehicles[1]).z(), 3);
  EXPECT_THAT(errors_of("[[tide]]\namplitude_m = 30\n"), HasSubstr("amplitude_m"));
}

TEST(Scenario, SurfaceCraftBuoysAndDriftersFloatUnlessToldOtherwise) {
  const auto mount_of = [](const std::string& lines) {
    return read("[[vehicle]]\nname = \"one\"\nid = 1\n" + lines).vehicles.front().mount;
  };
  for (const std::string model : {"surface-craft", "buoy", "drifter"}) {
    EXPECT_EQ(mount_of("model = \"" + model + "\"\n"), Mount::kFloating);
    EXPECT_EQ(mount_of("model = \"" + model + "\"\nmount = \"fixed\"\n"), Mount::kFixed);
  }
  EXPECT_EQ(mount_of("model = \"fixed\"\n"), Mount::kFixed);
  EXPECT_EQ(mount_of(""), Mount::kFixed);
}

TEST(Scenario, WhatIsWrittenReadsBack) {
  Scenario scenario =
      read("[scenario]\nname='x'\nseed=9000000000000000\n[[vehicle]]\nname='a'\nid=2147483647");
  const std::string text = to_toml([&](ConfigVisitor& v) { visit(v, scenario); }, true);
  const Scenario back = read(text);
  EXPECT_EQ(back.seed, scenario.seed);
  EXPECT_EQ(back.vehicles[0].id, 2147483647);
  EXPECT_EQ(back.duration, scenario.duration);
}

TEST(Scenario, ARasterIsCarriedOnlyWhereTheSeabedIsMadeFromIt) {
  const std::string raster = ::testing::TempDir() + "scenario-raster-" + std::to_string(getpid()) + ".asc";
  std::ofstream(raster) << "ncols 1\n";
  const auto carried = [&](const std::string& terrain) {
    auto file = ConfigFile::parse(terrain + "path = \"" + raster + "\"\n", "s.toml");
    Scenario scenario;
    file.read([&](ConfigVisitor& v) { visit(v, scenario); });
    file.check(/*whole_file=*/false);
    return configuration_of(file);
  };
  EXPECT_THAT(carried("[terrain]\nkind = \"raster\"\n[terrain.raster]\n"), HasSubstr("ncols 1"));
  EXPECT_THAT(carried("[terrain]\nkind = \"flat\"\n[[terrain.nested]]\n[terrain.nested.raster]\n"),
              HasSubstr("ncols 1"));
  for (const char* kind : {"kind = \"flat\"\n", ""})
    EXPECT_THAT(carried("[terrain]\n" + std::string(kind) + "[terrain.raster]\n"), Not(HasSubstr("ncols 1")));
  std::filesystem::remove(raster);
}

TEST(SessionOf, IsPositiveAndTheSameForTheSameIncarnation) {
  std::set<std::int64_t> sessions;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const std::int64_t session = session_of(seed, "channel-server");
    EXPECT_GT(session, 0);
    EXPECT_EQ(session, session_of(seed, "channel-server"));
    sessions.insert(session);
  }
  EXPECT_EQ(sessions.size(), 1000u);
  EXPECT_NE(session_of(1, "a"), session_of(1, "b"));
}

}  // namespace
}  // namespace halocline::bus
