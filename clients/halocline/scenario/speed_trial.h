// SPDX-License-Identifier: BSD-3-Clause
// Whether a vehicle holds a speed: its model and its pilot's control laws in the open sea, before the run.
//
// A straight level way in still water without surface and bottom, from the set speed on, for kTrial_s. Left
// out: turns, climbs, currents; what a vehicle does not hold straight it does not hold there either.
#pragma once

#include "clients/autopilot/autopilot_config.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::clients {

inline constexpr double kTrial_s = 90;

struct SpeedTrial {
  double speed_mps = 0;      // through the water, mean over the last tenth
  double depth_error_m = 0;  // the greatest on the way
};

// With the gains and the steering of `pilot`, which fit the model; `set_speed_mps` above 0. A motion that
// diverges holds no speed (0).
SpeedTrial try_speed(const vehicle_sim::Model& model, const PilotConfig& pilot, SimDuration command_period,
                     double set_speed_mps);

}  // namespace halocline::clients
