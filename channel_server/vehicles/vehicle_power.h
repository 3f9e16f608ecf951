// SPDX-License-Identifier: BSD-3-Clause
// The batteries of vehicles as their modems see them: what packets take from them, and from when on they are
// empty.
//
// A vehicle whose BATTERY says empty at u has no modem from u + lag on, the lag of states (state_history.h):
// longer than a message takes, so that every server takes it off the air at the same instant. One whose
// battery says otherwise later has it again likewise. A function of the contents of the messages and of the
// instant, in whatever order they came. A vehicle without a battery always has power. Not thread-safe.
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

// The battery of one vehicle, by its name and id.
struct PowerOf {
  std::string vehicle;
  VehicleId id = 0;
  double transmit_efficiency = 0.5;  // acoustic over electric power, 0.001 to 1
  double receiving_w = 0;            // while a packet is followed, 0 and up
};

class VehiclePower {
 public:
  static constexpr std::size_t kMaxReports = 4096;  // of one vehicle; the oldest make room

  VehiclePower() = default;  // nobody has a battery
  VehiclePower(std::vector<PowerOf> batteries, SimDuration lag);

  bool has_batteries() const { return !batteries_.empty(); }
  // Null without a battery.
  const PowerOf* battery_of(VehicleId id) const;

  // That a transmission of `modem` takes; 0 without a battery.
  double transmit_energy_j(VehicleId id, const acoustics::Modem& modem, SimDuration duration) const;

  // The vehicle reports at `at` whether its battery is empty; of one without a battery of no effect.
  void add_report(std::string_view vehicle, SimTime at, bool is_empty);
  bool has_power(VehicleId id, SimTime at) const;

  // Drops reports that no instant at or after `time` needs.
  void forget_before(SimTime time);
  void clear();  // forgets all reports

 private:
  struct Battery {
    PowerOf settings;
    Schedule<bool> is_empty{false, kMaxReports};
  };
  std::map<VehicleId, Battery> batteries_;
  SimDuration lag_;
};

}  // namespace halocline::channel_server
