// SPDX-License-Identifier: BSD-3-Clause
// Means over a packet's time and band of exp(-scale power) while its slow fading holds: what decides of
// frequency-shift keying (acoustics/reception/link_prediction.h). Many states are computed together, as
// vectors.
#pragma once

#include <array>
#include <cstddef>

#include "acoustics/reception/medium_states.h"

namespace halocline::acoustics {

class ExponentialMeans {
 public:
  static constexpr std::size_t kMax = kMediumStates;
  using Values = std::array<double, kMax>;

  // What fades within a packet: its mean power; the variance of its mean over the bits, by itself and by its
  // beats over the slow power. Single errors, which are met at one place of each part of the band, feel how
  // coherent paths beat within it.
  struct Fast {
    double power = 0, own = 0, beats = 0;
    bool beats_within_parts = false;
  };
  explicit ExponentialMeans(const Fast& fast) : fast_(fast) {}

  // kMax at most; then finish().
  void add(const SlowSound& slow, double scale);
  void finish();

  // -ln of the mean, and its relative variance over the fast fading, in the order of adding.
  double nepers(std::size_t i) const { return cells_.nepers[i]; }
  double variance(std::size_t i) const { return cells_.variance[i]; }
  // Scale times the effective ratio of the cells, log-normal, dB.
  struct Ratios {
    Values medians_db, deviations_db;
  };
  Ratios ratios() const;

  struct Cells {
    std::size_t count = 0;
    Values scale, slow_power, least, mean, variance, nepers;
  };

 private:
  Fast fast_;
  Cells cells_;
};

}  // namespace halocline::acoustics
