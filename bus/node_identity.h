// SPDX-License-Identifier: BSD-3-Clause
// Who a node is on the bus.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/random.h"

namespace halocline::bus {

// The order in which participants step at one instant of lockstep (lockstep_schedule.h): sources of
// information before those that act on it.
enum class Stage { kTime, kTerrain, kVehicles, kPilots, kTraffic, kClients, kChannel };

// The publisher: the node's name (is_valid_name), a number that differs for each incarnation, and its stage.
struct NodeIdentity {
  std::string name;
  std::int64_t session = 0;
  Stage stage = Stage::kClients;
};

// The session of a node's incarnation. In lockstep it must be the same in each run: made of the seed and the
// name. In a process of its own it must differ from run to run: made of the given entropy (wall clock,
// process id) and the name. The session of what a program sends for a vehicle is made of the program's own
// session and the vehicle's name.
inline std::int64_t session_of(std::uint64_t entropy, std::string_view name) {
  const std::uint64_t bits =
      bits_at({.seed = entropy, .purpose = purpose_of("session"), .who = purpose_of(name)});
  return static_cast<std::int64_t>(bits >> 1 | 1);  // positive, never 0
}

// What a node has counted since it started; published in STATUS.
struct BusCounters {
  std::int64_t received = 0;
  std::int64_t sent = 0;
  std::int64_t refused = 0;
  std::int64_t unsent = 0;  // refused by the network, at first or for good
  std::int64_t rivals = 0;  // of those refused: of a second publisher of a name, or of a second CLOCK
  std::int64_t gaps = 0;
  std::int64_t repaired = 0;
  std::int64_t lost = 0;
  std::int64_t duplicates = 0;
  std::int64_t late = 0;  // results published more than the scenario's state_lag_s after their instant, and
                          // what came too late
  std::int64_t wakeups = 0;  // handled, and may have changed when the node is due (Wakeup::kMayAdvanceDue)
};

}  // namespace halocline::bus
