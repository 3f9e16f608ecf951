// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_time.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "ocean/potential_temperature.h"
#include "tests/support/tolerance.h"

namespace halocline::ocean {
namespace {

using halocline::testing::tolerance;

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

// Leap years as each calendar has them (CF 1.10, section 4.4.1), and the ten days that the standard one
// leaves out.
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
  EXPECT_NE(
      refused("months since 2000-01-01", "").find("allowed are seconds, minutes, hours, days or another"),
      std::string::npos);
  EXPECT_NE(refused("days since 2000-13-01", "").find("2000-13-01"), std::string::npos);
  EXPECT_NE(refused("days since 2001-02-29", "").find("2001-02-29"), std::string::npos);
  EXPECT_NE(refused("days since 2000-01-01 06:00:00 EST", "").find("EST"), std::string::npos);
  EXPECT_NE(refused("days since 2000-01-01", "lunar").find("360_day"), std::string::npos);
  EXPECT_EQ(refused("days since 2001-02-29", "all_leap"), "taken");
}

// Units of published files, and dates made by cftime 1.6.
struct Instant {
  const char *units, *calendar;
  double value;
  const char* date;  // to the second
};
const std::vector<Instant> kInstants{
    {"seconds since 1968-05-23 00:00:00 GMT", "", 1700000000, "2022-04-05T22:13:20Z"},
    {"hours since 2000-01-01 00:00:00 UTC", "", 6, "2000-01-01T06:00:00Z"},
    {"hours since 2000-01-01T00:00:00Z", "", 6, "2000-01-01T06:00:00Z"},
    {"hours since 2000-01-01 00:00:00 Z", "", 6, "2000-01-01T06:00:00Z"},
    {"seconds since 1970-01-01 00:00:00 +0000", "", 1, "1970-01-01T00:00:01Z"},
    {"seconds since 1970-01-01 00:00:00 +00:00", "", 1, "1970-01-01T00:00:01Z"},
    {"seconds since 1970-01-01 00:00:00+00:00", "", 1, "1970-01-01T00:00:01Z"},
    {"hours since 2024-10-08 15:15:42.5 -6:00", "", 0, "2024-10-08T21:15:42Z"},
    {"hours since 2024-10-08 15:15:42.5 -06:00", "", 0, "2024-10-08T21:15:42Z"},
    {"hours since 2024-10-08 15:15:42.5 -600", "", 0, "2024-10-08T21:15:42Z"},
    {"hours since 2024-10-08 15:15:42.5 +05:30", "", 0, "2024-10-08T09:45:42Z"},
    {"hours since 2000-01-01 00", "", 3, "2000-01-01T03:00:00Z"},
    {"hours since 2000-01-01 6", "", 0, "2000-01-01T06:00:00Z"},
    {"hours since 2000-1-1 0:0:0", "", 3, "2000-01-01T03:00:00Z"},
    {"hours since 2000-01-01 06:00", "", 0, "2000-01-01T06:00:00Z"},
    {"hours since 2000-01-01 00:00:00.000000", "", 3, "2000-01-01T03:00:00Z"},
    {"days since 1950-01-01T00:00:00Z", "", 27028.25, "2024-01-01T06:00:00Z"},
    {"Days since 1950-01-01", "", 1, "1950-01-02T00:00:00Z"},
    {"DAYS SINCE 1950-01-01", "", 1, "1950-01-02T00:00:00Z"},
    {"days since 20000101", "", 1, "2000-01-02T00:00:00Z"},
    {"days since 20000101T060000", "", 0, "2000-01-01T06:00:00Z"},
    {"milliseconds since 1970-01-01", "", 1700000000000, "2023-11-14T22:13:20Z"},
    {"ms since 1970-01-01", "", 1700000000000, "2023-11-14T22:13:20Z"},
    {"msec since 1970-01-01", "", 1700000000000, "2023-11-14T22:13:20Z"},
    {"microseconds since 1970-01-01", "", 1700000000000000, "2023-11-14T22:13:20Z"},
    {"nanoseconds since 1970-01-01", "", 1.7e+18, "2023-11-14T22:13:20Z"},
    {"minutes since 2000-01-01", "", 90, "2000-01-01T01:30:00Z"},
    {"min since 2000-01-01", "", 90, "2000-01-01T01:30:00Z"},
    {"mins since 2000-01-01", "", 90, "2000-01-01T01:30:00Z"},
    {"hrs since 2000-01-01", "", 3, "2000-01-01T03:00:00Z"},
    {"hr since 2000-01-01", "", 3, "2000-01-01T03:00:00Z"},
    {"h since 2000-01-01", "", 3, "2000-01-01T03:00:00Z"},
    {"d since 2000-01-01", "", 1, "2000-01-02T00:00:00Z"},
    {"secs since 2000-01-01", "", 1, "2000-01-01T00:00:01Z"},
    {"weeks since 2000-01-01", "", 1, "2000-01-08T00:00:00Z"},
    {"hours after 2000-01-01", "", 3, "2000-01-01T03:00:00Z"},
    {"hours from 2000-01-01", "", 3, "2000-01-01T03:00:00Z"},
    {"days since 1970", "", 1, "1970-01-02T00:00:00Z"},
    {"days since 0001-01-01 00:00:00", "", 738887, "2024-01-01T00:00:00Z"},
    {"days since 0001-01-01 00:00:00", "proleptic_gregorian", 738885, "2024-01-01T00:00:00Z"},
    {"days since 2000-01-01", "julian", 60, "2000-03-01T00:00:00Z"},
    {"days since 2000-01-01", "360_day", 60, "2000-03-01T00:00:00Z"},
    {"days since 2000-01-01", "noleap", 59, "2000-03-01T00:00:00Z"},
    {"days since 2001-01-01", "all_leap", 60, "2001-03-01T00:00:00Z"},
    {"days since 2000-01-01", "366_day", 60, "2000-03-01T00:00:00Z"},
    {"hours since 1900-01-01", "gregorian", 1086966, "2024-01-01T06:00:00Z"},
    {"days since 1-Jan-2000 00:00:0.0", "", 1, "2000-01-02T00:00:00Z"},
};

TEST(CfTime, UnitsOfPublishedFilesGiveTheirDates) {
  for (const Instant& one : kInstants) {
    const CfTimeAxis axis = CfTimeAxis::parse(one.units, one.calendar);
    constexpr double kRoundingS = 1e-3;  // of a double after 2000 years: 8 us
    EXPECT_EQ(axis.date_of(axis.seconds_at(one.value) + kRoundingS), one.date) << one.units;
  }
}

TEST(CfTime, UnitsWithoutADateOrAFixedLengthAreRefused) {
  for (const char* units : {
           "days since 2000-02-30",
           "days since 2001-02-29",
           "days since 0000-01-01",
           "seconds since 2000-01-01 00:00:00 EST",
           "day as %Y%m%d.%f",
           "months since 1955-01-01 00:00:00",
           "years since 2000-01-01",
           "second",
           "m since 2000-01-01",
           "hours since",
           "",
       }) {
    EXPECT_THROW(CfTimeAxis::parse(units, ""), InvalidArgument) << units;
  }
}

// The check value of UNESCO Technical Paper 44, and back.
TEST(PotentialTemperature, IsThatOfTheTables) {
  EXPECT_NEAR(adiabatic_temperature_degc(40, 40, 10'000, 0), 36.89073, tolerance(5e-6));
  EXPECT_NEAR(adiabatic_temperature_degc(40, 36.89073, 0, 10'000), 40, tolerance(1e-4));
  EXPECT_EQ(in_situ_temperature_degc(35, 10, 0, 0.7), 10);
}

}  // namespace
}  // namespace halocline::ocean
