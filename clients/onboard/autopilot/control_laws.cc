// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/control_laws.h"

#include <algorithm>

namespace halocline::clients {

double limited_pi(double proportional, double integrand, double lowest, double highest, double& integral) {
  const double free = proportional + integral + integrand;
  const bool winds_up = (free > highest && integrand > 0) || (free < lowest && integrand < 0);
  if (!winds_up) integral += integrand;
  return std::clamp(proportional + integral, lowest, highest);
}

// PD law of the heading: rudder = clip(p (course - heading) - d r).
double rudder(const Gains& g, const SetPoints& points, const Measured& m) {
  const double error = wrapped(points.course_rad - m.heading_rad);
  return std::clamp(g.heading_p * error - g.heading_d_s * m.yaw_rate_radps, -g.max_fin_rad, g.max_fin_rad);
}

namespace {

// Cascade of a PI law of the depth and a PD law of the pitch; z is positive down, pitch positive up:
//
//   pitch_d = clip(p_z (z - z_d) + climb + integral of i_z (z - z_d))
//   stern   = clip(-p (pitch_d - pitch) + d q)
double stern_plane(const Gains& g, const SetPoints& points, const Measured& m, double dt_s,
                   Integrals& integrals) {
  const double too_deep_m = m.z_ned_m - points.z_ned_m;
  const double pitch_d = limited_pi(g.depth_p_rad_per_m * too_deep_m + points.climb_rad,
                                    g.depth_i_rad_per_m_s * too_deep_m * dt_s, -g.max_pitch_rad,
                                    g.max_pitch_rad, integrals.pitch_rad);
  return std::clamp(-g.pitch_p * (pitch_d - m.pitch_rad) + g.pitch_d_s * m.pitch_rate_radps, -g.max_fin_rad,
                    g.max_fin_rad);
}

// PI law of the speed with feed-forward: rpm = clip(f u_d + p (u_d - u) + integral of i (u_d - u)).
double propeller_rpm(const Gains& g, const SetPoints& points, const Measured& m, double dt_s,
                     Integrals& integrals) {
  const double too_slow_mps = points.speed_mps - m.speed_mps;
  return limited_pi(
      g.speed_feed_forward_rpm_s_per_m * points.speed_mps + g.speed_p_rpm_s_per_m * too_slow_mps,
      g.speed_i_rpm_per_m * too_slow_mps * dt_s, 0, g.max_rpm, integrals.speed_rpm);
}

}  // namespace

ActuatorCommand command(const Gains& gains, const SetPoints& points, const Measured& measured, double dt_s,
                        Integrals& integrals) {
  if (!points.propel) return {};
  return {.propeller_rpm = propeller_rpm(gains, points, measured, dt_s, integrals),
          .rudder_rad = rudder(gains, points, measured),
          .stern_plane_rad = stern_plane(gains, points, measured, dt_s, integrals)};
}

}  // namespace halocline::clients
