// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_time.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>

#include "core/check.h"
#include "core/csv_table.h"
#include "core/text/lower_case.h"
#include "ocean/cf_units.h"

namespace halocline::ocean {
namespace {

constexpr double kDay = 86'400;  // s

struct Date {
  int year = 0, month = 1, day = 1;
  double second = 0;  // second of the day
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

// Returns the quotient rounded down, for b > 0.
constexpr std::int64_t quotient(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

// Returns the Julian day number of a date at noon. Years begin with March 1, so that leap days come last:
//
//   e = 1 in January and February, else 0;  y = year + 4800 - e;  m = month + 12 e - 3
//   Gregorian: day + floor((153 m + 2) / 5) + 365 y + floor(y / 4) - floor(y / 100) + floor(y / 400) - 32045
//   Julian:    day + floor((153 m + 2) / 5) + 365 y + floor(y / 4) - 32083
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

constexpr std::array<std::string_view, 12> kMonths{"jan", "feb", "mar", "apr", "may", "jun",
                                                   "jul", "aug", "sep", "oct", "nov", "dec"};

// Remaining text of a date while it is parsed.
class DateText {
 public:
  explicit DateText(std::string_view text) : rest_(text) {}

  bool is_done() const { return rest_.empty(); }
  char front() const { return rest_.empty() ? '\0' : rest_.front(); }
  bool has_digit() const { return std::isdigit(static_cast<unsigned char>(front())) != 0; }
  bool take(std::string_view word) {
    if (lower_case(rest_.substr(0, word.size())) != word) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  void skip_blanks() {
    while (take(" ")) continue;
  }
  std::string_view digits() {
    const auto end =
        std::find_if(rest_.begin(), rest_.end(), [](unsigned char c) { return std::isdigit(c) == 0; });
    const std::string_view found = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    rest_.remove_prefix(found.size());
    return found;
  }

 private:
  std::string_view rest_;
};

// Returns the number; -1 for no digits, or for a number too large for a date.
int number_of(std::string_view digits) { return parse_number<int>(digits, 0, 99'999'999).value_or(-1); }

// Reads "2026-5-1", "20260501", "2026-5", "2026" or "1-May-2026"; omitted parts are 1.
bool read_day(DateText& text, Date& date) {
  const int sign = text.take("-") ? -1 : 1;
  const std::string_view first = text.digits();
  date.year = sign * number_of(first);
  if (first.size() == 8) {
    date = {number_of(first.substr(0, 4)), number_of(first.substr(4, 2)), number_of(first.substr(6)), 0};
    return sign > 0;
  }
  if (first.empty() || first.size() > 4) return false;
  if (!text.take("-")) return true;
  if (text.has_digit()) {
    date.month = number_of(text.digits());
    if (text.take("-")) date.day = number_of(text.digits());
    return true;
  }
  const auto* month =
      std::find_if(kMonths.begin(), kMonths.end(), [&](auto name) { return text.take(name); });
  date.day = date.year;
  date.month = static_cast<int>(month - kMonths.begin()) + 1;
  if (month == kMonths.end() || !text.take("-")) return false;
  date.year = number_of(text.digits());
  return date.year >= 0;
}

// Reads "6", "06:00", "06:00:00.5", "0600" or "060000" and returns the seconds of the day; NaN for other
// text.
double read_clock(DateText& text) {
  const std::string_view first = text.digits();
  const bool is_packed = first.size() == 4 || first.size() == 6;
  int hour = number_of(is_packed ? first.substr(0, 2) : first), minute = 0;
  double second = 0;
  if (is_packed) {
    minute = number_of(first.substr(2, 2));
    second = first.size() == 6 ? number_of(first.substr(4)) : 0;
  } else if (text.take(":")) {
    minute = number_of(text.digits());
    if (text.take(":")) second = number_of(text.digits());
  }
  if (text.take(".")) second += parse_number("0." + std::string(text.digits())).value_or(0);
  const bool is_time = hour >= 0 && hour <= 24 && minute >= 0 && minute < 60 && second >= 0 && second < 61;
  return is_time ? 3600.0 * hour + 60.0 * minute + second : std::nan("");
}

// Reads "", "Z", "UTC", "GMT", "+hh", "-h:mm", "+hhmm" or "-hmm" and returns how far the zone is ahead of
// UTC, s; NaN for another zone.
double read_zone(DateText& text) {
  text.skip_blanks();
  if (text.is_done() || text.take("utc") || text.take("gmt") || text.take("z"))
    return text.is_done() ? 0 : std::nan("");
  const int sign = text.take("-") ? -1 : text.take("+") ? 1 : 0;
  const std::string_view digits = text.digits();
  int hours = number_of(digits), minutes = 0;
  if (digits.size() > 2) {
    minutes = hours % 100;
    hours /= 100;
  } else if (text.take(":")) {
    minutes = number_of(text.digits());
  }
  const bool is_zone =
      sign != 0 && text.is_done() && hours >= 0 && hours <= 14 && minutes >= 0 && minutes < 60;
  return is_zone ? sign * (3600.0 * hours + 60.0 * minutes) : std::nan("");
}

// Reads a day, a time of day and a zone; false when the text is not such a date.
bool read_date(const std::string& text, Date& date) {
  DateText rest(text);
  rest.skip_blanks();
  if (!read_day(rest, date)) return false;
  if (!rest.take("t")) rest.skip_blanks();
  const double clock_s = rest.has_digit() ? read_clock(rest) : 0;
  date.second = clock_s - read_zone(rest);
  return std::isfinite(date.second);
}

double seconds_since_day_0(Calendar calendar, const std::string& text) {
  Date date;
  const bool has_year_0 = calendar != Calendar::kStandard && calendar != Calendar::kJulian;
  const bool is_date = read_date(text, date) && (date.year != 0 || has_year_0) && date.month >= 1 &&
                       date.month <= 12 && date.day >= 1 &&
                       date.day <= days_in_month(calendar, date.year, date.month);
  require(
      is_date,
      "\"" + text +
          "\" is no date of its calendar; allowed is YYYY-MM-DD, with a time of day hh:mm:ss and a zone as "
          "Z, GMT or +hh:mm if wished");
  return static_cast<double>(day_of(calendar, date)) * kDay + date.second;
}

// Splits "hours since 2000-01-01" into its unit and its date; UDUNITS allows several words for "since".
std::pair<std::string, std::string> split(const std::string& units) {
  const std::string text = lower_case(units);
  for (const std::string_view word : {" since ", " after ", " from ", " ref ", " @ "}) {
    const std::size_t at = text.find(word);
    if (at != std::string::npos) return {units.substr(0, at), units.substr(at + word.size())};
  }
  return {units, ""};
}

}  // namespace

CfTimeAxis CfTimeAxis::parse(const std::string& units, const std::string& calendar) {
  CfTimeAxis axis;
  const std::string name = calendar.empty() ? "standard" : lower_case(calendar);
  const auto* known =
      std::find_if(kCalendars.begin(), kCalendars.end(), [&](const auto& c) { return c.first == name; });
  require(known != kCalendars.end(),
          "calendar is \"" + calendar +
              "\"; allowed are standard, gregorian, proleptic_gregorian, julian, noleap, 365_day, all_leap, "
              "366_day, 360_day");
  axis.calendar_ = known->second;
  const auto [unit, date] = split(units);
  const std::optional<UnitFactor> seconds = unit_in(QuantityKind::kTime, unit);
  require(seconds && !date.empty(),
          "units are \"" + units + "\"; allowed are " + allowed_units(QuantityKind::kTime) +
              " since a date, as \"hours since 2000-01-01 00:00:00\"" +
              (lower_case(unit).starts_with("month") || lower_case(unit).starts_with("year")
                   ? ": months and years have no fixed length"
                   : ""));
  axis.unit_s_ = seconds->factor;
  axis.since_s_ = seconds_since_day_0(axis.calendar_, date);
  return axis;
}

double CfTimeAxis::seconds_of(const std::string& date) const { return seconds_since_day_0(calendar_, date); }

std::string CfTimeAxis::date_of(double seconds) const {
  const auto day = static_cast<std::int64_t>(std::floor(seconds / kDay));
  const auto of_day = static_cast<std::int64_t>(seconds - static_cast<double>(day) * kDay);
  // The date is the last year, month and day that begin no later than the instant. The first guess of the
  // year takes years of 367 days and so lies before it.
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
