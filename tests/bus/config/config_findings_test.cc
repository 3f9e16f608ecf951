// SPDX-License-Identifier: BSD-3-Clause
// What is found beyond single keys: near keys, files that cannot be read, and findings of other rooms.
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "core/files/file_path.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

void visit_sea(ConfigVisitor& v) {
  double number = 0;
  std::string text;
  v.section("environment", "", [&](ConfigVisitor& s) {
    s.number("wind_mps", number, {0, 60, "m/s", ""});
    s.number("shipping", number, {0, 1, "", ""});
    s.text("profile_file", text, {}, "");
  });
  v.list(
      "vehicle", "", 0, [](std::size_t) {},
      [&](ConfigVisitor& item, std::size_t) {
        item.text("name", text, {}, "");
        if (!item.given("mission")) return;
        item.section("mission", "", [&](ConfigVisitor& m) {
          m.number("speed_mps", number, {0, 5, "m/s", ""});
        });
      });
}

std::vector<std::string> errors_of(ConfigFile file,
                                   const std::function<void(ConfigVisitor&)>& body = visit_sea) {
  file.read(body);
  try {
    file.check(/*whole_file=*/true);
  } catch (const ConfigErrors& errors) {
    return errors.lines();
  }
  return {};
}

std::vector<std::string> errors_in(const std::string& text) {
  return errors_of(ConfigFile::parse(text, "sea.toml"));
}

TEST(UnknownKey, SuggestsTheNearestKeyOfItsTable) {
  EXPECT_THAT(errors_in("[environment]\nwimd_mps = 1\n"),
              ElementsAre("sea.toml:2: environment.wimd_mps is unknown; did you mean environment.wind_mps?"));
  EXPECT_THAT(errors_in("[environment]\nshpiping = 1\n"), ElementsAre(HasSubstr("environment.shipping?")));
  EXPECT_THAT(errors_in("[enviroment]\n"), ElementsAre(HasSubstr("did you mean environment?")));
}

TEST(UnknownKey, SuggestsASectionThatNoVehicleHas) {
  EXPECT_THAT(errors_in("[[vehicle]]\nname='a'\n[[vehicle]]\nname='b'\n[vehicle.misson]\n"),
              ElementsAre(HasSubstr("did you mean vehicle[1].mission?")));
}

TEST(UnknownKey, SuggestsTheTableInWhichTheKeyIsKnown) {
  EXPECT_THAT(errors_in("[[vehicle]]\nname='a'\n[vehicle.mission]\nwind_mps = 3\n"),
              ElementsAre(HasSubstr("did you mean environment.wind_mps?")));
}

TEST(UnknownKey, NamesItsNewNameWhereItWasRenamed) {
  EXPECT_THAT(errors_in("[[door]]\nvehicle = 'a'\n"),
              ElementsAre(HasSubstr("door is unknown; it is now modem_interface")));
}

TEST(UnknownKey, SuggestsNothingForAnotherWord) {
  EXPECT_THAT(
      errors_in("[environment]\nsalinity = 1\n"),
      ElementsAre(
          "sea.toml:2: environment.salinity is unknown; the keys of a scenario are in docs/scenarios.md"));
}

TEST(UnreadableFile, IsReportedWithTheReason) {
  const std::string folder = ::testing::TempDir() + "findings";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/water.csv") << "0,1500\n";
  std::ofstream(folder + "/sea.toml") << "[environment]\nprofile_file = \"water.csv\"\n";
  const auto reads_file = [](ConfigVisitor& v) {
    v.section("environment", "", [](ConfigVisitor& s) {
      FilePath file;
      s.file("profile_file", file, FileNames::kFiles, "");
      require_readable(s, "profile_file", file);
    });
  };
  const auto errors = [&](const std::vector<std::string>& overrides) {
    return errors_of(ConfigFile::load(folder + "/sea.toml", overrides), reads_file);
  };
  EXPECT_THAT(errors({}), IsEmpty());
  std::filesystem::remove(folder + "/water.csv");
  EXPECT_THAT(errors({}),
              ElementsAre(folder + "/sea.toml:2: environment.profile_file is 'water.csv'; cannot read " +
                          folder + "/water.csv: there is no such file"));
  EXPECT_THAT(errors({"environment.profile_file='.'"}), ElementsAre(HasSubstr("it is a folder")));
  EXPECT_THAT(errors({"environment.profile_file=''"}),
              ElementsAre(HasSubstr("allowed is the name of a file")));
  std::filesystem::remove_all(folder);
}

