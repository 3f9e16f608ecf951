// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline::ocean {
namespace {

using halocline::testing::tolerance;

constexpr double kRefused = std::numeric_limits<double>::infinity();

// A value in a unit, and the same in ours: spellings of published files. Constants: NIST SP 811, and the
// fathom of 6 feet.
struct Spelling {
  Quantity quantity;
  const char* units;
  double value, expected;
};
const std::vector<Spelling> kSpellings{
    {Quantity::kTemperature, "degC", 1, 1},
    {Quantity::kTemperature, "deg_C", 1, 1},
    {Quantity::kTemperature, "Celsius", 1, 1},
    {Quantity::kTemperature, "celsius", 1, 1},
    {Quantity::kTemperature, "degree_Celsius", 1, 1},
    {Quantity::kTemperature, "degrees_celsius", 1, 1},
    {Quantity::kTemperature, "degree_C", 1, 1},
    {Quantity::kTemperature, "degrees_C", 1, 1},
    {Quantity::kTemperature, "°C", 1, 1},
    {Quantity::kTemperature, "degrees C", 1, 1},
    {Quantity::kTemperature, "degree C", 1, 1},
    {Quantity::kTemperature, "deg C", 1, 1},
    {Quantity::kTemperature, "degs C", 1, 1},
    {Quantity::kTemperature, "deg. C", 1, 1},
    {Quantity::kTemperature, "C", 1, 1},
    {Quantity::kTemperature, "K", 293.15, 20},
    {Quantity::kTemperature, "kelvin", 293.15, 20},
    {Quantity::kTemperature, "Kelvin", 293.15, 20},
    {Quantity::kTemperature, "degK", 293.15, 20},
    {Quantity::kTemperature, "degF", 68, 20},
    {Quantity::kTemperature, "1", 1, kRefused},
    {Quantity::kTemperature, "m", 1, kRefused},
    {Quantity::kTemperature, "", 1, kRefused},
    {Quantity::kSpeed, "m/s", 1, 1},
    {Quantity::kSpeed, "m s-1", 1, 1},
    {Quantity::kSpeed, "m.s-1", 1, 1},
    {Quantity::kSpeed, "m s^-1", 1, 1},
    {Quantity::kSpeed, "m s**-1", 1, 1},
    {Quantity::kSpeed, "meter second-1", 1, 1},
    {Quantity::kSpeed, "Ms-1", 1, 1},
    {Quantity::kSpeed, "M/SEC", 1, 1},
    {Quantity::kSpeed, "m/sec", 1, 1},
    {Quantity::kSpeed, "cm/s", 1, 0.01},
    {Quantity::kSpeed, "cm s-1", 1, 0.01},
    {Quantity::kSpeed, "knot", 1, 0.5144444444},
    {Quantity::kSpeed, "kt", 1, 0.5144444444},
    {Quantity::kSpeed, "kts", 1, 0.5144444444},
    {Quantity::kSpeed, "km/h", 3.6, 1},
    {Quantity::kSpeed, "m", 1, kRefused},
    {Quantity::kSpeed, "", 1, kRefused},
    {Quantity::kSalinity, "1", 35, 35},
    {Quantity::kSalinity, "1e-3", 35, 35},
    {Quantity::kSalinity, "0.001", 35, 35},
    {Quantity::kSalinity, "psu", 35, 35},
    {Quantity::kSalinity, "PSU", 35, 35},
    {Quantity::kSalinity, "PSS-78", 35, 35},
    {Quantity::kSalinity, "pss", 35, 35},
    {Quantity::kSalinity, "PSS78", 35, 35},
    {Quantity::kSalinity, "", 35, 35},
    {Quantity::kSalinity, "ppt", 35, 35},
    {Quantity::kSalinity, "g kg-1", 35, 35},
    {Quantity::kSalinity, "parts per thousand", 35, 35},
    {Quantity::kSalinity, "Practical Salinity Scale", 35, 35},
    {Quantity::kLength, "m", 1, 1},
    {Quantity::kLength, "meter", 1, 1},
    {Quantity::kLength, "meters", 1, 1},
    {Quantity::kLength, "metres", 1, 1},
    {Quantity::kLength, "Meters", 1, 1},
    {Quantity::kLength, "km", 1, 1000},
    {Quantity::kLength, "100 km", 1, 100000},
    {Quantity::kLength, "cm", 1, 0.01},
    {Quantity::kLength, "ft", 1, 0.3048},
    {Quantity::kLength, "feet", 1, 0.3048},
    {Quantity::kLength, "foot", 1, 0.3048},
    {Quantity::kLength, "US_survey_foot", 1, 0.3048006096},
    {Quantity::kLength, "us-ft", 1, 0.3048006096},
    {Quantity::kLength, "fathom", 1, 1.8288},
    {Quantity::kLength, "fathoms", 1, 1.8288},
    {Quantity::kLength, "level", 1, kRefused},
    {Quantity::kLength, "sigma_level", 1, kRefused},
    {Quantity::kLength, "1", 1, kRefused},
    {Quantity::kPressure, "dbar", 1, 1},
    {Quantity::kPressure, "decibar", 1, 1},
    {Quantity::kPressure, "decibars", 1, 1},
    {Quantity::kPressure, "db", 1, 1},
    {Quantity::kPressure, "dBar", 1, 1},
    {Quantity::kPressure, "bar", 1, 10},
    {Quantity::kPressure, "Pa", 10000, 1},
    {Quantity::kPressure, "MPa", 1, 100},
    {Quantity::kPressure, "psi", 1, 0.689475729},
    {Quantity::kPressure, "PSI", 1, 0.689475729},
    {Quantity::kAngle, "degrees_north", 1, 1},
    {Quantity::kAngle, "degree_north", 1, 1},
    {Quantity::kAngle, "degree_N", 1, 1},
    {Quantity::kAngle, "degrees_N", 1, 1},
    {Quantity::kAngle, "degreeN", 1, 1},
    {Quantity::kAngle, "degreesN", 1, 1},
    {Quantity::kAngle, "degrees_east", 1, 1},
    {Quantity::kAngle, "degree_E", 1, 1},
    {Quantity::kAngle, "degrees", 1, 1},
    {Quantity::kAngle, "degree", 1, 1},
    {Quantity::kAngle, "deg", 1, 1},
    {Quantity::kAngle, "radian", 1, 57.29577951},
    {Quantity::kAngle, "radians", 1, 57.29577951},
};

TEST(CfUnits, SpellingsOfTheSeaMeanWhatTheirAuthorsMeant) {
  for (const Spelling& one : kSpellings) {
    const auto unit = unit_in(one.quantity, one.units);
    const double found = unit ? (*unit)(one.value) : kRefused;
    if (std::isfinite(one.expected))
      EXPECT_NEAR(found, one.expected, tolerance(1e-8 * std::max(1.0, std::abs(one.expected)))) << one.units;
    else
      EXPECT_EQ(found, kRefused) << one.units;
  }
}

TEST(CfUnits, AnyUnitOfFixedLengthIsOneOfTime) {
  for (const auto& [units, expected_s] : std::vector<std::pair<std::string, double>>{{"ms", 1e-3},
                                                                                     {"microseconds", 1e-6},
                                                                                     {"ns", 1e-9},
                                                                                     {"weeks", 604'800},
                                                                                     {"6 hours", 21'600},
                                                                                     {"kiloseconds", 1e3},
                                                                                     {"Days", 86'400},
                                                                                     {"fortnight", 1'209'600},
                                                                                     {"min", 60}}) {
    const auto unit = unit_in(Quantity::kTime, units);
    ASSERT_TRUE(unit) << units;
    EXPECT_NEAR(unit->factor, expected_s, tolerance(1e-12 * expected_s)) << units;
  }
  for (const char* units : {"months", "years", "m", "s s", "1", "", "furlong", "s-1", "/", "s /", "1e999 s"})
    EXPECT_FALSE(unit_in(Quantity::kTime, units)) << units;
}

TEST(CfUnits, DegreesTellNorthFromEast) {
  for (const char* units : {"degrees_north", "degree_N", "degreesN", "DEGREES_NORTH"})
    EXPECT_EQ(direction_in(units), Direction::kNorth) << units;
  for (const char* units : {"degrees_east", "degree_E", "degreeE"})
    EXPECT_EQ(direction_in(units), Direction::kEast) << units;
  for (const char* units : {"degrees", "degree", "deg C", "m", ""})
    EXPECT_EQ(direction_in(units), Direction::kUnknown) << units;
}

}  // namespace
}  // namespace halocline::ocean
