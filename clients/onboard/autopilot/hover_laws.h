// SPDX-License-Identifier: BSD-3-Clause
// Control law of `hover`: from a point to hold to the speeds of four thrusters.
//
// Model: a vehicle that has thrust ahead, astern, up and down, but not sideways, holds a point by turning.
// The force wanted in the world's horizontal plane is a PID law of the position with a feed-forward of the
// drag at the set speed V:
//
//   F     = P e + C V^2 e / e_max - D v + integral
//   e_max = V D / P
//
// The position error e is limited to e_max, so that the vehicle approaches at the speed V. It heads where F
// points and applies the component of F along the bow (weathervaning, after Fossen 2021, Handbook, 2nd ed.,
// section 13.3). In a current the integral grows to balance the drag, so the bow turns into the current and
// the vehicle stands still. Below a minimum force the heading is kept.
//
// Depth: PID of z. On the way the hull pitches along its path, for a slender hull at an angle to the flow is
// turned further away from it (Munk moment). Pitch and heading: PD, stiff enough to withstand that moment up
// to 1.9 m/s with `hover`. Thrust is proportional to the square of the thruster speed. The thrusters have the
// order of vehicle_sim/dynamics/hover.h. Left out: holding a point in currents whose direction changes faster
// than the vehicle can turn. Pure functions.
#pragma once

#include <array>

#include "core/frames.h"

namespace halocline::clients {

// The defaults suit `hover`.
struct HoverGains {
  double position_p_n_per_m = 15;     // N per metre of distance
  double position_i_n_per_m_s = 0.4;  // N per metre and second
  double position_d_n_s_per_m = 60;   // N per m/s over ground
  double cruise_n_s2_per_m2 = 29;  // N per (m/s)^2 of the set speed: drag, and the loss of thrust with speed
  double heading_p_nm = 60;        // N m per rad
  double heading_d_nm_s = 50;      // N m per rad/s
  double depth_p_n_per_m = 30;     // N per metre
  double depth_i_n_per_m_s = 1;    // N per metre and second
  double depth_d_n_s_per_m = 100;  // N per m/s
  double pitch_p_nm = 150;         // N m per rad
  double pitch_d_nm_s = 60;        // N m per rad/s
  double max_pitch_rad = 0.3490658503988659;  // limit on the way: 20 degrees
  double min_force_n = 1;                     // force below which the heading is kept
  double beside_axis_m = 0.25;                // distance of the horizontal thrusters from the axis
  double from_middle_m = 0.45;                // distance of the vertical thrusters from the middle
  double full_thrust_n = 51.5;                // thrust ahead of one thruster at full_rpm
  double astern_ratio = 0.78;                 // full thrust astern / full thrust ahead
  double full_rpm = 3600;
};

// Point to hold, in world NED metres.
struct StationPoint {
  Vec3 position_ned_m = Vec3::Zero();
  double speed_mps = 1;  // speed of the approach, above 0
};

struct HoverMeasured {
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();  // over ground
  double heading_rad = 0, pitch_rad = 0;
  double pitch_rate_radps = 0, yaw_rate_radps = 0;
};

struct HoverIntegrals {
  double north_n = 0, east_n = 0, down_n = 0;
  double heading_rad = 0;  // latest set heading
  bool has_heading = false;
};

// Returns the thruster speeds in revolutions per minute, within +-full_rpm, in the order port, starboard,
// bow, stern. One control step of `dt_s` seconds, which updates `integrals`.
std::array<double, 4> hover_command(const HoverGains& gains, const StationPoint& point,
                                    const HoverMeasured& measured, double dt_s, HoverIntegrals& integrals);

}  // namespace halocline::clients
