// SPDX-License-Identifier: BSD-3-Clause
// The pressures of a link's paths over time, whatever makes them: the model of acoustics/fading/link_fading.h
// or a measured channel (acoustics/fading/measured_fading.h).
#pragma once

#include <complex>
#include <vector>

#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

// Instants of equal distance, seconds from a start.
struct FadingTimes {
  double begin_s = 0, step_s = 0;  // the first instant and the distance to the next
  int count = 1;
};

class PathResponses {
 public:
  virtual ~PathResponses() = default;

  // h of each path at each instant after `start`, by path, then instant: pressures re 1 uPa with the phase of
  // reflections and fading, without that of the delay. `large_scale` is that of the link at the time.
  virtual std::vector<std::complex<double>> responses(const std::vector<SoundPath>& paths, const Band& band,
                                                      SimTime start, const FadingTimes& times,
                                                      double large_scale) const = 0;
};

}  // namespace halocline::acoustics
