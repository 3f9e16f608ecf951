// SPDX-License-Identifier: BSD-3-Clause
// Multicast groups of tiles of the sea: what only the programs of one vehicle receive reaches only the hosts
// that run them.
//
// With tile_m of [bus], the families of kFamiliesInTiles are published on the group of the tile that the
// vehicle starts in. Tile (i, j) is that of floor(start / tile_m), north and east; its group is number 1 + 8
// (i mod 8) + (j mod 8), on the port of the bus, and has the address of the bus' group plus that number:
// tiles that lie eight apart share one. All else is published on the group of the bus, number 0, and so is
// what belongs to vehicles that the scenario does not name. A channel never changes its group, so sessions,
// gaps and repairs are as on one group.
//
// Every program receives the group of the bus, and those of the channels that it subscribes to; whoever
// subscribes to a whole family receives all. Groups are joined for the host: LCM 1.3.1 gives each of its
// programs every group of its port that any program has joined (receive_filter.h leaves out what it does not
// subscribe to). LCM 1.5 receives one group alone, and is refused.
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

#include "bus/runtime/scenario.h"
#include "bus/subscription.h"

namespace halocline::bus {

// Memberships in multicast groups, of this host while it lives.
class GroupMemberships {
 public:
  GroupMemberships() = default;
  ~GroupMemberships();
  GroupMemberships(const GroupMemberships&) = delete;
  GroupMemberships& operator=(const GroupMemberships&) = delete;
  // `address`: IPv4, host byte order. Throws NetworkError where the kernel refuses it.
  void join(std::uint32_t address);

 private:
  std::vector<int> sockets_;  // each has as many as the kernel allows, 20 by default
};

class TileGroups {
 public:
  static constexpr int kSide = 8, kCount = kSide * kSide;

  // For a bus on `url`. Throws InvalidArgument unless it is udpm://GROUP:PORT and has kCount groups after its
  // own.
  TileGroups(std::string url, const Scenario& scenario);

  // Of a channel; a repair is of the group of what is repaired.
  int group_of(std::string_view channel) const;
  // Those of the tiles whose channels any of the expressions of LCM matches.
  std::set<int> groups_of(const std::vector<Subscribed>& subscribed) const;
  std::string url_of(int group) const;

  // To be published on. `bus`: that of group 0.
  lcm::LCM& carrier_of(std::string_view channel, lcm::LCM& bus);
  // The host receives these from now on. Throws NetworkError.
  void join(const std::set<int>& groups);
  // All, whatever the scenario: for a program that shows every message of any run. Of a URL without a group
  // it joins none.
  static void join_all(const std::string& url, GroupMemberships& memberships);

 private:
  std::string url_;
  std::uint32_t address_;  // of group 0, host byte order
  std::map<std::string, int, std::less<>> group_of_vehicle_;
  std::map<int, std::unique_ptr<lcm::LCM>> carriers_;  // opened when they are first published on
  GroupMemberships memberships_;
};

// Throws NetworkError where `lcm`, on `url`, receives its own group alone.
void require_every_group(lcm::LCM& lcm, const std::string& url);

}  // namespace halocline::bus
