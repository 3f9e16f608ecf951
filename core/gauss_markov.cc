// SPDX-License-Identifier: BSD-3-Clause
#include "core/gauss_markov.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline {
namespace {

constexpr int kHalvings = 36;
constexpr std::int64_t kLast = std::int64_t{1} << kHalvings;  // ms
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;

}  // namespace

// Distribution at the middle of an interval of length 2 h with ends a and b, c = exp(-h / T):
//
//   mean      (a + b) c / (1 + c^2),
//   variance  sigma^2 (1 - c^2) / (1 + c^2)
//
// (Rasmussen and Williams 2006, appendix B, conditioned on both ends).
GaussMarkovProcess::GaussMarkovProcess(double deviation, double correlation_time_s,
                                       const DrawAddress& address)
    : deviation_(deviation), is_zero_(deviation == 0), address_(address) {
  require_in_range(deviation, 0, 1e9, "standard deviation");
  require_in_range(correlation_time_s, 0.1, 1e6, "correlation time", "s");
  for (int i = 0; i < kHalvings; ++i) {
    const double half_s = static_cast<double>(kLast >> (i + 1)) / 1000;
    const double c = elementary::exp(-half_s / correlation_time_s);
    middles_.push_back(
        {c / (1 + c * c),
         deviation * std::sqrt(-elementary::expm1(-2 * half_s / correlation_time_s) / (1 + c * c))});
  }
  last_correlation_ = elementary::exp(-static_cast<double>(kLast) / 1000 / correlation_time_s);
  last_deviation_ = deviation * std::sqrt(1 - last_correlation_ * last_correlation_);
}

GaussMarkovProcess GaussMarkovProcess::random_walk(double step_per_sqrt_s, const DrawAddress& address) {
  require_in_range(step_per_sqrt_s, 0, 1e9, "step of a random walk", "1/sqrt(s)");
  GaussMarkovProcess walk(address);
  walk.is_zero_ = step_per_sqrt_s == 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double half_s = static_cast<double>(kLast >> (i + 1)) / 1000;
    walk.middles_.push_back({0.5, step_per_sqrt_s * std::sqrt(half_s / 2)});
  }
  walk.last_correlation_ = 1;
  walk.last_deviation_ = step_per_sqrt_s * std::sqrt(static_cast<double>(kLast) / 1000);
  return walk;
}

double GaussMarkovProcess::draw(std::int64_t millisecond) const {
  DrawAddress address = address_;
  address.which = static_cast<std::uint64_t>(millisecond);
  return normal_at(address);
}

// Levy's construction: first the ends of the process,
//
//   x(0) = sigma z_0,    x(end) = c x(0) + sigma sqrt(1 - c^2) z_end,    c = exp(-end / T),
//
// then the middles of the intervals that contain k.
double GaussMarkovProcess::at_millisecond(std::int64_t k, Cursor& cursor) const {
  auto& path = cursor.path_;
  if (path.empty()) {
    const double first = deviation_ * draw(0);
    path.push_back({0, kLast, first, last_correlation_ * first + last_deviation_ * draw(kLast)});
  }
  while (path.size() > 1 && (k < path.back().from || k > path.back().to)) path.pop_back();
  while (k != path.back().from && k != path.back().to) {
    const Cursor::Bracket in = path.back();
    const std::int64_t middle = (in.from + in.to) / 2;
    const Middle& m = middles_[path.size() - 1];
    const double value = m.weight * (in.at_from + in.at_to) + m.deviation * draw(middle);
    path.push_back(k <= middle ? Cursor::Bracket{in.from, middle, in.at_from, value}
                               : Cursor::Bracket{middle, in.to, value, in.at_to});
  }
  return k == path.back().from ? path.back().at_from : path.back().at_to;
}

double GaussMarkovProcess::at(SimTime time, Cursor& cursor) const {
  if (is_zero_) return 0;
  const std::int64_t ns = std::clamp<std::int64_t>(time.nanoseconds(), 0, kLast * kNanosecondsPerMillisecond);
  const std::int64_t k = ns / kNanosecondsPerMillisecond, rest = ns % kNanosecondsPerMillisecond;
  const double value = at_millisecond(k, cursor);
  if (rest == 0) return value;
  const double share = static_cast<double>(rest) / static_cast<double>(kNanosecondsPerMillisecond);
  return value + share * (at_millisecond(k + 1, cursor) - value);
}

double GaussMarkovProcess::at(SimTime time) const {
  Cursor cursor;
  return at(time, cursor);
}

}  // namespace halocline
