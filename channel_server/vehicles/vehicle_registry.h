// Everybody who has been heard: names, ids, states and modems of all vehicles, and who is present at an
// instant.
//
// A vehicle is present at instant t when its position at t, decided at t, is known from a state no older than
// the time-out (state_history.h). One id belongs to one name: the first heard keeps it until that vehicle is
// forgotten. All answers are pure functions of what was heard and the instants asked about, whatever the
// order it was heard in.
//
// Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_id.h"

namespace halocline::channel_server {

// The modems that the scenario gives.
struct ConfiguredModems {
  VehicleModem standard;
  std::map<std::string, VehicleModem, std::less<>> of_vehicle;  // by name, where not the standard one

  const VehicleModem& of(std::string_view vehicle) const;
};

class VehicleRegistry {
 public:
  // A link table holds 400 peers; more vehicles are refused.
  static constexpr std::size_t kMaxVehicles = 401;

  VehicleRegistry(PositionRule rule, ConfiguredModems modems);

  // Empty when taken (a repetition is); else why not.
  std::string hear_state(std::string_view name, VehicleId id, const StampedState& state);
  // A modem may be announced before the vehicle's first state. Empty when taken; else why not.
  std::string hear_modem(std::string_view name, SimTime from, const VehicleModem& modem);

  // Ascending ids of all present at `instant`.
  std::vector<VehicleId> present(SimTime instant) const;
  // Where the vehicle is at `instant` as decided at `decided_at`; empty when unknown or its state is too old.
  std::optional<Placement> placement(VehicleId id, SimTime instant, SimTime decided_at) const;
  // The same, however old the state: for aiming at a moment to come.
  std::optional<Placement> prediction(VehicleId id, SimTime instant, SimTime decided_at) const;

  std::optional<VehicleId> id_of(std::string_view name) const;
  // Of a vehicle that is not forgotten; empty text otherwise.
  std::string name_of(VehicleId id) const;
  // The standard one for an id never heard.
  const VehicleModem& modem(VehicleId id, SimTime instant) const;
  const VehicleModem& modem(std::string_view name, SimTime instant) const;

  // Forgets vehicles without a state since `time`, and states and modems that no later instant needs.
  void forget_before(SimTime time);
  // Another run: forgets everybody, keeps rules and configured modems.
  void clear();

  const PositionRule& rule() const { return rule_; }
  const ConfiguredModems& configured_modems() const { return modems_; }
  std::size_t size() const { return vehicles_.size(); }

 private:
  struct Vehicle {
    std::string name;
    StateHistory states;
  };

  PositionRule rule_;
  ConfiguredModems modems_;
  std::map<VehicleId, Vehicle> vehicles_;
  std::map<std::string, VehicleId, std::less<>> ids_;
  std::map<std::string, ModemSchedule, std::less<>> schedules_;
};

// A vehicle with its place and modem at one instant.
struct PlacedVehicle {
  VehicleId id = 0;
  Placement placement;
  const VehicleModem* modem = nullptr;  // lives as long as the fleet is not changed
};

// All present at `instant`, by id.
std::vector<PlacedVehicle> place_all(const VehicleRegistry& fleet, SimTime instant);

}  // namespace halocline::channel_server
