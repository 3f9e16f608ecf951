// SPDX-License-Identifier: BSD-3-Clause
// Seabeds given by formulas, hulls put down somewhere, and how deep they lie in a seabed: for contact tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "core/frames.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim::testing {

// z (positive down) as a function of north and east; the tangent plane by central differences.
class FormulaSeabed : public Seabed {
 public:
  using Formula = std::function<double(double, double)>;
  explicit FormulaSeabed(Formula z) : z_(std::move(z)) {}

  std::optional<SeabedPlane> plane_at(double north, double east) const override {
    constexpr double kReach = 1e-6;
    const double dz_north = (z_(north + kReach, east) - z_(north - kReach, east)) / (2 * kReach);
    const double dz_east = (z_(north, east + kReach) - z_(north, east - kReach)) / (2 * kReach);
    return SeabedPlane{z_(north, east), Vec3(dz_north, dz_east, -1).normalized()};
  }
  double operator()(double north, double east) const { return z_(north, east); }

 private:
  Formula z_;
};

using SeabedPointer = std::shared_ptr<const FormulaSeabed>;

inline SeabedPointer flat(double z) {
  return std::make_shared<FormulaSeabed>([z](double, double) { return z; });
}

// Flat at `z` south of `foot`, rising by `angle` to the north of it.
inline SeabedPointer ramp(double z, double foot_north, double angle_rad) {
  const double slope = std::tan(angle_rad);
  return std::make_shared<FormulaSeabed>(
      [=](double north, double) { return z - slope * std::max(0.0, north - foot_north); });
}

// An endless slope that rises to the north, at `z` at the origin.
inline SeabedPointer slope(double z, double angle_rad) {
  const double rise = std::tan(angle_rad);
  return std::make_shared<FormulaSeabed>([=](double north, double) { return z - rise * north; });
}

// A sharp edge that runs east at north = 0, its crest at `crest_z`, both sides falling at `angle`.
inline SeabedPointer ridge(double crest_z, double angle_rad) {
  const double fall = std::tan(angle_rad);
  return std::make_shared<FormulaSeabed>(
      [=](double north, double) { return crest_z + fall * std::abs(north); });
}

// At rest in its own frame but for its speed ahead.
inline VehicleState at(const Vec3& position, const EulerAngles& attitude = {}, double speed = 0) {
  VehicleState s;
  s.position_ned_m = position;
  s.orientation = to_quaternion(attitude);
  s.velocity_body[0] = speed;
  return s;
}

// How deep the hull, a spheroid, lies in the seabed: over points of its whole surface, measured vertically,
// so never less than the true depth. `seabed_z`(north, east) is the seabed's z, positive down.
template <class SeabedDepth>
double deepest_in(const SeabedDepth& seabed_z, const VehicleState& s, const HullShape& hull) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 40; ++i) {
    const double along = i / 20.0 - 1,
                 radius = hull.diameter_m / 2 * std::sqrt(std::max(0.0, 1 - along * along));
    for (int k = 0; k < 12; ++k) {
      const double angle = 2 * std::numbers::pi * k / 12;
      const Vec3 point =
          s.position_ned_m +
          s.orientation * Vec3(along * hull.length_m / 2, radius * std::cos(angle), radius * std::sin(angle));
      deepest = std::max(deepest, point.z() - seabed_z(point.x(), point.y()));
    }
  }
  return deepest;
}

}  // namespace halocline::vehicle_sim::testing
