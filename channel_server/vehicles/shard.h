// Which part of the work one of several channel servers does: they split the vehicles, all receive all, and the
// union of what they publish is what one would.
#pragma once

#include "channel_server/vehicles/vehicle_id.h"

namespace halocline::channel_server {

// A server with index i of n serves the vehicles whose id mod n is i: what arrives at them, the receipts of what
// they send, the link tables that start at them.
struct Shard {
  int index = 0;  // 0 to count - 1
  int count = 1;

  bool serves(VehicleId id) const { return id % count == index; }
  bool is_alone() const { return count == 1; }
};

}  // namespace halocline::channel_server
