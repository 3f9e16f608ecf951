#include "vehicle_sim/dynamics/submergence.h"

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

}  // namespace

// Area of a segment of the unit circle over pi, its chord at -s from the centre: 1 - (acos s - s sqrt(1 - s^2)) / pi.
double submerged_share_of_circle(double depth_in_radii) {
  const double s = depth_in_radii;
  if (s >= 1) return 1;
  if (s <= -1) return 0;
  return 1 - (elementary::acos(s) - s * std::sqrt(1 - s * s)) / std::numbers::pi;
}

// Sections at xi in (-1, 1) along the axis have the radius D/2 sqrt(1 - xi^2) and the volume 1 - xi^2; their sum by the
// midpoint rule.
Submergence submergence(const ModelParameters& model, const VehicleState& state, double surface_z_m,
                        const Vec3& slope) {
  const HullShape& hull = model.hull;
  const double depth = depth_below_surface_m(state.position_ned_m, surface_z_m);
  if (is_wholly_submerged(hull, depth)) return {};
  const Vec3 bow = state.orientation * Vec3::UnitX();
  const double down_along_x = bow.z() - slope.dot(bow);  // under the surface, a metre along the hull
  double weight_sum = 0, wet_sum = 0, wet_moment = 0;
  for (int i = 0; i < kSections; ++i) {
    const double along = (2 * i + 1.0) / kSections - 1;  // -1 to 1 over the hull
    const double x = along * hull.length_m / 2;
    const double volume = 1 - along * along;  // of the section, in units that cancel
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

}  // namespace halocline::vehicle_sim
