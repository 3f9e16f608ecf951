// SPDX-License-Identifier: BSD-3-Clause
// Linear-phase filter with a given amplitude over frequency.
//
// The amplitude is sampled at frequencies f_s / 1024 apart and the filter is truncated by a Kaiser window,
// which smooths steps of the amplitude over about f_s / 300. The filter has 1025 symmetric taps, the middle
// one at the sample itself, so that it has no delay.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace halocline::acoustics {

inline constexpr std::size_t kFilterHalf = 512;  // taps on either side

// Taps for an amplitude over frequency. Throws InvalidArgument unless the rate is above 0 and `amplitude` is
// finite and >= 0 for 0 < f <= rate_hz / 2.
std::vector<double> linear_phase_taps(const std::function<double(double frequency_hz)>& amplitude,
                                      double rate_hz);
// result[n] is the sum over k of taps[k] padded[n + k], in the order of k, for all n whose samples exist.
std::vector<double> convolved(const std::vector<double>& padded, const std::vector<double>& taps);
// The filtered samples, as many as given; the signal is taken to be 0 before the first and after the last.
std::vector<double> filtered(const std::vector<double>& samples, const std::vector<double>& taps);

}  // namespace halocline::acoustics
