// SPDX-License-Identifier: BSD-3-Clause
// From set points and what the vehicle measures to propeller, rudder and stern planes.
//
// Model, after Fossen 2021 (Handbook, 2nd ed., chapters 15 and 16):
//   rudder  = p_heading (course - heading) - d_heading r                     heading: PD
//   pitch_d = clip(p_depth (z - z_d) + climb + integral), stern = -p_pitch (pitch_d - pitch) + d_pitch q
//                                                           depth: PI on the outside, PD of pitch within
//   rpm     = feed_forward u_d + p_speed (u_d - u) + integral               speed: PI with feed-forward
// Signs as in vehicle_command_t: positive rudder turns to starboard, positive stern planes push the nose
// down. An integral stands still while its output is at a limit. The default gains suit `torpedo` and
// `remus100-pvs` at 0.8 to 2.5 m/s: heading and pitch settle within about 5 s, the depth loop has 0.1 rad/s
// at 2 m/s. Left out:
// fins' loss of effect at low speed (gains are not scheduled), roll (the hull rights itself).
#pragma once

#include "clients/autopilot/guidance.h"

namespace halocline::clients {

struct Gains {
  double heading_p = 1.0;           // rad of rudder per rad of heading
  double heading_d_s = 0.6;         // rad of rudder per rad/s of yaw rate
  double depth_p_rad_per_m = 0.05;  // pitch per metre of depth error
  double depth_i_rad_per_m_s = 0;   // and per metre and second of its integral; for one that is not trimmed
  double pitch_p = 1.5;             // rad of stern plane per rad of pitch
  double pitch_d_s = 0.6;           // rad of stern plane per rad/s of pitch rate
  double speed_feed_forward_rpm_s_per_m = 597.3;  // 1000 rpm drive both at 1.6741 m/s
  double speed_p_rpm_s_per_m = 300;               // rpm per m/s of speed error
  double speed_i_rpm_per_m = 30;                  // and per metre of its integral
  double max_pitch_rad = 0.3490658503988659;      // of the set pitch: 20 degrees
  double max_fin_rad = 0.2617993877991494;        // of rudder and stern planes: 15 degrees
  double max_rpm = 1525;                          // of the propeller
};

// Measured state of the vehicle. Angles radians, rates about its own axes in rad/s.
struct Measured {
  double z_ned_m = 0;
  double heading_rad = 0;
  double pitch_rad = 0;
  double pitch_rate_radps = 0;
  double yaw_rate_radps = 0;
  double speed_mps = 0;  // forward through the water
};

struct ActuatorCommand {
  double propeller_rpm = 0;    // 0 to max_rpm
  double rudder_rad = 0;       // within +-max_fin
  double stern_plane_rad = 0;  // within +-max_fin
  double buoyancy_m3 = 0;      // of a buoyancy engine (glide_laws.h)
  double moving_mass_m = 0;    // of a moving mass, positive forward
};

// Integrator states.
struct Integrals {
  double pitch_rad = 0;  // of depth, as pitch
  double speed_rpm = 0;  // of speed, as propeller speed
};

// proportional + integral, held to [lowest, highest]; the integral moves on by the integrand only while that
// does not bind, or where it leads back from the limit.
double limited_pi(double proportional, double integrand, double lowest, double highest, double& integral);

// The rudder alone.
double rudder(const Gains& gains, const SetPoints& points, const Measured& measured);

// One step of `dt_s` (0 or above) seconds; moves `integrals` on.
ActuatorCommand command(const Gains& gains, const SetPoints& points, const Measured& measured, double dt_s,
                        Integrals& integrals);

}  // namespace halocline::clients
