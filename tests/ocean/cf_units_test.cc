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
  QuantityKind quantity;
  const char* units;
  double value, expected;
};
const std::vector<Spelling> kSpellings{
    {QuantityKind::kTemperature, "degC", 1, 1},
    {QuantityKind::kTemperature, "deg_C", 1, 1},
    {QuantityKind::kTemperature, "Celsius", 1, 1},
    {QuantityKind::kTemperature, "celsius", 1, 1},
    {QuantityKind::kTemperature, "degree_Celsius", 1, 1},
    {QuantityKind::kTemperature, "degrees_celsius", 1, 1},
    {QuantityKind::kTemperature, "degree_C", 1, 1},
    {QuantityKind::kTemperature, "degrees_C", 1, 1},
    {QuantityKind::kTemperature, "°C", 1, 1},
    {QuantityKind::kTemperature, "degrees C", 1, 1},
    {QuantityKind::kTemperature, "degree C", 1, 1},
    {QuantityKind::kTemperature, "deg C", 1, 1},
    {QuantityKind::kTemperature, "degs C", 1, 1},
    {QuantityKind::kTemperature, "deg. C", 1, 1},
    {QuantityKind::kTemperature, "C", 1, 1},
    {QuantityKind::kTemperature, "K", 293.15, 20},
    {QuantityKind::kTemperature, "kelvin", 293.15, 20},
    {QuantityKind::kTemperature, "Kelvin", 293.15, 20},
    {QuantityKind::kTemperature, "degK", 293.15, 20},
    {QuantityKind::kTemperature, "degF", 68, 20},
    {QuantityKind::kTemperature, "1", 1, kRefused},
    {QuantityKind::kTemperature, "m", 1, kRefused},
    {QuantityKind::kTemperature, "", 1, kRefused},
    {QuantityKind::kSpeed, "m/s", 1, 1},
    {QuantityKind::kSpeed, "m s-1", 1, 1},
    {QuantityKind::kSpeed, "m.s-1", 1, 1},
    {QuantityKind::kSpeed, "m s^-1", 1, 1},
    {QuantityKind::kSpeed, "m s**-1", 1, 1},
    {QuantityKind::kSpeed, "meter second-1", 1, 1},
    {QuantityKind::kSpeed, "Ms-1", 1, 1},
    {QuantityKind::kSpeed, "M/SEC", 1, 1},
    {QuantityKind::kSpeed, "m/sec", 1, 1},
    {QuantityKind::kSpeed, "cm/s", 1, 0.01},
    {QuantityKind::kSpeed, "cm s-1", 1, 0.01},
    {QuantityKind::kSpeed, "knot", 1, 0.5144444444},
    {QuantityKind::kSpeed, "kt", 1, 0.5144444444},
    {QuantityKind::kSpeed, "kts", 1, 0.5144444444},
    {QuantityKind::kSpeed, "km/h", 3.6, 1},
    {QuantityKind::kSpeed, "m", 1, kRefused},
    {QuantityKind::kSpeed, "", 1, kRefused},
    {QuantityKind::kSalinity, "1", 35, 35},
    {QuantityKind::kSalinity, "1e-3", 35, 35},
    {QuantityKind::kSalinity, "0.001", 35, 35},
    {QuantityKind::kSalinity, "psu", 35, 35},
    {QuantityKind::kSalinity, "PSU", 35, 35},
    {QuantityKind::kSalinity, "PSS-78", 35, 35},
    {QuantityKind::kSalinity, "pss", 35, 35},
    {QuantityKind::kSalinity, "PSS78", 35, 35},
    {QuantityKind::kSalinity, "", 35, 35},
    {QuantityKind::kSalinity, "ppt", 35, 35},
    {QuantityKind::kSalinity, "g kg-1", 35, 35},
    {QuantityKind::kSalinity, "parts per thousand", 35, 35},
    {QuantityKind::kSalinity, "Practical Salinity Scale", 35, 35},
    {QuantityKind::kLength, "m", 1, 1},
    {QuantityKind::kLength, "meter", 1, 1},
    {QuantityKind::kLength, "meters", 1, 1},
    {QuantityKind::kLength, "metres", 1, 1},
    {QuantityKind::kLength, "Meters", 1, 1},
    {QuantityKind::kLength, "km", 1, 1000},
    {QuantityKind::kLength, "100 km", 1, 100000},
    {QuantityKind::kLength, "cm", 1, 0.01},
    {QuantityKind::kLength, "ft", 1, 0.3048},
    {QuantityKind::kLength, "feet", 1, 0.3048},
    {QuantityKind::kLength, "foot", 1, 0.3048},
    {QuantityKind::kLength, "US_survey_foot", 1, 0.3048006096},
    {QuantityKind::kLength, "us-ft", 1, 0.3048006096},
    {QuantityKind::kLength, "fathom", 1, 1.8288},
    {QuantityKind::kLength, "fathoms", 1, 1.8288},
    {QuantityKind::kLength, "level", 1, kRefused},
    {QuantityKind::kLength, "sigma_level", 1, kRefused},
    {QuantityKind::kLength, "1", 1, kRefused},
    {QuantityKind::kPressure, "dbar", 1, 1},
    {QuantityKind::kPressure, "decibar", 1, 1},
    {QuantityKind::kPressure, "decibars", 1, 1},
    {QuantityKind::kPressure, "db", 1, 1},
    {QuantityKind::kPressure, "dBar", 1, 1},
    {QuantityKind::kPressure, "bar", 1, 10},
    {QuantityKind::kPressure, "Pa", 10000, 1},
    {QuantityKind::kPressure, "MPa", 1, 100},
    {QuantityKind::kPressure, "psi", 1, 0.689475729},
    {QuantityKind::kPressure, "PSI", 1, 0.689475729},
    {QuantityKind::kAngle, "degrees_north", 1, 1},
    {QuantityKind::kAngle, "degree_north", 1, 1},
    {QuantityKind::kAngle, "degree_N", 1, 1},
    {QuantityKind::kAngle, "degrees_N", 1, 1},
    {QuantityKind::kAngle, "degreeN", 1, 1},
    {QuantityKind::kAngle, "degreesN", 1, 1},
    {QuantityKind::kAngle, "degrees_east", 1, 1},
    {QuantityKind::kAngle, "degree_E", 1, 1},
    {QuantityKind::kAngle, "degrees", 1, 1},
    {QuantityKind::kAngle, "degree", 1, 1},
    {QuantityKind::kAngle, "deg", 1, 1},
    {QuantityKind::kAngle, "radian", 1, 57.29577951},
    {QuantityKind::kAngle, "radians", 1, 57.29577951},
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
    const auto unit = unit_in(QuantityKind::kTime, units);
    ASSERT_TRUE(unit) << units;
    EXPECT_NEAR(unit->factor, expected_s, tolerance(1e-12 * expected_s)) << units;
  }
  for (const char* units : {"months", "years", "m", "s s", "1", "", "furlong", "s-1", "/", "s /", "1e999 s"})
    EXPECT_FALSE(unit_in(QuantityKind::kTime, units)) << units;
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
