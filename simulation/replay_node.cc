// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/replay_node.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "channel_server/channel_server_config.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "core/sim_time.h"

namespace halocline::clients {

Played played_in(const ScenarioConfig& config) {
  const auto& equipped = config.channel_server.vehicles;
  const auto& vehicles = config.scenario.vehicles;
  const bool depends_on_them =
      std::any_of(equipped.begin(), equipped.end(), [](const auto& v) { return v.clock.has_value(); }) ||
      std::any_of(vehicles.begin(), vehicles.end(), [](const auto& v) { return v.battery.has_value(); }) ||
      !make_equipment(config.channel_server, config.scenario).noise.sources().empty();
  return depends_on_them ? Played::kWithEquipment : Played::kStatesAndPackets;
}

ReplayNode::ReplayNode(lcm::LCM& lcm, bus::NodeIdentity identity, Recording recording)
    : Node(lcm, std::move(identity)), recording_(std::move(recording)) {}

bus::Due ReplayNode::on_due() const {
  const bool done = next_ == recording_.events.size();
  return {.sim = done ? SimTime::never() : recording_.events[next_].at};
}

void ReplayNode::on_step(const bus::Now& now) {
  for (; next_ < recording_.events.size() && recording_.events[next_].at <= now.sim; ++next_) {
    const Recording::Event& event = recording_.events[next_];
    std::visit([&](const auto& message) { bus().publish(event.channel, message); }, event.message);
  }
}

std::string ReplayNode::status_text() const {
  return "played " + std::to_string(next_) + " of " + std::to_string(recording_.events.size()) +
         " recorded messages";
}

}  // namespace halocline::clients
