// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/noise/noise_variation.h"

#include <numbers>

#include "core/check.h"
#include "core/elementary.h"
#include "core/gauss_markov.h"
#include "core/random.h"

namespace halocline::acoustics {

namespace {

constexpr double kDayS = 86'400;

Decibels rise_by_night(const NoiseVariation& variation, SimTime at) {
  if (variation.day_night_db == 0) return {0};
  const double turn = 2 * std::numbers::pi * (at.seconds() - variation.noon_s) / kDayS;
  return {variation.day_night_db * (1 - elementary::cos(turn)) / 2};
}

}  // namespace

void validate(const NoiseVariation& v) {
  require_in_range(v.spread_db, 0, 30, "spread of the noise", "dB");
  require_in_range(v.spread_time_s, 0.1, 1e6, "correlation time of the noise", "s");
  require(v.burst_exponent == 0 || (v.burst_exponent >= 0.5 && v.burst_exponent <= 2),
          "the exponent of impulsive noise is 0 (none), or 0.5 to 2");
  require_in_range(v.burst_level.value, -100, 100, "level of impulsive noise", "dB");
  require_in_range(v.burst.seconds(), 1e-3, 60, "duration of a burst of noise", "s");
  require_in_range(v.day_night_db, 0, 20, "rise of the noise by night", "dB");
  require_in_range(v.noon_s, -1e6, 1e6, "time of noon", "s");
}

Decibels noise_offset(const NoiseVariation& variation, std::uint64_t seed, SimTime at) {
  const Decibels of_day = rise_by_night(variation, at);
  if (variation.spread_db == 0) return of_day;
  const DrawAddress address{.seed = seed, .purpose = purpose_of("noise-spread")};
  const double sigma = variation.spread_db;
  return of_day + Decibels{GaussMarkovProcess(sigma, variation.spread_time_s, address).at(at) -
                           sigma * sigma * std::numbers::ln10 / 20};
}

double burst_power(double exponent, std::uint64_t seed, std::uint32_t receiver, std::int64_t burst) {
  constexpr std::uint32_t kAngle = purpose_of("noise-burst-angle"), kSize = purpose_of("noise-burst-size");
  const auto draw = [&](std::uint32_t purpose) {
    return uniform_at(
        {.seed = seed, .purpose = purpose, .who = receiver, .which = static_cast<std::uint64_t>(burst)});
  };
  // The logarithm of A = sin(a U) / sin(U)^(1 / a) (sin((1 - a) U) / W)^((1 - a) / a) (Kanter 1975).
  const double a = exponent / 2;
  if (a >= 1) return 1;
  const double u = std::numbers::pi * draw(kAngle), w = -elementary::log(draw(kSize));
  const auto log_sin = [](double angle) { return elementary::log(elementary::sin(angle)); };
  return elementary::exp(log_sin(a * u) - log_sin(u) / a +
                         (1 - a) / a * (log_sin((1 - a) * u) - elementary::log(w)));
}

}  // namespace halocline::acoustics
