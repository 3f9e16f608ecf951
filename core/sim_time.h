// SPDX-License-Identifier: BSD-3-Clause
// Simulation time: integer nanoseconds, so that sums are exact and an instant is the same in every process.
//
// SimTime is an instant since the start of the scenario, SimDuration a difference of two. Wall clocks never
// convert to SimTime. On the bus an instant is `int64_t utime`, microseconds: to_utime rounds to the nearest
// microsecond, so an instant made by from_utime survives the round trip.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>

namespace halocline {

class SimDuration {
 public:
  constexpr SimDuration() = default;
  static constexpr SimDuration from_nanoseconds(std::int64_t ns) { return SimDuration(ns); }
  static constexpr SimDuration from_microseconds(std::int64_t us) { return SimDuration(us * 1000); }
  static constexpr SimDuration from_milliseconds(std::int64_t ms) { return SimDuration(ms * 1'000'000); }
  // Nearest nanosecond; |seconds| below 9.2e9.
  static SimDuration from_seconds(double seconds) { return SimDuration(std::llround(seconds * 1e9)); }

  constexpr std::int64_t nanoseconds() const { return ns_; }
  constexpr double seconds() const { return static_cast<double>(ns_) / 1e9; }

  constexpr auto operator<=>(const SimDuration&) const = default;
  constexpr SimDuration operator-() const { return SimDuration(-ns_); }
  constexpr SimDuration operator+(SimDuration other) const { return SimDuration(ns_ + other.ns_); }
  constexpr SimDuration operator-(SimDuration other) const { return SimDuration(ns_ - other.ns_); }
  constexpr SimDuration operator*(std::int64_t n) const { return SimDuration(ns_ * n); }

 private:
  explicit constexpr SimDuration(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

class SimTime {
 public:
  constexpr SimTime() = default;  // start of the scenario
  static constexpr SimTime from_nanoseconds(std::int64_t ns) { return SimTime(ns); }
  static constexpr SimTime from_utime(std::int64_t us) { return SimTime(us * 1000); }
  static SimTime from_seconds(double seconds) { return SimTime(std::llround(seconds * 1e9)); }
  // An instant later than any that a scenario reaches; "never" in schedules.
  static constexpr SimTime never() { return SimTime(std::numeric_limits<std::int64_t>::max()); }
  // An instant earlier than any other; "at once" in schedules.
  static constexpr SimTime at_once() { return SimTime(std::numeric_limits<std::int64_t>::min()); }

  constexpr std::int64_t nanoseconds() const { return ns_; }
  constexpr std::int64_t to_utime() const {
    return ns_ >= 0 ? (ns_ / 1000 + (ns_ % 1000 >= 500)) : -((-ns_) / 1000 + ((-ns_) % 1000 > 500));
  }
  constexpr double seconds() const { return static_cast<double>(ns_) / 1e9; }

  constexpr auto operator<=>(const SimTime&) const = default;
  constexpr SimTime operator+(SimDuration d) const { return SimTime(ns_ + d.nanoseconds()); }
  constexpr SimTime operator-(SimDuration d) const { return SimTime(ns_ - d.nanoseconds()); }
  constexpr SimDuration operator-(SimTime other) const {
    return SimDuration::from_nanoseconds(ns_ - other.ns_);
  }

 private:
  explicit constexpr SimTime(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

// Returns an instant of a schedule moved by `by`; never() and at_once() stay.
constexpr SimTime moved(SimTime time, SimDuration by) {
  return time == SimTime::never() || time == SimTime::at_once() ? time : time + by;
}

// Returns the first instant of the grid {0, period, 2 period, ...} that is later than `time`; period > 0.
constexpr SimTime next_on_grid(SimTime time, SimDuration period) {
  const std::int64_t p = period.nanoseconds();
  std::int64_t k = time.nanoseconds() / p;
  if (time.nanoseconds() % p < 0) --k;
  return SimTime::from_nanoseconds((k + 1) * p);
}

}  // namespace halocline
