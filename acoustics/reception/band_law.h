// How the power of a band is distributed that interference which fades with it opposes.
//
// Q = S - t (I - mean I), t a threshold: Q is below t (N + mean I) exactly when S / (N + I) is below t. Of scattered sound both
// are sums over the modes of acoustics/reception/mean_sound.h, so that with c_j = scattered_j - t interference_j
//   K(s) = ln E exp(s Q) = sum of -ln(1 - c_j s) + rest_j s (1 + s scattered_j / (1 - c_j s)),
// and so for what fades apart from the signal.
// Where Q is y = K'(s), its normal score is z = r + ln(u / r) / r, r = sign(s) sqrt(2 (s y - K)), u = s sqrt(K'') (saddle point:
// Lugannani and Rice 1980, Barndorff-Nielsen 1986), accurate to some per cent of probability in the deepest tails, too.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "acoustics/reception/mean_sound.h"

namespace halocline::acoustics {

struct BandPoint {
  double power = 0,
         score = 0;  // Q is below the power with the probability that a standard normal is below the score
};

class BandLaw {
 public:
  static constexpr std::size_t kPoints = 13;
  using Points = std::array<BandPoint, kPoints>;

  // The modes while the power that does not fade within a packet is `slow_power`.
  BandLaw(const MeanSound& sound, double threshold, double slow_power);

  double mean() const { return mean_; }
  double variance() const { return variance_; }
  double skewness() const { return skewness_; }
  Points points() const;  // by rising power; equal ones where nothing fades

 private:
  struct Term {
    double scale, rest, beats;  // beats: rest times scattered
    double count;               // equal ones
  };
  std::span<const Term> terms() const { return {terms_.data(), count_}; }

  std::array<Term, kSignalFrequencies + 1> terms_{};
  std::size_t count_ = 0;  // of those
  double offset_ = 0;      // of the power, beside the terms
  double mean_ = 0, variance_ = 0, skewness_ = 0;
};

}  // namespace halocline::acoustics
