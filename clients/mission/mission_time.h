// SPDX-License-Identifier: BSD-3-Clause
// From the times of messages to simulation time.
//
// Messages of our own programs carry simulation time. A log recorded at sea, or with other programs, carries
// Unix time or a machine's uptime: times later than a day are shifted, so that the first whole second becomes
// 0. A utime more than 30 days from the middle of all states' comes from another clock (or from none: 0).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace halocline::clients {

struct MissionTime {
  std::int64_t zero_us = 0;                 // taken off every time
  std::optional<std::int64_t> middle_us{};  // of the states' times; empty: every time is taken as it is

  bool is_sound(std::int64_t utime) const;
};

// Within this much two times are of one clock.
inline constexpr std::int64_t kSameClock_us = 30LL * 86'400 * 1'000'000;

// The middle of the states' times: of a clock that most vehicles share. Empty where no state has a time:
// there is none, or several hold the same.
std::optional<std::int64_t> middle_of(std::vector<std::int64_t> state_utimes);

// Of the CLOCKs of a lockstep run all stand at their stamps, but for those that damage changed.
bool is_stamped_with_simulation_time(std::int64_t clocks, std::int64_t clocks_at_their_stamps);

// What a log whose first message is of this time is shifted by: 0 within the first day.
std::int64_t zero_of(std::int64_t first_utime);

}  // namespace halocline::clients
