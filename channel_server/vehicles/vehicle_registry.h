// SPDX-License-Identifier: BSD-3-Clause
// Registry of the vehicles of a run: their names, ids, states, modems and equipment, and which of them are
// present at an instant.
//
// A vehicle is present at instant t when its position at t, decided at t, is known from a state no older than
// the time-out (state_history.h). One id belongs to one name: the first name that claims it keeps it until
// that vehicle is forgotten. All results are functions of the messages received and of the given instants,
// whatever the order of the messages.
//
// Storage is bounded. Vehicles of reserve() are always admitted; for others see unlisted_vehicles.h. The
// modem of a vehicle without a state is forgotten when no state follows in time, or when kMaxAnnounced others
// were announced after it, so an endless sequence of invented names keeps no vehicle's modem out.
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/unlisted_vehicles.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/limits.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// Modems that the scenario defines.
struct ConfiguredModems {
  VehicleModem standard;
  std::map<std::string, VehicleModem, std::less<>> of_vehicle;  // others have the standard one

  const VehicleModem& of(std::string_view vehicle) const;
};

class VehicleRegistry {
 public:
  static constexpr std::size_t kMaxAnnounced = kMaxVehicles;  // modems of vehicles without a state

  VehicleRegistry(PositionRule rule, ConfiguredModems modems, VehicleEquipment equipment = {});

  // Reserves the name and the id of a vehicle of the scenario: no other vehicle gets them, and it is always
  // admitted.
  void reserve(std::string_view name, VehicleId id);
  // Adds a state. Returns an empty string when it is accepted (a repetition is), else the reason why not.
  [[nodiscard]] std::string add_state(std::string_view name, VehicleId id, const StampedState& state);
  // Sets the modem that the vehicle carries from `from` on. It may be announced before the vehicle's first
  // state.
  void announce_modem(std::string_view name, SimTime from, const VehicleModem& modem, SimTime received_at);
  // Sets the listening mode of its modem from `from` on; it may be announced before the first state too.
  void announce_listening(std::string_view name, SimTime from, const Listening& listening,
                          SimTime received_at);

  // Returns the ascending ids of all vehicles present at `instant`.
  std::vector<VehicleId> present(SimTime instant) const;
  // Calls visit(id, placement, modem) for each vehicle present at `instant`, by ascending id.
  template <class Visit>
  void visit_present(SimTime instant, Visit&& visit) const {
    for (const auto& vehicle : vehicles_) {
      const auto place = vehicle->states.at(instant, instant, rule_);
      if (is_present(place)) visit(vehicle->id, *place, vehicle->announced.modems.at(instant));
    }
  }
  // Returns the placement of the vehicle at `instant` as decided at `decided_at`; empty when it is unknown or
  // its state is too old.
  std::optional<Placement> placement(VehicleId id, SimTime instant, SimTime decided_at) const;
  // Returns the placement however old the state is: for an instant in the future.
  std::optional<Placement> prediction(VehicleId id, SimTime instant, SimTime decided_at) const;
  // True when a prediction is a placement too: it is known, from a state that is not too old.
  bool is_present(const std::optional<Placement>& predicted) const {
    return predicted && predicted->age <= rule_.state_timeout;
  }

  // Returns the states of a vehicle, null when it is unknown; valid until the registry is changed.
  const StateHistory* states_of(VehicleId id) const {
    const Vehicle* vehicle = find(id);
    return vehicle != nullptr ? &vehicle->states : nullptr;
  }

