// SPDX-License-Identifier: BSD-3-Clause
// Water for ray tracing: sound speed linear in depth between knots, and absorption within each layer.
//
// Model: between two knots a ray is an arc of a circle, so that travel time, range and length have closed
// forms. A table of depth and speed is used as it is (exact); temperature-salinity tables and Munk's formula
// are sampled so that linear interpolation between knots is within `speed_tolerance_mps` of the profile. A
// kink at a minimum of the speed forms an artificial channel: there, and only there, a parabola replaces it
// (rounded_channels), within the tolerance. Below the last knot and above the first the speed is constant.
// Absorption in a layer is the parabola through its values at the top, the middle and the bottom. The error
// of the delay by sampling and thinning is below tolerance / speed of the delay, mostly much less, since
// errors of both signs cancel (0.01 m/s: below 7e-6 of the delay).
//
// Immutable: calls may overlap between threads. Left out: variation of the water with range.
#pragma once

#include <functional>
#include <vector>

#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {

// Absorption within a layer, dB/m, at the share u = 0..1 of its thickness: a0 + a1 u + a2 u^2.
struct LayerAbsorption {
  double a0 = 0, a1 = 0, a2 = 0;
};

// Mean absorption, dB/m, along a path that crosses a layer from sine s1 to sine s2. Along the arc sines
// change linearly with length (to first order in (c2 - c1)/c), so that the means over the path of the share u
// of the thickness and of its square are
//   mean u = (1 + p) / 3,  mean u^2 = (2 p^2 + 3 p + 3) / 15,  p = s1 / (s1 + s2):
// from (1/2, 1/3) for a straight path to (2/3, 8/15) for one that turns at the end.
inline double mean_absorption(const LayerAbsorption& layer, double s1, double s2) {
  const double sum = s1 + s2, p = sum > 0 ? s1 / sum : 0.5;
  return layer.a0 + layer.a1 * (1 + p) / 3 + layer.a2 * (2 * p * p + 3 * p + 3) / 15;
}

// Absorption of the part of `layer` between the shares `from` and `to` of its thickness: its u runs 0..1 over
// that part.
inline LayerAbsorption restricted(const LayerAbsorption& layer, double from, double to) {
  const double d = to - from;
  return {layer.a0 + from * (layer.a1 + from * layer.a2), d * (layer.a1 + 2 * from * layer.a2),
          d * d * layer.a2};
}

// Absorption, dB/km, at a depth, m.
using AbsorptionAtDepth = std::function<double(double)>;

inline constexpr double kSpeedTolerance = 0.01;  // m/s, default for sampling and rounding

// A profile of layers with linear sound speed.
class RayWater {
 public:
  // `knots` as the rows of SoundSpeedProfile::from_speeds(); throws InvalidArgument under the same
  // conditions.
  RayWater(std::vector<SpeedRow> knots, const AbsorptionAtDepth& absorption_db_per_km);

  // Samples a profile. A table of speeds is exact, except at the axes of channels.
  static RayWater from_profile(const SoundSpeedProfile& profile,
                               const AbsorptionAtDepth& absorption_db_per_km,
                               double speed_tolerance_mps = kSpeedTolerance);

  // Depths of the knots, from 0 to kDeepestWater, and the speed at each.
  const std::vector<double>& depths_m() const { return depth_; }
  const std::vector<double>& speeds_mps() const { return speed_; }
  // Gradient in the layer below each knot, 1/s; one fewer than knots.
  const std::vector<double>& gradients_per_s() const { return gradient_; }
  const std::vector<LayerAbsorption>& absorption() const { return absorption_; }

  std::size_t layers() const { return gradient_.size(); }
  // Index of the layer that contains a depth 0..kDeepestWater; at a knot, the one below.
  std::size_t layer_at(double depth_m) const;
  double speed_at(double depth_m) const;
  double absorption_db_per_m(double depth_m) const { return absorption_db_per_m(depth_m, layer_at(depth_m)); }
  // Absorption at a depth in a known layer, dB/m.
  double absorption_db_per_m(double depth_m, std::size_t layer) const {
    const double u = (depth_m - depth_[layer]) / (depth_[layer + 1] - depth_[layer]);
    const LayerAbsorption& of_layer = absorption_[layer];
    return of_layer.a0 + u * (of_layer.a1 + u * of_layer.a2);
  }
  // True when the speed is the same at all depths from the surface to `bottom_depth_m`.
  bool is_isovelocity_above(double bottom_depth_m) const;

 private:
  std::vector<double> depth_, speed_, gradient_;
  std::vector<LayerAbsorption> absorption_;
};

// A minimal subset of the knots, first and last included, between which linear interpolation is within
// `tolerance_mps` of all of them: a deep profile of 101 knots needs 20 for 0.1 m/s. Throws InvalidArgument
// when tolerance_mps < 0.
std::vector<SpeedRow> thinned(const std::vector<SpeedRow>& knots, double tolerance_mps);
// The knots with the kink at each minimum of the speed replaced by knots on the parabola that joins both
// adjacent pieces with their gradients, at most as far as the middle of the shorter piece. A kink of Delta g
// per second is rounded over the half-height d at which the speed changes by Delta g d / 4 <= tolerance_mps;
// kinks for which d is below 1 m remain. Throws InvalidArgument when tolerance_mps < 0.
std::vector<SpeedRow> rounded_channels(const std::vector<SpeedRow>& knots, double tolerance_mps);
// The rows of a table of speeds; for other profiles, samples between which it is within the tolerance.
std::vector<SpeedRow> knots_of(const SoundSpeedProfile& profile, double speed_tolerance_mps);

}  // namespace halocline::acoustics
