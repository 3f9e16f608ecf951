#include "acoustics/reception/band_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// s in units of 1 / deviation.
constexpr std::array<double, 8> kBelow{-500, -90, -28, -11, -5, -2.4, -1, -0.35};
constexpr std::array<double, 5> kAbove{0.5, 1.5, 5, 30, 300};

constexpr double kMostScore = 6;

// By score, linear between.
constexpr std::size_t kScoreRows = 241;
constexpr double kScoreStep = 2 * kMostScore / (kScoreRows - 1);
const std::array<double, kScoreRows> kProbabilities = [] {
  std::array<double, kScoreRows> made{};
  for (std::size_t i = 0; i < kScoreRows; ++i) {
    made[i] = normal_probability(-kMostScore + kScoreStep * static_cast<double>(i));
  }
  return made;
}();

// Sums of terms of alike scale.
struct Octave {
  double mean = 0, variance = 0, rest = 0, rest_variance = 0, rate = 0;
};

// ln of the parts of a packet that fall independently below what is fallen below with the score, `crossings` a stretch.
double log_parts(double score, double crossings, double turns, double stretches) {
  // Below the table by the tail of the normal distribution.
  const double p = score > -4 ? std::min(tabulated_probability(score), 1 - 1e-9)
                              : fast_exp(-score * score / 2) / (std::sqrt(2 * pi) * -score) *
                                    (1 - 1 / (score * score - 1 / (score * score + 2)));
  const double both = std::max(p * (1 - p), 1e-300);
  const double crossed = both * (1 - fast_exp(-crossings / both));
  const double apart = 1 + 0.27 * fast_exp(-squared(turns / 0.12));
  if (p < 1e-6) return fast_log(std::clamp(1 + (stretches - 1) * apart * crossed / both, 1.0, stretches));
  const double once = -fast_log(1 - p);
  const double all = once - (stretches - 1) * apart * fast_log(std::max(1 - crossed / (1 - p), 1e-300));
  return fast_log(std::clamp(all / once, 1.0, stretches));
}

}  // namespace

double tabulated_probability(double score) {
  const double place = (std::clamp(score, -kMostScore, kMostScore) + kMostScore) / kScoreStep;
  const auto i = std::min(static_cast<std::size_t>(place), kScoreRows - 2);
  return kProbabilities[i] + (place - static_cast<double>(i)) * (kProbabilities[i + 1] - kProbabilities[i]);
}

double interference_share(const CollectedSound& sound, double threshold, double slow_power) {
  const double louder = sound.slow.mean > 0 ? slow_power / sound.slow.mean : 0;
  double signal = 0, changed = 0;
  for (const FadingTerm& term : sound.terms) {
    const double taken = threshold * term.interference, beats = louder * term.signal_beats,
                 taken_beats = threshold * term.interference_beats;
    signal += term.signal * term.unit + 2 * beats * term.unit;
    changed += taken * (2 * term.signal + taken) + 2 * (beats * taken + taken_beats * (term.unit + taken));
  }
  return signal > 0 ? changed / signal : changed > 0 ? 1 : 0;
}

