// SPDX-License-Identifier: BSD-3-Clause
// Position of a vehicle at an instant, from the states it has published: a pure function of their contents.
//
// Rule. The position at instant t, as decided at instant d, uses only the states known then: those with
// time <= d - state_lag.
//
// - With a known state at or before t and one after it, no more than `state_timeout` apart: linear
//   interpolation between the two.
// - Otherwise: the latest known state at or before t, extrapolated with its velocity.
// - Without a known state at or before t: no position.
//
// The velocity is interpolated, or kept constant, in the same cases. The lag is longer than the delay of a
// message on the bus, so the result does not depend on which datagram was faster, and it never uses what was
// unknown at d (causal). A packet's arrival that is decided after it happened therefore benefits from states
// received meanwhile; one that is decided ahead extrapolates.
//
// Error of the extrapolation over a time h at acceleration a:
//
//   a h^2 / 2   (1 mm at 1 m/s^2 over 50 ms)
//
// Left out: orientation, which does not affect omnidirectional transducers.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct StampedState {
  SimTime time;                          // instant at which the state holds
  Vec3 position_ned_m = Vec3::Zero();    // world NED, m
  Vec3 velocity_ned_mps = Vec3::Zero();  // over ground, world NED, m/s
};

struct PositionRule {
  SimDuration state_lag = SimDuration::from_milliseconds(50);        // 0 or more
  SimDuration state_timeout = SimDuration::from_milliseconds(5000);  // above 0; older states give no position
};

struct Placement {
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();
  SimDuration age;  // time from the latest known state at or before the instant to the instant
};

// Recent states of one vehicle, ordered by time. Not thread-safe.
class StateHistory {
 public:
  // More than any lookahead needs at 1 kHz; beyond it the oldest states are dropped.
  static constexpr std::size_t kMaxStates = 16'384;

  // Inserts a state, in any order. Returns false and changes nothing when there already is a state of that
  // time.
  bool insert(const StampedState& state);

  // Returns the placement by the rule above, whatever the age of the state.
  std::optional<Placement> at(SimTime instant, SimTime decided_at, const PositionRule& rule) const;

  // Drops the states that no instant at or after `time` can need: all but the last one before it.
  void forget_before(SimTime time);

  bool empty() const { return size() == 0; }
  std::size_t size() const { return states_.size() - forgotten_; }
  // Time of the latest state; only while not empty.
  SimTime latest() const { return states_.back().time; }

 private:
  using Place = std::vector<StampedState>::const_iterator;
  Place begin() const { return states_.begin() + static_cast<std::ptrdiff_t>(forgotten_); }
  Place first_after(SimTime time) const;
  void forget_first(std::size_t count);

  std::vector<StampedState> states_;  // ascending by time, each time once
  std::size_t forgotten_ = 0;         // dropped states at the front; fewer than the rest
};

}  // namespace halocline::channel_server
