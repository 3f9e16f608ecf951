// SPDX-License-Identifier: BSD-3-Clause
// Gaussian noise of a given spectrum as samples.
//
// White normal draws of standard deviation 1 at the rate f_s have the density 2 / f_s; a filter of linear
// phase turns it into N(f) = 2 |H(f)|^2 / f_s. H follows sqrt(N f_s / 2) at frequencies f_s / 1024 apart and
// is cut by a Kaiser window: steps of the spectrum are smoothed over about f_s / 300. Draws are addressed by
// the number of the sample: the same noise however it is cut into pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/random.h"

namespace halocline::acoustics {

class ShapedNoise {
 public:
  // `density`: N(f), one-sided, in the square of the samples' unit a hertz, at 0 < f <= f_s / 2.
  // `address.which` is not used. Throws InvalidArgument unless the rate is above 0 and densities are 0 and
  // up.
  ShapedNoise(const std::function<double(double frequency_hz)>& density, double rate_hz, DrawAddress address);

  // Samples number `first` and following; `weight`, unless empty, multiplies the draw of a sample before the
  // filter.
  std::vector<double> samples(std::int64_t first, std::size_t count,
                              const std::function<double(std::int64_t sample)>& weight = {}) const;

 private:
  DrawAddress address_;
  std::vector<double> taps_;  // symmetric, the middle one belongs to the sample itself
};

}  // namespace halocline::acoustics
