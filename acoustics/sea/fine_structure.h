// SPDX-License-Identifier: BSD-3-Clause
// Fine structure and internal waves: the rate at which a medium that is not perfect turns rays.
//
// Model. A ray through anisotropic blobs of sound speed (Chernov 1960) turns at random, with the variance
//   d<theta^2>/dr = mu = sqrt(pi) (dc / c0)^2 / (L_v sqrt(sin^2 theta + (L_v / L_h)^2)),
// L_v = 5 m and L_h = 500 m the height and length of the blobs, c0 = 1500 m/s. The sum under the root joins
// the limits of a ray across the blobs and one along them: our choice. The deviation of the sound speed is
//   dc^2 = fine_structure^2 + (internal_wave |dc/dz|)^2,
// with internal_wave the rms displacement of the water by internal waves.
//
// After the range r a ray lies within sigma_z = sqrt(mu r^3 / 3) of its depth, mu its mean over the range of
// a cycle. Left out: the change of mu along a link whose water changes.
//
// Thread rule: free functions on values, which threads may call at the same time.
#pragma once

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

inline constexpr double kBlobHeightM = 5, kBlobLengthM = 500;  // L_v, L_h: our choices
inline constexpr double kBlobSpeedMps = 1500;                  // c0

// Irregularity of the water. The default is a perfect medium, in which rays are neither turned nor smoothed.
struct FineStructure {
  double speed_mps = 0;        // rms of the sound speed of fine structure, m/s, 0..5
  double internal_wave_m = 0;  // rms displacement by internal waves, m, 0..50

  bool is_perfect() const { return speed_mps == 0 && internal_wave_m == 0; }
  // dc^2 where the sound speed changes by `gradient_per_s`, m^2/s^2.
  double speed_variance(double gradient_per_s) const {
    const double wave = internal_wave_m * gradient_per_s;
    return speed_mps * speed_mps + wave * wave;
  }
  bool operator==(const FineStructure&) const = default;
};

// Throws InvalidArgument, naming the field, its value and the permitted range, unless every field is in
// range.
void validate(const FineStructure& structure);

// mu of a ray whose angle has the sine `sine`, in water of the variance `speed_variance`, rad^2/m.
double turning_rate(double speed_variance, double sine);

// Mean of mu over the range of a cycle of the rays of Snell's invariant `xi`, s/m, that pass `depth_m` in
// water `bottom_m` deep, rad^2/m: from their upper turning point or the surface to the lower one or the
// bottom. A mean over range is one over depth weighted by the cotangent of the angle. A ray that does not
// reach `depth_m` has mu of a horizontal ray there.
double cycle_turning_rate(const RayWater& water, const FineStructure& structure, double bottom_m,
                          double depth_m, double xi);

}  // namespace halocline::acoustics
