// SPDX-License-Identifier: BSD-3-Clause
// Means of exp(-scale power) over the time and band of a packet whose block fading is constant; they
// determine the bit errors of frequency-shift keying (acoustics/prediction/link_prediction.h). Up to kMax
// states are computed together as vectors.
#pragma once

#include <array>
#include <cstddef>

#include "acoustics/prediction/medium_states.h"

namespace halocline::acoustics {

// Accumulates states with add(), then computes their means with finish().
class ExponentialMeans {
 public:
  static constexpr std::size_t kMax = kMediumStates;
  using Values = std::array<double, kMax>;

  // The power that fades within a packet: its mean, and the variance of its mean over the bits, by itself
  // (`own`) and by cross terms per unit of block-fading power (`cross_terms`). With
  // `cross_terms_within_parts`, coherent paths interfere within each part of the band: an uncoded bit is
  // received at one frequency of each part and is exposed to that interference.
  struct Fast {
    double power = 0, own = 0, cross_terms = 0;
    bool cross_terms_within_parts = false;
  };
  explicit ExponentialMeans(const Fast& fast) : fast_(fast) {}

  // Adds a state, at most kMax of them, with the `scale` of its power; call finish() after the last.
  void add(const BlockFading& block_fading, double scale);
  void finish();

  // The negative logarithm of the mean, and its relative variance over the fast fading; `i` counts the states
  // in the order in which they were added.
  double nepers(std::size_t i) const { return cells_.nepers[i]; }
  double variance(std::size_t i) const { return cells_.variance[i]; }
  // The effective ratio of the cells times the scale, log-normal, dB.
  struct Ratios {
    Values medians_db, deviations_db;
  };
  Ratios ratios() const;

  // Intermediate results, one entry for each state.
  struct Cells {
    std::size_t count = 0;
    Values scale, block_power, least, mean, variance, nepers;
  };

 private:
  Fast fast_;
  Cells cells_;
};

}  // namespace halocline::acoustics
