// SPDX-License-Identifier: BSD-3-Clause
// Water as rays see it: sound speed linear in depth between knots, absorption within each layer.
//
// Model: between two knots a ray is an arc of a circle, so travel time, range and length are closed forms. A
// table of depth and speed is taken as it is (exact); temperature-salinity tables and Munk's formula are
// sampled where the straight line between knots would be further than `speed_tolerance_mps` from the profile.
// A kink where the speed is least makes a channel that the water has not: there, and there alone, a parabola
// takes its place (rounded_channels), by no more than the tolerance. Below the last knot and above the first
// the speed is constant. Absorption in a layer is the parabola through its value at the top, the middle and
// the bottom. Delay error of sampling and of thinning: below tolerance / speed of the delay, mostly far less,
// as errors of both signs cancel (0.01 m/s: below 7e-6 of the delay).
//
// Immutable: calls may overlap between threads. Left out: change of the water with range.
#pragma once

#include <functional>
#include <vector>

#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {

// dB per metre within a layer at the share u = 0..1 of its thickness: a0 + a1 u + a2 u^2.
struct LayerAbsorption {
  double a0 = 0, a1 = 0, a2 = 0;
};

// Mean along a path that crosses a layer from sine s1 to sine s2, of absorption a0 + a1 u + a2 u^2, dB/m.
// Along the arc sines change evenly with length (to first order in (c2 - c1)/c), so the mean over the path of
// the share u of the thickness is (1 + p)/3, that of u^2 is (2 p^2 + 3 p + 3)/15, p = s1/(s1 + s2): from
// straight (1/2, 1/3) to turning at the end (2/3, 8/15).
inline double mean_absorption(const LayerAbsorption& layer, double s1, double s2) {
  const double sum = s1 + s2, p = sum > 0 ? s1 / sum : 0.5;
  return layer.a0 + layer.a1 * (1 + p) / 3 + layer.a2 * (2 * p * p + 3 * p + 3) / 15;
}

// `layer` seen from the share `from` to the share `to` of its thickness: a new u runs 0..1 over that part.
inline LayerAbsorption restricted(const LayerAbsorption& layer, double from, double to) {
  const double d = to - from;
  return {layer.a0 + from * (layer.a1 + from * layer.a2), d * (layer.a1 + 2 * from * layer.a2),
          d * d * layer.a2};
}

// Absorption, dB/km, at a depth, m.
using AbsorptionAtDepth = std::function<double(double)>;

inline constexpr double kSpeedTolerance = 0.01;  // m/s: of sampling and of rounding, unless stated

class RayWater {
 public:
  // `knots` as the rows of SoundSpeedProfile::from_speeds; throws InvalidArgument where those would.
  RayWater(std::vector<SpeedRow> knots, const AbsorptionAtDepth& absorption_db_per_km);

  // Samples a profile: exact for a table of speeds, but for the axes of channels.
  static RayWater from_profile(const SoundSpeedProfile& profile,
                               const AbsorptionAtDepth& absorption_db_per_km,
                               double speed_tolerance_mps = kSpeedTolerance);

  // From 0 to kDeepestWater; speeds at each.
  const std::vector<double>& depths_m() const { return depth_; }
  const std::vector<double>& speeds_mps() const { return speed_; }
  // 1/s, of the layer below each knot; one fewer than knots.
  const std::vector<double>& gradients_per_s() const { return gradient_; }
  const std::vector<LayerAbsorption>& absorption() const { return absorption_; }

  std::size_t layers() const { return gradient_.size(); }
  // The layer that holds a depth 0..kDeepestWater; at a knot, the one below.
  std::size_t layer_at(double depth_m) const;
  double speed_at(double depth_m) const;
  double absorption_db_per_m(double depth_m) const { return absorption_db_per_m(depth_m, layer_at(depth_m)); }
  // The same of a depth in a layer that is known.
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

// The fewest of the given knots, first and last among them, between which linear interpolation stays within
// `tolerance_mps` of all of them: a deep profile of 101 knots needs 20 for 0.1 m/s. Throws when tolerance_mps
// < 0.
std::vector<SpeedRow> thinned(const std::vector<SpeedRow>& knots, double tolerance_mps);
// The same knots with the kink at each minimum of the speed replaced by knots on the parabola that meets both
// neighbouring pieces with their gradients, as far as the middle of the shorter of them. Of the kink by Delta
// g per second it takes half-height d to where the speed changes by Delta g d / 4 <= tolerance_mps; kinks for
// which d is below 1 m stay. Throws when tolerance_mps < 0.
std::vector<SpeedRow> rounded_channels(const std::vector<SpeedRow>& knots, double tolerance_mps);
// The rows of a table of speeds, or samples of another profile between which it stays within the tolerance.
std::vector<SpeedRow> knots_of(const SoundSpeedProfile& profile, double speed_tolerance_mps);

}  // namespace halocline::acoustics
