// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/seabed_profile.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::channel_server {
namespace {

// Lowers the two points beside `range_m` until the bottom there is `depth_m` deep. With the weights w0, w1 of
// linear interpolation and the missing depth d, each point i moves down by
//
//   d w_i / (w0^2 + w1^2)
//
// which is continuous in the range.
void lower_to(std::vector<acoustics::ProfiledDepth>& points, double range_m, double depth_m) {
  const auto after =
      std::find_if(points.begin() + 1, points.end() - 1, [&](const auto& p) { return p.range_m > range_m; });
  acoustics::ProfiledDepth &p0 = *std::prev(after), &p1 = *after;
  const double w1 = std::clamp((range_m - p0.range_m) / (p1.range_m - p0.range_m), 0.0, 1.0), w0 = 1 - w1;
  const double missing = depth_m - (w0 * p0.depth_m + w1 * p1.depth_m);
  if (missing <= 0) return;
  p0.depth_m += missing * w0 / (w0 * w0 + w1 * w1);
  p1.depth_m += missing * w1 / (w0 * w0 + w1 * w1);
}

}  // namespace

std::array<double, kSplineReach> spline_weights(double u) {
  const double rest = 1 - u, b0 = rest * rest * rest / 6, b3 = u * u * u / 6,
               b1 = (4 + u * u * (3 * u - 6)) / 6, b2 = 1 - b0 - b1 - b3;
  return {-b0 / 6, (8 * b0 - b1) / 6, (8 * b1 - b0 - b2) / 6, (8 * b2 - b1 - b3) / 6, (8 * b3 - b2) / 6,
          -b3 / 6};
}

double mean_of_known(const std::array<double, 4>& z_m, const std::array<double, 4>& weights) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::isnan(z_m[i])) continue;
    sum += weights[i] * z_m[i];
    weight += weights[i];
  }
  return weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

acoustics::BottomProfile bottom_under(const SeabedProfile& seabed, const acoustics::RayLink& link,
                                      double sea_surface_z_m) {
  std::vector<acoustics::ProfiledDepth> points;
  for (std::size_t i = 0; i < seabed.z_m.size(); ++i) {
    const double depth = std::clamp(seabed.z_m[i] - sea_surface_z_m, kMinWaterM, acoustics::kDeepestWater);
    points.push_back({seabed.first_m + static_cast<double>(i) * seabed.spacing_m, depth});
  }
  lower_to(points, 0, link.source_depth_m + kMinWaterM);
  lower_to(points, link.range_m, link.receiver_depth_m + kMinWaterM);
  return acoustics::BottomProfile(std::move(points));
}

bool cuts_straight_line(const acoustics::BottomProfile& bottom, const acoustics::RayLink& link) {
  return std::any_of(bottom.points().begin(), bottom.points().end(), [&](const auto& point) {
    if (point.range_m < 0 || point.range_m > link.range_m) return false;
    const double share = link.range_m > 0 ? point.range_m / link.range_m : 0;
    return link.source_depth_m + share * (link.receiver_depth_m - link.source_depth_m) >= point.depth_m;
  });
}

}  // namespace halocline::channel_server
