// SPDX-License-Identifier: BSD-3-Clause
// From set points to a glider's buoyancy engine, moving mass and rudder.
//
// A sawtooth between a shallow depth and that of the set points: heavy and nose down until that depth is
// passed, then light and nose up until the shallow one is, at the same pitch either way. The depth may be one
// that keeps a height above the ground (seabed_ahead.h): it turns where the ground comes near. Pitch: PI by
// the place of the mass,
//   mass = p (pitch - pitch_d) + s integral,  integral += i s (pitch - pitch_d) dt,  s = 1 on the way down,
//                                             -1 up:
// the trim of a dive, mirrored, is that of the climb, so it is learnt once. Rudder: that of control_laws.h.
// Speed follows from net buoyancy and pitch; a set speed is not used. Turns overshoot by what the engine
// needs to change sign (`glider`: 20 s and some metres). Left out: rolling the mass for turns, currents.
#pragma once

#include "clients/autopilot/control_laws.h"
#include "clients/autopilot/guidance.h"
#include "core/archive.h"

namespace halocline::clients {

// The defaults suit `glider`.
struct GlideGains {
  double shallow_z_m = 5;                 // where it turns down again, z
  double pitch_rad = 0.4537856055185257;  // either way, 26 degrees: just steeper than the flattest glide
  double volume_m3 = 2.5e-4;              // of the engine, either way
  double mass_p_m_per_rad = 0.03;
  double mass_i_m_per_rad_s = 0.002;
  double max_mass_m = 0.05;  // of its place, either way
};

struct GlideState {
  bool is_climbing = false;
  double trim_m = 0;  // of the mass, on the way down

  void archive(Archive& a) { a(is_climbing, trim_m); }
};

// One step of `dt_s` (0 or above) seconds; moves `state` on. Stopped (SetPoints::propel false) it is neutral;
// to surface it climbs straight ahead.
inline ActuatorCommand glide_command(const GlideGains& glide, const Gains& gains, const SetPoints& points,
                                     const Measured& m, double dt_s, GlideState& state) {
  if (!points.propel && !points.surface) return {};
  if (points.surface || m.z_ned_m >= points.z_ned_m) {
    state.is_climbing = true;
  } else if (m.z_ned_m <= glide.shallow_z_m) {
    state.is_climbing = false;
  }
  const double sense = state.is_climbing ? -1 : 1;
  const double too_high_rad = m.pitch_rad + sense * glide.pitch_rad;
  const double mass = limited_pi(glide.mass_p_m_per_rad * sense * too_high_rad,
                                 glide.mass_i_m_per_rad_s * sense * too_high_rad * dt_s, -glide.max_mass_m,
                                 glide.max_mass_m, state.trim_m);
  return {.rudder_rad = points.surface ? 0 : rudder(gains, points, m),
          .buoyancy_m3 = -sense * glide.volume_m3,
          .moving_mass_m = sense * mass};
}

}  // namespace halocline::clients
