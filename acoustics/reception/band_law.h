// SPDX-License-Identifier: BSD-3-Clause
// How signal over noise and interference fades in phase-shift keying, and how long its fades last.
//
// Q = S - t (I - mean I), t a threshold: Q is below t (N + mean I) exactly when S / (N + I) is below t. Both
// are sums over what paths scatter (acoustics/reception/collected_sound.h), so that with c = signal - t
// interference of each
//   K(s) = ln E exp(s Q) = sum of -n ln(1 - c s) + r s / (1 - c s),
// r the slow power that beats with it. Paths that fade together have c of all of them and n < 1; terms of
// alike c count as one. Where Q is y = K'(s), its normal score is z = r + ln(u / r) / r, r = sign(s) sqrt(2
// (s y - K)), u = s sqrt(K'') (saddle point: Lugannani and Rice 1980, Barndorff-Nielsen 1986), accurate to
// some per cent of probability in the deepest tails, too. It falls below y as often a second as the density
// of Q there, exp(K - s y) / sqrt(2 pi K''), times sqrt(V / (2 pi)), V the variance of its slope: 2 c (2 pi
// B)^2 of what each term is there (Rice 1944).
// It stays above y at instants `step` apart, `count` of them, with the probability
//   (1 - p) (1 - q / (1 - p))^((count - 1) (1 + e)),  q = p (1 - p) (1 - exp(-nu / (p (1 - p))))
// p its probability below y, nu the crossings a step; e = 0.27 exp(-(B step / 0.12)^2) because the crossings
// of so smooth a process keep apart: our fit.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "acoustics/reception/collected_sound.h"

namespace halocline::acoustics {

// Instants at which a packet is met.
struct Stretches {
  double count = 1, step_s = 0;
};

// Of a standard normal below `score`, within 1e-4.
double tabulated_probability(double score);

// What Q is the sum of at a threshold, whatever the slow power is: terms of alike scale as one.
class BandTerms {
 public:
  BandTerms(const CollectedSound& sound, double threshold);

  double threshold() const { return threshold_; }
  // How much of the variance of Q interference makes or takes away, while the power that does not fade within
  // a packet is `slow_power`; at most, at any such power.
  double interference_share(double slow_power) const { return share(louder(slow_power)); }
  double most_interference_share() const;

 private:
  friend class BandLaw;
  static constexpr std::size_t kOctaves = 8;
  // Of what beats with the slow power, by the signal and by the interference times the threshold.
  struct Beats {
    double rest = 0, variance = 0, rate = 0;
  };
  struct Octave {
    double mean = 0, variance = 0, rate = 0;
    Beats signal, interference;
  };
  double louder(double slow_power) const { return mean_slow_ > 0 ? slow_power / mean_slow_ : 0; }
  double share(double louder) const;

  double threshold_, mean_slow_, fast_;
  std::array<Octave, 2 * kOctaves> octaves_{};  // of falling positive scales, then negative ones
  // The variance of the signal; of that, what interference changes; each times how loud the slow power is.
  double signal_ = 0, signal_beats_ = 0, changed_ = 0, changed_beats_ = 0;
};

class BandLaw {
 public:
  static constexpr std::size_t kPoints = 14;
  using Values = std::array<double, kPoints>;
  struct Points {
    Values powers{},
        scores{};  // Q is below the power with the probability that a standard normal is below the score
    Values log_parts{};  // of a packet that fall below it independently
  };

  // While the power that does not fade within a packet is `slow_power`.
  BandLaw(const BandTerms& terms, double slow_power);

  double mean() const { return mean_; }
  double variance() const { return variance_; }
  double skewness() const { return skewness_; }
  Points points(const Stretches& stretches) const;  // by rising power; equal ones where nothing fades

 private:
  struct Term {
    double scale, rest, count, rate;  // rate: (2 pi B)^2 times 2 c
  };
  std::span<const Term> terms() const { return {terms_.data(), count_}; }

  std::array<Term, 2 * BandTerms::kOctaves> terms_{};
  std::size_t count_ = 0;  // of those
  double offset_ = 0;      // of the power, beside the terms
  double mean_ = 0, variance_ = 0, skewness_ = 0;
};

}  // namespace halocline::acoustics
