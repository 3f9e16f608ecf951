// SPDX-License-Identifier: BSD-3-Clause
// Drift of the sound-speed profile: the upper water warms and cools over hours, as internal tides and weather
// move it.
//
// Model, with H the depth to which the profile drifts:
//   dc(z, t) = a_1(t) cos(pi z / H) + a_2(t) cos(2 pi z / H)  m/s,  0 <= z <= H
// a_1 and a_2 are independent Gauss-Markov processes (core/gauss_markov.h). Below H the value at H falls
// linearly to 0 at 2 H, so that the speed has no step (our choice). The water is constant in blocks of
// kBlockS, with the values of the block's beginning; from one block to the next each amplitude changes by
// sigma sqrt(2 (1 - exp(-kBlockS / T))) rms, 0.07 m/s at 0.3 m/s and 6 h. All draws are addressed by seed and
// block, so every process has the same water. Left out: changes of temperature in absorption, changes from
// place to place.
#pragma once

#include <cstdint>
#include <vector>

#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {

// Parameters of the drift.
struct ProfileDrift {
  static constexpr double kBlockS = 600;    // duration of a block, s
  static constexpr double kDeepestM = 200;  // greatest H, m

  double spread_mps = 0;  // standard deviation of each amplitude, 0..10; 0: no drift
  double time_s = 21600;  // correlation time, 0.1..1e6
  double depth_m = 200;   // H, 1..kDeepestM
  std::uint64_t seed = 0;

  bool any() const { return spread_mps > 0; }
};

// Throws InvalidArgument, naming the field, unless every field is in range.
void validate(const ProfileDrift& drift);

// a_1 and a_2 of a block, m/s; block 0 begins at time 0, and those before it are alike.
struct DriftAmplitudes {
  double first_mps = 0, second_mps = 0;
  bool any() const { return first_mps != 0 || second_mps != 0; }
};
DriftAmplitudes drift_amplitudes(const ProfileDrift& drift, std::int64_t block);

// dc at 16 equal steps down to H, which is `depth_m`, and at 2 H, between which sound uses it linearly:
// within 0.005 m/s of the cosines for amplitudes of 0.3 m/s.
std::vector<SpeedRow> drift_rows(double depth_m, const DriftAmplitudes& amplitudes);

}  // namespace halocline::acoustics
