// SPDX-License-Identifier: BSD-3-Clause
// Identity and counters of a node on the bus.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/random.h"

namespace halocline::bus {

// Order in which participants step at one instant of lockstep (lockstep_schedule.h): nodes that provide
// information before those that act on it.
enum class Stage { kTime, kTerrain, kVehicles, kPilots, kTraffic, kClients, kChannel };

// A publisher: the node's name (is_valid_name), a number that differs for each incarnation, and its stage.
struct NodeIdentity {
  std::string name;
  std::int64_t session = 0;
  Stage stage = Stage::kClients;
};

// Returns the session number of an incarnation of a node: a hash of `entropy` and the name. In lockstep it
// must be the same in each run, so the entropy is the seed. In a separate process it must differ from run to
// run, so the entropy is made of wall clock and process id. The session of messages that a program sends for
// a vehicle is made of the program's own session and the vehicle's name.
inline std::int64_t session_of(std::uint64_t entropy, std::string_view name) {
  const std::uint64_t bits =
      bits_at({.seed = entropy, .purpose = purpose_of("session"), .who = purpose_of(name)});
  return static_cast<std::int64_t>(bits >> 1 | 1);  // positive, never 0
}

// Counters of a node since its start; published in STATUS.
struct BusCounters {
  std::int64_t received = 0;
  std::int64_t sent = 0;
  std::int64_t refused = 0;
  std::int64_t unsent = 0;  // refused by the network, whether or not sent later
  std::int64_t duplicate_publishers =
      0;  // refused because of a second publisher of a name, or a second CLOCK
  std::int64_t gaps = 0;
  std::int64_t repaired = 0;
  std::int64_t lost = 0;
  std::int64_t duplicates = 0;
  // Results published more than the scenario's state_lag_s after their instant, and messages received too
  // late.
  std::int64_t late = 0;
  std::int64_t wakeups = 0;  // messages that may have changed when the node is due (Wakeup::kMayAdvanceDue)
};

}  // namespace halocline::bus
