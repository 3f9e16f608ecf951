// SPDX-License-Identifier: BSD-3-Clause
// Likelihood of a trial for the numbers that a calibration fits.
//
// Model. In a bin of one pair, k of n packets are right with probability
//   integral of normal(x; 0, slow) binomial(k; n, p(noise + receiver + x)) dx,
// p the delivery with that much more noise. The integral takes 65 points over four standard deviations to
// both sides: five points of Gauss and Hermite are 5.7 dB apart for 4.2 dB, while a bin of 20 packets tells
// the level within 1 dB, so that sum would jump with the offset. The mean of m levels, or of SNRs, is normal
// with standard deviation sqrt(slow^2 + 3^2 / m); an SNR falls by the noise, a level does not. Bins are
// independent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "simulation/calibration/trial_data.h"
#include "simulation/calibration/trial_forecast.h"

namespace halocline::clients {

// The numbers, by which a scenario's sea is another; SeaNumber is the index of each.
enum SeaNumber : std::size_t {
  kNoiseDb,     // added to the ambient noise, dB
  kReceiverDb,  // added to the noise in the receivers alone, dB
  kLnBottom,    // logarithm of the factor of the bottom's roughness and slope
  kLnSlowDb,    // logarithm of the standard deviation over hours, dB
  kLnEcho,      // logarithm of the factor of the late echoes' share
  kSeaNumbers
};
using SeaNumbers = std::array<double, kSeaNumbers>;

// A pair of a trial with its forecasts.
struct ForecastPair {
  TrialPair trial;
  std::vector<PairForecast> forecasts;   // in different seas
  std::vector<std::size_t> forecast_of;  // index among them for each bin of the trial
};

// Logarithms of the likelihood, without terms that no number changes.
double log_likelihood(const ForecastPair& pair, const SeaNumbers& numbers);
// The same, window by window of time; adds to `windows`.
void add_by_window(const ForecastPair& pair, const SeaNumbers& numbers,
                   std::map<std::int64_t, double>& windows);

inline constexpr double kLevelSpreadDb = 3;  // of one level, beside what is slow

}  // namespace halocline::clients
