// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/run_time_base.h"

#include <algorithm>
#include <cstdlib>

namespace halocline::clients {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000, kDay_us = 86'400 * kSecond_us;
constexpr double kMinShareAtStamp = 0.9;

}  // namespace

bool RunTimeBase::is_sound(std::int64_t utime) const {
  return !middle_us || std::abs(utime - *middle_us) <= kSameClock_us;
}

std::optional<std::int64_t> middle_of(std::vector<std::int64_t> state_utimes) {
  std::sort(state_utimes.begin(), state_utimes.end());
  if (state_utimes.empty() || (state_utimes.front() == state_utimes.back() && state_utimes.size() > 1))
    return std::nullopt;
  return state_utimes[state_utimes.size() / 2];
}

bool is_stamped_with_simulation_time(std::int64_t clocks, std::int64_t clocks_at_their_stamps) {
  return clocks > 0 &&
         static_cast<double>(clocks_at_their_stamps) >= kMinShareAtStamp * static_cast<double>(clocks);
}

std::int64_t zero_of(std::int64_t first_utime) {
  return first_utime > kDay_us ? first_utime / kSecond_us * kSecond_us : 0;
}

}  // namespace halocline::clients
