// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/waveform/moving_link.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/check.h"

namespace halocline::acoustics {

MovingLink::MovingLink(double begin_s, double step_s, std::vector<std::vector<PathGain>> frames)
    : step_s_(step_s) {
  require(frames.size() >= 2, "a moving link needs its paths at two instants at least");
  require(std::isfinite(step_s) && step_s > 0, "the instants of a moving link must be apart");
  for (auto& paths : frames) {
    std::stable_sort(paths.begin(), paths.end(),
                     [](const PathGain& a, const PathGain& b) { return a.identity < b.identity; });
  }
  for (std::size_t k = 0; k + 1 < frames.size(); ++k) {
    const double at_s = begin_s + static_cast<double>(k) * step_s;
    // Change of delay over a step, d tau / du = 1 / D - 1, for a path that is known at one instant only.
    const auto moved_s = [&](const PathGain& path) { return step_s * (1 / path.doppler_factor - 1); };
    auto old = frames[k].begin(), next = frames[k + 1].begin();
    while (old != frames[k].end() || next != frames[k + 1].end()) {
      const bool has_old =
          old != frames[k].end() && (next == frames[k + 1].end() || old->identity <= next->identity);
      const bool has_next =
          next != frames[k + 1].end() && (old == frames[k].end() || next->identity <= old->identity);
      if (has_old && has_next) {
        spans_.push_back({at_s, old->delay_s, next->delay_s, old->gain, next->gain});
      } else if (has_old) {
        spans_.push_back({at_s, old->delay_s, old->delay_s + moved_s(*old), old->gain, 0});
      } else {
        spans_.push_back({at_s, next->delay_s - moved_s(*next), next->delay_s, 0, next->gain});
      }
      require(step_s + spans_.back().delay_end_s > spans_.back().delay_s,
              "a path of a moving link becomes shorter faster than sound travels");
      if (has_old) ++old;
      if (has_next) ++next;
    }
  }
}

double MovingLink::longest_delay_s() const {
  double longest_s = 0;
  for (const Span& span : spans_) longest_s = std::max({longest_s, span.delay_s, span.delay_end_s});
  return longest_s;
}

void MovingLink::add_received(const AnalyticSignal& sent, double departure_s, Samples& received) const {
  for (const Span& span : spans_) {
    if (span.begin_s + step_s_ < departure_s || span.begin_s > departure_s + sent.duration_s()) continue;
    add_span(span, sent, departure_s, received);
  }
}

// Adds a path's contribution to the samples from begin + delay up to, but not including, end + delay at the
// end.
void MovingLink::add_span(const Span& span, const AnalyticSignal& sent, double departure_s,
                          Samples& received) const {
  const double slope = (span.delay_end_s - span.delay_s) / step_s_;
  const double per_slope = 1 / (1 + slope);
  const std::complex<double> gain_slope = (span.gain_end - span.gain) / step_s_;
  const double first_s = span.begin_s + span.delay_s, end_s = span.begin_s + step_s_ + span.delay_end_s;
  const auto index = [&](double time_s) {
    return static_cast<std::ptrdiff_t>(std::ceil((time_s - received.begin_s) * received.rate_hz));
  };
  const auto last = std::min(index(end_s), std::ssize(received.values));
  for (auto n = std::max<std::ptrdiff_t>(index(first_s), 0); n < last; ++n) {
    const double at_s = received.begin_s + static_cast<double>(n) / received.rate_hz;
    const double left_after_s = (at_s - first_s) * per_slope;  // departure, after span.begin_s
    const std::complex<double> gain = span.gain + left_after_s * gain_slope;
    const std::complex<double> x = sent.at(span.begin_s + left_after_s - departure_s);
    received.values[static_cast<std::size_t>(n)] += gain.real() * x.real() - gain.imag() * x.imag();
  }
}

}  // namespace halocline::acoustics