TEST(UnreadableFile, AScenarioThatIsMissingIsNamedWithTheReason) {
  EXPECT_THROW(
      {
        try {
          ConfigFile::load("nowhere.toml");
        } catch (const ConfigErrors& errors) {
          EXPECT_THAT(errors.lines(),
                      ElementsAre(HasSubstr("nowhere.toml: cannot be read: there is no such file")));
          throw;
        }
      },
      ConfigErrors);
}

TEST(Finding, NamesFileLineKeyAndValue) {
  auto file = ConfigFile::parse("[environment]\nwind_mps = 7\n[[vehicle]]\nname='a'\n", "sea.toml",
                                {"environment.shipping=0.5"});
  file.read(visit_sea);
  file.check(/*whole_file=*/true);
  file.refuse("environment.wind_mps", "7", "too windy");
  file.refuse("environment.shipping", "0.5", "too loud");
  file.refuse("vehicle.0.mission.speed_mps", "1.5", "too fast");
  file.warn("vehicle.0.name", "a", "short");
  EXPECT_THAT(file.warnings(), ElementsAre("sea.toml:4: vehicle[0].name is 'a'; short"));
  try {
    file.check_findings();
    FAIL() << "nothing was refused";
  } catch (const ConfigErrors& errors) {
    EXPECT_THAT(errors.lines(),
                ElementsAre("sea.toml:2: environment.wind_mps is 7; too windy",
                            "command line: environment.shipping is 0.5; too loud",
                            "sea.toml:3: vehicle[0].mission.speed_mps is 1.5 by default; too fast"));
  }
}

struct Bottom {
  std::string kind = "flat";
  double depth = 100, slope = 0;
  std::string file;
};

void visit_bottom(ConfigVisitor& v, Bottom& b) {
  v.section("bottom", "", [&](ConfigVisitor& s) {
    s.text("kind", b.kind, {"flat", "slope", "raster"}, "");
    s.number("depth_m", b.depth, {0, 11000, "m", ""});
    s.when(b.kind == "slope", "kind = \"slope\"", [&] { s.number("slope", b.slope, {-1, 1, "", "steep"}); });
    s.when(b.kind == "raster", "kind = \"raster\"",
           [&] { s.section("raster", "", [&](ConfigVisitor& r) { r.text("path", b.file, {}, ""); }); });
  });
}

std::vector<std::string> warnings_in(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
  auto file = ConfigFile::parse(text, "sea.toml", overrides);
  Bottom bottom;
  file.read([&](ConfigVisitor& v) { visit_bottom(v, bottom); });
  file.check(/*whole_file=*/true);
  return file.warnings();
}

TEST(KeyWithoutEffect, IsWarnedOfWithTheChoiceThatItLacks) {
  EXPECT_THAT(warnings_in("[bottom]\nkind = 'flat'\nslope = 0.1\n"),
              ElementsAre("sea.toml:3: bottom.slope is 0.1; it has no effect, it counts only with kind = "
                          "\"slope\""));
  EXPECT_THAT(warnings_in("", {"bottom.slope=0.1"}),
              ElementsAre(HasSubstr("command line: bottom.slope is 0.1; it has no effect")));
}

TEST(KeyWithoutEffect, IsSilentWhereItCountsOrIsNotGiven) {
  EXPECT_THAT(warnings_in("[bottom]\nkind = 'slope'\nslope = 0.1\n"), IsEmpty());
  EXPECT_THAT(warnings_in("[bottom]\nkind = 'raster'\n[bottom.raster]\npath = 'a.tif'\n"), IsEmpty());
  EXPECT_THAT(warnings_in("[bottom]\ndepth_m = 3\n"), IsEmpty());
}

