// Forces of fins, propeller and thrusters, and how actuators follow their commands.
//
// Body frame about CO; N and N m; signs of VehicleState's ActuatorValues. Sources: Allen, Vorus and Prestero
// 2000 and Fossen 2021, section 9.4 (published laws); Polhamus 1966, NASA TN D-3767 (FinLaw::kLocalFlow: the force of
// a thin low fin stands across its chord). Left out: the propeller's race over the fins, interference of fin and hull.
#pragma once

#include "vehicle_sim/vehicle_state.h"

namespace halocline::vehicle_sim {

// `nu_r`: velocity relative to the water, m/s and rad/s. `deflection_rad` positive to starboard turn.
// kDeflection: Y = -1/2 rho (u^2 + v^2) A C_L delta, X = -1/2 rho (u^2 + v^2) A C_L delta^2, N = x Y.
// kLocalFlow: with v_f = v + x r, along the chord u_c = u cos(delta) - v_f sin(delta), across it
// v_n = u sin(delta) + v_f cos(delta): F_n = -1/2 rho A (C_L |u_c| + C_Dn |v_n|) v_n along the fin's normal
// (sin delta, cos delta). Continuous at every angle, and takes energy from the vehicle at every one.
Vec6 rudder_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad);

// The same turned into the vertical plane, w - x q for v + x r: Z and M = -x Z; positive deflection pitches the bow
// down.
Vec6 stern_planes_force(const FinPair& fins, double density, const Vec6& nu_r, double deflection_rad);

// The thrust on the hull and the part of the shaft's torque that turns it, with the shares of Thruster applied.
// `nu_r` as above; `speed_mps` for ThrusterInflow::kSpeed, 0 or above, over ground or relative as the model's
// CurrentTreatment says. `turn_rate_hz` of any sign.
Vec6 thruster_force(const Thruster& thruster, double density, const Vec6& nu_r, double speed_mps,
                    double turn_rate_hz);

// The command held to the limits of the actuators. `command` finite.
ActuatorValues limited(const ModelParameters& model, const ActuatorValues& command);

// Rate of change of each actuator, per second: (limited command - value) / lag.
ActuatorValues actuator_rate(const ModelParameters& model, const ActuatorValues& value,
                             const ActuatorValues& limited_command);

}  // namespace halocline::vehicle_sim
