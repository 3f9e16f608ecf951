// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/multipath.h"

#include <algorithm>

#include "acoustics/link/transmission_loss.h"
#include "core/check.h"

namespace halocline::acoustics {

std::vector<double> bottom_point_fractions(int count) {
  require(count >= 1, "at least one bottom point is needed");
  std::vector<double> fractions;
  for (int i = 0; i < count; ++i) fractions.push_back((i + 0.5) / count);
  return fractions;
}

EchoPath echo_path(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                   const BottomPoint& point) {
  const double surface = model.environment().sea_surface_z_m;
  const double from = depth_below_surface_m(from_ned_m, surface),
               to = depth_below_surface_m(to_ned_m, surface);
  const double bottom = depth_below_surface_m(point.position_ned_m, surface);
  const double down = (point.position_ned_m - from_ned_m).norm(),
               up = (to_ned_m - point.position_ned_m).norm();

  // One bounce without loss: TL over the length of both legs, alpha their mean weighted by length.
  EchoPath path;
  path.length_m = down + up;
  path.delay_s =
      model.delay_s(from_ned_m, point.position_ned_m) + model.delay_s(point.position_ned_m, to_ned_m);
  if (path.length_m > 0) {
    const double mean_absorption = (model.path_loss(from, bottom, down).absorption_db_per_km * down +
                                    model.path_loss(bottom, to, up).absorption_db_per_km * up) /
                                   path.length_m;
    path.level =
        model.transmitter().source_level -
        transmission_loss(path.length_m, model.environment().spreading_exponent, mean_absorption).total;
  } else {
    path.level = model.transmitter().source_level;
  }
  // The two beams point to the reflection point on the bottom.
  path.level = path.level - model.transmitter().beam.loss(angle_down_rad(from_ned_m, point.position_ned_m)) -
               model.receiver().beam.loss(angle_down_rad(to_ned_m, point.position_ned_m));
  path.blocked = point.blocked_from_transmitter || point.blocked_to_receiver;
  path.receivable = !path.blocked && path.level > model.receiver().min_receivable_level;
  return path;
}

EchoAssessment assess_echoes(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                             const std::vector<BottomPoint>& points) {
  EchoAssessment assessment;
  for (const BottomPoint& point : points) {
    assessment.paths.push_back(echo_path(model, from_ned_m, to_ned_m, point));
  }
  const bool any = std::any_of(assessment.paths.begin(), assessment.paths.end(),
                               [](const EchoPath& path) { return path.receivable; });
  assessment.likelihood = any ? EchoLikelihood::kLikely : EchoLikelihood::kUnlikely;
  return assessment;
}

}  // namespace halocline::acoustics
