// SPDX-License-Identifier: BSD-3-Clause
// Analytic signal of a sampled waveform, evaluated at any instant: the signal without negative frequencies,
// which a path can delay and turn in phase.
//   x_a(t) = x(t) + j (h * x)(t),  h the Hilbert transformer, taps 2 / (pi k) at odd k
// Values between samples are interpolated by a sinc of 32 taps; both filters have a Kaiser window. From 0.01
// to 0.4 of the sampling rate the error of the amplitude is below 1e-4. The signal is 0 before its first and
// after its last sample.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace halocline::acoustics {

// A waveform that can be evaluated at any instant.
class AnalyticSignal {
 public:
  // Throws InvalidArgument unless the rate is above 0 and all samples are finite.
  AnalyticSignal(double rate_hz, const std::vector<double>& samples);

  double rate_hz() const { return rate_hz_; }
  double duration_s() const { return static_cast<double>(count_) / rate_hz_; }
  // Value at `time_s` after the first sample.
  std::complex<double> at(double time_s) const;

 private:
  double rate_hz_;
  std::ptrdiff_t count_ = 0;
  // Real and imaginary parts, with zeros before and after.
  std::vector<double> real_, turned_;
};

}  // namespace halocline::acoustics
