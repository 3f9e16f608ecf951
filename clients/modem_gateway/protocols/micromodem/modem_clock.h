// SPDX-License-Identifier: BSD-3-Clause
// Calendar clock of a modem: its vehicle's clock plus an offset that a host sets. All times passed to it are
// readings of the vehicle's clock.
//
// Until it is set, it shows the vehicle's clock counted from 1970. With `pps` the modem receives a pulse at
// each whole second of the vehicle's clock, and the time that a host sets is valid from the next pulse. All
// such clocks then agree in their fractions of a second, as far as the vehicles' clocks agree, and the
// fraction of an arrival time is the travel time of a packet that left on a whole second.
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
  // Sets the clock to `calendar_s`, seconds since 1970, UTC.
  void set(SimTime now, std::int64_t calendar_s);

  // Returns microseconds since 1970.
  std::int64_t calendar_us(SimTime time) const { return time.to_utime() + offset_us_; }
  // Returns the next whole second of the clock, which may be `now`.
  SimTime next_second(SimTime now) const;

  std::string hhmmss(SimTime time, int decimals = 0) const;  // truncated, not rounded
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

// Converts a date and time of day, UTC, to seconds since 1970; nothing when there is no such date or time.
std::optional<std::int64_t> calendar_seconds(std::int64_t year, std::int64_t month, std::int64_t day,
                                             std::int64_t hour, std::int64_t minute, std::int64_t second);
// Converts a text of the form yyyy-mm-ddThh:mm:ssZ.
std::optional<std::int64_t> calendar_seconds(std::string_view iso);

}  // namespace halocline::modem_gateway
