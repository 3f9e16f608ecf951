// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/submergence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline::vehicle_sim {
namespace {

constexpr int kSections = 16;

double share_of_disc(double depth_m, double radius_m) {
  if (radius_m <= 0) return depth_m > 0 ? 1 : 0;
  return submerged_share_of_circle(depth_m / radius_m);
}

constexpr int kColumns = 8;
// Points on the unit circle: cos and sin of multiples of 45 degrees.
constexpr double kHalf = std::numbers::sqrt2 / 2;
constexpr double kCircle[kColumns][2] = {{1, 0},  {kHalf, kHalf},   {0, 1},  {-kHalf, kHalf},
                                         {-1, 0}, {-kHalf, -kHalf}, {0, -1}, {kHalf, -kHalf}};
constexpr double kRamp = 0.02;  // fraction of the height: a bottom that is this deep is wet
// Cosine of the tilt, about 87 degrees, beyond which the hull lies on its side.
constexpr double kMinUpright = 0.05;

// Returns the wet length of a column from its bottom up, 0 to its height. The depth below the surface of a
// point r of the body frame is
//
//   f(r) = (down - slope) . r - surface_below_co
//
// and decreases along the column, r = bottom - s z, by (down - slope).z per metre.
double wet_length(double bottom_below_m, double upright, double height_m) {
  if (upright > kMinUpright) return std::clamp(bottom_below_m / upright, 0.0, height_m);
  if (upright < -kMinUpright)  // keel up: the wet part is at the deck
    return height_m - std::clamp(bottom_below_m / upright, 0.0, height_m);
  return bottom_below_m > 0 ? height_m : 0;
}

}  // namespace

// Area of a segment of the unit circle, over pi, with s the distance of the chord above the centre:
//
//   A / pi = 1 - (acos(s) - s sqrt(1 - s^2)) / pi
double submerged_share_of_circle(double depth_in_radii) {
  const double s = depth_in_radii;
  if (s >= 1) return 1;
  if (s <= -1) return 0;
  return 1 - (elementary::acos(s) - s * std::sqrt(1 - s * s)) / std::numbers::pi;
}

// Sums over sections of the spheroid by the midpoint rule. The section at xi in (-1, 1) along the axis has
// the radius D/2 sqrt(1 - xi^2), and a volume proportional to 1 - xi^2.
Submergence submergence(const ModelParameters& model, const VehicleState& state, double surface_z_m,
                        const Vec3& slope) {
  const HullShape& hull = model.hull;
  const double depth = depth_below_surface_m(state.position_ned_m, surface_z_m);
  if (is_wholly_submerged(hull, depth)) return {};
  const Vec3 bow = state.orientation * Vec3::UnitX();
  const double down_along_x = bow.z() - slope.dot(bow);  // submersion per metre along the hull
  double weight_sum = 0, wet_sum = 0, wet_moment = 0;
  for (int i = 0; i < kSections; ++i) {
    const double along = (2 * i + 1.0) / kSections - 1;  // -1 to 1 over the hull
    const double x = along * hull.length_m / 2;
    const double volume = 1 - along * along;  // volume of the section; its unit cancels
    const double radius = hull.diameter_m / 2 * std::sqrt(volume);
    const double wet = volume * share_of_disc(depth + x * down_along_x, radius);
    weight_sum += volume;
    wet_sum += wet;
    wet_moment += wet * x;
  }
  const double stern_depth = depth + model.stern_planes.x_m * down_along_x;
  return {wet_sum / weight_sum, share_of_disc(stern_depth, model.propeller.diameter_m / 2),
          wet_sum > 0 ? wet_moment / wet_sum : 0};
}

// Volume and moment of the wet part, as sums over columns of cross-section a_i and wet length l_i:
//
//   V     = sum a_i l_i,  a_i = pi L B / 4 / 8
//   V c   = sum a_i l_i (bottom_i - l_i / 2 z)
//
// The columns lie at 1/sqrt(2) of the half axes, where they have the second moments of the ellipse, A L^2 /
// 16 and A B^2 / 16.
WetFloats wet_floats(const std::vector<Float>& floats, double surface_below_co_m, const Axes& down,
                     const Axes& slope) {
  const Axes below = down - slope;
  WetFloats wet;
  double total_area = 0, wet_area = 0;
  for (const Float& f : floats) {
    const double area = std::numbers::pi / 4 * f.length_m * f.beam_m / kColumns;
    for (const auto& [x, y] : kCircle) {
      const Axes bottom = Axes(f.bottom_m) + Axes(kHalf * x * f.length_m / 2, kHalf * y * f.beam_m / 2, 0);
      const double bottom_below = dot(below, bottom) - surface_below_co_m;
      const double length = wet_length(bottom_below, below.z, f.height_m);
      const double middle = below.z < 0 ? f.height_m - length / 2 : length / 2;
      wet.volume_m3 += area * length;
      wet.moment_m4 = wet.moment_m4 + area * length * (bottom - Axes(0, 0, middle));
      total_area += area;
      wet_area += area * std::min(length / (kRamp * f.height_m), 1.0);
    }
  }
  wet.bottom_share = total_area > 0 ? wet_area / total_area : 0;
  return wet;
}

}  // namespace halocline::vehicle_sim
