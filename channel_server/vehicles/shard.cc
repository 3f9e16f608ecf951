// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/shard.h"

#include <cstddef>
#include <span>
#include <tuple>

namespace halocline::channel_server {
namespace {

// Side of an area in which vehicles hear most others, so that no division of it saves links, m.
constexpr double kSmallAreaM = 3000;

double side_m(std::span<const StartPlace> vehicles, int axis) {
  const auto by_place = [axis](const StartPlace& a, const StartPlace& b) {
    return a.start_ned_m[axis] < b.start_ned_m[axis];
  };
  const auto [least, most] = std::minmax_element(vehicles.begin(), vehicles.end(), by_place);
  return most->start_ned_m[axis] - least->start_ned_m[axis];
}

void take_turns(std::span<StartPlace> vehicles, int first, int count, ServersByVehicle& servers) {
  std::sort(vehicles.begin(), vehicles.end(),
            [](const StartPlace& a, const StartPlace& b) { return a.id < b.id; });
  int turn = 0;
  for (const StartPlace& vehicle : vehicles) servers[vehicle.id] = first + turn++ % count;
}

// Assigns the vehicles to `count` servers from `first` on.
void share_out(std::span<StartPlace> vehicles, int first, int count, ServersByVehicle& servers) {
  if (vehicles.empty()) return;
  if (count == 1) {
    for (const StartPlace& vehicle : vehicles) servers[vehicle.id] = first;
    return;
  }
  const int axis = side_m(vehicles, 0) > side_m(vehicles, 1) ? 0 : 1;
  if (side_m(vehicles, axis) <= kSmallAreaM) {
    take_turns(vehicles, first, count, servers);
    return;
  }
  std::sort(vehicles.begin(), vehicles.end(), [axis](const StartPlace& a, const StartPlace& b) {
    return std::tuple(a.start_ned_m[axis], a.id) < std::tuple(b.start_ned_m[axis], b.id);
  });
  const int half = count / 2;
  const std::size_t cut = vehicles.size() * static_cast<std::size_t>(half) / static_cast<std::size_t>(count);
  share_out(vehicles.first(cut), first, half, servers);
  share_out(vehicles.subspan(cut), first + half, count - half, servers);
}

}  // namespace

std::shared_ptr<const ServersByVehicle> servers_by_place(std::vector<StartPlace> vehicles, int count) {
  auto servers = std::make_shared<ServersByVehicle>();
  share_out(vehicles, 0, count, *servers);
  return servers;
}

}  // namespace halocline::channel_server
