// SPDX-License-Identifier: BSD-3-Clause
// Gauss-Markov (Ornstein-Uhlenbeck) process as a function of time: stationary, variance sigma^2, correlation
// exp(-|t| / T).
//
// The value at an instant is one fixed number, whatever the step and the order of evaluation: the process is
// built from its ends inwards (Levy's construction). It is drawn at 0 and at 2^36 ms (two years; later
// instants have that value), then at the middle of each interval given both ends a and b. For a Gauss-Markov
// process this is exact: with h half the interval and c = exp(-h / T),
//
//   mean      (a + b) c / (1 + c^2),
//   variance  sigma^2 (1 - c^2) / (1 + c^2)
//
// (Rasmussen and Williams 2006, appendix B). Each draw is addressed by its millisecond (core/random.h). At
// whole milliseconds the process is exact in distribution; between them it is interpolated linearly, so its
// derivative exists.
//
// random_walk() is the limit of a long correlation time with a start from 0: a Wiener process, whose middles
// have
//
//   mean      (a + b) / 2,
//   variance  s^2 h / 2.
//
// The functions have no side effects. A Cursor keeps the latest draws so that neighbouring instants cost two
// draws instead of 37; results do not depend on it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "core/sim_time.h"

namespace halocline {

class GaussMarkovProcess {
 public:
  // `deviation` (any unit) 0 or above; `correlation_time_s` 0.1 to 1e6. `address.which` is not used.
  GaussMarkovProcess(double deviation, double correlation_time_s, const DrawAddress& address);

  // Random walk with x(0) = 0 and standard deviation step sqrt(t) after t seconds; `step_per_sqrt_s` 0 or
  // above.
  static GaussMarkovProcess random_walk(double step_per_sqrt_s, const DrawAddress& address);

  class Cursor;

  // Returns the value at `time` (before 0: that at 0).
  double at(SimTime time) const;
  // Returns the same, using the working memory of one caller.
  double at(SimTime time, Cursor& cursor) const;

 private:
  struct Middle {
    double weight, deviation;  // factor of the sum of both ends; deviation of the draw
  };
  explicit GaussMarkovProcess(const DrawAddress& address) : address_(address) {}
  double draw(std::int64_t millisecond) const;
  double at_millisecond(std::int64_t k, Cursor& cursor) const;

  double deviation_ = 0;                              // at 0
  double last_correlation_ = 0, last_deviation_ = 0;  // distribution of the last value, given the first
  bool is_zero_ = false;
  DrawAddress address_;
  std::vector<Middle> middles_;  // indexed by the depth of the halving, widest first
};

class GaussMarkovProcess::Cursor {
  friend class GaussMarkovProcess;
  struct Bracket {
    std::int64_t from, to;
    double at_from, at_to;
  };
  std::vector<Bracket> path_;  // each within the previous one
};

}  // namespace halocline
