// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/hover_laws.h"

#include <algorithm>
#include <cmath>

#include "clients/onboard/autopilot/guidance.h"
#include "core/elementary.h"

namespace halocline::clients {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kSlowMps = 0.3;  // forward speed below which the set pitch goes to 0

// Thrust is proportional to the square of the speed: n = n_full sqrt(T / T_full), with the sign of T.
double rpm_for(const HoverGains& g, double thrust_n) {
  const double full = thrust_n < 0 ? g.astern_ratio * g.full_thrust_n : g.full_thrust_n;
  const double rpm = g.full_rpm * std::sqrt(std::min(std::abs(thrust_n) / full, 1.0));
  return std::copysign(rpm, thrust_n);
}

// Returns the wanted horizontal force, north and east, N:
//
//   F = P e - D v + C V^2 e / e_max + integral,  |e| <= e_max = V D / P
//
// The integral changes only within 2 e_max of the point and is limited to the full thrust of a thruster.
Vec2 horizontal_force(const HoverGains& g, const StationPoint& point, const HoverMeasured& m, double dt_s,
                      HoverIntegrals& integrals) {
  const Vec2 away = (point.position_ned_m - m.position_ned_m).head<2>();
  const double farthest = point.speed_mps * g.position_d_n_s_per_m / g.position_p_n_per_m;
  const double distance = away.norm();
  const Vec2 error = distance > farthest ? Vec2(away * (farthest / distance)) : away;
  Vec2 integral(integrals.north_n, integrals.east_n);
  if (distance < 2 * farthest) integral += g.position_i_n_per_m_s * dt_s * error;
  if (integral.norm() > g.full_thrust_n) integral *= g.full_thrust_n / integral.norm();
  integrals.north_n = integral.x();
  integrals.east_n = integral.y();
  const Vec2 cruise = g.cruise_n_s2_per_m2 * point.speed_mps * point.speed_mps * (error / farthest);
  return g.position_p_n_per_m * error - g.position_d_n_s_per_m * m.velocity_ned_mps.head<2>() + cruise +
         integral;
}

// Returns the wanted force along z, N, a PID law of the depth error e, which is limited so that the vertical
// speed stays below half the set speed V:
//
//   F = P e - D v_z + integral,  |e| <= e_max = 0.5 V D / P
//
// The integral changes only within e_max of the depth and is limited to the full thrust of a thruster.
double down_force(const HoverGains& g, const StationPoint& point, const HoverMeasured& m, double dt_s,
                  HoverIntegrals& integrals) {
  const double farthest = 0.5 * point.speed_mps * g.depth_d_n_s_per_m / g.depth_p_n_per_m;
  const double too_high_m = point.position_ned_m.z() - m.position_ned_m.z();
  const double error = std::clamp(too_high_m, -farthest, farthest);
  const double grown = std::abs(too_high_m) < farthest ? integrals.down_n + g.depth_i_n_per_m_s * dt_s * error
                                                       : integrals.down_n;
  integrals.down_n = std::clamp(grown, -g.full_thrust_n, g.full_thrust_n);
  return g.depth_p_n_per_m * error - g.depth_d_n_s_per_m * m.velocity_ned_mps.z() + integrals.down_n;
}

// Returns the set pitch: along the path while under way, nose up in a climb, so that the flow does not turn
// the hull away from it; level at rest.
double wanted_pitch(const HoverGains& g, const StationPoint& point, const HoverMeasured& m) {
  const double forward_mps = m.velocity_ned_mps.x() * elementary::cos(m.heading_rad) +
                             m.velocity_ned_mps.y() * elementary::sin(m.heading_rad);
  if (forward_mps <= 0) return 0;
  const double too_high_m = point.position_ned_m.z() - m.position_ned_m.z();
  const double descent_mps = g.depth_p_n_per_m / g.depth_d_n_s_per_m * too_high_m;
  const double steepest = elementary::tan(g.max_pitch_rad);
  const double slope = std::clamp(descent_mps / forward_mps, -steepest, steepest);
  return -elementary::atan(slope * std::min(forward_mps / kSlowMps, 1.0));
}

// Returns the direction of the wanted force, or the latest one while the force is below the minimum.
double wanted_heading(const HoverGains& g, const Vec2& force, double heading_rad, HoverIntegrals& integrals) {
  if (!integrals.has_heading) integrals.heading_rad = heading_rad;
  integrals.has_heading = true;
  if (force.norm() > g.min_force_n) integrals.heading_rad = elementary::atan2(force.y(), force.x());
  return integrals.heading_rad;
}

}  // namespace

std::array<double, 4> hover_command(const HoverGains& g, const StationPoint& point, const HoverMeasured& m,
                                    double dt_s, HoverIntegrals& integrals) {
  const Vec2 force = horizontal_force(g, point, m, dt_s, integrals);
  const double turn = wrapped(wanted_heading(g, force, m.heading_rad, integrals) - m.heading_rad);
  const double surge =
      force.x() * elementary::cos(m.heading_rad) + force.y() * elementary::sin(m.heading_rad);
  const double yaw = g.heading_p_nm * turn - g.heading_d_nm_s * m.yaw_rate_radps;
  const double heave = down_force(g, point, m, dt_s, integrals);
  const double pitch =
      g.pitch_p_nm * (wanted_pitch(g, point, m) - m.pitch_rad) - g.pitch_d_nm_s * m.pitch_rate_radps;
  // Turning takes priority: surge and heave get the thrust that yaw and pitch leave.
  const double most = g.full_thrust_n * g.astern_ratio;
  const double differ = std::clamp(yaw / (2 * g.beside_axis_m), -most, most);
  const double tilt =
      std::clamp(pitch / (2 * g.from_middle_m), -most, most);  // nose down by a downward push at the bow
  const double ahead =
      std::clamp(surge / 2, -(g.full_thrust_n - std::abs(differ)), g.full_thrust_n - std::abs(differ));
  const double down =
      std::clamp(heave / 2, -(g.full_thrust_n - std::abs(tilt)), g.full_thrust_n - std::abs(tilt));
  return {rpm_for(g, ahead + differ), rpm_for(g, ahead - differ), rpm_for(g, down - tilt),
          rpm_for(g, down + tilt)};
}

}  // namespace halocline::clients
