// SPDX-License-Identifier: BSD-3-Clause
// What vehicles carry besides their modems, as the scenario gives it, and what has become of it.
#pragma once

#include <set>

#include "channel_server/vehicles/vehicle_clocks.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "channel_server/vehicles/vehicle_power.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct VehicleEquipment {
  VehicleClocks clocks = {};
  VehiclePower power = {};
  VehicleNoise noise = {};
  std::set<VehicleId> transponders = {};  // that answer pings to all

  // Drops what no instant at or after `time` needs.
  void forget_before(SimTime time) {
    clocks.forget_before(time);
    power.forget_before(time);
    noise.forget_before(time);
  }
  // Another run: all is as the scenario gives it.
  void clear() {
    clocks.clear();
    power.clear();
    noise.clear();
  }
};

}  // namespace halocline::channel_server
