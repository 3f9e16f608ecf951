// SPDX-License-Identifier: BSD-3-Clause
// Which vehicles that are not of the scenario (unlisted) are followed.
//
// Rule. kMaxAtOnce of them are followed from their first state on. While so many are followed, another is
// followed from its second state on: one of the same id and of another time, the two no more than the
// time-out apart. Beyond `max_followed` nobody is.
//
// Link tables grow with the square of the vehicles, and so do the searches for their paths: thousands of
// vehicles in one place take gigabytes and stop a run in real time. One datagram for each of thousands of
// names is no fleet, so those that publish steadily find places. Many vehicles of another program belong in
// the scenario (`model = "external"`), where each has its place.
//
// Bounded: of kMaxCandidates names the first state is remembered, the longest unused make room. Not
// thread-safe.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "channel_server/vehicles/vehicle_id.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class UnlistedVehicles {
 public:
  static constexpr std::size_t kMaxAtOnce = 64;     // our choice
  static constexpr std::size_t kMaxFollowed = 256;  // by default; our choice, for real time in a core
  static constexpr std::size_t kMaxCandidates = 16'384;

  // `timeout`: of states, above 0. `max_followed`: 0 and up.
  explicit UnlistedVehicles(SimDuration timeout, std::size_t max_followed = kMaxFollowed)
      : timeout_(timeout), max_followed_(max_followed) {}

  // A state that holds at `time`, of one that is not followed. Empty when it is followed from now on; else
  // why not.
  [[nodiscard]] std::string admit(std::string_view name, VehicleId id, SimTime time);
  // One of those followed is followed no more.
  void leave();
  // Nobody is followed, and nobody known.
  void clear();

  std::size_t followed() const { return followed_; }

 private:
  struct Candidate {
    VehicleId id = 0;
    SimTime time;  // of its first state
  };
  // Whether its second state has come; remembers a first one.
  bool is_steady(std::string_view name, const Candidate& now);

  SimDuration timeout_;
  std::size_t max_followed_, followed_ = 0;
  LruCache<std::string, Candidate> candidates_{kMaxCandidates};
};

}  // namespace halocline::channel_server
