// SPDX-License-Identifier: BSD-3-Clause
// Sharding: which part of the work each of several channel servers does. The servers divide the vehicles
// among themselves, all receive every message, and the union of what they publish equals what one server
// would publish.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "channel_server/vehicles/vehicle_id.h"
#include "core/frames.h"

namespace halocline::channel_server {

// Index of the server of each vehicle of the scenario.
using ServersByVehicle = std::unordered_map<VehicleId, int>;

// One channel server of several. Server i of n serves the vehicles that `servers` assigns to it and, of all
// other vehicles, those with id mod n = i. It computes the arrivals at its vehicles, the receipts of the
// packets they send, and the link tables that start at them.
struct Shard {
  int index = 0;  // 0 to count - 1
  int count = 1;
  std::shared_ptr<const ServersByVehicle> servers = nullptr;  // null: no assignment; the same for all shards

  bool serves(VehicleId id) const { return of(id) == index; }
  bool is_alone() const { return count == 1; }
  int of(VehicleId id) const {
    if (!servers) return id % count;
    const auto found = servers->find(id);
    return found == servers->end() ? id % count : found->second;
  }
  // Returns the index of the server that searches for the paths between two vehicles: the server of either,
  // chosen by one bit of a hash of both ids.
  int owner_of(VehicleId a, VehicleId b) const {
    const auto [low, high] = std::minmax(a, b);
    // Mixing steps like those of SplitMix64 (Steele and others 2014).
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

// Assigns vehicles to `count` servers by their start positions, so that few links run between vehicles of
// different servers. The vehicles are divided in two across the longer side of their area, north or east, and
// each part again. Within an area of 3 km, where most vehicles hear each other, vehicles are assigned in turn
// by their ids instead, so that each server has equally many in the middle, which hear most others. The
// numbers of vehicles of any two servers differ by one at most. Vehicles stay with their servers wherever
// they go.
std::shared_ptr<const ServersByVehicle> servers_by_place(std::vector<StartPlace> vehicles, int count);

}  // namespace halocline::channel_server
