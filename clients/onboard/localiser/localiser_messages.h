// SPDX-License-Identifier: BSD-3-Clause
// Conversions between bus messages and the values of the position estimator.
#pragma once

#include "acoustics/sea/sound_speed_profile.h"
#include "bus/messages/messages.h"
#include "clients/onboard/localiser/dead_reckoning.h"
#include "clients/onboard/localiser/position_estimator.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

OwnMotion to_motion(const vehicle_sensors_t& sensors);

// Throws InvalidArgument when a sound speed is not one of water.
acoustics::SoundSpeedProfile to_profile(const environment_t& environment);

// Returns the position in STATE, extrapolated to `at` by its velocity.
Vec3 true_position(const vehicle_state_t& state, SimTime at);

// Sets the fields of the estimate in `message`. `z_ned_m`: z of the vehicle.
void set_estimate(position_estimate_t& message, const PositionEstimate& estimate, double z_ned_m,
                  const EstimatorRules& rules);

}  // namespace halocline::clients
