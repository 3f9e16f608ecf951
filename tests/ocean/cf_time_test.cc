// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_time.h"

#include <gtest/gtest.h>

#include "core/check.h"
#include "ocean/potential_temperature.h"
#include "tests/support/tolerance.h"

namespace halocline::ocean {
namespace {

using testing::tolerance;

constexpr double kDayS = 86'400;

double days_between(const std::string& calendar, const std::string& from, const std::string& to) {
  const CfTimeAxis axis = CfTimeAxis::parse("days since 1900-01-01", calendar);
  return (axis.seconds_of(to) - axis.seconds_of(from)) / kDayS;
}

TEST(CfTime, UnitsCountFromTheirDate) {
  const CfTimeAxis hours = CfTimeAxis::parse("hours since 2000-01-01 00:00:00", "");
  EXPECT_EQ(hours.seconds_at(24) - hours.seconds_of("2000-01-01T06:00:00Z"), 18 * 3600);
  const CfTimeAxis days = CfTimeAxis::parse("days since 2026-05-01 12:00:00 UTC", "proleptic_gregorian");
  EXPECT_EQ(days.seconds_at(0.5), days.seconds_of("2026-05-02"));
  const CfTimeAxis seconds = CfTimeAxis::parse("seconds since 1970-01-01T00:00:00Z", "gregorian");
  EXPECT_EQ(seconds.date_of(seconds.seconds_at(1'700'000'000)), "2023-11-14T22:13:20Z");
}

// Leap years as each calendar has them (CF 1.10, section 4.4.1), and the ten days that the standard one leaves out.
TEST(CfTime, EachCalendarHasItsOwnDays) {
  EXPECT_EQ(days_between("standard", "1900-02-28", "1900-03-01"), 1);
  EXPECT_EQ(days_between("julian", "1900-02-28", "1900-03-01"), 2);
  EXPECT_EQ(days_between("standard", "2000-02-28", "2000-03-01"), 2);
  EXPECT_EQ(days_between("noleap", "2000-02-28", "2000-03-01"), 1);
  EXPECT_EQ(days_between("all_leap", "2001-02-28", "2001-03-01"), 2);
  EXPECT_EQ(days_between("360_day", "2001-02-30", "2001-03-01"), 1);
  EXPECT_EQ(days_between("360_day", "2001-01-01", "2002-01-01"), 360);
  EXPECT_EQ(days_between("365_day", "2000-01-01", "2004-01-01"), 4 * 365);
  EXPECT_EQ(days_between("standard", "1582-10-04", "1582-10-15"), 1);
  EXPECT_EQ(days_between("proleptic_gregorian", "1582-10-04", "1582-10-15"), 11);
  EXPECT_EQ(days_between("standard", "0001-01-01", "2000-01-01"), 730'121);  // Julian from then on
  EXPECT_EQ(days_between("proleptic_gregorian", "0001-01-01", "2000-01-01"), 730'119);
}

TEST(CfTime, DatesAndSecondsAreInverse) {
  for (const char* calendar : {"standard", "julian", "noleap", "all_leap", "360_day"}) {
    const CfTimeAxis axis = CfTimeAxis::parse("days since 1999-12-30", calendar);
    for (int day = 0; day < 1500; ++day) {
      const double seconds = axis.seconds_at(day + 0.25);
      EXPECT_EQ(axis.seconds_of(axis.date_of(seconds)), seconds) << calendar << ' ' << axis.date_of(seconds);
    }
  }
}

TEST(CfTime, WhatIsWrongIsNamed) {
  const auto refused = [](const std::string& units, const std::string& calendar) {
    try {
      CfTimeAxis::parse(units, calendar);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_NE(refused("months since 2000-01-01", "").find("allowed are seconds, minutes, hours or days"),
            std::string::npos);
  EXPECT_NE(refused("days since 2000-13-01", "").find("2000-13-01"), std::string::npos);
  EXPECT_NE(refused("days since 2001-02-29", "").find("2001-02-29"), std::string::npos);
  EXPECT_NE(refused("days since 2000-01-01 06:00:00+02:00", "").find("UTC"), std::string::npos);
  EXPECT_NE(refused("days since 2000-01-01", "lunar").find("360_day"), std::string::npos);
  EXPECT_EQ(refused("days since 2001-02-29", "all_leap"), "taken");
}

// The check value of UNESCO Technical Paper 44, and back.
TEST(PotentialTemperature, IsThatOfTheTables) {
  EXPECT_NEAR(adiabatic_temperature_degc(40, 40, 10'000, 0), 36.89073, tolerance(5e-6));
  EXPECT_NEAR(adiabatic_temperature_degc(40, 36.89073, 0, 10'000), 40, tolerance(1e-4));
  EXPECT_EQ(in_situ_temperature_degc(35, 10, 0, 0.7), 10);
}

}  // namespace
}  // namespace halocline::ocean
