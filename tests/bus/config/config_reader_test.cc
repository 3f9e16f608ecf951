// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "core/frames.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Part {
  std::string label = "none";
  double weight = 1;
};

enum class Colour { kRed, kGreen };

struct Config {
  double wind = 5;
  std::int64_t count = 2;
  std::int32_t narrow = 3;
  bool on = false;
  std::string mode = "slow";
  Vec3 at = Vec3(1, 2, 3);
  std::vector<double> levels{1, 2};
  std::vector<Vec3> route;
  double angle_rad = 0;
  Colour colour = Colour::kRed;
  double depth = 10;
  std::vector<Part> parts;
};

void visit(ConfigVisitor& v, Config& c) {
  v.number("wind_mps", c.wind, {0, 60, "m/s", "wind"});
  v.integer("count", c.count, {0, 10, "", "how many"});
  integer_as(v, "narrow", c.narrow, {0, 100, "", "of 32 bits"});
  v.boolean("on", c.on, "whether");
  v.text("mode", c.mode, {"slow", "fast"}, "how");
  v.vector3("at_m", c.at, {-100, 100, "m", "where"});
  v.numbers("levels_db", c.levels, {0, 200, "dB", "levels"});
  v.points("route_m", c.route, {-100, 100, "m", "way points"});
  degrees(v, "angle_deg", c.angle_rad, {-180, 180, "deg", "angle"});
  choice(v, "colour", c.colour, {"red", "green"}, "colour");
  v.section("sea", "the sea", [&](ConfigVisitor& s) {
    s.number("depth_m", c.depth, {0, 11000, "m", "depth"});
  });
  v.list(
      "part", "a part", c.parts.size(), [&](std::size_t n) { c.parts.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) {
        item.text("label", c.parts[i].label, {}, "name");
        item.number("weight_kg", c.parts[i].weight, {0, 100, "kg", "weight"});
      });
}

Config read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  auto file = ConfigFile::parse(text, "test.toml", overrides);
  Config config;
  file.read([&](ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/true);
  return config;
}

std::vector<std::string> errors_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const ConfigErrors& errors) {
    return errors.lines();
  }
  return {};
}

std::string error_of(const std::string& text) {
  const auto errors = errors_of(text);
  return errors.size() == 1 ? errors[0] : std::to_string(errors.size()) + " errors";
}

TEST(ConfigReader, AnEmptyFileLeavesTheDefaults) {
  const Config config = read("");
  EXPECT_EQ(config.wind, 5);
  EXPECT_EQ(config.mode, "slow");
  EXPECT_TRUE(config.parts.empty());
}

TEST(ConfigReader, ReadsEveryKindOfValue) {
  const Config config = read(R"(
    wind_mps = 7
    count = 4
    narrow = 5
    on = true
    mode = "fast"
    at_m = [1, 2.5, -3]
    levels_db = [100, 150.5]
    route_m = [[1, 2, 3], [4, 5, 6]]
    angle_deg = 90
    colour = "green"
    sea.depth_m = 4000
    [[part]]
    label = "a"
    [[part]]
    weight_kg = 2
  )");
  EXPECT_EQ(config.wind, 7);
  EXPECT_EQ(config.count, 4);
  EXPECT_EQ(config.narrow, 5);
  EXPECT_TRUE(config.on);
  EXPECT_EQ(config.mode, "fast");
  EXPECT_EQ(config.at, Vec3(1, 2.5, -3));
  EXPECT_THAT(config.levels, ElementsAre(100, 150.5));
  EXPECT_THAT(config.route, ElementsAre(Vec3(1, 2, 3), Vec3(4, 5, 6)));
  EXPECT_DOUBLE_EQ(config.angle_rad, std::numbers::pi / 2);
  EXPECT_EQ(config.colour, Colour::kGreen);
  EXPECT_EQ(config.depth, 4000);
  ASSERT_EQ(config.parts.size(), 2u);
  EXPECT_EQ(config.parts[0].label, "a");
  EXPECT_EQ(config.parts[1].weight, 2);
}

