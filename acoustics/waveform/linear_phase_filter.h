// SPDX-License-Identifier: BSD-3-Clause
// A filter of linear phase with a given amplitude over frequency.
//
// The amplitude is taken at frequencies f_s / 1024 apart, and the filter cut by a Kaiser window: steps of the
// amplitude are smoothed over about f_s / 300. 1025 taps, symmetric; the middle one belongs to the sample
// itself, so the filter delays nothing.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace halocline::acoustics {

inline constexpr std::size_t kFilterHalf = 512;  // taps to either side

// `amplitude`: at 0 < f <= rate_hz / 2, 0 and up. Throws InvalidArgument unless that holds and the rate is
// above 0.
std::vector<double> linear_phase_taps(const std::function<double(double frequency_hz)>& amplitude,
                                      double rate_hz);
// result[n] is the sum over k of taps[k] padded[n + k], in the order of k; as many as there are samples with
// all of theirs.
std::vector<double> convolved(const std::vector<double>& padded, const std::vector<double>& taps);
// Of as many samples, which are 0 before the first and after the last.
std::vector<double> filtered(const std::vector<double>& samples, const std::vector<double>& taps);

}  // namespace halocline::acoustics
