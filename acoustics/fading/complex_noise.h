// SPDX-License-Identifier: BSD-3-Clause
// Stationary complex Gaussian noise of mean power 1 as a function of time, by a sum of sines (Rice 1944;
// Clarke 1968):
//   g(t) = 1/sqrt(N) sum_k exp(j (2 pi f_k t + phi_k)),  N = 16
// Its autocorrelation is exp(-(2 pi B tau)^2 / 2): the frequencies are normal with standard deviation B, one
// from each of N strata of equal probability, then shifted and scaled to mean 0 and rms B, so that a single
// realisation has the right rate of fading. Phases are uniform. All draws are addressed (core/random.h): the
// value at an instant depends on the address alone. Its amplitude is Rayleigh's to within 0.8 % of
// probability (N = 16).
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>

#include "core/random.h"

namespace halocline::acoustics {

class ComplexNoise {
 public:
  static constexpr std::size_t kSines = 16;
  using Sines = std::array<double, kSines>;

  // `address.which` is not used.
  explicit ComplexNoise(DrawAddress address);

  // At `time_s` with the spread `doppler_spread_hz` >= 0.
  std::complex<double> at(double time_s, double doppler_spread_hz) const;

  // Frequencies, in units of B, and phases, in cycles 0..1.
  const Sines& frequencies() const { return frequencies_; }
  const Sines& phases() const { return phases_; }

 private:
  Sines frequencies_, phases_;
};

}  // namespace halocline::acoustics
