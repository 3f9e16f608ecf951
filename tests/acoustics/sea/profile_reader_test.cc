// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/profile_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::tolerance;

SoundSpeedProfile read(const std::string& text, ProfileReading reading = {}) {
  std::istringstream in(text);
  return read_csv_profile(in, "cast.csv", reading);
}

std::string complaint(const std::string& text, ProfileReading reading = {}) {
  try {
    read(text, reading);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(ProfileReader, ReadsTemperatureAndSalinity) {
  const auto profile = read("station,depth_m,salinity_psu,temperature_degC\nA,0,35,20\nA,100,34,10\n");
  EXPECT_NEAR(profile.water(50).temperature_degc, 15, tolerance(1e-14));
  EXPECT_EQ(profile.sound_speed_mps(100), mackenzie_1981(10, 34, 100));
}

TEST(ProfileReader, ReadsSpeeds) {
  const auto profile = read("depth_m,sound_speed_mps\n0,1500\n200,1480\n");
  EXPECT_NEAR(profile.sound_speed_mps(100), 1490, tolerance(1e-12));
  EXPECT_FALSE(profile.knows_water());
}

TEST(ProfileReader, AbsoluteSalinityMeansTeos10) {
  const auto profile = read("depth_m,CT_degC,SA_g_per_kg\n0,10,35\n");
  EXPECT_EQ(profile.model(), SoundSpeedModel::kTeos10);
  EXPECT_EQ(profile.sound_speed_mps(0), teos10_75_term(35, 10, 0));
}

TEST(ProfileReader, PracticalSalinityIsNotTakenForAbsolute) {
  ProfileReading reading;
  reading.model = SoundSpeedModel::kTeos10;
  EXPECT_THAT(complaint("depth_m,temperature_degC,salinity_psu\n0,10,35\n", reading),
              HasSubstr("SA_g_per_kg"));
}

TEST(ProfileReader, UnsortedAndRepeatedDepthsAreRefusedWithTheirLines) {
  const std::string text =
      complaint("depth_m,temperature_degC,salinity_psu\n0,20,35\n10,19,35\n10,19,35\n5,20,35\n");
  EXPECT_THAT(text, AllOf(HasSubstr("cast.csv: line 4, depth_m"), HasSubstr("line 5, depth_m")));
}

// One cast: 0 to 100 m by halves on lines 2 to 202, and back.
TEST(ProfileReader, ACastThatGoesDownAndUpIsToldInOneLine) {
  std::string text = "depth_m,temperature_degC,salinity_psu\n";
  for (int i = 0; i <= 400; ++i) text += std::to_string(0.5 * std::min(i, 400 - i)) + ",10,35\n";
  EXPECT_EQ(complaint(text),
            "cast.csv: the cast goes down and up, and turns at 100 m: keep the way down, lines 2 to 202, or "
            "the way up, lines "
            "203 to 402 in reverse order");
  EXPECT_THAT(complaint("depth_m,sound_speed_mps\n40,1500\n30,1500\n20,1500\n10,1500\n"),
              HasSubstr("cast.csv: depths fall: lines 2 to 5 are of the way up; reverse their order"));
}

TEST(ProfileReader, OfManyFaultsFiveAreShownAndTheRestCounted) {
  std::string text = "depth_m,sound_speed_mps\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(10 * i) + ",warm\n";
  const std::string told = complaint(text);
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 5);
  EXPECT_THAT(told, HasSubstr("cast.csv: and 15 more"));
}

TEST(ProfileReader, EveryBadCellIsNamedWithWhatIsAllowed) {
  const std::string text =
      complaint("depth_m,temperature_degC,salinity_psu\n0,warm,35\n-1,10,35\n20,10,99\n");
  EXPECT_THAT(text,
              AllOf(HasSubstr("line 2, temperature_degC: 'warm'; allowed is a number from -5 to 45 degC"),
                    HasSubstr("line 3, depth_m: '-1'"), HasSubstr("line 4, salinity_psu: '99'")));
}

TEST(ProfileReader, MissingColumnsAndRowsAreRefused) {
  EXPECT_THAT(complaint("depth_m,temperature_degC\n0,10\n"), HasSubstr("salinity_psu"));
  EXPECT_THAT(complaint("depth_m,sound_speed_mps\n"), HasSubstr("no row"));
  EXPECT_THAT(complaint(""), HasSubstr("no header"));
}

constexpr const char* kLevitus = "/usr/share/ferret-vis/data/levitus_climatology.cdf";

GridProfile levitus_at(double latitude_deg, double longitude_deg) {
  return read_grid_profile({kLevitus, "", to_radians(latitude_deg), to_radians(longitude_deg), 0},
                           SoundSpeedModel::kMackenzie1981);
}

class LevitusTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kLevitus)) GTEST_SKIP() << "needs Debian's ferret-datasets";
  }
};

