#include "channel_server/vehicles/state_history.h"

#include <algorithm>

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
  return {state.position_ned_m + (instant - state.time).seconds() * state.velocity_ned_mps,
          state.velocity_ned_mps, instant - state.time};
}

}  // namespace

bool StateHistory::insert(const StampedState& state) {
  const auto place = std::lower_bound(states_.begin(), states_.end(), state.time, is_earlier);
  if (place != states_.end() && place->time == state.time) return false;
  states_.insert(place, state);
  if (states_.size() > kMaxStates) states_.pop_front();
  return true;
}

std::optional<Placement> StateHistory::at(SimTime instant, SimTime decided_at,
                                          const PositionRule& rule) const {
  const SimTime known_until = decided_at - rule.state_lag;
  const auto unknown = std::upper_bound(states_.begin(), states_.end(), known_until, is_later);
  const auto after = std::upper_bound(states_.begin(), unknown, instant, is_later);
  if (after == states_.begin()) return std::nullopt;
  const StampedState& before = *std::prev(after);
  const bool bracketed = after != unknown && after->time - before.time <= rule.state_timeout;
  return bracketed ? between(before, *after, instant) : carried_on(before, instant);
}

void StateHistory::forget_before(SimTime time) {
  while (states_.size() > 1 && states_[1].time < time) states_.pop_front();
}

}  // namespace halocline::channel_server
