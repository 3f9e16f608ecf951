// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/ocean_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::ocean {
namespace {

using halocline::testing::tolerance;

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr GeodeticOrigin kGridOrigin{to_radians(40), to_radians(-50)};

OceanGrid small_grid() {
  OceanGrid grid;
  grid.times_s = {0, 3600};
  grid.depths_m = {0, 50, 200};
  grid.latitudes_rad = {to_radians(39.5), to_radians(40), to_radians(40.75)};
  grid.longitudes_rad = {to_radians(-50.5), to_radians(-50), to_radians(-49.25)};
  return grid;
}

template <class Function>
std::vector<float> values_of(const OceanGrid& grid, const Function& function) {
  std::vector<float> values;
  for (const double time : grid.times_s)
    for (const double depth : grid.depths_m)
      for (const double latitude : grid.latitudes_rad)
        for (const double longitude : grid.longitudes_rad)
          values.push_back(
              static_cast<float>(function(time, depth, to_degrees(latitude), to_degrees(longitude))));
  return values;
}

OceanValues constant(const OceanGrid& grid) {
  const std::vector<float> zero(grid.levels() * grid.columns(), 0.F);
  return {zero, zero, std::vector<float>(zero.size(), 10.F), std::vector<float>(zero.size(), 35.F)};
}

// Linear interpolation gives back what is linear in each axis, products among them.
TEST(OceanField, IsLinearInSpaceAndTime) {
  const OceanGrid grid = small_grid();
  OceanValues values = constant(grid);
  const auto linear = [](double time, double depth, double latitude, double longitude) {
    return 10 + time / 3600 + depth / 100 + 2 * (latitude - 40) * (longitude + 50) +
           (latitude - 40) * time / 3600;
  };
  values.temperature_degc = values_of(grid, linear);
  const OceanField field(grid, values, kGridOrigin);
  const double metres_per_degree = to_radians(6'359'000.0);  // along the meridian at 40 degrees, within 0.1 %
  const double north_m = 0.3 * metres_per_degree;
  const double expected = linear(900, 80, 40.3, -50);
  EXPECT_NEAR(field.water_at({north_m, 0, 80}, 900).temperature_degc, expected, tolerance(1e-3));
  EXPECT_NEAR(field.water_at({0, 0, 20}, 1800).temperature_degc, linear(1800, 20, 40, -50), tolerance(1e-6));
  const auto column = field.column_at(north_m, 0, 900);
  ASSERT_EQ(column.size(), 3U);
  const double share = (80.0 - 50) / 150;
  EXPECT_NEAR(column[1].temperature_degc + share * (column[2].temperature_degc - column[1].temperature_degc),
              field.water_at({north_m, 0, 80}, 900).temperature_degc, tolerance(1e-12));
}

TEST(OceanField, HoldsItsEdges) {
  const OceanGrid grid = small_grid();
  OceanValues values = constant(grid);
  values.temperature_degc = values_of(grid, [](double time, double depth, double latitude, double) {
    return 10 + time / 3600 - depth / 100 + latitude - 40;
  });
  const OceanField field(grid, values, kGridOrigin);
  EXPECT_EQ(field.water_at({0, 0, -3}, -100).temperature_degc, field.water_at({0, 0, 0}, 0).temperature_degc);
  EXPECT_EQ(field.water_at({0, 0, 4000}, 9e9).temperature_degc,
            field.water_at({0, 0, 200}, 3600).temperature_degc);
  EXPECT_EQ(field.water_at({9e5, 0, 0}, 0).temperature_degc, field.water_at({5e5, 0, 0}, 0).temperature_degc);
}

// Against the transverse Mercator projection (Karney 2011, as GeographicLib has it): origin 40 N 50 W, the
// place 0.25 degrees north and 0.3 degrees east of it lies 27 798 m north and 25 508 m east.
TEST(OceanField, PlacesAreThoseOfTheWorldsFrame) {
  OceanGrid grid = small_grid();
  grid.latitudes_rad = {to_radians(39.5), to_radians(40.25), to_radians(41)};
  grid.longitudes_rad = {to_radians(-50.5), to_radians(-49.7), to_radians(-49)};
  OceanValues values = constant(grid);
  values.temperature_degc = values_of(grid, [](double, double, double latitude, double longitude) {
    return 10 + 20 * (std::abs(latitude - 40.25) + std::abs(longitude + 49.7));
  });
  const OceanField field(grid, values, kGridOrigin);
  double least = 100, north_m = 0, east_m = 0;
  for (double x = 27'600; x < 28'000; x += 10) {
    for (double y = 25'300; y < 25'700; y += 10) {
      const double t = field.water_at({x, y, 0}, 0).temperature_degc;
      if (t >= least) continue;
      least = t;
      north_m = x;
      east_m = y;
    }
  }
  // M(40..40.25) * 0.25 deg + N sin cos (0.3 deg)^2 / 2; N cos (0.3 deg).
  EXPECT_NEAR(north_m, 27'758.9 + 43.2, tolerance(12));
  EXPECT_NEAR(east_m, 25'512.6, tolerance(12));
}

// Towards the true east means a little to the south of the grid's east, east of the origin's meridian in the
// north.
TEST(OceanField, CurrentsTurnWithTheMeridians) {
  const OceanGrid grid = small_grid();
  OceanValues values = constant(grid);
  values.east_mps.assign(values.east_mps.size(), 1.F);
  const OceanField field(grid, values, kGridOrigin);
  EXPECT_EQ(field.current_ned_mps({0, 0, 10}, 0), Vec3(0, 1, 0));
  const double east_m = 50'000, radius_m = 6'387'000;
  const double turn = east_m / radius_m * std::tan(to_radians(40));
  const Vec3 current = field.current_ned_mps({0, east_m, 10}, 0);
  EXPECT_NEAR(current.x(), turn, tolerance(2e-5));
  EXPECT_NEAR(current.norm(), 1, tolerance(1e-9));
}

TEST(OceanField, FillsTheSeabedFromAboveAndLandFromTheNearestColumn) {
  const OceanGrid grid = small_grid();
  OceanValues values = constant(grid);
  auto& t = values.temperature_degc;
  const auto at = [&](std::size_t depth, std::size_t row, std::size_t column) -> float& {
    return t[(depth * 3 + row) * 3 + column];
  };
  at(0, 1, 1) = 12;
  at(1, 1, 1) = 8;
  at(2, 1, 1) = kMissing;                                                      // seabed
  for (std::size_t depth = 0; depth < 3; ++depth) at(depth, 1, 2) = kMissing;  // land
  at(0, 0, 2) = 15;  // a step away, and before the others
  const OceanField field(grid, values, kGridOrigin);
  EXPECT_EQ(field.water_at({0, 0, 200}, 0).temperature_degc, 8);
  EXPECT_EQ(field.water_at({0, 1e6, 0}, 0).temperature_degc, 15);
}

TEST(OceanField, CrossesTheLinesOfItsGrid) {
  const OceanGrid grid = small_grid();
  const OceanField field(grid, constant(grid), kGridOrigin);
  const std::vector<double> level = field.crossings({-20'000, 5000, 20}, {20'000, 5000, 20});
  ASSERT_EQ(level.size(), 1U);  // the row through the origin
  EXPECT_NEAR(level[0], 0.5, tolerance(1e-3));
  const std::vector<double> down = field.crossings({100, 100, 0}, {100, 100, 100});
  ASSERT_EQ(down.size(), 1U);
  EXPECT_DOUBLE_EQ(down[0], 0.5);
}

TEST(OceanField, RefusesWhatItCannotBe) {
  const auto refusal = [](const OceanGrid& grid, const OceanValues& values, const GeodeticOrigin& origin) {
    try {
      OceanField(grid, values, origin);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  const OceanGrid grid = small_grid();
  EXPECT_EQ(refusal(grid, constant(grid), kGridOrigin), "taken");
  EXPECT_EQ(refusal(grid, constant(grid), {kGridOrigin.latitude_rad, to_radians(310)}),
            "taken");  // another turn
  EXPECT_NE(refusal(grid, constant(grid), {to_radians(45), kGridOrigin.longitude_rad})
                .find("latitude of the scenario's origin is 45 deg; allowed is 39.5 to 40.75 deg"),
            std::string::npos);
  OceanValues hot = constant(grid);
  hot.temperature_degc[5] = 50;
  EXPECT_NE(refusal(grid, hot, kGridOrigin).find("temperature is 50 degC; allowed is -5 to 45 degC"),
            std::string::npos);
  OceanValues empty = constant(grid);
  std::fill(empty.north_mps.begin() + 27, empty.north_mps.end(), kMissing);
  EXPECT_NE(refusal(grid, empty, kGridOrigin).find("northward current has no value at time 1"),
            std::string::npos);
  OceanGrid falling = grid;
  falling.depths_m = {0, 100, 50};
  EXPECT_NE(refusal(falling, constant(grid), kGridOrigin).find("the axis of depth does not rise"),
            std::string::npos);
}

}  // namespace
}  // namespace halocline::ocean
