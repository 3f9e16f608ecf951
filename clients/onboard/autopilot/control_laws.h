// SPDX-License-Identifier: BSD-3-Clause
// Control laws of a vehicle with propeller, rudder and stern planes: from set points and measured state to
// actuator commands.
//
// Model, after Fossen 2021 (Handbook, 2nd ed., chapters 15 and 16):
//
//   heading, PD:             rudder  = p_heading (course - heading) - d_heading r
//   depth, outer loop, PI:   pitch_d = clip(p_depth (z - z_d) + climb + integral)
//   pitch, inner loop, PD:   stern   = -p_pitch (pitch_d - pitch) + d_pitch q
//   speed, PI:               rpm     = feed_forward u_d + p_speed (u_d - u) + integral
//
// Signs as in vehicle_command_t: a positive rudder turns to starboard, positive stern planes push the nose
// down. Anti-windup: an integral is held while its output is at a limit. The default gains suit `torpedo` and
// `remus100-pvs` at 0.8 to 2.5 m/s: heading and pitch settle within about 5 s; the depth loop has a bandwidth
// of 0.1 rad/s at 2 m/s. Left out: the loss of fin effectiveness at low speed (gains are not scheduled), roll
// (the hull rights itself).
#pragma once

#include "clients/onboard/autopilot/guidance.h"

namespace halocline::clients {

struct Gains {
  double heading_p = 1.0;           // rad of rudder per rad of heading
  double heading_d_s = 0.6;         // rad of rudder per rad/s of yaw rate
  double depth_p_rad_per_m = 0.05;  // rad/m, pitch per metre of depth error
  double depth_i_rad_per_m_s = 0;   // rad/(m s), pitch per integral of depth error, for a vehicle out of trim
  double pitch_p = 1.5;             // rad of stern plane per rad of pitch
  double pitch_d_s = 0.6;           // rad of stern plane per rad/s of pitch rate
  double speed_feed_forward_rpm_s_per_m = 597.3;  // 1000 rpm drive both models at 1.6741 m/s
  double speed_p_rpm_s_per_m = 300;               // rpm per m/s of speed error
  double speed_i_rpm_per_m = 30;                  // rpm per metre of the integral of the speed error
  double max_pitch_rad = 0.3490658503988659;      // limit of the set pitch: 20 degrees
  double max_fin_rad = 0.2617993877991494;        // limit of rudder and stern planes: 15 degrees
  double max_rpm = 1525;                          // limit of the propeller speed
};

// Measured state of the vehicle. Angles in radians, rates about the body axes in rad/s.
struct Measured {
  double z_ned_m = 0;
  double heading_rad = 0;
  double pitch_rad = 0;
  double pitch_rate_radps = 0;
  double yaw_rate_radps = 0;
  double speed_mps = 0;  // forward speed through the water
};

struct ActuatorCommand {
  double propeller_rpm = 0;    // rpm, 0 to max_rpm
  double rudder_rad = 0;       // within +-max_fin_rad
  double stern_plane_rad = 0;  // within +-max_fin_rad
  double buoyancy_m3 = 0;      // change of volume by a buoyancy engine (glide_laws.h)
  double moving_mass_m = 0;    // position of a moving mass, positive forward
};

// Integrator states of the PI loops.
struct Integrals {
  double pitch_rad = 0;  // depth loop, in units of its output, pitch
  double speed_rpm = 0;  // speed loop, in units of its output, propeller speed
};

// Returns proportional + integral, limited to [lowest, highest]. `integral` grows by the integrand unless
// that would drive the output further beyond a limit (anti-windup by conditional integration).
double limited_pi(double proportional, double integrand, double lowest, double highest, double& integral);

// Returns the rudder angle alone, rad.
double rudder(const Gains& gains, const SetPoints& points, const Measured& measured);

// Returns the command of one control step of `dt_s` seconds (0 or above) and updates `integrals`. All zeros
// when `points` does not propel.
ActuatorCommand command(const Gains& gains, const SetPoints& points, const Measured& measured, double dt_s,
                        Integrals& integrals);

}  // namespace halocline::clients
