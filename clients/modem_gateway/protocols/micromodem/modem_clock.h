// SPDX-License-Identifier: BSD-3-Clause
// The calendar clock of a modem: its vehicle's clock, shifted by what a host has set. All times given to it
// are readings of that clock.
//
// Before it is set it shows the vehicle's clock from 1970 on. With `pps`, a pulse each whole second to which
// all synchronised modems agree, here the whole seconds of the vehicle's clock, the time that a host sets
// holds from the next pulse: so the fractions of a second of all such clocks are equal, as far as the
// vehicles' clocks are, and that of an arrival is the travel time of what left on a second.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class ModemClock {
 public:
  explicit ModemClock(bool has_pps) : has_pps_(has_pps) {}

  bool has_pps() const { return has_pps_; }
  bool is_set() const { return is_set_; }
  // `calendar_s`: seconds since 1970, UTC.
  void set(SimTime now, std::int64_t calendar_s);

  // Microseconds since 1970.
  std::int64_t calendar_us(SimTime time) const { return time.to_utime() + offset_us_; }
  // The next whole second of the clock, `now` included.
  SimTime next_second(SimTime now) const;

  std::string hhmmss(SimTime time, int decimals = 0) const;  // cut off, not rounded
  std::string yyyymmdd(SimTime time) const;
  std::string comma_separated(SimTime time) const {
    return comma_separated_of(calendar_us(time) / 1'000'000);
  }
  static std::string comma_separated_of(std::int64_t calendar_s);  // yyyy,mm,dd,hh,mm,ss
  std::string iso(SimTime time) const;                             // yyyy-mm-ddThh:mm:ssZ
  std::string iso_us(SimTime time) const;                          // yyyy-mm-ddThh:mm:ss.ffffff
  void archive(Archive& a) { a(is_set_, offset_us_); }

 private:
  bool has_pps_;
  bool is_set_ = false;
  std::int64_t offset_us_ = 0;
};

// Seconds since 1970 of a date and time of day, UTC; none where there is no such.
std::optional<std::int64_t> calendar_seconds(std::int64_t year, std::int64_t month, std::int64_t day,
                                             std::int64_t hour, std::int64_t minute, std::int64_t second);
// Of yyyy-mm-ddThh:mm:ssZ.
std::optional<std::int64_t> calendar_seconds(std::string_view iso);

}  // namespace halocline::modem_gateway