TEST(ConfigReader, AnImpossibleValueNamesFileLineKeyAndWhatIsAllowed) {
  EXPECT_EQ(error_of("\nwind_mps = 61"), "test.toml:2: wind_mps is 61; allowed is 0 to 60 m/s");
  EXPECT_EQ(error_of("[sea]\ndepth_m = -1"), "test.toml:2: sea.depth_m is -1; allowed is 0 to 11000 m");
  EXPECT_EQ(error_of("mode = 'medium'"), "test.toml:1: mode is 'medium'; allowed are slow, fast");
  EXPECT_EQ(error_of("[[part]]\n[[part]]\nweight_kg = 101"),
            "test.toml:3: part[1].weight_kg is 101; allowed is 0 to 100 kg");
}

TEST(ConfigReader, NanAndInfinityAreNeverAllowed) {
  for (const char* value : {"nan", "inf", "-inf"}) {
    EXPECT_THAT(error_of(std::string("wind_mps = ") + value), HasSubstr("allowed is 0 to 60")) << value;
  }
}

TEST(ConfigReader, ATextIsOneLineWithoutControlCharacters) {
  for (const char* bad : {"\\u001b[2J", "a\\nb", "\\u009b"})
    EXPECT_THAT(error_of("[[part]]\nlabel = \"" + std::string(bad) + "\""),
                HasSubstr("one line without control characters"))
        << bad;
}

TEST(ConfigReader, AWrongTypeNamesTheOneNeeded) {
  EXPECT_THAT(error_of("wind_mps = 'strong'"), HasSubstr("a number is needed"));
  EXPECT_THAT(error_of("count = 2.5"), HasSubstr("a whole number is needed"));
  EXPECT_THAT(error_of("on = 1"), HasSubstr("allowed is true or false"));
  EXPECT_THAT(error_of("mode = 3"), HasSubstr("a text is needed, allowed are slow, fast"));
  EXPECT_THAT(error_of("at_m = 3"), HasSubstr("an array of numbers is needed"));
  EXPECT_THAT(error_of("at_m = [1, 2]"), HasSubstr("three numbers are needed"));
  EXPECT_THAT(error_of("levels_db = [1, 'x']"), HasSubstr("a number is needed"));
  EXPECT_THAT(error_of("route_m = [1, 2, 3]"), HasSubstr("an array of numbers is needed"));
  EXPECT_THAT(error_of("sea = 3"), HasSubstr("a table [sea] is needed"));
  EXPECT_THAT(error_of("part = 3"), HasSubstr("an array of tables [[part]] is needed"));
  EXPECT_THAT(error_of("part = [1]"), HasSubstr("an array of tables [[part]] is needed"));
  EXPECT_THAT(errors_of("wind_mps = {a = 1}"),
              ::testing::Contains(HasSubstr("wind_mps is a table; a number is needed")));
}

TEST(ConfigReader, UnknownKeysAreErrorsWhereverTheyStand) {
  EXPECT_THAT(
      errors_of("wnd_mps = 3\n[sea]\ndepht_m = 3\n[[part]]\nlable = 'a'\n[nowhere]\nx = 1"),
      ElementsAre(HasSubstr("test.toml:6: nowhere is unknown"), HasSubstr("test.toml:5: part[0].lable"),
                  HasSubstr("test.toml:3: sea.depht_m"), HasSubstr("test.toml:1: wnd_mps is unknown")));
}

TEST(ConfigReader, ReportsEverythingAtOnce) {
  const auto errors = errors_of(R"(wind_mps = 100
count = "two"
on = "yes"
mode = "medium"
angle_deg = 181
[sea]
depth_m = -1
deep = true
[[part]]
weight_kg = -1
)");
  EXPECT_EQ(errors.size(), 8u) << ::testing::PrintToString(errors);
}

