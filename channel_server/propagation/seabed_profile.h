// SPDX-License-Identifier: BSD-3-Clause
// How the seabed runs under one link, at even places along it, and the bottom that rays meet.
//
// Places along a link are horizontal distances from its first end, m; the link's other end lies at its range.
// The samples of seabed_map.h begin before the first end and go on beyond the other, so the facets of the
// bottom between the ends never depend on where the samples stop. Where an end of the link lies below the
// bottom, the samples beside it are lowered, in proportion to what they count there, until the bottom lies
// just below the end; nowhere else is it changed. Land counts as 0.1 m of water.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/bottom_profile.h"

namespace halocline::channel_server {

struct SeabedProfile {
  double first_m = 0;           // place of the first sample, -1e6..0
  double spacing_m = 1;         // between samples, above 0
  std::vector<double> z_m;      // of the seabed, two samples at least
  bool beyond_terrain = false;  // some depth between the ends is the last known one

  static SeabedProfile flat(double z_m) { return {-1e5, 1e6, {z_m, z_m}}; }
};

// Of slopes.
struct SlopeSums {
  double count = 0, sum = 0, squares = 0;

  double variance() const {
    const double mean = sum / std::max(count, 1.0);
    return std::max(squares / std::max(count, 1.0) - mean * mean, 0.0);
  }
};

// What links whose rays are not traced need of it.
struct SeabedPlaces {
  std::array<double, 16> z_m{};  // at even places between the ends
  double mean_square_slope = 0;  // along the link, beside the mean slope
  bool beyond_terrain = false;   // as SeabedProfile's
};

// Lattice points that weigh at a place between points 0 and 1: -2 to 3.
inline constexpr int kSplineReach = 6;
// Their weights at `u` of the way from point 0 to point 1, 0..1: cubic B-splines b of coefficients that are
// (8 f_i - f_(i-1) - f_(i+1)) / 6.
std::array<double, kSplineReach> spline_weights(double u);

// The mean of those of four weighed depths that are known: the weights of the others are shared out. NaN
// without any.
double mean_of_known(const std::array<double, 4>& z_m, const std::array<double, 4>& weights);

// The least water a bottom profile knows, m: what land counts as, and what is left under an end.
inline constexpr double kMinWaterM = 0.1;

// The bottom along a link whose ends are those of `seabed` in its order.
acoustics::BottomProfile bottom_under(const SeabedProfile& seabed, const acoustics::RayLink& link,
                                      double sea_surface_z_m);

// Whether the bottom reaches up to the straight line between the ends of the link.
bool cuts_straight_line(const acoustics::BottomProfile& bottom, const acoustics::RayLink& link);

}  // namespace halocline::channel_server
