// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/modem_clock.h"

#include <chrono>
#include <cstddef>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"

namespace halocline::modem_gateway {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

struct CalendarTime {
  int year;
  unsigned month, day;
  std::int64_t hour, minute, second, microsecond;
};

CalendarTime calendar_of(std::int64_t us) {
  using std::chrono::microseconds;
  const std::chrono::sys_time<microseconds> time{microseconds(us)};
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date(day);
  const std::int64_t within = (time - day).count(), second = within / kSecond_us;
  return {int(date.year()), unsigned(date.month()), unsigned(date.day()), second / 3600, second / 60 % 60,
          second % 60,      within % kSecond_us};
}

}  // namespace

void ModemClock::set(SimTime now, std::int64_t calendar_s) {
  const std::int64_t now_us = now.to_utime();
  const std::int64_t since_pulse_us = ((now_us % kSecond_us) + kSecond_us) % kSecond_us;
  const std::int64_t holds_from_us =
      has_pps_ && since_pulse_us > 0 ? now_us - since_pulse_us + kSecond_us : now_us;
  offset_us_ = calendar_s * kSecond_us - holds_from_us;
  is_set_ = true;
}

SimTime ModemClock::next_second(SimTime now) const {
  const std::int64_t us = calendar_us(now);
  return now + SimDuration::from_microseconds((kSecond_us - us % kSecond_us) % kSecond_us);
}

std::string ModemClock::hhmmss(SimTime time, int decimals) const {
  const CalendarTime at = calendar_of(calendar_us(time));
  const std::string text = fmt::format("{:02}{:02}{:02}", at.hour, at.minute, at.second);
  if (decimals == 0) return text;
  return text + "." + fmt::format("{:06}", at.microsecond).substr(0, static_cast<std::size_t>(decimals));
}

std::string ModemClock::yyyymmdd(SimTime time) const {
  const CalendarTime at = calendar_of(calendar_us(time));
  return fmt::format("{:04}{:02}{:02}", at.year, at.month, at.day);
}

std::string ModemClock::comma_separated_of(std::int64_t calendar_s) {
  const CalendarTime at = calendar_of(calendar_s * kSecond_us);
  return fmt::format("{:04},{:02},{:02},{:02},{:02},{:02}", at.year, at.month, at.day, at.hour, at.minute,
                     at.second);
}

std::string ModemClock::iso(SimTime time) const {
  const CalendarTime at = calendar_of(calendar_us(time));
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", at.year, at.month, at.day, at.hour, at.minute,
                     at.second);
}

std::string ModemClock::iso_us(SimTime time) const {
  const std::string whole = iso(time);
  return whole.substr(0, whole.size() - 1) + hhmmss(time, 6).substr(6);
}

std::optional<std::int64_t> calendar_seconds(std::int64_t year, std::int64_t month, std::int64_t day,
                                             std::int64_t hour, std::int64_t minute, std::int64_t second) {
  const bool is_small = year >= 1970 && year <= 9999 && month >= 1 && month <= 12 && day >= 1 && day <= 31;
  if (!is_small) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  const bool is_time =
      hour >= 0 && hour < 24 && minute >= 0 && minute < 60 && second >= 0 && second <= 60;  // a leap second
  if (!date.ok() || !is_time) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + hour) * 60 + minute) * 60 + second;
}

std::optional<std::int64_t> calendar_seconds(std::string_view iso) {
  // The form is yyyy-mm-ddThh:mm:ss, optionally with Z.
  if (iso.size() < 19 || iso.size() > 20 || iso[4] != '-' || iso[7] != '-' || iso[10] != 'T' ||
      iso[13] != ':' || iso[16] != ':' || (iso.size() == 20 && iso[19] != 'Z'))
    return std::nullopt;
  const auto number = [&](std::size_t begin, std::size_t size) {
    return integer_in(iso.substr(begin, size), 0, 9999).value_or(-1);
  };
  return calendar_seconds(number(0, 4), number(5, 2), number(8, 2), number(11, 2), number(14, 2),
                          number(17, 2));
}

}  // namespace halocline::modem_gateway
