#include "acoustics/reception/band_law.h"

#include <algorithm>
#include <cmath>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"

namespace halocline::acoustics {
namespace {

// s in units of 1 / deviation, or of what the greatest term allows.
constexpr std::array<double, 9> kBelow{-1000, -200, -50, -16, -7, -3.5, -2, -1.1, -0.45};
constexpr std::array<double, 3> kAbove{0.4, 0.8, 0.95};
constexpr double kMostAbove = 3;  // deviations

}  // namespace

BandLaw::BandLaw(const MeanSound& sound, double threshold, double slow_power) {
  const double slow_mean = sound.coherent_power() + sound.medium[0].real(),
               louder = slow_mean > 0 ? slow_power / slow_mean : 0;
  double rest = slow_power, squares = 0;
  for (const BandMode& mode : sound.modes) {
    const Term term{mode.scattered - threshold * mode.interference, louder * mode.rest,
                    louder * mode.rest * mode.scattered, 1};
    rest -= term.rest;
    squares += squared(term.scale);
    terms_[count_++] = term;
  }
  // What fades in no mode: as many equal terms as the variance of all tells.
  if (const double apart = threshold * sound.apart; apart > 1e-9 * slow_power) {
    const double own =
        sound.shared.own - 2 * threshold * sound.shared.xy + squared(threshold) * sound.shared.yy - squares;
    const double count = std::clamp(squared(apart) / std::max(own, 1e-30), 1.0, 100.0);
    terms_[count_++] = {-apart / count, 0, 0, count};
  }
  offset_ = std::max(rest, 0.0) + threshold * sound.shared.y;
  double third = 0;
  mean_ = offset_;
  for (const Term& term : terms()) {
    mean_ += term.count * term.scale + term.rest;
    variance_ += term.count * squared(term.scale) + 2 * term.beats;
    third += 2 * term.count * term.scale * squared(term.scale) + 6 * term.scale * term.beats;
  }
  variance_ = std::max(variance_, 0.0);
  if (variance_ > 0) skewness_ = third / (variance_ * std::sqrt(variance_));
}

BandLaw::Points BandLaw::points() const {
  Points points;
  points.fill({mean_, 0});
  if (!(variance_ > 1e-9 * squared(mean_))) {
    for (std::size_t i = 0; i < kPoints; ++i)
      points[i].score = -4 + 7.0 * static_cast<double>(i) / (kPoints - 1);
    return points;
  }
  const double deviation = std::sqrt(variance_);
  double least = -1e30, most = kMostAbove / deviation;  // of s
  for (const Term& term : terms()) {
    if (term.scale > 0) most = std::min(most, 1 / term.scale);
    if (term.scale < 0) least = std::max(least, 1 / term.scale);
  }
  const auto point = [&](double s) {
    double k = 0, first = 0, second = 0, product = 1;
    for (const Term& term : terms()) {
      const double a = 1 / (1 - term.scale * s), beats = term.beats * a;
      if (term.count == 1) {
        product *= a;
      } else {
        k += term.count * fast_log(a);
      }
      k += s * (term.rest + s * beats);
      first += term.count * term.scale * a + term.rest + beats * s * (2 - term.scale * s) * a;
      second += term.count * squared(term.scale * a) + 2 * beats * a * a;
    }
    k += fast_log(product);
    const double r = std::copysign(std::sqrt(std::max(2 * (s * first - k), 1e-12)), s);
    const double u = s * std::sqrt(std::max(second, 1e-30));
    return BandPoint{offset_ + first, r + fast_log(u / r) / r};
  };
  std::size_t i = 0;
  for (const double below : kBelow) {
    // Toward the end that negative terms set, never at it.
    const double s = below / deviation;
    points[i++] = point(s * least / (least + s));
  }
  points[i++] = {mean_, skewness_ / 6};
  for (const double above : kAbove) points[i++] = point(above * most);
  return points;
}

}  // namespace halocline::acoustics
