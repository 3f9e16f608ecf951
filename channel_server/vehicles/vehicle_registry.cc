// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/vehicle_registry.h"

#include <algorithm>
#include <utility>

#include "core/check.h"

namespace halocline::channel_server {

const VehicleModem& ConfiguredModems::of(std::string_view vehicle) const {
  const auto own = of_vehicle.find(vehicle);
  return own == of_vehicle.end() ? standard : own->second;
}

VehicleRegistry::VehicleRegistry(PositionRule rule, ConfiguredModems modems, VehicleEquipment equipment)
    : rule_(rule),
      modems_(std::move(modems)),
      equipment_(std::move(equipment)),
      unlisted_(rule.state_timeout) {
  require(rule.state_lag >= SimDuration(), "state_lag must not be negative");
  require(rule.state_timeout > SimDuration(), "state_timeout must be positive");
}

std::string VehicleRegistry::add_state(std::string_view name, VehicleId id, const StampedState& state) {
  const auto known = ids_.find(name);
  if (known != ids_.end() && known->second != id) {
    return "vehicle_id " + std::to_string(id) + "; this vehicle has the id " + std::to_string(known->second);
  }
  const std::size_t place = place_of(id);
  const bool is_known = place < vehicles_.size() && vehicles_[place]->id == id;
  if (is_known && vehicles_[place]->name != name) {
    return "vehicle_id " + std::to_string(id) + " belongs to " + vehicles_[place]->name;
  }
  if (!is_known) {
    if (std::string problem = find_place_for(name, id, state.time); !problem.empty()) return problem;
  }
  Vehicle& vehicle = is_known ? *vehicles_[place] : add_vehicle(name, id);
  vehicle.states.insert(state);
  return {};
}

void VehicleRegistry::reserve(std::string_view name, VehicleId id) {
  reserved_.emplace(name, id);
  reserved_ids_.insert(id);
}

std::string VehicleRegistry::find_place_for(std::string_view name, VehicleId id, SimTime time) {
  if (const auto reserved = reserved_.find(name); reserved != reserved_.end()) {
    if (reserved->second == id) return {};
    return "vehicle_id " + std::to_string(id) + "; in the scenario this vehicle has the id " +
           std::to_string(reserved->second);
  }
  if (reserved_ids_.contains(id))
    return "vehicle_id " + std::to_string(id) + " is that of another vehicle in the scenario";
  return unlisted_.admit(name, id, time);
}

// Returns the index of the vehicle, or that at which it would be inserted, by binary search. Consecutive ids,
// as in most fleets, need no search.
std::size_t VehicleRegistry::searched_place_of(VehicleId id) const {
  const auto place =
      std::lower_bound(vehicles_.begin(), vehicles_.end(), id,
                       [](const auto& vehicle, VehicleId sought) { return vehicle->id < sought; });
  return static_cast<std::size_t>(place - vehicles_.begin());
}

VehicleRegistry::Vehicle& VehicleRegistry::add_vehicle(std::string_view name, VehicleId id) {
  ids_.emplace(name, id);
  Schedules schedules = configured(name);
  if (const auto announced = announced_.find(name); announced != announced_.end()) {
    schedules = std::move(announced->second.schedules);
    forget_announced(announced);
  }
  const auto place = vehicles_.begin() + static_cast<std::ptrdiff_t>(place_of(id));
  return **vehicles_.insert(
      place, std::make_unique<Vehicle>(Vehicle{id, std::string(name), {}, std::move(schedules)}));
}

VehicleRegistry::Schedules VehicleRegistry::configured(std::string_view name) const {
  const VehicleModem& modem = modems_.of(name);
  return {ModemSchedule(modem), ListenSchedule(modem.listening)};
}

void VehicleRegistry::announce_modem(std::string_view name, SimTime from, const VehicleModem& modem,
                                     SimTime received_at) {
  schedules_of(name, received_at).modems.set(from, modem);
}

void VehicleRegistry::announce_listening(std::string_view name, SimTime from, const Listening& listening,
                                         SimTime received_at) {
  schedules_of(name, received_at).listening.set(from, listening);
}

VehicleRegistry::Schedules& VehicleRegistry::schedules_of(std::string_view name, SimTime received_at) {
  if (const auto id = ids_.find(name); id != ids_.end()) return vehicles_[place_of(id->second)]->announced;
  auto announced = announced_.find(name);
  if (announced == announced_.end()) {
    if (announced_.size() == kMaxAnnounced) {
      forget_announced(announced_.find(announced_by_turn_.begin()->second));
    }
    announced = announced_.emplace(name, Announced{configured(name), {}, 0}).first;
  }
  Announced& entry = announced->second;
  entry.received_at = received_at;
  announced_by_turn_.erase(entry.turn);
  entry.turn = ++turns_;
  announced_by_turn_.emplace(entry.turn, name);
  return entry.schedules;
}

void VehicleRegistry::forget_announced(std::map<std::string, Announced, std::less<>>::iterator announced) {
  announced_by_turn_.erase(announced->second.turn);
  announced_.erase(announced);
}

std::vector<VehicleId> VehicleRegistry::present(SimTime instant) const {
  std::vector<VehicleId> ids;
  visit_present(instant, [&](VehicleId id, const auto&, const auto&) { ids.push_back(id); });
  return ids;
}

std::optional<Placement> VehicleRegistry::placement(VehicleId id, SimTime instant, SimTime decided_at) const {
  auto placed = prediction(id, instant, decided_at);
  if (!is_present(placed)) placed.reset();
  return placed;
}

std::optional<Placement> VehicleRegistry::prediction(VehicleId id, SimTime instant,
                                                     SimTime decided_at) const {
  const Vehicle* vehicle = find(id);
  return vehicle != nullptr ? vehicle->states.at(instant, decided_at, rule_) : std::nullopt;
}

std::optional<VehicleId> VehicleRegistry::id_of(std::string_view name) const {
  const auto known = ids_.find(name);
  return known == ids_.end() ? std::nullopt : std::optional(known->second);
}

std::string VehicleRegistry::name_of(VehicleId id) const {
  const Vehicle* vehicle = find(id);
  return vehicle != nullptr ? vehicle->name : std::string();
}

const VehicleModem& VehicleRegistry::modem(VehicleId id, SimTime instant) const {
  const Vehicle* vehicle = find(id);
  return vehicle != nullptr ? vehicle->announced.modems.at(instant) : modems_.standard;
}

const VehicleModem& VehicleRegistry::modem(std::string_view name, SimTime instant) const {
  if (const auto id = ids_.find(name); id != ids_.end()) return modem(id->second, instant);
  const auto announced = announced_.find(name);
  return announced == announced_.end() ? modems_.of(name) : announced->second.schedules.modems.at(instant);
}

const Listening& VehicleRegistry::listening(VehicleId id, SimTime instant) const {
  const Vehicle* vehicle = find(id);
  return vehicle != nullptr ? vehicle->announced.listening.at(instant) : modems_.standard.listening;
}

// Sleep begins with an announcement, so a modem that sleeps within the interval sleeps at the first instant
// of one of the visited modes.
bool VehicleRegistry::sleeps_during(VehicleId id, SimTime from, SimTime to) const {
  const Vehicle* vehicle = find(id);
  if (vehicle == nullptr) return false;
  bool sleeps = false;
  vehicle->announced.listening.visit_during(
      from, to, [&](const Listening& listening, SimTime since) { sleeps |= listening.is_asleep(since); });
  return sleeps;
}

void VehicleRegistry::forget_before(SimTime time) {
  equipment_.forget_before(time);
  const auto has_gone = [&](const auto& vehicle) { return vehicle->states.latest() < time; };
  for (const auto& vehicle : vehicles_) {
    if (has_gone(vehicle)) {
      ids_.erase(vehicle->name);
      if (!reserved_.contains(vehicle->name)) unlisted_.leave();
    } else {
      vehicle->states.forget_before(time);
      vehicle->announced.modems.forget_before(time);
      vehicle->announced.listening.forget_before(time);
    }
  }
  std::erase_if(vehicles_, has_gone);
  while (!announced_.empty()) {
    const auto oldest = announced_.find(announced_by_turn_.begin()->second);
    if (oldest->second.received_at >= time) break;
    forget_announced(oldest);
  }
}

std::vector<PlacedVehicle> place_all(const VehicleRegistry& fleet, SimTime instant) {
  std::vector<PlacedVehicle> placed;
  place_all(fleet, instant, placed);
  return placed;
}

void place_all(const VehicleRegistry& fleet, SimTime instant, std::vector<PlacedVehicle>& placed) {
  placed.clear();
  placed.reserve(fleet.size());
  fleet.visit_present(instant, [&](VehicleId id, const Placement& place, const VehicleModem& modem) {
    if (modem.fitted) placed.push_back({id, place, &modem});
  });
}

}  // namespace halocline::channel_server
