// How long to wait for an answer before a grant is said again: from the answers that came.
//
// Jacobson's estimate (1988): mean plus four mean deviations of the time from grant to answer, smoothed; Karn's
// rule: an answer to what was said twice tells nothing of how long it took. A repetition may be lost like what it
// repeats: only from the third on does the wait double, up to a bound, because then somebody is slow, or away. What a
// participant computes counts as time to the answer.
#pragma once

#include <algorithm>

#include "core/sim_time.h"

namespace halocline::conductor {

class RetransmissionTimer {
 public:
  static constexpr SimDuration kMin = SimDuration::from_microseconds(1000);
  static constexpr SimDuration kAtFirst = SimDuration::from_milliseconds(20);
  static constexpr SimDuration kMax = SimDuration::from_milliseconds(200);

  // A grant is said, for the first time or again. Steady time.
  void say(SimTime steady) {
    if (times_said_++ == 0) first_said_ = steady;
    const int doublings = std::clamp(times_said_ - 3, 0, 10);
    again_at_ = steady + std::min(estimate() * (std::int64_t{1} << doublings), kMax);
  }
  // Its answer came.
  void answered(SimTime steady) {
    if (times_said_ == 1) learn(steady - first_said_);
    times_said_ = 0;
    again_at_ = SimTime::never();
  }
  // When it is to be said again; never() while nothing waits for an answer.
  SimTime again_at() const { return again_at_; }
  int times_said() const { return times_said_; }

 private:
  SimDuration estimate() const { return known_ ? std::clamp(mean_ + deviation_ * 4, kMin, kMax) : kAtFirst; }
  void learn(SimDuration took) {
    if (!known_) {
      mean_ = took;
      deviation_ = SimDuration::from_nanoseconds(took.nanoseconds() / 2);
      known_ = true;
      return;
    }
    const std::int64_t error = (took - mean_).nanoseconds();
    mean_ = SimDuration::from_nanoseconds(mean_.nanoseconds() + error / 8);
    deviation_ = SimDuration::from_nanoseconds(deviation_.nanoseconds() +
                                               ((error < 0 ? -error : error) - deviation_.nanoseconds()) / 4);
  }

  bool known_ = false;
  SimDuration mean_, deviation_;
  int times_said_ = 0;
  SimTime first_said_, again_at_ = SimTime::never();
};

}  // namespace halocline::conductor
