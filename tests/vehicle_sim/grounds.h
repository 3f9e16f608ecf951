// Grounds given by formulas, for contact tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "vehicle_sim/seabed.h"

namespace halocline::vehicle_sim::testing {

// z (positive down) as a function of north and east; the tangent plane by central differences.
class FormulaGround : public Seabed {
 public:
  using Formula = std::function<double(double, double)>;
  explicit FormulaGround(Formula z) : z_(std::move(z)) {}

  std::optional<SeabedPlane> plane_at(double north, double east) const override {
    constexpr double kReach = 1e-6;
    const double dz_north = (z_(north + kReach, east) - z_(north - kReach, east)) / (2 * kReach);
    const double dz_east = (z_(north, east + kReach) - z_(north, east - kReach)) / (2 * kReach);
    return SeabedPlane{z_(north, east), Vec3(dz_north, dz_east, -1).normalized()};
  }
  double z(double north, double east) const { return z_(north, east); }

 private:
  Formula z_;
};

using GroundPointer = std::shared_ptr<const FormulaGround>;

inline GroundPointer flat(double z) {
  return std::make_shared<FormulaGround>([z](double, double) { return z; });
}

// Flat at `z` south of `foot`, rising by `angle` to the north of it.
inline GroundPointer ramp(double z, double foot_north, double angle_rad) {
  const double slope = std::tan(angle_rad);
  return std::make_shared<FormulaGround>(
      [=](double north, double) { return z - slope * std::max(0.0, north - foot_north); });
}

// An endless slope that rises to the north, at `z` at the origin.
inline GroundPointer slope(double z, double angle_rad) {
  const double rise = std::tan(angle_rad);
  return std::make_shared<FormulaGround>([=](double north, double) { return z - rise * north; });
}

// A sharp edge that runs east at north = 0, its crest at `crest_z`, both sides falling at `angle`.
inline GroundPointer ridge(double crest_z, double angle_rad) {
  const double fall = std::tan(angle_rad);
  return std::make_shared<FormulaGround>(
      [=](double north, double) { return crest_z + fall * std::abs(north); });
}

}  // namespace halocline::vehicle_sim::testing
