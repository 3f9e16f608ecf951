// SPDX-License-Identifier: BSD-3-Clause
// Which part of the work one of several channel servers does: they split the vehicles, all receive all, and
// the union of what they publish is what one would.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"

namespace halocline::channel_server {

// The index of the server of each vehicle of the scenario.
using ServersByVehicle = std::unordered_map<VehicleId, int>;

// A server with index i of n serves the vehicles that `servers` gives it, and of others those whose id mod n
// is i: what arrives at them, the receipts of what they send, the link tables that start at them.
struct Shard {
  int index = 0;  // 0 to count - 1
  int count = 1;
  std::shared_ptr<const ServersByVehicle> servers = nullptr;  // null: of no vehicle; the same for all shards

  bool serves(VehicleId id) const { return of(id) == index; }
  bool is_alone() const { return count == 1; }
  // The index of who serves it.
  int of(VehicleId id) const {
    if (!servers) return id % count;
    const auto found = servers->find(id);
    return found == servers->end() ? id % count : found->second;
  }
  // Which server searches for the paths between two vehicles: that of the one or of the other, by a bit of a
  // hash of both ids.
  int owner_of(VehicleId a, VehicleId b) const {
    const auto [low, high] = std::minmax(a, b);
    // A step like those of SplitMix64 (Steele and others 2014).
    std::uint64_t hash = (static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high)) + 1;
    hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9u;
    hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EBu;
    return of(hash >> 63 != 0 ? high : low);
  }
};

struct StartPlace {
  VehicleId id;
  Vec3 start_ned_m;
};

// Shares vehicles out among `count` servers by where they start, so that few links run from those of one to
// those of another: the vehicles are cut in two across their longer side, north or east, and the parts again.
// In an area of 3 km, where most hear each other, the servers take the vehicles in turns of their ids
// instead, so that each has as many in the middle, which hear most. Each server has as many vehicles as any
// other but for one. They stay with their servers wherever they go.
std::shared_ptr<const ServersByVehicle> servers_by_place(std::vector<StartPlace> vehicles, int count);

}  // namespace halocline::channel_server