BandLaw::BandLaw(const CollectedSound& sound, double threshold, double slow_power) {
  const double louder = sound.slow.mean > 0 ? slow_power / sound.slow.mean : 0;
  std::array<Octave, 2 * kOctaves> octaves{};
  double greatest = 0;
  for (const FadingTerm& term : sound.terms)
    greatest = std::max({greatest, term.unit, threshold * term.interference});
  for (const FadingTerm& term : sound.terms) {
    const double taken = threshold * term.interference;
    const double variance = term.signal * (term.unit - 2 * taken) + squared(taken);
    if (!(variance > 1e-12 * squared(greatest))) continue;
    double scale = std::max(term.unit, term.signal) - taken;
    const double least = std::sqrt(variance) / 2;
    if (std::abs(scale) < least) scale = std::copysign(least, scale);
    const double rest = louder * term.signal_beats - threshold * term.interference_beats;
    const auto octave = static_cast<std::size_t>(
        std::clamp(-std::ilogb(std::abs(scale) / greatest), 0, static_cast<int>(kOctaves) - 1));
    Octave& sum = octaves[scale > 0 ? octave : kOctaves + octave];
    sum.mean += variance / scale;
    sum.variance += variance;
    sum.rest += rest;
    sum.rest_variance += 2 * rest * scale;
    sum.rate += (variance + 2 * std::max(rest * scale, 0.0)) * term.squared_spread;
  }
  mean_ = offset_ = slow_power + sound.fast;
  double third = 0;
  for (const Octave& sum : octaves) {
    if (!(sum.variance > 0)) continue;
    double scale = (sum.variance + sum.rest_variance) / (sum.mean + 2 * sum.rest);
    const double plain = sum.variance / sum.mean;
    if (!(scale * plain > 0) || std::abs(scale) > 2 * std::abs(plain) ||
        std::abs(scale) < std::abs(plain) / 2)
      scale = plain;
    const double rest = sum.rest * plain > 0 ? sum.rest : 0;
    const double all = sum.variance + std::max(sum.rest_variance, 0.0);
    terms_[count_++] = {scale, rest, sum.mean / scale, 2 * scale * squared(2 * pi) * sum.rate / all};
    const Term& term = terms_[count_ - 1];
    offset_ -= term.count * scale + rest;
    variance_ += term.count * squared(scale) + 2 * rest * scale;
    third += 2 * term.count * scale * squared(scale) + 6 * rest * squared(scale);
  }
  if (variance_ > 0) skewness_ = third / (variance_ * std::sqrt(variance_));
}

BandLaw::Points BandLaw::points(const Stretches& stretches) const {
  Points points;
  points.fill({mean_, 0, 0});
  if (!(variance_ > 1e-9 * squared(mean_))) {
    for (std::size_t i = 0; i < kPoints; ++i)
      points[i].score = -4 + 7.0 * static_cast<double>(i) / (kPoints - 1);
    return points;
  }
  const double deviation = std::sqrt(variance_);
  double least = -1e30, most = 1e30;  // of s
  for (const Term& term : terms()) {
    if (term.scale > 0) most = std::min(most, 1 / term.scale);
    if (term.scale < 0) least = std::max(least, 1 / term.scale);
  }
  const auto point = [&](double s) {
    double k = 0, first = 0, second = 0, slope = 0;
    for (const Term& term : terms()) {
      const double a = 1 / (1 - term.scale * s), rest = term.rest * a * a;
      k += term.count * fast_log(a) + s * term.rest * a;
      const double here = term.count * term.scale * a + rest;
      first += here;
      second += term.count * squared(term.scale * a) + 2 * rest * term.scale * a;
      slope += term.rate * here;
    }
    double score = skewness_ / 6;
    const double exponent = std::max(s * first - k, 0.0);
    if (s != 0) {
      const double r = std::copysign(std::sqrt(std::max(2 * exponent, 1e-12)), s);
      const double u = s * std::sqrt(std::max(second, 1e-30));
      score = r + fast_log(u / r) / r;
    }
    const double crossings = fast_exp(-exponent) / (2 * pi) * std::sqrt(std::max(slope / second, 0.0));
    const double turns = stretches.step_s * std::sqrt(std::max(slope / (2 * second), 0.0)) / (2 * pi);
    return BandPoint{offset_ + first, score,
                     log_parts(score, crossings * stretches.step_s, turns, stretches.count)};
  };
  std::size_t i = 0;
  // Toward the ends that the terms set, never at them.
  const auto toward = [&](double end, double deviations) {
    const double s = deviations / deviation;
    return s * end / (end + s);
  };
  for (const double below : kBelow) points[i++] = point(toward(least, below));
  points[i++] = point(0);
  for (const double above : kAbove) points[i++] = point(toward(most, above));
  return points;
}

}  // namespace halocline::acoustics
