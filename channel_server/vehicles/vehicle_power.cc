// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/vehicle_power.h"

#include <utility>

#include "acoustics/modem/modem_power.h"

namespace halocline::channel_server {

VehiclePower::VehiclePower(std::vector<PowerOf> batteries, SimDuration lag) : lag_(lag) {
  for (PowerOf& battery : batteries) batteries_[battery.id].settings = std::move(battery);
}

const PowerOf* VehiclePower::battery_of(VehicleId id) const {
  const auto found = batteries_.find(id);
  return found == batteries_.end() ? nullptr : &found->second.settings;
}

double VehiclePower::transmit_energy_j(VehicleId id, const acoustics::Modem& modem,
                                       SimDuration duration) const {
  const PowerOf* battery = battery_of(id);
  return battery == nullptr ? 0 : transmit_power_w(modem, battery->transmit_efficiency) * duration.seconds();
}

void VehiclePower::add_report(std::string_view vehicle, SimTime at, bool is_empty) {
  for (auto& [id, battery] : batteries_) {
    if (battery.settings.vehicle != vehicle) continue;
    battery.is_empty.set(at, is_empty);
  }
}

bool VehiclePower::has_power(VehicleId id, SimTime at) const {
  const auto found = batteries_.find(id);
  return found == batteries_.end() || !found->second.is_empty.at(at - lag_);
}

void VehiclePower::forget_before(SimTime time) {
  for (auto& [id, battery] : batteries_) battery.is_empty.forget_before(time - lag_);
}

}  // namespace halocline::channel_server
