// SPDX-License-Identifier: BSD-3-Clause
// Check of a calibration: each pair is left out in turn, the others fit the numbers, and a band of 80 % is
// forecast for what the pair measured.
//
// The band has what is left unknown of the numbers, those that the trial does not tell with their priors, the
// slow sea over the pair's own hours (half of its variance with the correlation time of the slow fading, half
// with that of the noise, as the defaults of both have it), and the chance of single packets: 400 draws,
// addressed by the pair.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulation/calibration/trial_fit.h"
#include "simulation/calibration/trial_likelihood.h"
#include "simulation/ensemble/sea_member.h"

namespace halocline::clients {

// What a pair's check is about: the share of its packets, its mean SNR or its mean level.
enum class TrialQuantity { kDelivery, kSnr, kLevel };

struct PairCheck {
  std::string from, to;
  TrialQuantity quantity = TrialQuantity::kDelivery;
  double measured = 0;
  ForecastBand predicted;
  bool is_inside() const { return measured >= predicted.low && measured <= predicted.high; }
};

// `unknown` are numbers that vary between seas but are not among the fitted ones of `all`.
std::vector<PairCheck> check_left_out(const TrialFit& fit, const SeaPosterior& all,
                                      const std::vector<SeaNumber>& unknown,
                                      const std::vector<ForecastPair>& pairs);

}  // namespace halocline::clients
