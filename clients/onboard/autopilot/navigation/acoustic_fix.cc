// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/navigation/acoustic_fix.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"

namespace halocline::clients {

std::optional<PlaceFix> place_by_beacon(const AcousticFixRules& rules, const Vec3& beacon,
                                        const BeaconMeasurement& measured, const EulerAngles& attitude,
                                        double own_z_m) {
  constexpr double kMinLevelPart = 0.1;  // minimum horizontal part: about 6 degrees from the vertical
  const double level = elementary::cos(measured.elevation_rad);
  const Vec3 towards = to_quaternion(attitude) * Vec3(level * elementary::cos(measured.bearing_rad),
                                                      level * elementary::sin(measured.bearing_rad),
                                                      -elementary::sin(measured.elevation_rad));
  const double horizontal_part = towards.head<2>().norm();
  if (horizontal_part < kMinLevelPart) return std::nullopt;
  const double range = measured.travel_time_s * rules.sound_speed_mps, drop = beacon.z() - own_z_m;
  const double horizontal = std::sqrt(std::max(0.0, range * range - drop * drop));
  const Eigen::Vector2d place = beacon.head<2>() - horizontal * towards.head<2>() / horizontal_part;
  const double across =
      horizontal * elementary::hypot(measured.angle_deviation_rad, rules.heading_deviation_rad);
  const double deviation = elementary::hypot(across, rules.range_deviation * range);
  return PlaceFix{place.x(), place.y(), std::max(deviation, rules.min_deviation_m)};
}

}  // namespace halocline::clients
