// SPDX-License-Identifier: BSD-3-Clause
// From a point to hold to the speeds of four thrusters: how `hover` goes somewhere and stays there.
//
// Model: a vehicle that pushes ahead, astern and up and down but not sideways holds a point by turning. The
// force it wants in the world frame is a PID law of its position, F = P e + C V^2 e / e_max - D v + integral,
// with e cut to e_max = V D / P so that it approaches at the set speed V, the second term being the drag at
// that speed; it heads where F points and pushes its part along the bow (weather-vaning, after Fossen 2021,
// Handbook, 2nd ed., section 13.3). In a current the integral becomes the drag, so the bow comes to face the
// current and the vehicle stands still. Below a least force the heading is kept. Depth: PID of z. On the way
// the hull pitches along its path, for a flow across a slender hull turns it further (Munk moment); pitch and
// heading: PD, stiff enough to hold it against that up to 1.9 m/s with `hover`. Thrust goes with the square
// of speed; thrusters in the order of vehicle_sim/dynamics/hover.h. Left out: a station closer than the
// vehicle can turn in gusts that veer by more than it can follow. Pure functions.
#pragma once

#include <array>

#include "core/frames.h"

namespace halocline::clients {

// The defaults suit `hover`.
struct HoverGains {
  double position_p_n_per_m = 15;     // N per metre of distance
  double position_i_n_per_m_s = 0.4;  // and per metre and second
  double position_d_n_s_per_m = 60;   // N per m/s over ground
  double cruise_n_s2_per_m2 = 29;  // N per (m/s)^2 of the set speed: drag, and what thrust loses with speed
  double heading_p_nm = 60;        // N m per rad
  double heading_d_nm_s = 50;      // N m per rad/s
  double depth_p_n_per_m = 30;     // N per metre
  double depth_i_n_per_m_s = 1;    // and per metre and second
  double depth_d_n_s_per_m = 100;  // N per m/s
  double pitch_p_nm = 150;         // N m per rad
  double pitch_d_nm_s = 60;        // N m per rad/s
  double max_pitch_rad = 0.3490658503988659;  // on the way: 20 degrees
  double min_force_n = 1;                     // below which the heading is kept
  double beside_axis_m = 0.25;                // of the horizontal thrusters
  double from_middle_m = 0.45;                // of the vertical thrusters
  double full_thrust_n = 51.5;                // of a thruster at full_rpm, ahead
  double astern_ratio = 0.78;                 // of its thrust astern
  double full_rpm = 3600;
};

// Where to, world NED metres.
struct StationPoint {
  Vec3 position_ned_m = Vec3::Zero();
  double speed_mps = 1;  // of the approach, above 0
};

struct HoverMeasured {
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();  // over ground
  double heading_rad = 0, pitch_rad = 0;
  double pitch_rate_radps = 0, yaw_rate_radps = 0;
};

struct HoverIntegrals {
  double north_n = 0, east_n = 0, down_n = 0;
  double heading_rad = 0;  // last wanted
  bool has_heading = false;
};

// Revolutions a minute: port, starboard, bow, stern; within +-full_rpm. One step of `dt_s`; moves `integrals`
// on.
std::array<double, 4> hover_command(const HoverGains& gains, const StationPoint& point,
                                    const HoverMeasured& measured, double dt_s, HoverIntegrals& integrals);

}  // namespace halocline::clients
