// SPDX-License-Identifier: BSD-3-Clause
// Forecasts of the pairs of a trial for any value of the numbers that a calibration fits: level, SNR and
// delivery computed at five factors of the bottom's roughness and slope (1/4 to 4), the delivery also at five
// of the late echoes' share, and interpolated between.
//
// Model: the score of the delivery (delivery_curve.h) at a bottom factor and an echo factor is that of the
// bottom factor alone plus what the echo factor changes at the scenario's own bottom. Beyond the five factors
// the values go on as between the last two. Noise adds to the offset of the curve.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <vector>

#include "simulation/calibration/delivery_curve.h"
#include "simulation/calibration/trial_data.h"
#include "simulation/composition.h"

namespace halocline::clients {

// Natural logarithms of the factors; the middle one is the scenario as it is.
inline constexpr std::array<double, 5> kLnFactors{-2 * std::numbers::ln2, -std::numbers::ln2, 0,
                                                  std::numbers::ln2, 2 * std::numbers::ln2};

// Forecast of one pair.
struct PairForecast {
  using Values = std::array<double, kLnFactors.size()>;

  Values level_db{}, snr_db{};  // by bottom factor; SNR without an offset
  std::array<DeliveryCurve::Scores, kLnFactors.size()> by_bottom{}, by_echo{};

  // Interpolates one of the values between the factors by a cubic through four of them.
  static double at(const Values& values, double ln_factor);
  DeliveryCurve::Scores scores_at(double ln_bottom, double ln_echo) const;
};

// Numbers of a scenario that exist, for those of a calibration that need them.
bool has_bottom_factor(const ScenarioConfig& config);
bool has_echo_factor(const ScenarioConfig& config);

// Returns the times, s, from which the sea is another by [[environment_change]], ascending, the first 0.
std::vector<double> changes_of_sea(const ScenarioConfig& config);

// Returns the forecasts of all pairs, each at the times `from_s` of `changes_of_sea` with the indices
// `wanted[p]` (ascending) of pair p, in their order. Throws InvalidArgument when an end is none.
std::vector<std::vector<PairForecast>> pair_forecasts(const ScenarioConfig& config,
                                                      const std::vector<TrialPair>& pairs,
                                                      const std::vector<double>& from_s,
                                                      const std::vector<std::vector<std::size_t>>& wanted);

}  // namespace halocline::clients
