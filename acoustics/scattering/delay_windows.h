// SPDX-License-Identifier: BSD-3-Clause
// Windows of delay of turned sound.
//
// Model. The sound that arrives by way of one state has a gamma distribution of delay, of its mean and
// variance, here as eight parts of equal power at its quantiles (Wilson and Hilferty 1931; the low
// ones of a wide distribution by its power law), scaled to the mean. All parts of both directions of a link
// stand in a histogram, 16 bins an e-fold of excess delay, each part in the two bins beside it; windows are
// cut at quantiles of the whole. A bin that a quantile cuts is divided in proportion, so windows move without
// steps.
#pragma once

#include <vector>

#include "acoustics/scattering/turned_sound.h"

namespace halocline::acoustics {

inline constexpr std::size_t kMaxDelayWindows = 16;

// One window: a share of the power at one delay.
struct DelayWindow {
  double power = 0;         // re 1 m
  double excess_s = 0;      // mean delay in excess of TurnedSound::reference_s
  double launch_sine = 0;   // rms sine of the launch angle at the first end
  double arrival_sine = 0;  // rms sine of the angle at the other end
};

// Turned sound of a link from both ends: its power is the mean of the two.
class DelaySpectrum {
 public:
  DelaySpectrum(const TurnedSound& forward, const TurnedSound& backward);

  double power() const { return power_; }  // re 1 m
  // At most kMaxDelayWindows windows by rising delay; none without power.
  std::vector<DelayWindow> windows() const;

 private:
  struct Bin {
    double power = 0, delay = 0;            // sums, the delay weighted by power
    double launch = 0, launch_power = 0;    // of sin^2 and of power, forward
    double arrival = 0, arrival_power = 0;  // likewise, backward
  };
  void add(const TurnedSound& sound, bool forward);

  std::vector<Bin> bins_;
  double power_ = 0;
};

}  // namespace halocline::acoustics
