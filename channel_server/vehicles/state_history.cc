// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/state_history.h"

#include <algorithm>
#include <iterator>

#include "core/state_extrapolation.h"

namespace halocline::channel_server {
namespace {

bool is_earlier(const StampedState& state, SimTime time) { return state.time < time; }
bool is_later(SimTime time, const StampedState& state) { return time < state.time; }

Placement between(const StampedState& before, const StampedState& after, SimTime instant) {
  const double share = (instant - before.time).seconds() / (after.time - before.time).seconds();
  return {before.position_ned_m + share * (after.position_ned_m - before.position_ned_m),
          before.velocity_ned_mps + share * (after.velocity_ned_mps - before.velocity_ned_mps),
          instant - before.time};
}

Placement carried_on(const StampedState& state, SimTime instant) {
  const SimDuration age = instant - state.time;
  return {reckoned_position(state.position_ned_m, state.velocity_ned_mps, age), state.velocity_ned_mps, age};
}

}  // namespace

bool StateHistory::insert(const StampedState& state) {
  const auto place = std::lower_bound(begin(), states_.cend(), state.time, is_earlier);
  if (place != states_.end() && place->time == state.time) return false;
  states_.insert(place, state);
  if (size() > kMaxStates) forget_first(1);
  return true;
}

// Returns the first state after `time`, which is nearly always one of the latest.
StateHistory::Place StateHistory::first_after(SimTime time) const {
  constexpr int kLatest = 4;
  Place after = states_.end();
  for (int i = 0; i < kLatest; ++i, --after) {
    if (after == begin() || std::prev(after)->time <= time) return after;
  }
  return std::upper_bound(begin(), after, time, is_later);
}

std::optional<Placement> StateHistory::at(SimTime instant, SimTime decided_at,
                                          const PositionRule& rule) const {
  const SimTime known_until = decided_at - rule.state_lag;
  const Place after = first_after(std::min(instant, known_until));
  if (after == begin()) return std::nullopt;
  const StampedState& before = *std::prev(after);
  const bool bracketed =
      after != states_.end() && after->time <= known_until && after->time - before.time <= rule.state_timeout;
  return bracketed ? between(before, *after, instant) : carried_on(before, instant);
}

void StateHistory::forget_before(SimTime time) {
  std::size_t count = 0;
  while (count + 1 < size() && begin()[static_cast<std::ptrdiff_t>(count + 1)].time < time) ++count;
  forget_first(count);
}

void StateHistory::forget_first(std::size_t count) {
  forgotten_ += count;
  if (forgotten_ < size()) return;
  states_.erase(states_.begin(), begin());
  forgotten_ = 0;
}

}  // namespace halocline::channel_server
