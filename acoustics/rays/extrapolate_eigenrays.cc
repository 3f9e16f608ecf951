// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/extrapolate_eigenrays.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

// Displacement of the ends, m: the growth of the range, and of the depth of each end.
struct Displacement {
  double apart, source_down, receiver_down;
};

// Angle of a straight ray of `angle_rad` and `length_m` after its end has moved: the direction to the moved
// end.
double turned(double angle_rad, double length_m, double apart_m, double down_m) {
  return elementary::atan2(length_m * elementary::sin(angle_rad) + down_m,
                           length_m * elementary::cos(angle_rad) + apart_m);
}

// The path with another length, when the old or the new length lies within the metre in which sound does not
// spread.
Eigenray grown_near_source(Eigenray path, double length_m) {
  const double before_m = path.path_length_m;
  path.amplitude *= std::max(before_m, kMinDistance) / std::max(length_m, kMinDistance);
  path.absorption_db = before_m > 0 ? path.absorption_db * length_m / before_m : 0;
  path.path_length_m = length_m;
  return path;
}

Eigenray extrapolated(Eigenray path, const EndSpeeds& speeds, const Displacement& moved) {
  // Fermat's principle:
  //   d tau = <cos / c> dr + sin(arrival) / c_r dz_r - sin(launch) / c_s dz_s
  const double delay_s = path.delay_s, length_m = path.path_length_m;
  const double speed_mps = length_m > 0 ? length_m / delay_s : speeds.source_mps;
  const double gradient_s =
      path.range_slowness_spm * moved.apart +
      elementary::sin(path.arrival_angle_rad) / speeds.receiver_mps * moved.receiver_down -
      elementary::sin(path.launch_angle_rad) / speeds.source_mps * moved.source_down;
  // Unfolded as seen from the source, the receiver's downward direction is reversed by an odd number of
  // bounces.
  const bool flipped = (path.surface_bounces + path.bottom_bounces) % 2 != 0;
  const double turn = flipped ? -1 : 1, down = turn * moved.receiver_down - moved.source_down;
  // A spherical wavefront of radius L about the source, with c = L / tau and the displacement d:
  //   tau'^2 = (tau + d tau)^2 + (w / c)^2,  w^2 = |d|^2 - (c d tau)^2
  const double along = speed_mps * gradient_s;
  const double across_squared = std::max(moved.apart * moved.apart + down * down - along * along, 0.0);
  path.delay_s =
      std::sqrt((delay_s + gradient_s) * (delay_s + gradient_s) + across_squared / (speed_mps * speed_mps));
  path.launch_angle_rad = turned(path.launch_angle_rad, length_m, moved.apart, down);
  path.arrival_angle_rad = turned(path.arrival_angle_rad, length_m, moved.apart, turn * down);
  if (length_m < kMinDistance || speed_mps * path.delay_s < kMinDistance)
    return grown_near_source(path, speed_mps * path.delay_s);
  const double grown = path.delay_s / delay_s;
  path.path_length_m *= grown;
  path.absorption_db *= grown;
  path.amplitude /= grown;
  return path;
}

}  // namespace

std::vector<Eigenray> extrapolate_eigenrays(const std::vector<Eigenray>& found, const RayLink& from,
                                            const EndSpeeds& speeds, const RayLink& to) {
  const Displacement moved{to.range_m - from.range_m, to.source_depth_m - from.source_depth_m,
                           to.receiver_depth_m - from.receiver_depth_m};
  std::vector<Eigenray> paths;
  paths.reserve(found.size());
  for (const Eigenray& path : found) paths.push_back(extrapolated(path, speeds, moved));
  std::stable_sort(paths.begin(), paths.end(),
                   [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; });
  return paths;
}

}  // namespace halocline::acoustics
