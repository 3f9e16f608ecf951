// SPDX-License-Identifier: BSD-3-Clause
// A waveform over one link whose ends, and so its paths, move: a sum of delayed, turned and weighed copies.
//
// Model. The paths of the link are known for departures t_k of equal distance. Between two of them the delay
// tau of a path and its gain g, complex as it turns the phase, are linear in the instant of departure. What
// left at u arrives at t = u + tau(u), so that
//   y(t) = sum over paths of Re[g(u) x_a(u)],  u the solution of u + tau(u) = t:
// each path has the Doppler shift of its own, 1 / (1 + d tau / du), on all frequencies alike, and compresses
// and stretches what it carries. A path that one of the two does not know rises from nothing, or falls to it,
// between them, while its delay goes on by its Doppler shift. The gain is that of the band's centre for all
// frequencies. Left out: absorption over the band, and what of the gain's change with the Doppler shift is no
// change of level.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "acoustics/waveform/analytic_signal.h"

namespace halocline::acoustics {

struct PathGain {
  std::uint64_t identity = 0;  // of the same path at another instant
  double delay_s = 0;
  std::complex<double> gain = 0;  // received over sent pressure, that at 1 m
  double doppler_factor = 1;      // received over sent frequency, above 0
};

// Samples of equal distance from an instant on.
struct Samples {
  double begin_s = 0, rate_hz = 1;
  std::vector<double> values;
};

class MovingLink {
 public:
  // frames[k]: the paths of what leaves at begin_s + k step_s. Throws InvalidArgument unless there are two at
  // least, the step is above 0, and no path becomes shorter by as much as time passes.
  MovingLink(double begin_s, double step_s, std::vector<std::vector<PathGain>> frames);

  // Of any of its paths; 0 without one.
  double longest_delay_s() const;
  // Adds what arrives of `sent`, whose first sample leaves at `departure_s`: what leaves while the link is
  // known.
  void add_received(const AnalyticSignal& sent, double departure_s, Samples& received) const;

 private:
  struct Span {  // of one path between two frames
    double begin_s;
    double delay_s, delay_end_s;
    std::complex<double> gain, gain_end;
  };
  void add_span(const Span& span, const AnalyticSignal& sent, double departure_s, Samples& received) const;

  double step_s_;
  std::vector<Span> spans_;
};

}  // namespace halocline::acoustics