TEST(ConfigReader, AnErrorSeenByTwoReadersIsReportedOnce) {
  auto file = ConfigFile::parse("wind_mps = 99", "test.toml");
  Config config;
  for (int i = 0; i < 2; ++i) file.read([&](ConfigVisitor& v) { visit(v, config); });
  try {
    file.check(true);
    FAIL();
  } catch (const ConfigErrors& errors) {
    EXPECT_EQ(errors.lines().size(), 1u);
  }
}

TEST(ConfigReader, WhatIsNoTomlNamesItsLine) {
  EXPECT_THAT(error_of("a = 1\nb = = 2\n"), HasSubstr("test.toml:2: "));
  EXPECT_THAT(error_of("wind_mps = 1\nwind_mps = 2\n"), HasSubstr("test.toml:2: "));
}

TEST(ConfigReader, AKeyOfTooManyPartsIsRefusedWithItsLine) {
  std::string deep = "a";
  for (int i = 0; i < 60'000; ++i) deep += i % 2 == 0 ? ".a" : " . 'a.b'";
  const auto refused = HasSubstr(":2: a key has more than 32 dotted parts");
  EXPECT_THAT(errors_of("\n" + deep + " = 1"), ElementsAre(refused));
  EXPECT_THAT(errors_of("\n[" + deep + "]"), ElementsAre(refused));
  EXPECT_THAT(errors_of("x = \"\"\"\\\"\n\"\"\"\"\ny = {" + deep + " = 1}"),
              ElementsAre(HasSubstr(":3: a key")));
  EXPECT_THAT(errors_of("", {deep + " = 1"}), ElementsAre(HasSubstr("a key has more than 32 dotted parts")));
}

TEST(ConfigReader, DotsOutsideKeysAreNotCounted) {
  const std::string dots(100, '.');
  EXPECT_TRUE(errors_of("mode = 'slow' # " + dots + "\nlevels_db = [1.0, 2.0" + ", 3.0, 4.0]").empty());
  EXPECT_THAT(errors_of("mode = '" + dots + "'"), ElementsAre(HasSubstr("allowed are slow")));
}

TEST(ConfigReader, AFileThatCannotBeReadIsAnErrorThatNamesIt) {
  try {
    ConfigFile::load("/nowhere/at-all.toml");
    FAIL();
  } catch (const ConfigErrors& errors) {
    EXPECT_THAT(errors.what(), HasSubstr("/nowhere/at-all.toml: cannot be read"));
  }
  EXPECT_THROW(ConfigFile::load("/tmp"), ConfigErrors);
}

TEST(ConfigReader, ProblemsAcrossKeysCarryTheirPlace) {
  auto file = ConfigFile::parse("[sea]\n\ndepth_m = 3", "test.toml");
  file.read([](ConfigVisitor& v) {
    v.section("sea", "", [](ConfigVisitor& s) {
      s.problem("depth_m", "allowed is more than the draught");
      s.problem("name", "allowed is a name");
    });
  });
  try {
    file.check(true);
    FAIL();
  } catch (const ConfigErrors& errors) {
    EXPECT_THAT(errors.lines(), ElementsAre("test.toml:3: sea.depth_m is 3; allowed is more than the draught",
                                            "test.toml:1: sea.name is missing; allowed is a name"));
  }
}

TEST(ConfigReader, AnotherProgramsKeysInASharedTableAreNoErrorsForOneProgram) {
  const auto read_part = [](ConfigVisitor& v) {
    double mine = 0;
    v.section("shared", "", [&](ConfigVisitor& s) {
      s.shared_with_others();
      s.number("mine", mine, {0, 1, "", ""});
    });
  };
  const char* text = "[shared]\nmine = 1\ntheirs = 2\n[other]\nx = 1\n";
  auto alone = ConfigFile::parse(text, "test.toml");
  alone.read(read_part);
  EXPECT_NO_THROW(alone.check(/*whole_file=*/false));
  auto whole = ConfigFile::parse(text, "test.toml");
  whole.read(read_part);
  EXPECT_THROW(whole.check(/*whole_file=*/true), ConfigErrors);
}

TEST(ConfigOverride, ReplacesAndAddsValues) {
  EXPECT_EQ(read("wind_mps = 1", {"wind_mps=9"}).wind, 9);
  EXPECT_EQ(read("", {"sea.depth_m=77"}).depth, 77);
  EXPECT_EQ(read("[sea]\ndepth_m = 1", {"sea.depth_m=77"}).depth, 77);
  EXPECT_EQ(read("", {"mode='fast'", "mode=\"slow\""}).mode, "slow");
  EXPECT_EQ(read("", {"at_m=[4,5,6]"}).at, Vec3(4, 5, 6));
}

TEST(ConfigOverride, ReachesIntoAnArrayOfTables) {
  const Config config = read("[[part]]\nlabel='a'\n[[part]]\nlabel='b'", {"part.1.weight_kg=7"});
  EXPECT_EQ(config.parts[0].weight, 1);
  EXPECT_EQ(config.parts[1].weight, 7);
  EXPECT_EQ(config.parts[1].label, "b");
}

TEST(ConfigOverride, BeyondTheArrayIsAnError) {
  EXPECT_THAT(errors_of("[[part]]\n", {"part.1.weight_kg=7"}),
              ElementsAre(HasSubstr("there is no '1' to change")));
  EXPECT_THAT(errors_of("[[part]]\n", {"part.x.weight_kg=7"}), ElementsAre(HasSubstr("there is no 'x'")));
}

TEST(ConfigOverride, ItsErrorsNameTheCommandLine) {
  EXPECT_THAT(errors_of("", {"wind_mps=99"}),
              ElementsAre("command line: wind_mps is 99; allowed is 0 to 60 m/s"));
  EXPECT_THAT(errors_of("", {"wimd=1"}), ElementsAre(HasSubstr("command line: wimd is unknown")));
  EXPECT_THAT(errors_of("", {"mode=[fast"}), ElementsAre(HasSubstr("a value in TOML or a word")));
  EXPECT_THAT(errors_of("", {"nonsense"}), ElementsAre(HasSubstr("section.key=value")));
}

TEST(ConfigOverride, AWordNeedsNoQuotes) {
  EXPECT_EQ(read("", {"mode=fast"}).mode, "fast");
  EXPECT_EQ(read("", {"colour = green"}).colour, Colour::kGreen);
  const auto label = [](const std::string& given) {
    return read("[[part]]\n", {"part.0.label=" + given}).parts.at(0).label;
  };
  EXPECT_EQ(label("two words"), "two words");
  EXPECT_EQ(label("casts/may-2.csv"), "casts/may-2.csv");
  EXPECT_EQ(label("10.0.4.0/24"), "10.0.4.0/24");
  EXPECT_EQ(label("2026-05-01T06:00:00Z"), "2026-05-01T06:00:00Z");
  EXPECT_EQ(label("7"), "7");
}

TEST(ConfigOverride, AWordInThePlaceOfANumberIsRefused) {
  EXPECT_THAT(errors_of("", {"wind_mps=strong"}),
              ElementsAre("command line: wind_mps is 'strong'; a number is needed, allowed is 0 to 60 m/s"));
}

TEST(ConfigReader, ErrorsShowNumbersAsShortAsTheyAre) {
  EXPECT_EQ(error_of("wind_mps = 1e300"), "test.toml:1: wind_mps is 1e+300; allowed is 0 to 60 m/s");
  EXPECT_EQ(error_of("at_m = [1e300, 0.0]"), "test.toml:1: at_m is 1e+300; allowed is -100 to 100 m");
  EXPECT_EQ(error_of("at_m = [1.5, 0]"),
            "test.toml:1: at_m is [ 1.5, 0 ]; three numbers are needed, each: allowed is -100 to 100 m");
  const std::string digits(300, '9');
  EXPECT_LT(error_of("wind_mps = " + digits + ".0").size(), 200u);
  EXPECT_LT(error_of("mode = '" + digits + "'").size(), 300u);
  EXPECT_LT(errors_of("", {"wind_mps=" + digits}).at(0).size(), 300u);
  EXPECT_LT(error_of("wind_mps = " + digits).size(), 200u);
}

TEST(ConfigOverride, AnIndexThatIsHugeIsAnErrorAndNoCrash) {
  EXPECT_EQ(errors_of("[[part]]\n", {"part.99999999999999999999.weight_kg=7"}).size(), 1u);
}

TEST(ConfigWriter, WhatIsWrittenReadsBackTheSame) {
  Config config = read("angle_deg = 33.3\n[[part]]\nlabel='a'\n[[part]]\nlabel='b'\nweight_kg=0.1");
  config.wind = 1.0 / 3.0;
  config.at = Vec3(1e-7, -33.333333333333336, 99.9);
  config.levels = {0, 1e-300, 199.99999999999997};
  config.route = {Vec3(1, 2, 3), Vec3(-0.1, 0.2, 0.3)};
  config.parts[0].label = "quote \" backslash \\ ünï";
  for (const bool comments : {false, true}) {
    const std::string text = to_toml([&](ConfigVisitor& v) { visit(v, config); }, comments);
    const Config back = read(text);
    EXPECT_EQ(back.wind, config.wind);
    EXPECT_EQ(back.count, config.count);
    EXPECT_EQ(back.at, config.at);
    EXPECT_EQ(back.levels, config.levels);
    EXPECT_EQ(back.route, config.route);
    EXPECT_NEAR(back.angle_rad, config.angle_rad, 1e-15);
    ASSERT_EQ(back.parts.size(), 2u);
    EXPECT_EQ(back.parts[0].label, config.parts[0].label);
    EXPECT_EQ(back.parts[1].weight, config.parts[1].weight);
    EXPECT_EQ(to_toml([&](ConfigVisitor& v) { visit(v, const_cast<Config&>(back)); }, comments), text);
  }
}

TEST(ConfigWriter, CommentsGiveMeaningRangeAndUnit) {
  Config config;
  EXPECT_THAT(to_toml([&](ConfigVisitor& v) { visit(v, config); }, true),
              HasSubstr("wind_mps = 5.0  # wind (0 to 60 m/s)"));
}

TEST(ConfigFile, WritesWhatItReadWithOverridesAndWithoutWhatIsLeftOut) {
  const auto file = ConfigFile::parse(
      "b.deep.on = true  # a comment\n"
      "[a]\nlevel = 0.3\nwhole = 5\nzero = 0.0\nname = \"tab\\there\"\nlist = [1.5, 2.0]\n"
      "route = [[0, 1.0], [2, 3]]\npair = {x = 1, y = 2.5}\n"
      "[[item]]\nk = 1\n[item.sub]\nz = -1e300\n[[item]]\nk = 2\n",
      "test", {"a.whole=6", "item.1.k=7", "gone.threads=3"});
  EXPECT_EQ(file.to_toml({"gone.threads", "not.there", "a.zero"}),
            "\n[a]\nlevel = 0.3\nlist = [1.5, 2.0,]\nname = \"tab\\u0009here\"\n"
            "route = [\n  [0, 1.0,],\n  [2, 3,],\n]\nwhole = 6\n\n[a.pair]\nx = 1\ny = 2.5\n"
            "\n[b]\n\n[b.deep]\non = true\n"
            "\n[[item]]\nk = 1\n\n[item.sub]\nz = -1e+300\n\n[[item]]\nk = 7\n");
}

}  // namespace
}  // namespace halocline::bus
