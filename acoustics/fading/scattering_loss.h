// SPDX-License-Identifier: BSD-3-Clause
// Optional: what rough boundaries scatter out of shallow water. Steeper than the bottom's critical angle,
// sound is gone within a few bounces; forward and below that angle it goes on. Without this all of it goes on
// (acoustics/fading/path_fading.h).
//
// Model, q = sin^2 of the critical angle, cos(critical) = c_water / c_bottom, and Gamma^2 of one bounce as
// there:
// - Bottom: what is scattered, 1 - exp(-Gamma^2), leaves by Lambert's law (Urick 1983, section 8.5; the law
//   is our choice for sound that goes on forward), of which q stays below the critical angle:
//     kept = q + (1 - q) exp(-Gamma^2)  a bounce, Gamma^2 the mean of the path's bounces.
// - Surface: what is scattered is reflected by the facets of the waves, whose slopes are normal with the
//   variance (0.003 + 5.12e-3 U) / 2 in the plane of the sound (Cox and Munk 1954). A facet of slope a turns
//   the grazing angle theta into theta + 2 atan(a) and meets sound by 1 + a / tan(theta), 0 at least. The
//   share f that so becomes steeper than the critical angle is lost at the bottom:
//     kept = 1 - (1 - exp(-Gamma^2)) f (1 - sin^2(theta) / q)  a bounce,
//   for as many bounces as the path has at both boundaries. The last factor is our choice: steeper paths
//   themselves lose more at the bottom than their scattered sound. A bottom slower than the water has no
//   critical angle and no such loss.
// Where it holds: waves and facets longer than the sound's (above some 10 kHz), many bounces. A path without
// bounces at the bottom loses nothing at the surface.
// Left out: sound that is scattered below the critical angle again; shadows of crests; slopes of the bottom.
#pragma once

#include "acoustics/fading/path_fading.h"
#include "acoustics/sea/boundary_reflection.h"

namespace halocline::acoustics {

// q of a bottom under water of 1500 m/s, 0..1; 0 where it is slower than the water.
double trapped_share(const FluidBottom& bottom);

// Bounces of one path: counts and sums of the squared sines of their grazing angles.
struct RoughBounces {
  int surface_count = 0, bottom_count = 0;
  double surface_sine_squares = 0, bottom_sine_squares = 0;
};

// f: share of the sound at a grazing angle of this sine, 0..1, that waves turn beyond the critical angle, q
// above 0.
double steepened_share(double wind_mps, double sine, double trapped_share);

// Share of the path's power that is left of what both boundaries scatter, 0..1; 1 for a model without this
// loss.
double kept_share(const FadingModel& model, double wind_mps, double frequency_hz, double trapped_share,
                  const RoughBounces& bounces);

}  // namespace halocline::acoustics
