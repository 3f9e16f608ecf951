// SPDX-License-Identifier: BSD-3-Clause
// Where a vehicle is at an instant, from the states it has published: a pure function of their contents.
//
// Rule. The position at instant t, as decided at instant d, knows the states with time <= d - state_lag, and
// no other:
//   - with a known state at or before t and one after it, the two no more than `state_timeout` apart: on the
//     straight line between the two (linear interpolation);
//   - else the latest known state at or before t, carried on by its velocity;
//   - without a known state at or before t: nowhere.
// The velocity is interpolated, or carried on unchanged, in the same cases.
// The lag is longer than a message takes on the bus, so the answer does not depend on which datagram was
// quicker, and it never uses what was not yet known at d (causal). A packet's arrival decided later than it
// happened therefore profits from states received meanwhile; one decided ahead extrapolates.
//
// Error of the extrapolation over a time h at acceleration a: a h^2 / 2 (1 mm at 1 m/s^2 over 50 ms).
// Left out: orientation, which matters to nothing that is omnidirectional.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "channel_server/vehicles/unlisted_vehicles.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct StampedState {
  SimTime time;                          // at which it holds
  Vec3 position_ned_m = Vec3::Zero();    // world NED, m
  Vec3 velocity_ned_mps = Vec3::Zero();  // over ground, world NED, m/s
};

struct PositionRule {
  SimDuration state_lag = SimDuration::from_milliseconds(50);        // 0 and up
  SimDuration state_timeout = SimDuration::from_milliseconds(5000);  // above 0; older states place nobody
  // That are not of the scenario and are followed, 0 and up.
  int max_unlisted_vehicles = UnlistedVehicles::kMaxFollowed;
};

struct Placement {
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();
  SimDuration age;  // from the latest known state at or before the instant, to the instant
};

// The recent states of one vehicle, by time. Not thread-safe.
class StateHistory {
 public:
  // More than any horizon needs at a kilohertz; the oldest make room.
  static constexpr std::size_t kMaxStates = 16'384;

  // In any order. False, and nothing changed, when a state of that time is held already.
  bool insert(const StampedState& state);

  // See the rule above; does not judge the age.
  std::optional<Placement> at(SimTime instant, SimTime decided_at, const PositionRule& rule) const;

  // Drops what no instant at or after `time` can need: all states but the last before it.
  void forget_before(SimTime time);

  bool empty() const { return size() == 0; }
  std::size_t size() const { return states_.size() - forgotten_; }
  // Of the latest state; only while not empty.
  SimTime latest() const { return states_.back().time; }

 private:
  using Place = std::vector<StampedState>::const_iterator;
  Place begin() const { return states_.begin() + static_cast<std::ptrdiff_t>(forgotten_); }
  Place first_after(SimTime time) const;
  void forget_first(std::size_t count);

  std::vector<StampedState> states_;  // ascending by time, each time once
  std::size_t forgotten_ = 0;         // of them, the first; fewer than the rest, so that each is moved once
};

}  // namespace halocline::channel_server
