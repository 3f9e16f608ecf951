#include "channel_server/vehicles/vehicle_registry.h"

#include <utility>

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

std::string VehicleRegistry::add_state(std::string_view name, VehicleId id, const StampedState& state) {
  const auto known = ids_.find(name);
  if (known != ids_.end() && known->second != id) {
    return "vehicle_id " + std::to_string(id) + "; this vehicle has the id " + std::to_string(known->second);
  }
  const auto holder = vehicles_.find(id);
  if (holder != vehicles_.end() && holder->second.name != name) {
    return "vehicle_id " + std::to_string(id) + " belongs to " + holder->second.name;
  }
  if (holder == vehicles_.end() && vehicles_.size() == kMaxVehicles) {
    return "too many vehicles; at most " + std::to_string(kMaxVehicles) + " are followed";
  }
  Vehicle& vehicle = holder == vehicles_.end() ? add_vehicle(name, id) : holder->second;
  vehicle.states.insert(state);
  return {};
}

VehicleRegistry::Vehicle& VehicleRegistry::add_vehicle(std::string_view name, VehicleId id) {
  ids_.emplace(name, id);
  Schedules schedules = configured(name);
  if (const auto announced = announced_.find(name); announced != announced_.end()) {
    schedules = std::move(announced->second.schedules);
    forget_announced(announced);
  }
  return vehicles_.emplace(id, Vehicle{std::string(name), {}, std::move(schedules)}).first->second;
}

VehicleRegistry::Schedules VehicleRegistry::configured(std::string_view name) const {
  const VehicleModem& modem = modems_.of(name);
  return {ModemSchedule(modem), ListenSchedule(modem.listening)};
}

void VehicleRegistry::announce_modem(std::string_view name, SimTime from, const VehicleModem& modem,
                                     SimTime received_at) {
  schedules_of(name, received_at).modems.announce(from, modem);
}

void VehicleRegistry::announce_listening(std::string_view name, SimTime from, const Listening& listening,
                                         SimTime received_at) {
  schedules_of(name, received_at).listening.announce(from, listening);
}

VehicleRegistry::Schedules& VehicleRegistry::schedules_of(std::string_view name, SimTime received_at) {
  if (const auto id = ids_.find(name); id != ids_.end()) return vehicles_.at(id->second).announced;
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
  return vehicle == vehicles_.end() ? modems_.standard : vehicle->second.announced.modems.at(instant);
}

const VehicleModem& VehicleRegistry::modem(std::string_view name, SimTime instant) const {
  if (const auto id = ids_.find(name); id != ids_.end()) return modem(id->second, instant);
  const auto announced = announced_.find(name);
  return announced == announced_.end() ? modems_.of(name) : announced->second.schedules.modems.at(instant);
}

const Listening& VehicleRegistry::listening(VehicleId id, SimTime instant) const {
  const auto vehicle = vehicles_.find(id);
  return vehicle == vehicles_.end() ? modems_.standard.listening
                                    : vehicle->second.announced.listening.at(instant);
}

// Sleep begins with an announcement, so one of the first instants of those that hold meanwhile is one of sleep.
bool VehicleRegistry::sleeps_during(VehicleId id, SimTime from, SimTime to) const {
  const auto vehicle = vehicles_.find(id);
  if (vehicle == vehicles_.end()) return false;
  bool sleeps = false;
  vehicle->second.announced.listening.visit_during(
      from, to, [&](const Listening& listening, SimTime since) { sleeps |= listening.is_asleep(since); });
  return sleeps;
}

void VehicleRegistry::forget_before(SimTime time) {
  for (auto vehicle = vehicles_.begin(); vehicle != vehicles_.end();) {
    if (vehicle->second.states.latest() < time) {
      ids_.erase(vehicle->second.name);
      vehicle = vehicles_.erase(vehicle);
    } else {
      vehicle->second.states.forget_before(time);
      vehicle->second.announced.modems.forget_before(time);
      vehicle->second.announced.listening.forget_before(time);
      ++vehicle;
    }
  }
  while (!announced_.empty()) {
    const auto oldest = announced_.find(announced_by_turn_.begin()->second);
    if (oldest->second.received_at >= time) break;
    forget_announced(oldest);
  }
}

void VehicleRegistry::clear() {
  vehicles_.clear();
  ids_.clear();
  announced_.clear();
  announced_by_turn_.clear();
}

std::vector<PlacedVehicle> place_all(const VehicleRegistry& fleet, SimTime instant) {
  std::vector<PlacedVehicle> placed;
  for (const VehicleId id : fleet.present(instant)) {
    placed.push_back({id, *fleet.placement(id, instant, instant), &fleet.modem(id, instant)});
  }
  return placed;
}

}  // namespace halocline::channel_server
