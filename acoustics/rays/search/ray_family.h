// SPDX-License-Identifier: BSD-3-Clause
// A family of rays about one of them: those of the same bounces that end within reach of the receiver, and
// the integral of their density there over launch angles.
//
// Model: acoustics/rays/search/smoothed_folds.h. Rays are taken at steps over which the depth of arrival
// changes by about sigma_z, at which the trapezoidal rule is exact to 0.1 dB for a normal density.
//
// Immutable after construction: calls may overlap between threads.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/family_rays.h"

namespace halocline::acoustics {

// sigma_z beyond which a ray does not count, and between neighbouring rays of a family.
inline constexpr double kFamilyReach = 3.5, kFamilyStep = 1.2;
inline constexpr double kWidestFamilyStep = 0.02;  // rad

// The vertical place of the receiver and the spread of rays about their ends, m.
struct FamilySpread {
  double sigma_m, receiver_m, bottom_m;
};

class RayFamily {
 public:
  // Takes rays to both sides of `seed`, at first `step` rad apart.
  RayFamily(FamilyRays& rays, const FamilyRay& seed, const FamilySpread& spread, double step);

  // Too few rays to integrate over.
  bool is_empty() const { return rays_.size() < 3; }
  FamilyBounces bounces() const { return bounces_; }
  double from() const { return rays_.front().theta; }  // launch angles, rad
  double to() const { return rays_.back().theta; }
  // True when the path is one of the family.
  bool holds(const Eigenray& path) const;

  // Integral of sqrt(2 pi) times the density at the receiver over the launch angles, rad/m: of all rays, and
  // of those up to the fold between two paths, the ray between them that ends furthest from the receiver.
  double integral() const { return sums_.back(); }
  double integral_to_fold(const Eigenray& a, const Eigenray& b) const;

  // How far zeta is bent about the ray launched at `theta`, in units of 2 sigma_z: the greatest distance of
  // rays within reach from the straight line through the two beside it.
  double bend_at(double theta) const;
  // Share of the integral, 0..1, of rays that a spread of `sigma_m` takes out of the field of their fold:
  // about each ray zeta is taken as a fold, whose field gives way where its Airy length is less than sigma_m,
  // and is gone at half of it.
  double share_beyond_folds(double sigma_m, double frequency_hz, double receiver_mps) const;

 private:
  void add_side(FamilyRays& rays, const FamilyRay& seed, double sigma, double step);
  std::size_t fold_between(const Eigenray& a, const Eigenray& b) const;

  FamilyBounces bounces_;
  double sigma_m_;
  std::vector<FamilyRay> rays_;  // by rising launch angle
  std::vector<double> sums_;     // integral up to each ray
};

}  // namespace halocline::acoustics
