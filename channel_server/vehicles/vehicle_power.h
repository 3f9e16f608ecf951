// SPDX-License-Identifier: BSD-3-Clause
// Batteries of vehicles as their modems see them: the energy that packets consume, and the instants at which
// batteries are empty.
//
// A vehicle whose BATTERY message reports an empty battery at u has no modem from u + lag on, with the lag of
// states (state_history.h): it is longer than the delay of a message, so every server removes the modem at
// the same instant. A later report of a battery that is not empty restores it in the same way. The result is
// a function of the contents of the messages and of the instant, whatever their order. A vehicle without a
// battery always has power. Not thread-safe.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "acoustics/modem/modem.h"
#include "channel_server/vehicles/schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// Battery of one vehicle, which is given by its name and id.
struct PowerOf {
  std::string vehicle;
  VehicleId id = 0;
  double transmit_efficiency = 0.5;  // acoustic over electric power, 0.001 to 1
  double receiving_w = 0;            // electric power while a packet is tracked, 0 or more
};

class VehiclePower {
 public:
  static constexpr std::size_t kMaxReports = 4096;  // limit for one vehicle; beyond it the oldest are dropped

  VehiclePower() = default;  // no vehicle has a battery
  VehiclePower(std::vector<PowerOf> batteries, SimDuration lag);

  bool has_batteries() const { return !batteries_.empty(); }
  // Returns the battery of a vehicle; null without one.
  const PowerOf* battery_of(VehicleId id) const;

  // Returns the energy that a transmission of `modem` takes, J; 0 without a battery.
  double transmit_energy_j(VehicleId id, const acoustics::Modem& modem, SimDuration duration) const;

  // Adds the vehicle's report, at `at`, on whether its battery is empty. No effect for a vehicle without a
  // battery.
  void add_report(std::string_view vehicle, SimTime at, bool is_empty);
  bool has_power(VehicleId id, SimTime at) const;

  // Drops reports that no instant at or after `time` needs.
  void forget_before(SimTime time);

 private:
  struct Battery {
    PowerOf settings;
    Schedule<bool> is_empty{false, kMaxReports};
  };
  std::map<VehicleId, Battery> batteries_;
  SimDuration lag_;
};

}  // namespace halocline::channel_server
