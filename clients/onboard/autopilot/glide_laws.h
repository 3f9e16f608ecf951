// SPDX-License-Identifier: BSD-3-Clause
// Control law of a glider: from set points to buoyancy engine, moving mass and rudder.
//
// The glider moves on a sawtooth between a shallow depth and the depth of the set points: it dives, heavy and
// nose down, until it has passed that depth, then climbs, light and nose up, to the shallow one. The pitch
// has the same magnitude both ways. The depth may follow from a height above the seabed (seabed_ahead.h); the
// glider then turns upwards where the seabed comes near.
//
// Pitch is controlled by the position of the moving mass, a PI law with s = 1 in a dive and -1 in a climb:
//
//   mass      = p (pitch - pitch_d) + s integral
//   integral += i s (pitch - pitch_d) dt
//
// The trim of a climb is the mirror image of that of a dive, so one integral serves both. The rudder is that
// of control_laws.h. Speed follows from net buoyancy and pitch; a set speed is not used. Turns overshoot in
// depth by the time that the engine needs to change sign (`glider`: 20 s and some metres). Left out: rolling
// the mass for turns, currents.
#pragma once

#include "clients/onboard/autopilot/control_laws.h"
#include "clients/onboard/autopilot/guidance.h"
#include "core/archive.h"

namespace halocline::clients {

// The defaults suit `glider`.
struct GlideGains {
  double shallow_z_m = 5;                 // z at which a climb ends
  double pitch_rad = 0.4537856055185257;  // 26 degrees, down or up: just steeper than the flattest glide
  double volume_m3 = 2.5e-4;              // change of volume by the engine: less in dives, more in climbs
  double mass_p_m_per_rad = 0.03;
  double mass_i_m_per_rad_s = 0.002;
  double max_mass_m = 0.05;  // limit of the mass's position, forward and aft
};

struct GlideState {
  bool is_climbing = false;
  double trim_m = 0;  // integral of the pitch law: position of the mass in a dive

  void archive(Archive& a) { a(is_climbing, trim_m); }
};

// Returns the command of one control step of `dt_s` seconds (0 or above) and updates `state`. Without
// propulsion (SetPoints::propel false) the glider is neutral; to surface it climbs straight ahead.
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
