// SPDX-License-Identifier: BSD-3-Clause
// Interface of the complex pressures of a link's paths over time. The model of acoustics/fading/link_fading.h
// and the measured channel of acoustics/fading/measured_fading.h implement it.
#pragma once

#include <complex>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/math/frequency_band.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

// Equidistant instants, in seconds from a start.
struct FadingTimes {
  double begin_s = 0, step_s = 0;  // the first instant and the interval between instants
  int count = 1;
};

// The responses of a link's paths.
class PathResponses {
 public:
  virtual ~PathResponses() = default;

  // Returns h of each path at each instant after `start`, in the order of paths, then instants. h is the
  // pressure re 1 uPa with the phase of reflections and fading, without the phase of the delay. `large_scale`
  // is the factor of the link's large-scale fading at the time.
  virtual std::vector<std::complex<double>> responses(const std::vector<Arrival>& paths, const Band& band,
                                                      SimTime start, const FadingTimes& times,
                                                      double large_scale) const = 0;
};

}  // namespace halocline::acoustics
