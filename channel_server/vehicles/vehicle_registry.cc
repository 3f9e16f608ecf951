#include "channel_server/vehicles/vehicle_registry.h"

#include "core/check.h"

namespace halocline::channel_server {

const VehicleModem& ConfiguredModems::of(std::string_view vehicle) const {
  const auto own = of_vehicle.find(vehicle);
  return own == of_vehicle.end() ? standard : own->second;
}

VehicleRegistry::VehicleRegistry(PositionRule rule, ConfiguredModems modems)
    : rule_(rule), modems_(std::move(modems)) {
  require(rule.state_lag >= SimDuration(), "state_lag must not be negative");
  require(rule.state_timeout > SimDuration(), "state_timeout must be positive");
}

std::string VehicleRegistry::hear_state(std::string_view name, VehicleId id, const StampedState& state) {
  const auto known = ids_.find(name);
  if (known != ids_.end() && known->second != id) {
    return "vehicle_id " + std::to_string(id) + "; this vehicle has the id " + std::to_string(known->second);
  }
  const auto holder = vehicles_.find(id);
  if (holder != vehicles_.end() && holder->second.name != name) {
    return "vehicle_id " + std::to_string(id) + " belongs to " + holder->second.name;
  }
  if (holder == vehicles_.end()) {
    if (vehicles_.size() == kMaxVehicles) return "too many vehicles; at most 401 are followed";
    ids_.emplace(name, id);
    vehicles_[id].name = name;
  }
  vehicles_[id].states.insert(state);
  return {};
}

std::string VehicleRegistry::hear_modem(std::string_view name, SimTime from, const VehicleModem& modem) {
  auto schedule = schedules_.find(name);
  if (schedule == schedules_.end()) {
    if (schedules_.size() == kMaxVehicles) return "too many vehicles; at most 401 are followed";
    schedule = schedules_.emplace(name, ModemSchedule(modems_.of(name))).first;
  }
  schedule->second.announce(from, modem);
  return {};
}

std::vector<VehicleId> VehicleRegistry::present(SimTime instant) const {
  std::vector<VehicleId> ids;
  for (const auto& [id, vehicle] : vehicles_) {
    if (placement(id, instant, instant)) ids.push_back(id);
  }
  return ids;
}

std::optional<Placement> VehicleRegistry::placement(VehicleId id, SimTime instant, SimTime decided_at) const {
  auto placed = prediction(id, instant, decided_at);
  if (placed && placed->age > rule_.state_timeout) placed.reset();
  return placed;
}

std::optional<Placement> VehicleRegistry::prediction(VehicleId id, SimTime instant,
                                                     SimTime decided_at) const {
  const auto vehicle = vehicles_.find(id);
  if (vehicle == vehicles_.end()) return std::nullopt;
  return vehicle->second.states.at(instant, decided_at, rule_);
}

std::optional<VehicleId> VehicleRegistry::id_of(std::string_view name) const {
  const auto known = ids_.find(name);
  return known == ids_.end() ? std::nullopt : std::optional(known->second);
}

std::string VehicleRegistry::name_of(VehicleId id) const {
  const auto vehicle = vehicles_.find(id);
  return vehicle == vehicles_.end() ? std::string() : vehicle->second.name;
}

const VehicleModem& VehicleRegistry::modem(VehicleId id, SimTime instant) const {
  const auto vehicle = vehicles_.find(id);
  return vehicle == vehicles_.end() ? modems_.standard : modem(vehicle->second.name, instant);
}

const VehicleModem& VehicleRegistry::modem(std::string_view name, SimTime instant) const {
  const auto schedule = schedules_.find(name);
  return schedule == schedules_.end() ? modems_.of(name) : schedule->second.at(instant);
}

void VehicleRegistry::forget_before(SimTime time) {
  for (auto vehicle = vehicles_.begin(); vehicle != vehicles_.end();) {
    if (vehicle->second.states.latest() < time) {
      ids_.erase(vehicle->second.name);
      vehicle = vehicles_.erase(vehicle);
    } else {
      vehicle->second.states.forget_before(time);
      ++vehicle;
    }
  }
  for (auto& [name, schedule] : schedules_) schedule.forget_before(time);
}

void VehicleRegistry::clear() {
  vehicles_.clear();
  ids_.clear();
  schedules_.clear();
}

std::vector<PlacedVehicle> place_all(const VehicleRegistry& fleet, SimTime instant) {
  std::vector<PlacedVehicle> placed;
  for (const VehicleId id : fleet.present(instant)) {
    placed.push_back({id, *fleet.placement(id, instant, instant), &fleet.modem(id, instant)});
  }
  return placed;
}

}  // namespace halocline::channel_server