TEST(KeyWithoutEffect, OfATableWarnsOnceForTheTable) {
  EXPECT_THAT(warnings_in("[bottom.raster]\npath = 'a.tif'\n"),
              ElementsAre(HasSubstr("bottom.raster is a table; it has no effect, it counts only with kind = "
                                    "\"raster\"")));
}

TEST(KeyWithoutEffect, IsCheckedAllTheSame) {
  EXPECT_THROW(warnings_in("[bottom]\nslope = 7\n"), ConfigErrors);
}

TEST(KeyWithoutEffect, IsWarnedOfOnceHoweverOftenItIsRead) {
  auto file = ConfigFile::parse("[bottom]\nslope = 0.1\n", "sea.toml");
  Bottom bottom;
  for (int i = 0; i < 2; ++i) {
    file.read([&](ConfigVisitor& v) { visit_bottom(v, bottom); });
    file.check(/*whole_file=*/true);
  }
  EXPECT_EQ(file.warnings().size(), 1u);
}

TEST(KeyWithoutEffect, CountsWhereOneOfTwoReadersUsesIt) {
  auto file = ConfigFile::parse("[bottom]\nslope = 0.1\n", "sea.toml");
  Bottom bottom, other;
  other.kind = "slope";
  file.read([&](ConfigVisitor& v) { visit_bottom(v, bottom); });
  file.read([&](ConfigVisitor& v) { visit_bottom(v, other); });
  file.check(/*whole_file=*/true);
  EXPECT_THAT(file.warnings(), IsEmpty());
}

TEST(KeyWithoutEffect, IsLeftOutOfTheEffectiveConfigurationAndListedInTheReference) {
  Bottom bottom;
  const auto body = [&](ConfigVisitor& v) { visit_bottom(v, bottom); };
  EXPECT_EQ(to_toml(body, /*with_comments=*/false), "\n[bottom]\nkind = \"flat\"\ndepth_m = 100.0\n");
  EXPECT_THAT(to_toml(body, /*with_comments=*/true), HasSubstr("slope = 0.0  # steep (-1 to 1)\n"));
}

TEST(KeyList, HoldsTheKeysOfOneClassAndTheConfigurationAll) {
  double power_w = 1, gain = 2, level_db = 3;
  const auto visit_gain = [&](ConfigVisitor& v) {
    v.advanced([&] { v.number("gain", gain, {0, 9, "", "gain"}); });
  };
  const auto body = [&](ConfigVisitor& v) {
    v.section("modem", "Modem", [&](ConfigVisitor& modem) {
      modem.number("power_w", power_w, {0, 9, "W", "power"});
      visit_gain(modem);
    });
    v.section("own", "Modem with the keys of [modem]",
              [&](ConfigVisitor& own) { own.listed_elsewhere([&] { visit_gain(own); }); });
    v.advanced([&] {
      v.section("pilot", "Pilot", [&](ConfigVisitor& pilot) {
        pilot.number("level_db", level_db, {0, 9, "dB", "level"});
      });
    });
  };
  EXPECT_EQ(
      to_key_list(body, KeyClass::kCommon),
      "\n# Modem\n[modem]\npower_w = 1.0  # power (0 to 9 W)\n\n# Modem with the keys of [modem]\n[own]\n");
  EXPECT_EQ(to_key_list(body, KeyClass::kAdvanced),
            "\n# Modem\n[modem]\ngain = 2.0  # gain (0 to 9)\n\n# Pilot\n[pilot]\nlevel_db = 3.0  # level (0 "
            "to 9 dB)\n");
  EXPECT_EQ(to_toml(body, /*with_comments=*/false),
            "\n[modem]\npower_w = 1.0\ngain = 2.0\n\n[own]\ngain = 2.0\n\n[pilot]\nlevel_db = 3.0\n");
}

TEST(Finding, AWarningIsNoError) {
  auto file = ConfigFile::parse("", "sea.toml");
  file.warn("environment.wind_mps", "5", "calm");
  EXPECT_NO_THROW(file.check_findings());
}

}  // namespace
}  // namespace halocline::bus
