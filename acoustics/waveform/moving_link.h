// SPDX-License-Identifier: BSD-3-Clause
// A waveform over one link with moving ends: a sum of copies that are delayed, turned in phase and weighted.
//
// Model. The paths of the link are known for equidistant instants of departure t_k. Between two of them the
// delay tau of a path and its complex gain g are linear in the instant of departure. A sample that departs at
// u arrives at t = u + tau(u), so that
//   y(t) = sum over paths of  Re[g(u) x_a(u)],  u the solution of u + tau(u) = t.
// Each path has its own Doppler factor 1 / (1 + d tau / du), equal for all frequencies, and compresses or
// stretches the waveform. A path known at only one of the two instants fades in or out between them, while
// its delay changes by its Doppler factor. The gain at the centre of the band is used for all frequencies.
// Left out: absorption over the band; changes of the gain by the Doppler shift other than those of level.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "acoustics/waveform/analytic_signal.h"

namespace halocline::acoustics {

// A path at one instant of departure.
struct PathGain {
  std::uint64_t identity = 0;  // equal for the same path at other instants
  double delay_s = 0;
  std::complex<double> gain = 0;  // received pressure over sent pressure at 1 m
  double doppler_factor = 1;      // received over sent frequency, above 0
};

// Equidistant samples from an instant on.
struct Samples {
  double begin_s = 0, rate_hz = 1;
  std::vector<double> values;
};

// The paths of a link over time.
class MovingLink {
 public:
  // frames[k] has the paths for departure at begin_s + k step_s. Throws InvalidArgument unless there are at
  // least two frames, the step is above 0, and every delay decreases by less than the time that passes.
  MovingLink(double begin_s, double step_s, std::vector<std::vector<PathGain>> frames);

  // Longest delay of all paths; 0 without a path.
  double longest_delay_s() const;
  // Adds the received waveform of `sent`, whose first sample departs at `departure_s`. Only what departs
  // while the link is known is added.
  void add_received(const AnalyticSignal& sent, double departure_s, Samples& received) const;

 private:
  // A path between two frames.
  struct Span {
    double begin_s;
    double delay_s, delay_end_s;
    std::complex<double> gain, gain_end;
  };
  void add_span(const Span& span, const AnalyticSignal& sent, double departure_s, Samples& received) const;

  double step_s_;
  std::vector<Span> spans_;
};

}  // namespace halocline::acoustics
