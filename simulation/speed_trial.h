// SPDX-License-Identifier: BSD-3-Clause
// Trial of whether a vehicle holds a speed, from its model and its pilot's control laws, before the run.
//
// The vehicle moves straight and level for kTrial_s through still water without surface and bottom, starting
// at the set speed. Turns, climbs and currents are left out: a speed that is not held straight ahead is not
// held in these either.
#pragma once

#include "clients/onboard/autopilot/autopilot_config.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::clients {

inline constexpr double kTrial_s = 90;

struct SpeedTrial {
  double speed_mps = 0;      // mean speed through the water in the last tenth of the trial
  double depth_error_m = 0;  // largest depth error during the trial
};

// Runs a trial with the gains and the steering of `pilot`, which must fit the model. `set_speed_mps` must be
// above 0. A motion that diverges yields speed 0.
SpeedTrial try_speed(const vehicle_sim::Model& model, const PilotConfig& pilot, SimDuration command_period,
                     double set_speed_mps);

}  // namespace halocline::clients
