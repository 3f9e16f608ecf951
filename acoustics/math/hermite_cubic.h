// SPDX-License-Identifier: BSD-3-Clause
// The cubic Hermite interpolant through values and slopes at both ends of an interval. It predicts a function
// within a cell of a table, where the function turns, and where it passes a value.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace halocline::acoustics {

// The cubic a + b t + c t^2 + d t^3 over t = 0..1, which represents an interval of width h.
class HermiteCubic {
 public:
  // Values f0, f1 and slopes s0, s1 at both ends; slopes are per unit of the interval's own coordinate.
  //   a = f0,  b = s0 h,  c = 3 (f1 - f0) - (2 s0 + s1) h,  d = 2 (f0 - f1) + (s0 + s1) h
  HermiteCubic(double f0, double s0, double f1, double s1, double h)
      : a_(f0), b_(s0 * h), c_(3 * (f1 - f0) - (2 * s0 + s1) * h), d_(2 * (f0 - f1) + (s0 + s1) * h) {}

  double operator()(double t) const { return a_ + t * (b_ + t * (c_ + t * d_)); }
  double slope(double t) const { return b_ + t * (2 * c_ + t * 3 * d_); }

  // Error of the cubic at t, given the function's value and slope there: the larger of the error of the value
  // and of the effect of the error of the slope over an eighth of the width `h`.
  double error_at(double t, double value, double slope_there, double h) const {
    return std::max(std::abs((*this)(t)-value), std::abs(slope(t) - slope_there * h) / 8);
  }
  double error_at_middle(double value, double slope_there, double h) const {
    return error_at(0.5, value, slope_there, h);
  }

  // The values of t strictly inside 0..1 at which the cubic turns, rising; at most two. They solve
  //   3 d t^2 + 2 c t + b = 0,
  // computed as w / (3 d) and b / w with w = -(c + sign(c) sqrt(c^2 - 3 b d)), which avoids cancellation.
  struct Turns {
    std::array<double, 2> at{};
    int count = 0;
    const double* begin() const { return at.data(); }
    const double* end() const { return at.data() + count; }
  };
  Turns turns() const {
    Turns turns;
    const double a = 3 * d_, disc = c_ * c_ - a * b_;
    if (disc <= 0) return turns;
    const double w = -(c_ + std::copysign(std::sqrt(disc), c_));
    std::array<double, 2> roots = {a != 0 ? w / a : -1, w != 0 ? b_ / w : -1};
    if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    for (const double t : roots) {
      if (t > 0 && t < 1) turns.at[static_cast<std::size_t>(turns.count++)] = t;
    }
    return turns;
  }

  // Least and greatest value over 0..1.
  std::pair<double, double> extremes() const {
    std::pair<double, double> values = std::minmax(a_, (*this)(1));
    for (const double t : turns()) {
      values = {std::min(values.first, (*this)(t)), std::max(values.second, (*this)(t))};
    }
    return values;
  }

  // Least |slope| over 0..1 of a cubic that does not turn there: at an end, or at the inflection -c / (3 d).
  double least_slope() const {
    double least = std::min(std::abs(slope(0)), std::abs(slope(1)));
    const double bend = -c_ / (3 * d_);
    if (bend > 0 && bend < 1) least = std::min(least, std::abs(slope(bend)));
    return least;
  }

  // Approximate t in 0..1 at which the cubic passes `value`, which has to lie between the values at the ends.
  // Meant as a start for Newton's method.
  double crossing(double value) const {
    const double end = (*this)(1);
    const bool rising = end > a_;
    double low = 0, high = 1, t = std::clamp((value - a_) / (end - a_), 0.0, 1.0);
    for (int i = 0; i < 4; ++i) {
      const double error = (*this)(t)-value, along = slope(t);
      ((error > 0) == rising ? high : low) = t;
      const double next = along != 0 ? t - error / along : -1;
      t = next >= low && next <= high ? next : 0.5 * (low + high);
    }
    return t;
  }

 private:
  double a_, b_, c_, d_;
};

}  // namespace halocline::acoustics
