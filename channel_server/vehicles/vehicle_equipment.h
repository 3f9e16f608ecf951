// SPDX-License-Identifier: BSD-3-Clause
// Equipment of vehicles besides their modems, as the scenario defines it, and its state during a run.
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
  std::set<VehicleId> transponders = {};  // vehicles that answer pings addressed to all

  // Drops data that no instant at or after `time` needs.
  void forget_before(SimTime time) {
    clocks.forget_before(time);
    power.forget_before(time);
    noise.forget_before(time);
  }
};

}  // namespace halocline::channel_server
