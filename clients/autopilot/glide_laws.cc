#include "clients/autopilot/glide_laws.h"

namespace halocline::clients {

ActuatorCommand glide_command(const GlideGains& glide, const Gains& gains, const SetPoints& points,
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