  std::optional<VehicleId> id_of(std::string_view name) const;
  // Returns the name of a vehicle that is not forgotten; an empty string for others.
  std::string name_of(VehicleId id) const;
  // Returns the modem that the vehicle carries; the standard one for an unknown id.
  const VehicleModem& modem(VehicleId id, SimTime instant) const;
  const VehicleModem& modem(std::string_view name, SimTime instant) const;
  // Returns the listening mode of its modem; that of the standard modem for an unknown id.
  const Listening& listening(VehicleId id, SimTime instant) const;
  // True when its modem sleeps at some instant of [from, to].
  bool sleeps_during(VehicleId id, SimTime from, SimTime to) const;
  // Calls visit(modem) for each modem that the vehicle carries at some instant of [from, to], as far as
  // announced; no call for an unknown id.
  template <class Visit>
  void visit_modems(VehicleId id, SimTime from, SimTime to, Visit&& visit) const {
    if (const Vehicle* vehicle = find(id))
      vehicle->announced.modems.visit_during(from, to,
                                             [&](const VehicleModem& modem, SimTime) { visit(modem); });
  }

  const VehicleEquipment& equipment() const { return equipment_; }
  VehicleEquipment& equipment() { return equipment_; }

  // Forgets vehicles without a state since `time`, modems of vehicles without any state that were received
  // before `time`, and states and modems that no later instant needs.
  void forget_before(SimTime time);

  const PositionRule& rule() const { return rule_; }
  const ConfiguredModems& configured_modems() const { return modems_; }
  std::size_t size() const { return vehicles_.size(); }
  std::size_t announced() const { return announced_.size(); }  // modems of vehicles without a state

 private:
  struct Schedules {
    ModemSchedule modems;
    ListenSchedule listening;
  };
  struct Vehicle {
    VehicleId id;
    std::string name;
    StateHistory states;
    Schedules announced;
  };
  struct Announced {
    Schedules schedules;
    SimTime received_at;
    std::uint64_t turn = 0;  // sequence number of the latest announcement, over all vehicles
  };
  // Admits a new vehicle: returns an empty string when it is tracked from now on, else the reason why not.
  std::string find_place_for(std::string_view name, VehicleId id, SimTime time);
  // Returns the index of the vehicle in vehicles_, or that at which it would be inserted. The guess is exact
  // while ids rise by one.
  std::size_t place_of(VehicleId id) const {
    const std::size_t guess =
        vehicles_.empty() ? 0
                          : static_cast<std::size_t>(id) - static_cast<std::size_t>(vehicles_.front()->id);
    return guess < vehicles_.size() && vehicles_[guess]->id == id ? guess : searched_place_of(id);
  }
  std::size_t searched_place_of(VehicleId id) const;
  const Vehicle* find(VehicleId id) const {
    const std::size_t place = place_of(id);
    return place < vehicles_.size() && vehicles_[place]->id == id ? vehicles_[place].get() : nullptr;
  }
  Vehicle& add_vehicle(std::string_view name, VehicleId id);
  Schedules configured(std::string_view name) const;
  // Returns the schedules of a vehicle with or without a state; the current announcement was received at
  // `received_at`.
  Schedules& schedules_of(std::string_view name, SimTime received_at);
  void forget_announced(std::map<std::string, Announced, std::less<>>::iterator announced);

  PositionRule rule_;
  ConfiguredModems modems_;
  VehicleEquipment equipment_;
  std::map<std::string, VehicleId, std::less<>> reserved_;
  std::set<VehicleId> reserved_ids_;
  UnlistedVehicles unlisted_;                       // vehicles that are not reserved
  std::vector<std::unique_ptr<Vehicle>> vehicles_;  // sorted by id
  std::map<std::string, VehicleId, std::less<>> ids_;
  std::map<std::string, Announced, std::less<>> announced_;
  std::map<std::uint64_t, std::string> announced_by_turn_;
  std::uint64_t turns_ = 0;
};

// Vehicle with its placement and modem at one instant.
struct PlacedVehicle {
  VehicleId id = 0;
  Placement placement;
  const VehicleModem* modem = nullptr;  // valid until the registry is changed
};

// Returns all vehicles present at `instant` that carry a modem, by ascending id.
std::vector<PlacedVehicle> place_all(const VehicleRegistry& fleet, SimTime instant);
// Writes these vehicles into `placed`, replacing its contents.
void place_all(const VehicleRegistry& fleet, SimTime instant, std::vector<PlacedVehicle>& placed);

}  // namespace halocline::channel_server
