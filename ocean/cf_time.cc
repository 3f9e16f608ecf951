// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_time.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/check.h"

namespace halocline::ocean {
namespace {

constexpr double kDay = 86'400;  // s

struct Date {
  int year = 0, month = 1, day = 1;
  double second = 0;  // of the day
};

constexpr std::array<std::pair<std::string_view, Calendar>, 9> kCalendars{
    {{"standard", Calendar::kStandard},
     {"gregorian", Calendar::kStandard},
     {"proleptic_gregorian", Calendar::kProlepticGregorian},
     {"julian", Calendar::kJulian},
     {"noleap", Calendar::kNoLeap},
     {"365_day", Calendar::kNoLeap},
     {"all_leap", Calendar::kAllLeap},
     {"366_day", Calendar::kAllLeap},
     {"360_day", Calendar::k360Day}}};

struct Unit {
  std::string_view name;
  double seconds;
};
constexpr std::array<Unit, 17> kUnits{{{"s", 1},
                                       {"sec", 1},
                                       {"secs", 1},
                                       {"second", 1},
                                       {"seconds", 1},
                                       {"min", 60},
                                       {"mins", 60},
                                       {"minute", 60},
                                       {"minutes", 60},
                                       {"h", 3600},
                                       {"hr", 3600},
                                       {"hrs", 3600},
                                       {"hour", 3600},
                                       {"hours", 3600},
                                       {"d", kDay},
                                       {"day", kDay},
                                       {"days", kDay}}};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// Rounded down.
constexpr std::int64_t quotient(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

// Julian day number of a date at noon: days of the years since March 1 of -4800, in which leap days come last.
std::int64_t julian_day(const Date& date, bool is_gregorian) {
  const std::int64_t early = date.month <= 2 ? 1 : 0;
  const std::int64_t year = date.year + 4800 - early, month = date.month + 12 * early - 3;
  const std::int64_t days = date.day + (153 * month + 2) / 5 + 365 * year + quotient(year, 4);
  return is_gregorian ? days - quotient(year, 100) + quotient(year, 400) - 32'045 : days - 32'083;
}

bool is_gregorian(Calendar calendar, const Date& date) {
  if (calendar == Calendar::kProlepticGregorian) return true;
  const auto from = std::pair(1582, 10), at = std::pair(date.year, date.month);
  return calendar == Calendar::kStandard && (at > from || (at == from && date.day >= 15));
}

bool is_leap(Calendar calendar, int year) {
  if (calendar == Calendar::kAllLeap) return true;
  if (calendar == Calendar::kNoLeap || year % 4 != 0) return false;
  return !is_gregorian(calendar, {year}) || year % 100 != 0 || year % 400 == 0;
}

int days_in_month(Calendar calendar, int year, int month) {
  constexpr std::array kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (calendar == Calendar::k360Day) return 30;
  return kDays[static_cast<std::size_t>(month - 1)] + (month == 2 && is_leap(calendar, year) ? 1 : 0);
}

std::int64_t day_of(Calendar calendar, const Date& date) {
  switch (calendar) {
    case Calendar::kStandard:
    case Calendar::kProlepticGregorian:
    case Calendar::kJulian:
      return julian_day(date, is_gregorian(calendar, date));
    case Calendar::k360Day:
      return 360 * static_cast<std::int64_t>(date.year) + 30 * (date.month - 1) + date.day - 1;
    case Calendar::kNoLeap:
    case Calendar::kAllLeap:
      break;
  }
  std::int64_t days = (calendar == Calendar::kNoLeap ? 365 : 366) * static_cast<std::int64_t>(date.year);
  for (int month = 1; month < date.month; ++month) days += days_in_month(calendar, date.year, month);
  return days + date.day - 1;
}

// "2026-05-01[T| ][06:00[:00.5]][Z| UTC|+00:00]"; false where it is none.
bool read_date(const std::string& text, Date& date) {
  std::string plain = text;
  for (const std::string_view zone : {"Z", " UTC", "+00:00"}) {
    if (plain.ends_with(zone)) plain.resize(plain.size() - zone.size());
  }
  std::replace(plain.begin(), plain.end(), 'T', ' ');
  int hour = 0, minute = 0, used = 0;
  double second = 0;
  if (std::sscanf(plain.c_str(), "%d-%d-%d%n", &date.year, &date.month, &date.day, &used) != 3) return false;
  std::string_view rest = std::string_view(plain).substr(static_cast<std::size_t>(used));
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  if (!rest.empty()) {
    int time_used = 0;
    const std::string time(rest);
    if (std::sscanf(time.c_str(), "%d:%d%n", &hour, &minute, &time_used) != 2) return false;
    int second_used = 0;
    if (time[static_cast<std::size_t>(time_used)] == ':') {
      if (std::sscanf(time.c_str() + time_used, ":%lf%n", &second, &second_used) != 1) return false;
    }
    if (static_cast<std::size_t>(time_used + second_used) != time.size()) return false;
  }
  date.second = 3600.0 * hour + 60.0 * minute + second;
  return hour >= 0 && hour <= 24 && minute >= 0 && minute < 60 && second >= 0 && second < 61;
}

double seconds_since_day_0(Calendar calendar, const std::string& text) {
  Date date;
  const bool is_date = read_date(text, date) && date.month >= 1 && date.month <= 12 && date.day >= 1 &&
                       date.day <= days_in_month(calendar, date.year, date.month);
  require(is_date,
          "\"" + text +
              "\" is no date of its calendar; allowed is YYYY-MM-DD, with a time of day hh:mm:ss in UTC "
              "if wished");
  return static_cast<double>(day_of(calendar, date)) * kDay + date.second;
}

}  // namespace

CfTimeAxis CfTimeAxis::parse(const std::string& units, const std::string& calendar) {
  CfTimeAxis axis;
  const std::string name = calendar.empty() ? "standard" : lower(calendar);
  const auto* known =
      std::find_if(kCalendars.begin(), kCalendars.end(), [&](const auto& c) { return c.first == name; });
  require(known != kCalendars.end(),
          "calendar is \"" + calendar +
              "\"; allowed are standard, gregorian, proleptic_gregorian, julian, noleap, 365_day, all_leap, "
              "366_day, 360_day");
  axis.calendar_ = known->second;
  std::istringstream words(units);
  std::string unit, since, date;
  words >> unit >> since;
  std::getline(words >> std::ws, date);
  const auto* one =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.name == lower(unit); });
  require(one != kUnits.end() && lower(since) == "since",
          "units are \"" + units + "\"; allowed are seconds, minutes, hours or days since a date");
  axis.unit_s_ = one->seconds;
  axis.since_s_ = seconds_since_day_0(axis.calendar_, date);
  return axis;
}

double CfTimeAxis::seconds_of(const std::string& date) const { return seconds_since_day_0(calendar_, date); }

std::string CfTimeAxis::date_of(double seconds) const {
  const auto day = static_cast<std::int64_t>(std::floor(seconds / kDay));
  const auto of_day = static_cast<std::int64_t>(seconds - static_cast<double>(day) * kDay);
  // The last year, month and day that begin no later.
  Date date{static_cast<int>(quotient(day - day_of(calendar_, {0}), 367)), 1, 1, 0};
  while (day_of(calendar_, {date.year + 1}) <= day) ++date.year;
  while (date.month < 12 && day_of(calendar_, {date.year, date.month + 1}) <= day) ++date.month;
  while (day_of(calendar_, {date.year, date.month, date.day + 1}) <= day &&
         date.day < days_in_month(calendar_, date.year, date.month))
    ++date.day;
  char text[40];
  std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02dZ", date.year, date.month, date.day,
                static_cast<int>(of_day / 3600), static_cast<int>(of_day / 60 % 60),
                static_cast<int>(of_day % 60));
  return text;
}

}  // namespace halocline::ocean
