// SPDX-License-Identifier: BSD-3-Clause
// Conversion of the times of messages to simulation time.
//
// Messages of Halocline's own programs carry simulation time. A log recorded at sea, or by other programs,
// carries Unix time or the uptime of a machine: when its first message is later than one day, all its times
// are shifted so that the first whole second becomes 0. A utime that differs from the median of the times of
// all states by more than 30 days comes from another clock, or from none (0).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace halocline::clients {

// Conversion of the times of one log: `zero_us` is subtracted from times that are near `middle_us`.
struct RunTimeBase {
  std::int64_t zero_us = 0;                 // subtracted from every time
  std::optional<std::int64_t> middle_us{};  // median of the states' times; empty: every time is accepted

  // True when `utime` comes from the clock that the states share.
  bool is_sound(std::int64_t utime) const;
};

// Largest difference of two times of one clock, us.
inline constexpr std::int64_t kSameClock_us = 30LL * 86'400 * 1'000'000;

// Returns the median of the states' times, which comes from the clock that most vehicles share. Empty when
// the states carry no usable time: there are none, or several that are all equal.
std::optional<std::int64_t> middle_of(std::vector<std::int64_t> state_utimes);

// True when at least nine tenths of the CLOCK messages of a log carry their stamp as their time, and there is
// one. In a log of a lockstep run all do, except damaged ones.
bool is_stamped_with_simulation_time(std::int64_t clocks, std::int64_t clocks_at_their_stamps);

// Returns the time that becomes 0 in a log whose first message has the time `first_utime`, us: its whole
// second, or 0 within the first day.
std::int64_t zero_of(std::int64_t first_utime);

}  // namespace halocline::clients
