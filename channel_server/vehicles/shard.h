// Which part of the work one of several channel servers does: they split the vehicles, all receive all, and the
// union of what they publish is what one would.
#pragma once

#include <algorithm>
#include <cstdint>

#include "channel_server/vehicles/vehicle_id.h"

namespace halocline::channel_server {

// A server with index i of n serves the vehicles whose id mod n is i: what arrives at them, the receipts of what
// they send, the link tables that start at them.
struct Shard {
  int index = 0;  // 0 to count - 1
  int count = 1;

  bool serves(VehicleId id) const { return id % count == index; }
  bool is_alone() const { return count == 1; }
  int of(VehicleId id) const { return id % count; }  // the index of who serves it
  // Which server searches for the paths between two vehicles: that of the one or of the other, by a bit of a hash of both ids.
  int owner_of(VehicleId a, VehicleId b) const {
    const auto [low, high] = std::minmax(a, b);
    // A step like those of SplitMix64 (Steele and others 2014).
    std::uint64_t hash = (static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high)) + 1;
    hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9u;
    hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EBu;
    return of(hash >> 63 != 0 ? high : low);
  }
};

}  // namespace halocline::channel_server
