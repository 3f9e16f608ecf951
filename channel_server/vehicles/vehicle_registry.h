// SPDX-License-Identifier: BSD-3-Clause
// The vehicles of a run: their names, ids, states, modems and equipment, and which of them are present at an
// instant.
//
// A vehicle is present at instant t when its position at t, decided at t, is known from a state no older than
// the time-out (state_history.h). One id belongs to one name: the first that claims it keeps it until that
// vehicle is forgotten. All answers are functions of the messages received and of the instants given,
// whatever the order of the messages.
//
// Bounded: those of reserve() always have their places, others as unlisted_vehicles.h says. The modem of a
// vehicle without a state is forgotten when no state follows in time, and when kMaxAnnounced others were
// announced after it, so names made up without end keep nobody's modem out.
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

// The modems that the scenario gives.
struct ConfiguredModems {
  VehicleModem standard;
  std::map<std::string, VehicleModem, std::less<>> of_vehicle;  // by name, where not the standard one

  const VehicleModem& of(std::string_view vehicle) const;
};

class VehicleRegistry {
 public:
  static constexpr std::size_t kMaxAnnounced = kMaxVehicles;  // modems of vehicles without a state

  VehicleRegistry(PositionRule rule, ConfiguredModems modems, VehicleEquipment equipment = {});

  // A vehicle of the scenario: nobody else gets its name, its id or its place, not even in another run.
  void reserve(std::string_view name, VehicleId id);
  // Empty when taken (a repetition is); else why not.
  [[nodiscard]] std::string add_state(std::string_view name, VehicleId id, const StampedState& state);
  // The vehicle carries `modem` from `from` on. A modem may be announced before the vehicle's first state.
  void announce_modem(std::string_view name, SimTime from, const VehicleModem& modem, SimTime received_at);
  // Its modem listens like this from `from` on; likewise.
  void announce_listening(std::string_view name, SimTime from, const Listening& listening,
                          SimTime received_at);

  // Ascending ids of all present at `instant`.
  std::vector<VehicleId> present(SimTime instant) const;
  // Calls visit(id, placement, modem) for each of them, in that order.
  template <class Visit>
  void visit_present(SimTime instant, Visit&& visit) const {
    for (const auto& vehicle : vehicles_) {
      const auto place = vehicle->states.at(instant, instant, rule_);
      if (is_present(place)) visit(vehicle->id, *place, vehicle->announced.modems.at(instant));
    }
  }
  // Where the vehicle is at `instant` as decided at `decided_at`; empty when unknown or its state is too old.
  std::optional<Placement> placement(VehicleId id, SimTime instant, SimTime decided_at) const;
  // The same, however old the state: for an instant to come.
  std::optional<Placement> prediction(VehicleId id, SimTime instant, SimTime decided_at) const;
  // Whether a prediction is a placement as well: known, and of a state that is not too old.
  bool is_present(const std::optional<Placement>& predicted) const {
    return predicted && predicted->age <= rule_.state_timeout;
  }

  // Null of a vehicle that is unknown; valid until the registry is changed.
  const StateHistory* states_of(VehicleId id) const {
    const Vehicle* vehicle = find(id);
    return vehicle != nullptr ? &vehicle->states : nullptr;
  }

  std::optional<VehicleId> id_of(std::string_view name) const;
  // Of a vehicle that is not forgotten; empty text otherwise.
  std::string name_of(VehicleId id) const;
  // The standard one for an unknown id.
  const VehicleModem& modem(VehicleId id, SimTime instant) const;
  const VehicleModem& modem(std::string_view name, SimTime instant) const;
  // How its modem listens; as configured by default for an unknown id.
  const Listening& listening(VehicleId id, SimTime instant) const;
  // Whether its modem sleeps at some instant of [from, to].
  bool sleeps_during(VehicleId id, SimTime from, SimTime to) const;
  // Calls visit(modem) for each that the vehicle carries at some instant of [from, to], as far as announced;
  // never for an unknown id.
  template <class Visit>
  void visit_modems(VehicleId id, SimTime from, SimTime to, Visit&& visit) const {
    if (const Vehicle* vehicle = find(id))
      vehicle->announced.modems.visit_during(from, to,
                                             [&](const VehicleModem& modem, SimTime) { visit(modem); });
  }

  const VehicleEquipment& equipment() const { return equipment_; }
  VehicleEquipment& equipment() { return equipment_; }

  // Forgets vehicles without a state since `time`, modems of vehicles without any state received before it,
  // and states and modems that no later instant needs.
  void forget_before(SimTime time);
  // Another run: forgets everybody, keeps rules and configured modems.
  void clear();

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
    std::uint64_t turn = 0;  // of the latest announcement, among all
  };
  // Empty when it has a place from now on; else why the vehicle, which has none yet, does not get one.
  std::string find_place_for(std::string_view name, VehicleId id, SimTime time);
  // Where the vehicle is among vehicles_, or would be. Ids mostly rise by one.
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
  // Of a vehicle with or without a state; what is announced now was received at `received_at`.
  Schedules& schedules_of(std::string_view name, SimTime received_at);
  void forget_announced(std::map<std::string, Announced, std::less<>>::iterator announced);

  PositionRule rule_;
  ConfiguredModems modems_;
  VehicleEquipment equipment_;
  std::map<std::string, VehicleId, std::less<>> reserved_;
  std::set<VehicleId> reserved_ids_;
  UnlistedVehicles unlisted_;                       // vehicles without a reserved place
  std::vector<std::unique_ptr<Vehicle>> vehicles_;  // by id
  std::map<std::string, VehicleId, std::less<>> ids_;
  std::map<std::string, Announced, std::less<>> announced_;
  std::map<std::uint64_t, std::string> announced_by_turn_;
  std::uint64_t turns_ = 0;
};

// A vehicle with its place and modem at one instant.
struct PlacedVehicle {
  VehicleId id = 0;
  Placement placement;
  const VehicleModem* modem = nullptr;  // valid until the registry is changed
};

// All present at `instant` that carry a modem, by id.
std::vector<PlacedVehicle> place_all(const VehicleRegistry& fleet, SimTime instant);
// The same into `placed`, whatever it held.
void place_all(const VehicleRegistry& fleet, SimTime instant, std::vector<PlacedVehicle>& placed);

}  // namespace halocline::channel_server
