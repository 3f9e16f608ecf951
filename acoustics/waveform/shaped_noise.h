// SPDX-License-Identifier: BSD-3-Clause
// Samples of Gaussian noise with a given spectrum.
//
// White normal draws of standard deviation 1 at the rate f_s have the density 2 / f_s; a linear-phase filter
// shapes it to N(f) = 2 |H(f)|^2 / f_s. H follows sqrt(N f_s / 2) at frequencies f_s / 1024 apart and is
// truncated by a Kaiser window: steps of the spectrum are smoothed over about f_s / 300. Draws are addressed
// by the number of the sample, so that the noise does not depend on how it is divided into blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/random.h"

namespace halocline::acoustics {

// A source of noise that is a function of the sample's number.
class ShapedNoise {
 public:
  // `density` is N(f), one-sided, in the squared unit of the samples per hertz, at 0 < f <= f_s / 2.
  // `address.which` is not used. Throws InvalidArgument unless the rate is above 0 and densities are >= 0.
  ShapedNoise(const std::function<double(double frequency_hz)>& density, double rate_hz, DrawAddress address);

  // Samples from number `first` on; `weight`, unless empty, multiplies the draw of a sample before the
  // filter.
  std::vector<double> samples(std::int64_t first, std::size_t count,
                              const std::function<double(std::int64_t sample)>& weight = {}) const;

 private:
  DrawAddress address_;
  std::vector<double> taps_;  // symmetric, the middle one at the sample itself
};

}  // namespace halocline::acoustics
