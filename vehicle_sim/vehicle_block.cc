// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/vehicle_block.h"

#include <cstddef>
#include <set>
#include <vector>

#include "vehicle_sim/fleet.h"

namespace halocline::vehicle_sim {

ScenarioPart part_of_block(const bus::Scenario& scenario, const VehicleSimConfig& config) {
  const std::vector<FleetMember> members = members_of(scenario, config);
  settings_of(scenario, config);
  faults_of(members, config);
  std::set<std::string> own;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (config.block.of(i, members.size()) == static_cast<std::size_t>(config.block.index))
      own.insert(members[i].name);
  }
  ScenarioPart part{scenario, config};
  part.config.block = {};
  const auto is_foreign = [&](const std::string& name) { return !own.contains(name); };
  std::erase_if(part.scenario.vehicles, [&](const auto& vehicle) { return is_foreign(vehicle.name); });
  std::erase_if(part.config.tethers, [&](const auto& tether) { return is_foreign(tether.vehicle); });
  std::erase_if(part.config.faults, [&](const auto& fault) { return is_foreign(fault.vehicle); });
  return part;
}

std::string node_name_of(const VehicleBlock& block) {
  return "vehicle-sim" + (block.is_alone() ? "" : "-" + std::to_string(block.index));
}

}  // namespace halocline::vehicle_sim
