// SPDX-License-Identifier: BSD-3-Clause
// Stationary complex Gaussian noise of mean power 1 as a function of time, by a sum of complex exponentials
// (Rice 1944; Clarke 1968):
//   g(t) = 1/sqrt(N) sum_k exp(j (2 pi f_k t + phi_k)),  N = 16
// Its autocorrelation is exp(-(2 pi B tau)^2 / 2). The frequencies are normal with the standard deviation B,
// one from each of N strata of equal probability, then shifted and scaled to mean 0 and rms B, so that every
// single realisation fades at the right rate. Phases are uniform. All random numbers are addressed
// (core/random.h): the value at an instant depends on the address alone. The amplitude has a Rayleigh
// distribution to within 0.8 % of probability (N = 16).
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>

#include "core/random.h"

namespace halocline::acoustics {

// One realisation of the noise.
class ComplexNoise {
 public:
  static constexpr std::size_t kSines = 16;
  using Sines = std::array<double, kSines>;

  // Draws the realisation of `address`, whose `which` is not used.
  explicit ComplexNoise(DrawAddress address);

  // The noise at `time_s` with the Doppler spread `doppler_spread_hz` >= 0.
  std::complex<double> at(double time_s, double doppler_spread_hz) const;

  // Frequencies in units of B, and phases in cycles, 0..1.
  const Sines& frequencies() const { return frequencies_; }
  const Sines& phases() const { return phases_; }

 private:
  Sines frequencies_, phases_;
};

}  // namespace halocline::acoustics
