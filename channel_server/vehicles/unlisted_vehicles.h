// SPDX-License-Identifier: BSD-3-Clause
// Admission of vehicles that are not in the scenario (unlisted vehicles).
//
// Rule. Up to kMaxAtOnce of them are tracked from their first state on. Beyond that, another one is tracked
// from its second state on: one with the same id and another time, the two no more than the time-out apart.
// Beyond kMaxTracked no more are admitted.
//
// Link tables, and the searches for their paths, grow with the square of the number of vehicles: thousands of
// vehicles in one place take gigabytes and stop a run in real time. A single datagram for each of thousands
// of names is not a fleet, so vehicles that publish steadily are preferred. A large fleet of another program
// belongs in the scenario (`model = "external"`), which admits each of its vehicles.
//
// Storage is bounded: the first states of kMaxCandidates names are remembered; beyond that the least recently
// used is dropped. Not thread-safe.
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
  static constexpr std::size_t kMaxAtOnce = 64;    // our choice
  static constexpr std::size_t kMaxTracked = 256;  // our choice, for real time on one core
  static constexpr std::size_t kMaxCandidates = 16'384;

  // `timeout` is that of states, above 0.
  explicit UnlistedVehicles(SimDuration timeout) : timeout_(timeout) {}

  // Decides on a vehicle that is not tracked, from a state that holds at `time`. Returns an empty string when
  // the vehicle is tracked from now on, else the reason why not.
  [[nodiscard]] std::string admit(std::string_view name, VehicleId id, SimTime time);
  // Notes that one tracked vehicle is not tracked any more.
  void leave();

 private:
  struct Candidate {
    VehicleId id = 0;
    SimTime time;  // time of its first state
  };
  // True when this is the candidate's second state; otherwise remembers it as the first.
  bool is_steady(std::string_view name, const Candidate& now);

  SimDuration timeout_;
  std::size_t tracked_ = 0;
  LruCache<std::string, Candidate> candidates_{kMaxCandidates};
};

}  // namespace halocline::channel_server
