// SPDX-License-Identifier: BSD-3-Clause
// What bubbles and waves near the surface do to one path of sound.
//
// Bubbles. The attenuation of the bubble layer (acoustics/sea/surface/surface_layers.h) is integrated along
// the ray, in the water that the ray was traced in. A path that leaves both ends for the deep loses, with
// I(z) the integral along the ray from the depth z down to its lower turning point or below the layer,
//
//   (2 I(0) for each bounce) + (2 I(turning depth) for each turn within the layer) +- I(z_s) +- I(z_r)
//
// with + at an end that the path leaves or meets from below, - from above. 2 I(0) is a bounce of APL-UW TR
// 9407, which the eigenray holds already, so nothing counts twice and paths between deep ends stay as they
// are. A path loses at most kMaxBubblePathDb here, unless its bounces alone lose more.
//
// Crests and troughs. A path without a bounce at the surface is clear with the probability p of
// SurfaceWaves::clear_share(): p^2 of its power stays steady and p - p^2 becomes fast fading at the rate of
// the waves. What waves do to bounces is the scattering of path_fading.h.
//
// Heave. An end that moves with the waves spreads a path by (f / c) v |sin(angle)| Hz more, v its rms
// velocity.
//
// Left out: the slower sound among bubbles, and waves along bounced paths close to an end.
#pragma once

#include "acoustics/fading/path_fading.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/surface/surface_layers.h"

namespace halocline::acoustics {

// The surface above a link, without ice.
struct NearSurface {
  BubbleLayer bubbles;
  SurfaceWaves waves;
};

// The layers near the surface under a wind of 0..60 m/s, at 1e3..1e6 Hz.
NearSurface near_surface(double wind_mps, double frequency_hz);

// Effect on one path.
struct SurfaceCrossing {
  double bubble_db = 0;    // loss beyond that of the bounces, dB; below 0 for a bounce close to an end
  double clear_share = 1;  // p
};

// Effect on a path of `link` that was traced in `water`, whose launch angle is at the link's source. Depths
// below the layers give no loss.
SurfaceCrossing crossing_of(const NearSurface& surface, const RayWater& water, const RayLink& link,
                            const Eigenray& path);

// Adds the loss to the path's amplitude and surface loss.
void take_bubbles(const SurfaceCrossing& crossing, Eigenray& path);

// Fading of the path once waves leave it clear for the share p only. Shares refer to the power p P that then
// arrives in the mean.
PathFading behind_crests(const PathFading& fading, double clear_share, double mean_wave_frequency_radps);

}  // namespace halocline::acoustics
