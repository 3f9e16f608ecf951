// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/slow_fading.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "acoustics/math/functions.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/gauss_markov.h"
#include "core/random.h"

namespace halocline::acoustics {
namespace {

using std::numbers::ln10;
using std::numbers::pi;

constexpr double kLunarTideS = 44714.16;  // period of M2
constexpr double kDayS = 86400;

// Modified Bessel function I0 by its power series, sum of (x / 2)^(2 k) / (k!)^2, for 0 <= x <= 5.
double bessel_i0(double x) {
  double term = 1, sum = 1;
  for (int k = 1; k <= 24; ++k) {
    term *= squared(x / (2 * k));
    sum += term;
  }
  return sum;
}

// Mean of a normal level that leaves the mean power at 1:  -sigma^2 ln(10) / 20.
double mean_of_normal(double deviation_db) { return -deviation_db * deviation_db * ln10 / 20; }

// The same for a cosine of random phase:  -10 log10 I0(A ln(10) / 10).
double mean_of_cosine(double amplitude_db) {
  return -10 * elementary::log10(bessel_i0(amplitude_db * ln10 / 10));
}

DrawAddress address_of(const SlowPair& pair, std::string_view purpose) {
  const std::uint64_t both = std::uint64_t{pair.lower_id} << 32 | pair.higher_id;
  return {.seed = identity_of({pair.seed, both}), .purpose = purpose_of(purpose)};
}

constexpr std::int64_t kStepMs = 1 << 16;  // a power of two, which the halvings of the process meet

std::int64_t step_of(SimTime at) { return std::max<std::int64_t>(at.nanoseconds() / 1'000'000 / kStepMs, 0); }

SlowLevels::Draws draws_of(const SlowFading& model, const SlowPair& pair, std::int64_t step) {
  SlowLevels::Draws draws{.step = step};
  if (model.deviation_db > 0) {
    const GaussMarkovProcess process(model.deviation_db, model.time_s, address_of(pair, "slow-fading"));
    GaussMarkovProcess::Cursor cursor;
    const auto at = [&](std::int64_t k) {
      return process.at(SimTime() + SimDuration::from_milliseconds(k * kStepMs), cursor);
    };
    draws.from_db = at(step);
    draws.to_db = at(step + 1);
  }
  draws.tide = uniform_at(address_of(pair, "slow-fading-tide"));
  draws.day = uniform_at(address_of(pair, "slow-fading-day"));
  return draws;
}

double cosine_level(double amplitude_db, double period_s, double time_s, double phase) {
  if (amplitude_db == 0) return 0;
  const double cycles = time_s / period_s + phase;
  return amplitude_db * elementary::cos(2 * pi * (cycles - std::floor(cycles))) +
         mean_of_cosine(amplitude_db);
}

Decibels level_of(const SlowFading& model, const SlowLevels::Draws& draws, SimTime at) {
  const double time_s = std::max(at.seconds(), 0.0);
  const double share = time_s / (kStepMs / 1000.0) - static_cast<double>(draws.step);
  return {draws.from_db + share * (draws.to_db - draws.from_db) + mean_of_normal(model.deviation_db) +
          cosine_level(model.tidal_db, kLunarTideS, time_s, draws.tide) +
          cosine_level(model.daily_db, kDayS, time_s, draws.day)};
}

}  // namespace

double SlowFading::rms_db() const {
  return std::sqrt(squared(deviation_db) + (squared(tidal_db) + squared(daily_db)) / 2);
}

void validate(const SlowFading& model) {
  require_in_range(model.deviation_db, 0, 20, "standard deviation of slow fading", "dB");
  require_in_range(model.time_s, 0.1, 1e6, "correlation time of slow fading", "s");
  require_in_range(model.tidal_db, 0, 20, "amplitude of tidal fading", "dB");
  require_in_range(model.daily_db, 0, 20, "amplitude of daily fading", "dB");
}

Decibels slow_level(const SlowFading& model, const SlowPair& pair, SimTime at) {
  return model.any() ? level_of(model, draws_of(model, pair, step_of(at)), at) : Decibels{0};
}

Decibels SlowLevels::at(const SlowPair& pair, SimTime at) {
  if (!model_.any()) return {0};
  if (kept_.size() >= kMaxPairs) kept_.clear();
  Draws& draws = kept_[{pair.seed, pair.lower_id, pair.higher_id}];
  if (draws.step != step_of(at)) draws = draws_of(model_, pair, step_of(at));
  return level_of(model_, draws, at);
}

// The normal parts add to one normal variable; the cosines are averaged over equidistant phases. Bisection of
// P(Y - Z < x) = mean over phases of Phi((x - mean - A_t cos - A_d cos) / s).
MarginQuantiles margin_quantiles(const SlowFading& model, double noise_spread_db) {
  if (!model.any() && noise_spread_db == 0) return {};
  constexpr int kPhases = 16;         // in half a turn, of each cosine
  constexpr double kNarrowest = 0.1;  // dB, keeps the mean over phases smooth when nothing else varies
  const double deviation = std::max(elementary::hypot(model.deviation_db, noise_spread_db), kNarrowest);
  const double mean = mean_of_normal(model.deviation_db) + mean_of_cosine(model.tidal_db) +
                      mean_of_cosine(model.daily_db) - mean_of_normal(noise_spread_db);
  const auto cosine = [](int i) { return elementary::cos(pi * (i + 0.5) / kPhases); };
  const auto share_below = [&](double margin_db) {
    double share = 0;
    for (int i = 0; i < kPhases; ++i) {
      for (int k = 0; k < kPhases; ++k) {
        const double middle = mean + model.tidal_db * cosine(i) + model.daily_db * cosine(k);
        share += normal_probability((margin_db - middle) / deviation);
      }
    }
    return share / (kPhases * kPhases);
  };
  const auto quantile = [&](double share) {
    const double widest = 6 * deviation + model.tidal_db + model.daily_db;
    double low = mean - widest, high = mean + widest;
    while (high - low > 0.002) {
      const double middle = (low + high) / 2;
      (share_below(middle) < share ? low : high) = middle;
    }
    return (low + high) / 2;
  };
  return {quantile(0.1), quantile(0.9)};
}

}  // namespace halocline::acoustics