TEST_F(LevitusTest, GivesTheColumnOfThePlace) {
  const GridProfile at = levitus_at(0.5, 179.5);  // warm pool of the Pacific
  EXPECT_NEAR(to_degrees(at.column_latitude_rad), 0.5, tolerance(1e-9));
  EXPECT_NEAR(to_degrees(at.column_longitude_rad), 179.5, tolerance(1e-9));
  EXPECT_NEAR(at.distance_m, 0, tolerance(1));
  EXPECT_EQ(at.levels, 20);
  // Broad bounds of that water in any atlas: 28..30 degC above, 1..2 degC at the bottom.
  EXPECT_NEAR(at.profile.water(0).temperature_degc, 29, tolerance(1));
  EXPECT_NEAR(at.profile.water(5000).temperature_degc, 1.5, tolerance(0.5));
  EXPECT_NEAR(at.profile.water(0).salinity_psu, 35, tolerance(0.7));
}

TEST_F(LevitusTest, NorthIsNorth) {
  EXPECT_LT(levitus_at(75, 0).profile.water(0).temperature_degc, 8);
  EXPECT_LT(levitus_at(-60, 0).profile.water(0).temperature_degc, 3);
  EXPECT_GT(levitus_at(10, -30).profile.water(0).temperature_degc, 24);
}

TEST_F(LevitusTest, LongitudesOfEveryTurnAreTheSame) {
  const double warm = levitus_at(20.2, -40.3).profile.water(0).temperature_degc;
  EXPECT_NEAR(levitus_at(20.2, 319.7).profile.water(0).temperature_degc, warm, tolerance(1e-6));
  EXPECT_NEAR(levitus_at(20.2, 319.7 - 720).profile.water(0).temperature_degc, warm, tolerance(1e-6));
}

TEST_F(LevitusTest, FillValuesAreNeverUsedAndTheColumnIsStated) {
  const GridProfile at = levitus_at(46.5, 1.0);  // land in France: the sea is some 200 km west
  EXPECT_GT(at.distance_m, 50e3);
  EXPECT_THAT(at.description, HasSubstr("km away"));
  for (const double depth : at.profile.row_depths_m()) {
    EXPECT_GT(at.profile.water(depth).temperature_degc, -3);
    EXPECT_LT(at.profile.water(depth).temperature_degc, 30);
  }
}

TEST_F(LevitusTest, AShallowColumnEndsWhereItsWaterEnds) {
  const GridProfile at = levitus_at(54.5, 4.5);  // North Sea, about 40 m deep
  EXPECT_LT(at.levels, 10);
  EXPECT_EQ(static_cast<int>(at.profile.row_depths_m().size()), at.levels);
}

TEST_F(LevitusTest, RefusesPlacesFarFromAnyWater) {
  EXPECT_THROW(levitus_at(48, 88), InvalidArgument);  // Dzungaria, 2000 km from the sea
}

TEST(ProfileReader, MissingFilesAreRefused) {
  EXPECT_THROW(read_profile("/nonexistent.csv", {}, 0, 0), InvalidArgument);
  EXPECT_THROW(read_profile("/nonexistent.nc", {}, 0, 0), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
