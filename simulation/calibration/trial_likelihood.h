// SPDX-License-Identifier: BSD-3-Clause
// Likelihood of a trial for the numbers that a calibration fits.
//
// Model. The slow sea has half of its variance with the correlation time of the slow fading and half with
// that of the noise, so the mean level of a bin varies with the share kept_in_bins() of the variance, and the
// rest passes within the bin. In a bin of one pair, k of n packets are right with probability
//   integral of normal(x; 0, slow sqrt(kept)) binomial(k; n, p(noise + receiver + x)) dx,
// p the delivery with that much more noise, its curve widened by the rest: a score s with the slope s'
// becomes s / sqrt(1 + s'^2 slow^2 (1 - kept)), which is exact for Phi(x / w). Without the rest a sea of our
// own making (tests) is fitted with an offset 1.3 dB too high and a quarter too little of slow. The integral
// takes 65 points over four standard deviations to both sides: five points of Gauss and Hermite are 5.7 dB
// apart for 4.2 dB, while a bin of 20 packets tells the level within 1 dB, so that sum would jump with the
// offset. The mean of m levels, or of SNRs, is normal with standard deviation sqrt(slow^2 + 3^2 / m); an SNR
// falls by the noise, a level does not. Bins are independent.
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

// Time scales of the slow sea, s.
struct SlowTimes {
  double bin_s = 7200, fading_s = 21600, noise_s = 3600;

  // Share of the variance over hours that the mean over a bin keeps: of a Gauss-Markov level of correlation
  // time T over u T seconds 2 (u - 1 + exp(-u)) / u^2.
  double kept_in_bins() const;
};

// A pair of a trial with its forecasts.
struct ForecastPair {
  TrialPair trial;
  std::vector<PairForecast> forecasts;   // in different seas
  std::vector<std::size_t> forecast_of;  // index among them for each bin of the trial
  SlowTimes times;
};

// Logarithms of the likelihood, without terms that no number changes.
double log_likelihood(const ForecastPair& pair, const SeaNumbers& numbers);
// The same, window by window of time; adds to `windows`.
void add_by_window(const ForecastPair& pair, const SeaNumbers& numbers,
                   std::map<std::int64_t, double>& windows);

// Returns a score of deliveries by `scores` at an offset of the noise, with a normal spread of it.
double widened_score(const DeliveryCurve::Scores& scores, double more_noise_db, double spread_db);

inline constexpr double kLevelSpreadDb = 3;  // of one level, beside what is slow

}  // namespace halocline::clients
