// SPDX-License-Identifier: BSD-3-Clause
// What public files of water hold, in fields and in columns: each fault of reading that a user would not
// notice.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "ocean/potential_temperature.h"
#include "tests/ocean/sea_file.h"
#include "tests/support/tolerance.h"

namespace halocline::ocean {
namespace {

using halocline::testing::tolerance;
using ocean::testing::SeaFile;
using ocean::testing::Texts;
using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr GeodeticOrigin kPlace{to_radians(43.2), to_radians(7.3)};

WaterColumn column(const SeaFile& file, const std::string& name, const GeodeticOrigin& place = kPlace) {
  return read_water_column({.temperature_path = file.write(name),
                            .latitude_rad = place.latitude_rad,
                            .longitude_rad = place.longitude_rad});
}

std::string refusal(const SeaFile& file, const std::string& name) {
  try {
    column(file, name);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "read";
}

std::vector<double> depths_of(const WaterColumn& column) {
  std::vector<double> depths;
  for (const WaterAtDepth& row : column.rows) depths.push_back(row.depth_m);
  return depths;
}

TEST(WaterColumn, IsWhatTheFieldOfTheSameFileHas) {
  SeaFile file;
  file.degrees = [](double, double depth, double latitude, double longitude) {
    return 20 - depth / 1000 + 3 * (latitude - 43.2) + 2 * (longitude - 7.3);
  };
  file.temperature = {{"standard_name", "sea_water_potential_temperature"}, {"units", "degC"}};
  const GeodeticOrigin place{to_radians(43.27), to_radians(7.42)};
  const auto field = read_ocean_field({file.write("same"), "", place});
  const std::vector<WaterAtDepth> expected = field->column_at(0, 0, 0);
  const WaterColumn found = column(file, "same", place);
  ASSERT_EQ(found.rows.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found.rows[i].temperature_degc, expected[i].temperature_degc);
    EXPECT_EQ(found.rows[i].salinity_psu, expected[i].salinity_psu);
  }
}

TEST(WaterColumn, TimesAreNoDepths) {
  SeaFile file;
  file.time.values = {0, 1, 2};
  file.order = {"time", "latitude", "longitude"};
  EXPECT_THAT(refusal(file, "hourly"), HasSubstr("there is no axis of depth"));
}

TEST(WaterColumn, DepthsAreInMetresFromAnyUnitAndAnyDirection) {
  SeaFile km, heights, rising, feet;
  km.depth = {"depth", {0, 0.1, 1, 4}, {{"units", "km"}, {"positive", "down"}}};
  km.degrees = [](double, double depth, double, double) { return 20 - depth; };
  heights.depth = {"z", {0, -100, -1000, -4000}, {{"units", "m"}, {"axis", "Z"}}};
  heights.order[1] = "z";
  heights.degrees = [](double, double height, double, double) { return 20 + height / 1000; };
  rising.depth.values = {4000, 1000, 100, 0};
  feet.depth = {
      "depth", {0, 328.083989501, 3280.83989501, 13123.3595801}, {{"units", "feet"}, {"axis", "Z"}}};
  feet.degrees = [](double, double depth, double, double) { return 20 - depth * 0.3048 / 1000; };
  for (const SeaFile& file : {km, heights, rising, feet}) {
    const WaterColumn found = column(file, "depths");
    EXPECT_THAT(depths_of(found),
                ElementsAre(0, DoubleNear(100, 1e-4), DoubleNear(1000, 1e-4), DoubleNear(4000, 1e-4)));
    EXPECT_NEAR(found.rows[3].temperature_degc, 16, tolerance(1e-5));
  }
}

// UNESCO Technical Paper 44: 1000 dbar at 43.2 degrees are 989.66 m.
TEST(WaterColumn, PressuresBecomeDepths) {
  SeaFile file;
  file.depth = {"depth", {0, 1000}, {{"units", "dbar"}, {"positive", "down"}}};
  EXPECT_THAT(depths_of(column(file, "pressure")), ElementsAre(0, DoubleNear(989.664, 1e-3)));
}

TEST(WaterColumn, PotentialTemperatureAndKelvinBecomeDegreesInSitu) {
  SeaFile file;
  file.degrees = [](double, double, double, double) { return 1.8; };
  file.temperature = {{"standard_name", "sea_water_potential_temperature"}, {"units", "degrees C"}};
  EXPECT_NEAR(column(file, "potential").rows[3].temperature_degc,
              in_situ_temperature_degc(36, 1.8, 4000, to_radians(43.2)), tolerance(1e-4));
  file.temperature = {{"standard_name", "sea_water_temperature"}, {"units", "K"}};
  file.degrees = [](double, double, double, double) { return 293.15; };
  EXPECT_NEAR(column(file, "kelvin").rows[0].temperature_degc, 20, tolerance(1e-4));
}

TEST(WaterColumn, AProjectionIsNoLatitudeAndLongitude) {
  SeaFile file;
  file.latitude = {
      "y", {-1777, -1757, -1737}, {{"units", "km"}, {"standard_name", "projection_y_coordinate"}}};
  file.longitude = {
      "x", {-1813, -1793, -1773}, {{"units", "km"}, {"standard_name", "projection_x_coordinate"}}};
  file.order = {"time", "depth", "y", "x"};
  file.two_dimensional = {
      {"lat", {66, 66.1, 66.2, 66.1, 66.2, 66.3, 66.2, 66.3, 66.4}, {{"units", "degrees_north"}}},
      {"lon", {12, 12.3, 12.6, 11.8, 12.1, 12.4, 11.6, 11.9, 12.2}, {{"units", "degrees_east"}}}};
  file.temperature.emplace_back("coordinates", "lon lat");
  EXPECT_THAT(
      refusal(file, "projected"),
      AllOf(HasSubstr("its dimension y is no axis of time, depth, latitude or longitude (units \"km\")"),
            HasSubstr("66 to 66.4 N, 11.6 to 12.6 E"), HasSubstr("regrid it first")));
}

// Evenly spaced in Mercator's projection only: read as even, 43.2 would lie in another row.
TEST(WaterColumn, UnevenAxesAreInterpolatedInTheirOwnCoordinates) {
  SeaFile file;
  file.latitude.values = {30, 40, 43, 44, 60};
  file.longitude.values = {-10, 7, 7.5, 8};
  file.degrees = [](double, double, double latitude, double longitude) {
    return latitude / 4 + longitude / 10;
  };
  EXPECT_NEAR(column(file, "uneven").rows[0].temperature_degc, 43.2 / 4 + 0.73, tolerance(1e-5));
}

TEST(WaterColumn, BeyondTheGridTheNearestColumnHoldsAndFarAwayNone) {
  const SeaFile file;
  const WaterColumn near = column(file, "near", {to_radians(43.5), to_radians(7.3)});
  EXPECT_NEAR(to_degrees(near.nearest_latitude_rad), 43.4, tolerance(1e-9));
  EXPECT_NEAR(near.distance_m, 11'120, tolerance(5));
  try {
    column(file, "far", {to_radians(45), to_radians(0)});
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("no water within 300 km of 45 N 0 E; its grid spans 43 to 43.4 N and 7.1 to 7.5 E"));
  }
}

TEST(WaterColumn, ConservativeTemperatureIsRefusedAndAbsoluteSalinityMadePractical) {
  SeaFile file;
  file.salinity = {{"standard_name", "sea_water_absolute_salinity"}, {"units", "g kg-1"}};
  EXPECT_NEAR(column(file, "absolute").rows[0].salinity_psu, 36 * 35 / 35.16504, tolerance(1e-5));
  EXPECT_THAT(read_ocean_field({file.write("remark"), "", kPlace})->remarks(),
              ElementsAre(HasSubstr("s is absolute salinity: made practical")));
  file.temperature = {{"standard_name", "sea_water_conservative_temperature"}, {"units", "degC"}};
  EXPECT_THAT(refusal(file, "conservative"), HasSubstr("t: is conservative temperature, which is not read"));
  SeaFile fraction;
  fraction.salinity = {{"standard_name", "sea_water_salinity"}, {"units", "W"}};
  EXPECT_THAT(refusal(fraction, "watt"), HasSubstr("s: units are \"W\"; allowed are psu"));
}

TEST(WaterColumn, AMissingValueIsComparedAsTheVariableRoundsIt) {
  SeaFile file;
  file.missing_value = 1e20;  // as a float 1.00000002e20
  file.degrees = [](double, double, double, double longitude) { return longitude > 7.4 ? 1e20 : 20; };
  const auto field = read_ocean_field({file.write("land"), "", kPlace});
  EXPECT_NEAR(field->water_at({0, 10'000, 0}, 0).temperature_degc, 20, tolerance(1e-6));
}

TEST(WaterColumn, AttributesMayBeStrings) {
  SeaFile file;
  file.strings = true;
  EXPECT_THAT(depths_of(column(file, "strings")), ElementsAre(0, 100, 1000, 4000));
}

TEST(WaterColumn, AxesMayStandInAnyOrder) {
  const SeaFile plain;
  for (const std::vector<std::string>& order :
       {std::vector<std::string>{"time", "depth", "longitude", "latitude"},
        {"latitude", "longitude", "depth", "time"},
        {"longitude", "time", "latitude", "depth"},
        {"depth", "latitude", "longitude"}}) {
    SeaFile file;
    file.order = order;
    file.time.values = {0, 6, 12};
    file.degrees = [](double time, double depth, double latitude, double longitude) {
      return 10 - depth / 1000 + (latitude - 43.2) + 5 * (longitude - 7.3) + time / 12;
    };
    const bool has_time = order.size() == 4;
    const auto field = read_ocean_field({file.write("order"), "", {to_radians(43.25), to_radians(7.45)}});
    EXPECT_NEAR(field->water_at({0, 0, 500}, 3 * 3600.0).temperature_degc,
                10 - 0.5 + 0.05 + 0.75 + (has_time ? 0.25 : 0), tolerance(1e-4));
  }
}

TEST(WaterColumn, AGridThatGoesRoundTheEarthHasNoSeam) {
  for (const std::vector<double>& longitudes : {std::vector<double>{-180, -120, -60, 0, 60, 120},
                                                {0, 60, 120, 180, 240, 300, 360},
                                                {120, 180, -120, -60, 0, 60}}) {
    SeaFile file;
    file.latitude.values = {-30, 0, 30};
    file.longitude.values = longitudes;
    file.degrees = [](double, double, double, double longitude) {
      return 10 + std::cos(to_radians(longitude));
    };
    const GeodeticOrigin origin{0, to_radians(175)};
    const auto field = read_ocean_field({file.write("round"), "", origin});
    const double share = 5.0 / 60;  // from 180 towards 120
    EXPECT_NEAR(field->water_at({0, 0, 0}, 0).temperature_degc, (1 - share) * 9 + share * 9.5,
                tolerance(1e-5));
    EXPECT_NEAR(column(file, "round", origin).rows[0].temperature_degc, (1 - share) * 9 + share * 9.5,
                tolerance(1e-5));
  }
}

TEST(WaterColumn, ALongitudeOutsideIsStatedAsTheScenarioHasIt) {
  SeaFile file;
  file.longitude.values = {300, 310, 320};
  try {
    read_ocean_field({file.write("outside"), "", {to_radians(43.2), to_radians(-30)}});
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("longitude of the scenario's origin is -30 deg; allowed is -60 to -40 deg"));
  }
}

TEST(WaterColumn, LevelsThatFollowTheTerrainAreNamed) {
  SeaFile file;
  file.depth = {"s_rho",
                {-0.875, -0.625, -0.375, -0.125},
                {{"standard_name", "ocean_s_coordinate_g2"},
                 {"positive", "up"},
                 {"formula_terms", "s: s_rho C: Cs_r"}}};
  file.order[1] = "s_rho";
  EXPECT_THAT(
      refusal(file, "sigma"),
      AllOf(HasSubstr("s_rho: its levels follow the terrain (ocean_s_coordinate_g2)"), HasSubstr("cdo")));
}

TEST(WaterColumn, AnAxisWithoutValuesIsRefused) {
  SeaFile file;
  file.time.values = {};
  EXPECT_THAT(refusal(file, "no-times"), HasSubstr("time: has no values"));
  EXPECT_THROW(read_ocean_field({file.write("no-times"), "", kPlace}), InvalidArgument);
}

TEST(WaterColumn, AnAxisOfOneValueWithoutMeaningIsNoObstacle) {
  SeaFile file;
  file.time = {"member", {1}, {}};
  file.order[0] = "member";
  EXPECT_THAT(depths_of(column(file, "member")), ElementsAre(0, 100, 1000, 4000));
  file.time.values = {1, 2};
  EXPECT_THAT(refusal(file, "members"), HasSubstr("its dimension member is no axis of time"));
}

TEST(WaterColumn, ContradictionsAreRefused) {
  SeaFile file;
  file.depth.attributes = {{"units", "m"}, {"positive", "down"}, {"standard_name", "height"}};
  EXPECT_THAT(refusal(file, "contradiction"), HasSubstr("they contradict each other"));
}

}  // namespace
}  // namespace halocline::ocean
