// SPDX-License-Identifier: BSD-3-Clause
// Distribution of the signal of a phase-shift keying receiver over noise and interference while paths fade
// within a packet, and the duration of its fades.
//
// Let S be the signal power, I the interference power, N the noise and t a threshold of S / (N + I). The
// decision variable
//   Q = S - t (I - mean I)
// is below t (N + mean I) exactly when S / (N + I) is below t. S and I are sums over the scattered power of
// the paths (acoustics/prediction/equalizer_statistics.h). A path has the coefficient c = signal - t
// interference and forms cross terms with the block-fading power b. Its terms in the cumulant generating
// function of Q are
//   K(s) = ln E exp(s Q) = sum of  -n ln(1 - c s) + b s / (1 - c s),
// n = 1 for an independent path. Paths that fade together share the sum of their c and have n < 1; terms of
// similar c are merged. The normal score of a value is the quantile of the standard normal distribution for
// the probability that Q is below it. Where Q equals y = K'(s), it is (saddle point: Lugannani and Rice 1980,
// Barndorff-Nielsen 1986)
//   z = r + ln(u / r) / r,  r = sign(s) sqrt(2 (s y - K)),  u = s sqrt(K''),
// accurate to some per cent of probability, in the deepest tails too. The rate of downward crossings of y is
// the density of Q there times the mean slope (Rice 1944):
//   rate = exp(K - s y) / sqrt(2 pi K'') * sqrt(V / (2 pi)),
// V the variance of the slope of Q: the sum over the terms of 2 c (2 pi B)^2 times the value of the term at
// y, B its Doppler spread. Q stays above y at `count` instants that are `step` apart with the probability
//   (1 - p) (1 - q / (1 - p))^((count - 1) (1 + e)),  q = p (1 - p) (1 - exp(-nu / (p (1 - p)))),
// p the probability that Q is below y and nu the crossings per step. The correction
//   e = 0.27 exp(-(B step / 0.12)^2)
// accounts for the regular spacing of the crossings of so smooth a process: our fit.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "acoustics/prediction/equalizer_statistics.h"

namespace halocline::acoustics {

// The instants at which a packet is evaluated: `count` of them, `step_s` apart.
struct Stretches {
  double count = 1, step_s = 0;
};

// Probability that a standard normal variable is below `score`, within 1e-4; tabulated.
double tabulated_probability(double score);

// The terms that make up Q at one threshold, independent of the block-fading power. Terms of similar scale
// are merged into one per octave.
class BandTerms {
 public:
  BandTerms(const EqualizerStatistics& sound, double threshold);

  double threshold() const { return threshold_; }
  // Share of the variance of Q that interference adds or removes while the block-fading power, constant
  // within a packet, is `block_power`; then the greatest such share for any `block_power`.
  double interference_share(double block_power) const { return share(louder(block_power)); }
  double most_interference_share() const;

 private:
  friend class FadeStatistics;
  static constexpr std::size_t kOctaves = 8;
  // Cross terms of the scattered power with the block-fading power, kept apart for the signal and for the
  // interference times the threshold.
  struct CrossTerms {
    double rest = 0, variance = 0, rate = 0;
  };
  struct Octave {
    double mean = 0, variance = 0, rate = 0;
    CrossTerms signal, interference;
  };
  double louder(double block_power) const { return mean_block_ > 0 ? block_power / mean_block_ : 0; }
  double share(double louder) const;

  double threshold_, mean_block_, fast_;
  // Octaves of descending positive scales, then of negative ones.
  std::array<Octave, 2 * kOctaves> octaves_{};
  // Variance of the signal and the part of it that interference changes; `*_cross_terms_` is what each gains
  // per unit of `louder` from cross terms with the block-fading power.
  double signal_ = 0, signal_cross_terms_ = 0, changed_ = 0, changed_cross_terms_ = 0;
};

// Distribution of Q for one block-fading power, from its cumulant generating function.
class FadeStatistics {
 public:
  static constexpr std::size_t kPoints = 14;
  using Values = std::array<double, kPoints>;
  // Points of the distribution function: Q is below `powers[i]` with the probability that a standard normal
  // variable is below `scores[i]`.
  struct Points {
    Values powers{}, scores{};
    Values log_parts{};  // ln of the number of parts of a packet that fade below the power independently
  };

  // Distribution while the block-fading power, constant within a packet, is `block_power`.
  FadeStatistics(const BandTerms& terms, double block_power);

  double mean() const { return mean_; }
  double variance() const { return variance_; }
  double skewness() const { return skewness_; }
  Points points(const Stretches& stretches) const;  // ascending power; equal powers when nothing fades

 private:
  struct Term {
    double scale, rest, count, rate;  // rate: (2 pi B)^2 times 2 c
  };
  std::span<const Term> terms() const { return {terms_.data(), count_}; }

  std::array<Term, 2 * BandTerms::kOctaves> terms_{};
  std::size_t count_ = 0;  // terms in use
  double offset_ = 0;      // constant part of the power, outside the terms
  double mean_ = 0, variance_ = 0, skewness_ = 0;
};

}  // namespace halocline::acoustics
