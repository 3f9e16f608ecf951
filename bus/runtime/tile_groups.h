// SPDX-License-Identifier: BSD-3-Clause
// Multicast groups of tiles of the sea: messages that only the programs of one vehicle receive reach only the
// hosts that run them.
//
// With tile_m of [bus], the families of kFamiliesInTiles are published on the group of the tile in which the
// vehicle starts. Tile (i, j) has i = floor(start_north / tile_m) and j = floor(start_east / tile_m). Its
// group has the number
//
//   1 + 8 (i mod 8) + (j mod 8)
//
// and its address is that of the bus' group plus this number, on the port of the bus: tiles eight apart share
// a group. All other channels, and those of vehicles that the scenario does not name, are published on the
// group of the bus, number 0. A channel never changes its group, so sessions, gaps and repairs are as on a
// single group.
//
// Every program receives the group of the bus, and those of the channels that it subscribes to; a program
// that subscribes to a whole family receives all groups. Groups are joined for the host: LCM 1.3.1 passes
// every group of its port that any program of the host has joined to each program (receive_filter.h drops
// unwanted messages). LCM 1.5 receives only one group, and is refused.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/config/scenario.h"
#include "bus/transport/subscription.h"

namespace halocline::bus {

// Memberships of this host in multicast groups, for the lifetime of the object.
class GroupMemberships {
 public:
  GroupMemberships() = default;
  ~GroupMemberships();
  GroupMemberships(const GroupMemberships&) = delete;
  GroupMemberships& operator=(const GroupMemberships&) = delete;
  // `address`: IPv4, host byte order. Throws NetworkError if the kernel refuses it.
  void join(std::uint32_t address);

 private:
  std::vector<int> sockets_;  // each has as many memberships as the kernel allows, 20 by default
};

class TileGroups {
 public:
  static constexpr int kSide = 8, kCount = kSide * kSide;

  // For a bus on `url`. Throws InvalidArgument unless it is udpm://GROUP:PORT and kCount multicast addresses
  // follow its own.
  TileGroups(std::string url, const Scenario& scenario);

  // Returns the group of a channel; a repair has the group of the repaired channel.
  int group_of(std::string_view channel) const;
  // Returns the groups of the tiles whose channels match any of the LCM expressions.
  std::set<int> groups_of(const std::vector<Subscribed>& subscribed) const;
  std::string url_of(int group) const;

  // Returns the LCM instance to publish on. `bus`: that of group 0.
  lcm::LCM& carrier_of(std::string_view channel, lcm::LCM& bus);
  // The host receives these groups from now on. Throws NetworkError.
  void join(const std::set<int>& groups);
  // Joins all groups, whatever the scenario, for a program that shows every message of any run. Joins none if
  // the URL has no group.
  static void join_all(const std::string& url, GroupMemberships& memberships);

 private:
  std::string url_;
  std::uint32_t address_;  // address of group 0, host byte order
  std::map<std::string, int, std::less<>> group_of_vehicle_;
  std::map<int, std::unique_ptr<lcm::LCM>> carriers_;  // opened when first published on
  GroupMemberships memberships_;
};

// Throws NetworkError if `lcm`, on `url`, receives only its own group.
void require_every_group(lcm::LCM& lcm, const std::string& url);

}  // namespace halocline::bus
