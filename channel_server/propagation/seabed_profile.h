// SPDX-License-Identifier: BSD-3-Clause
// Profile of the seabed under one link, sampled at equal distances, and the bottom that rays meet.
//
// Positions along a link are horizontal distances from its first end, m; the other end lies at the link's
// range. The samples of seabed_map.h begin before the first end and continue beyond the other, so the facets
// of the bottom between the ends never depend on where the samples stop. Where an end of the link lies below
// the bottom, the samples beside it are lowered, in proportion to their interpolation weights there, until
// the bottom lies just below the end; elsewhere the bottom is unchanged. Land counts as 0.1 m of water.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/bottom_profile.h"

namespace halocline::channel_server {

struct SeabedProfile {
  double first_m = 0;           // position of the first sample, -1e6..0
  double spacing_m = 1;         // between samples, above 0
  std::vector<double> z_m;      // z of the seabed, at least two samples
  bool beyond_terrain = false;  // some depth between the ends continues that at the edge of the data

  static SeabedProfile flat(double z_m) { return {-1e5, 1e6, {z_m, z_m}}; }
};

// Sums over slopes, for their variance.
struct SlopeSums {
  double count = 0, sum = 0, squares = 0;

  double variance() const {
    const double mean = sum / std::max(count, 1.0);
    return std::max(squares / std::max(count, 1.0) - mean * mean, 0.0);
  }
};

// Seabed data for links whose rays are not traced.
struct SeabedPlaces {
  std::array<double, 16> z_m{};  // at equal distances between the ends
  double mean_square_slope = 0;  // variance of the slope along the link about its mean
  bool beyond_terrain = false;   // see SeabedProfile
};

// Number of lattice points that contribute at a place between points 0 and 1: points -2 to 3.
inline constexpr int kSplineReach = 6;
// Returns their weights at the fraction `u` from point 0 to point 1, 0..1. They are cubic B-splines b with
// the coefficients
//
//   c_i = (8 f_i - f_(i-1) - f_(i+1)) / 6
std::array<double, kSplineReach> spline_weights(double u);

// Returns the weighted mean of the known ones of four depths; the weights of unknown depths (NaN) are
// redistributed. NaN when none is known.
double mean_of_known(const std::array<double, 4>& z_m, const std::array<double, 4>& weights);

// Least depth of water in a bottom profile, m: for land, and under an end of a link.
inline constexpr double kMinWaterM = 0.1;

// Returns the bottom along a link whose ends are those of `seabed`, in the same order.
acoustics::BottomProfile bottom_under(const SeabedProfile& seabed, const acoustics::RayLink& link,
                                      double sea_surface_z_m);

// True when the bottom reaches the straight line between the ends of the link.
bool cuts_straight_line(const acoustics::BottomProfile& bottom, const acoustics::RayLink& link);

}  // namespace halocline::channel_server
