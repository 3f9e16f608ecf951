// Forces of fins and propeller, and how actuators follow their commands.
//
// Body frame about CO; N and N m; signs of VehicleState's ActuatorValues. Source: Allen, Vorus and Prestero
// 2000 and Fossen 2021, section 9.4. Left out: stall, the fins' own velocity, the propeller's race over the
// fins.
#pragma once

#include "vehicle_sim/vehicle_state.h"

namespace halocline::vehicle_sim {

// `nu_r`: velocity relative to the water, m/s and rad/s. `deflection_rad` positive to starboard turn.
// Y = -1/2 rho (u^2 + v^2) A C_L delta, X = -1/2 rho (u^2 + v^2) A C_L delta^2, N = x Y.
Vec6 rudder_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad);

// The same turned into the vertical plane: Z and M = -x Z; positive deflection pitches the bow down.
Vec6 stern_planes_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad);

// Thrust on the hull (surge) and the part of the shaft's torque that heels it (roll), with the shares of
// Propeller applied. `speed_mps`: of the vehicle, 0 or above, over ground or relative as the model's
// CurrentTreatment says. `turn_rate_hz` of any sign.
Vec6 propeller_force(const Propeller& propeller, double density, double speed_mps, double turn_rate_hz);

// The command held to the limits of the actuators. `command` finite.
ActuatorValues limited(const ActuatorDynamics& dynamics, const ActuatorValues& command);

// Rate of change of each actuator, per second: (limited command - value) / lag.
ActuatorValues actuator_rate(const ActuatorDynamics& dynamics, const ActuatorValues& value,
                             const ActuatorValues& limited_command);

}  // namespace halocline::vehicle_sim
