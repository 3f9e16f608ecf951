// SPDX-License-Identifier: BSD-3-Clause
// Instants in the CF conventions: "hours since 2000-01-01 00:00:00" in one of six calendars.
//
// Model. An instant is a number of seconds since midnight at the start of day 0 of its calendar; only
// differences within one calendar are meaningful. Calendars (CF 1.10, section 4.4.1):
//
//   standard or gregorian    Julian dates up to 1582-10-04, Gregorian from 1582-10-15
//   proleptic_gregorian
//   julian
//   noleap or 365_day
//   all_leap or 366_day
//   360_day
//
// Julian day numbers follow Fliegel and Van Flandern 1968. Times are UTC without leap seconds. Error: 20 us,
// the resolution of a double after 2000 years.
//
//   const CfTimeAxis axis = CfTimeAxis::parse("hours since 2000-01-01", "standard");
//   const double later_s = axis.seconds_at(24) - axis.seconds_of("2000-01-01T06:00:00Z");  // 64 800
#pragma once

#include <string>

namespace halocline::ocean {

enum class Calendar { kStandard, kProlepticGregorian, kJulian, kNoLeap, kAllLeap, k360Day };

class CfTimeAxis {
 public:
  // Parses the attributes `units` and `calendar` (empty: standard). Units are any of fixed length
  // (ocean/cf_units.h) since a date. Throws InvalidArgument that names the text and what is allowed.
  static CfTimeAxis parse(const std::string& units, const std::string& calendar);

  // Returns the seconds from the calendar's day 0 to a value of the axis.
  double seconds_at(double value) const { return since_s_ + value * unit_s_; }
  // Returns the seconds from the calendar's day 0 to a date as UDUNITS and CF write it: "2026-05-01",
  // "20260501T0600", "2026-5-1 6:00:00.5 +02:00" (ahead of UTC), "1-May-2026 GMT". Throws InvalidArgument.
  double seconds_of(const std::string& date) const;
  // Returns the date of an instant, to the second, as "2026-05-01T06:00:00Z".
  std::string date_of(double seconds) const;

 private:
  Calendar calendar_ = Calendar::kStandard;
  double unit_s_ = 1, since_s_ = 0;
};

}  // namespace halocline::ocean
