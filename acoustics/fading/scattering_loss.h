// SPDX-License-Identifier: BSD-3-Clause
// Optional loss of the sound that rough boundaries scatter out of shallow water. Sound steeper than the
// bottom's critical angle disappears within a few bounces; sound below that angle travels on forwards.
// Without this option all scattered sound travels on (acoustics/fading/path_fading.h).
//
// Model, with q = sin^2 of the critical angle, cos(critical) = c_water / c_bottom, and Gamma the Rayleigh
// parameter of path_fading.h:
// - Bottom: the scattered share 1 - exp(-Gamma^2) leaves by Lambert's law (Urick 1983, section 8.5; the law
//   is our choice for sound that travels on forwards), of which q stays below the critical angle. Per bounce,
//     kept = q + (1 - q) exp(-Gamma^2),  Gamma^2 the mean of the path's bounces.
// - Surface: the facets of the waves reflect the scattered share. Their slopes are normally distributed with
//   the variance (0.003 + 5.12e-3 U) / 2 in the vertical plane of the sound (Cox and Munk 1954). A facet of
//   slope a turns the grazing angle theta into theta + 2 atan(a), and intercepts sound in proportion to
//   1 + a / tan(theta), 0 at least. The share f that becomes steeper than the critical angle is lost at the
//   bottom. Per bounce,
//     kept = 1 - (1 - exp(-Gamma^2)) f (1 - sin^2(theta) / q),
//   for as many bounces as the path has at both boundaries. The last factor is our choice: steeper paths lose
//   more at the bottom themselves than their scattered sound does.
// A bottom slower than the water has no critical angle and causes no such loss.
//
// Validity: waves and facets longer than the acoustic wavelength (above about 10 kHz), many bounces. A path
// without bottom bounces loses nothing at the surface. Neglected: sound scattered back below the critical
// angle, shadows of crests, slopes of the bottom.
#pragma once

#include "acoustics/fading/path_fading.h"
#include "acoustics/sea/boundary_reflection.h"

namespace halocline::acoustics {

// Trapped share q = sin^2 of the critical angle of a bottom under water of 1500 m/s, 0..1; 0 when the bottom
// is slower than the water.
double trapped_share(const FluidBottom& bottom);

// Bounces of one path: their counts, and the sums of the squared sines of their grazing angles.
struct RoughBounces {
  int surface_count = 0, bottom_count = 0;
  double surface_sine_squares = 0, bottom_sine_squares = 0;
};

// The share f, 0..1, of the sound at a grazing angle of this sine that waves turn beyond the critical angle;
// the trapped share q has to be above 0.
double steepened_share(double wind_mps, double sine, double trapped_share);

// Share of the path's power that remains after scattering at both boundaries, 0..1; 1 when the model has no
// such loss.
double kept_share(const FadingModel& model, double wind_mps, double frequency_hz, double trapped_share,
                  const RoughBounces& bounces);

}  // namespace halocline::acoustics
