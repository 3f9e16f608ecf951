// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/tile_groups.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/messages/channel_pattern.h"
#include "bus/messages/channels.h"
#include "bus/transport/receive_filter.h"
#include "bus/transport/transport.h"
#include "core/check.h"
#include "core/frames.h"

namespace halocline::bus {
namespace {

constexpr std::string_view kScheme = "udpm://";

// Families that only the vehicle's own programs receive, and programs that receive every message.
constexpr std::array kFamiliesInTiles{channels::kLinks,   channels::kSensors, channels::kDvl,
                                      channels::kGps,     channels::kSonar,   channels::kUsbl,
                                      channels::kBattery, channels::kCommand, channels::kEstimate};

// Returns the address of the group of udpm://GROUP:PORT, host byte order.
std::optional<std::uint32_t> address_of(const std::string& url) {
  in_addr group{};
  if (!url.starts_with(kScheme)) return std::nullopt;
  const std::string text = url.substr(kScheme.size(), url.find(':', kScheme.size()) - kScheme.size());
  if (inet_pton(AF_INET, text.c_str(), &group) != 1) return std::nullopt;
  const std::uint32_t address = ntohl(group.s_addr);
  return IN_MULTICAST(address) && IN_MULTICAST(address + TileGroups::kCount) ? std::optional(address)
                                                                             : std::nullopt;
}

int group_at(const Vec3& start_ned_m, double tile_m) {
  const auto number = [tile_m](double at_m) {
    const auto tile = static_cast<std::int64_t>(std::floor(at_m / tile_m));
    return static_cast<int>((tile % TileGroups::kSide + TileGroups::kSide) % TileGroups::kSide);
  };
  return 1 + TileGroups::kSide * number(start_ned_m.x()) + number(start_ned_m.y());
}

}  // namespace

GroupMemberships::~GroupMemberships() {
  for (const int one : sockets_) close(one);
}

void GroupMemberships::join(std::uint32_t address) {
  const ip_mreq membership{{htonl(address)}, {htonl(INADDR_ANY)}};
  const auto joins = [&](int one) {
    return setsockopt(one, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0 ||
           errno == EADDRINUSE;
  };
  if (!sockets_.empty() && joins(sockets_.back())) return;
  sockets_.push_back(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (joins(sockets_.back())) return;
  throw NetworkError(std::string("the multicast group of a tile cannot be joined: ") + std::strerror(errno));
}

TileGroups::TileGroups(std::string url, const Scenario& scenario) : url_(std::move(url)) {
  const auto address = address_of(url_);
  require(address.has_value(), "LCM URL is '" + url_ +
                                   "'; with bus.tile_m allowed is udpm://GROUP:PORT?ttl=N with " +
                                   std::to_string(kCount) + " groups after it");
  address_ = *address;
  for (const VehicleEntry& vehicle : scenario.vehicles)
    group_of_vehicle_.emplace(vehicle.name, group_at(vehicle.start_ned_m, scenario.tile_m));
}

int TileGroups::group_of(std::string_view channel) const {
  if (channel.starts_with(channels::kRepair.prefix)) channel.remove_prefix(channels::kRepair.prefix.size());
  const auto family = std::find_if(kFamiliesInTiles.begin(), kFamiliesInTiles.end(),
                                   [&](const Family& one) { return channel.starts_with(one.prefix); });
  if (family == kFamiliesInTiles.end()) return 0;
  const auto found = group_of_vehicle_.find(channel.substr(family->prefix.size()));
  return found == group_of_vehicle_.end() ? 0 : found->second;
}

std::set<int> TileGroups::groups_of(const std::vector<Subscribed>& subscribed) const {
  std::set<int> groups;
  for (const Subscribed& one : subscribed) {
    const ChannelPattern pattern(one.expression);
    if (!pattern.only_channel().empty()) {
      groups.insert(group_of(pattern.only_channel()));
      continue;
    }
    const std::string_view prefix = pattern.only_prefix();  // empty: any channel
    const bool is_in_tiles =
        std::any_of(kFamiliesInTiles.begin(), kFamiliesInTiles.end(), [&](const Family& family) {
          return family.prefix.starts_with(prefix) || prefix.starts_with(family.prefix);
        });
    if (!is_in_tiles) continue;
    for (const auto& [vehicle, group] : group_of_vehicle_) groups.insert(group);
  }
  groups.erase(0);
  return groups;
}

std::string TileGroups::url_of(int group) const {
  const in_addr address{htonl(address_ + static_cast<std::uint32_t>(group))};
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return std::string(kScheme) + text.data() + url_.substr(url_.find(':', kScheme.size()));
}

lcm::LCM& TileGroups::carrier_of(std::string_view channel, lcm::LCM& bus) {
  const int group = group_of(channel);
  if (group == 0) return bus;
  std::unique_ptr<lcm::LCM>& carrier = carriers_[group];
  if (!carrier) carrier = open_transport(url_of(group));
  return *carrier;
}

void TileGroups::join(const std::set<int>& groups) {
  for (const int group : groups) memberships_.join(address_ + static_cast<std::uint32_t>(group));
}

void TileGroups::join_all(const std::string& url, GroupMemberships& memberships) {
  const auto address = address_of(url);
  if (!address) return;
  for (std::uint32_t group = 1; group <= kCount; ++group) memberships.join(*address + group);
}

void require_every_group(lcm::LCM& lcm, const std::string& url) {
  sockaddr_in bound{};
  socklen_t size = sizeof bound;
  const int socket = receive_socket(lcm, url);
  if (socket < 0 || getsockname(socket, reinterpret_cast<sockaddr*>(&bound), &size) != 0) return;
  if (bound.sin_addr.s_addr == htonl(INADDR_ANY)) return;
  throw NetworkError("this LCM receives one multicast group alone; with bus.tile_m it has to be 1.3.1");
}

}  // namespace halocline::bus
