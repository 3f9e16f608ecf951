// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/fade_statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Saddle points s in units of 1 / deviation of Q; 0 is at the mean.
constexpr FadeStatistics::Values kDeviations{-500,  -90, -28, -11, -5, -2.4, -1,
                                             -0.35, 0,   0.5, 1.5, 5,  30,   300};
constexpr std::size_t kMean = 8;

constexpr double kMaxScore = 6;

// Probabilities of a standard normal variable over the score, interpolated linearly.
constexpr std::size_t kScoreRows = 241;
constexpr double kScoreStep = 2 * kMaxScore / (kScoreRows - 1);
const std::array<double, kScoreRows> kProbabilities = [] {
  std::array<double, kScoreRows> made{};
  for (std::size_t i = 0; i < kScoreRows; ++i) {
    made[i] = normal_probability(-kMaxScore + kScoreStep * static_cast<double>(i));
  }
  return made;
}();

// Number of octaves by which x >= 0 lies below 1: -floor(log2(x)), clamped to 0..`most`.
std::size_t octaves_below(double x, std::size_t most) {
  constexpr std::uint64_t kExponentOfOne = 1023;
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) >> 52;
  return exponent >= kExponentOfOne ? 0 : std::min<std::size_t>(kExponentOfOne - exponent, most);
}

using Values = FadeStatistics::Values;

double at_least(double x, double least) { return x > least ? x : least; }
double at_most(double x, double most) { return x < most ? x : most; }

// Probabilities of normal scores: tabulated; below -4 by the asymptotic tail of the normal distribution,
//   exp(-z^2 / 2) / (sqrt(2 pi) -z) (1 - 1 / (z^2 - 1 / (z^2 + 2))).
Values probabilities(const Values& scores) {
  Values tails, made;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double squares = scores[i] * scores[i];
    tails[i] =
        fast_exp(-squares / 2) / (std::sqrt(2 * pi) * -scores[i]) * (1 - 1 / (squares - 1 / (squares + 2)));
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    made[i] =
        at_least(scores[i] > -4 ? std::min(tabulated_probability(scores[i]), 1 - 1e-9) : tails[i], 1e-300);
  }
  return made;
}

// Logarithm of the number of parts of a packet that fade independently below the power of each score, with
// `crossings` downward crossings per stretch (the formula of q and e in fade_statistics.h; `turns` is B
// step). Of n parts all are above with the probability (1 - p)^n.
HALOCLINE_VECTOR_CLONES
Values log_parts(const Values& scores, const Values& crossings, const Values& turns, double stretches) {
  const Values below = probabilities(scores);
  Values crossed, more, all, few, logs;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double both = below[i] * (1 - below[i]);
    crossed[i] = both * (1 - fast_exp(-crossings[i] / both));
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    more[i] = (stretches - 1) * (1 + 0.27 * fast_exp(-squared(turns[i] / 0.12)));
    few[i] = crossed[i] / (below[i] * (1 - below[i]));
  }
  for (std::size_t i = 0; i < scores.size(); ++i) all[i] = at_least(1 - crossed[i] / (1 - below[i]), 1e-300);
  for (std::size_t i = 0; i < scores.size(); ++i) all[i] = fast_log(all[i]) / fast_log(1 - below[i]);
  for (std::size_t i = 0; i < scores.size(); ++i) logs[i] = more[i] * (below[i] < 1e-6 ? few[i] : all[i]);
  for (std::size_t i = 0; i < scores.size(); ++i) logs[i] = at_least(1 + logs[i], 1);
  for (std::size_t i = 0; i < scores.size(); ++i) logs[i] = fast_log(at_most(logs[i], stretches));
  return logs;
}

}  // namespace

double tabulated_probability(double score) {
  const double place = (std::clamp(score, -kMaxScore, kMaxScore) + kMaxScore) / kScoreStep;
  const auto i = std::min(static_cast<std::size_t>(place), kScoreRows - 2);
  return kProbabilities[i] + (place - static_cast<double>(i)) * (kProbabilities[i + 1] - kProbabilities[i]);
}

BandTerms::BandTerms(const EqualizerStatistics& sound, double threshold)
    : threshold_(threshold), mean_block_(sound.block_fading.mean), fast_(sound.fast) {
  double greatest = 0;
  for (const FadingTerm& term : sound.terms) {
    greatest = std::max({greatest, term.unit, threshold * term.interference});
  }
  const double inverse = greatest > 0 ? 1 / greatest : 0;
  for (const FadingTerm& term : sound.terms) {
    const double taken = threshold * term.interference,
                 taken_cross_terms = threshold * term.interference_cross_terms;
    signal_ += term.signal * term.unit;
    signal_cross_terms_ += 2 * term.signal_cross_terms * term.unit;
    changed_ += taken * (2 * term.signal + taken) + 2 * taken_cross_terms * (term.unit + taken);
    changed_cross_terms_ += 2 * term.signal_cross_terms * taken;
    const double variance = term.signal * (term.unit - 2 * taken) + squared(taken);
    if (!(variance > 1e-12 * squared(greatest))) continue;
    double scale = std::max(term.unit, term.signal) - taken;
    if (4 * squared(scale) < variance) scale = std::copysign(std::sqrt(variance) / 2, scale);
    const std::size_t octave = octaves_below(std::abs(scale) * inverse, kOctaves - 1);
    Octave& sum = octaves_[scale > 0 ? octave : kOctaves + octave];
    sum.mean += variance / scale;
    sum.variance += variance;
    sum.rate += variance * term.squared_spread;
    const auto add = [&](double rest, CrossTerms& cross_terms) {
      cross_terms.rest += rest;
      cross_terms.variance += 2 * rest * scale;
      cross_terms.rate += 2 * rest * scale * term.squared_spread;
    };
    add(term.signal_cross_terms, sum.signal);
    add(taken_cross_terms, sum.interference);
  }
}

double BandTerms::share(double louder) const {
  const double signal = signal_ + louder * signal_cross_terms_,
               changed = changed_ + louder * changed_cross_terms_;
  return signal > 0 ? changed / signal : changed > 0 ? 1 : 0;
}

// The share is the ratio of two linear functions of `louder`, hence monotonic: the greatest value is at one
// of the ends.
double BandTerms::most_interference_share() const {
  return std::max(share(0), signal_cross_terms_ > 0 ? changed_cross_terms_ / signal_cross_terms_ : 0);
}

FadeStatistics::FadeStatistics(const BandTerms& terms, double block_power) {
  const double louder = terms.louder(block_power);
  mean_ = offset_ = block_power + terms.fast_;
  double third = 0;
  for (const BandTerms::Octave& sum : terms.octaves_) {
    if (!(sum.variance > 0)) continue;
    const auto cross_terms = [&](double BandTerms::CrossTerms::*part) {
      return louder * sum.signal.*part - sum.interference.*part;
    };
    const double all_rest = cross_terms(&BandTerms::CrossTerms::rest),
                 rest_variance = cross_terms(&BandTerms::CrossTerms::variance);
    double scale = (sum.variance + rest_variance) / (sum.mean + 2 * all_rest);
    const double plain = sum.variance / sum.mean;
    if (!(scale * plain > 0) || std::abs(scale) > 2 * std::abs(plain) ||
        std::abs(scale) < std::abs(plain) / 2)
      scale = plain;
    const double rest = all_rest * plain > 0 ? all_rest : 0;
    const double all = sum.variance + std::max(rest_variance, 0.0),
                 rate = sum.rate + std::max(cross_terms(&BandTerms::CrossTerms::rate), 0.0);
    terms_[count_++] = {scale, rest, sum.mean / scale, 2 * scale * squared(2 * pi) * rate / all};
    const Term& term = terms_[count_ - 1];
    offset_ -= term.count * scale + rest;
    variance_ += term.count * squared(scale) + 2 * rest * scale;
    third += 2 * term.count * scale * squared(scale) + 6 * rest * squared(scale);
  }
  if (variance_ > 0) skewness_ = third / (variance_ * std::sqrt(variance_));
}

// The loops over the points have neither sums nor calls, so that compilers vectorise them.
HALOCLINE_VECTOR_CLONES
FadeStatistics::Points FadeStatistics::points(const Stretches& stretches) const {
  Points points;
  if (!(variance_ > 1e-9 * squared(mean_))) {
    points.powers.fill(mean_);
    for (std::size_t i = 0; i < kPoints; ++i)
      points.scores[i] = -4 + 7.0 * static_cast<double>(i) / (kPoints - 1);
    return points;
  }
  const double deviation = std::sqrt(variance_);
  double least = -1e30, most = 1e30;  // range of s
  for (const Term& term : terms()) {
    if (term.scale > 0) most = std::min(most, 1 / term.scale);
    if (term.scale < 0) least = std::max(least, 1 / term.scale);
  }
  // The points approach the poles at 1 / scale that bound s, but never reach them.
  Values s;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double plain = kDeviations[i] / deviation, end = i < kMean ? least : most;
    s[i] = plain * end / (end + plain);
  }
  Values k{}, first{}, second{}, slope{}, crossings, turns;
  // K(s), K'(s) and K''(s) of the file comment, and the variance of the slope of Q.
  for (const Term& term : terms()) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double a = 1 / (1 - term.scale * s[i]), rest = term.rest * a * a;
      k[i] += term.count * fast_log(a) + s[i] * term.rest * a;
      const double here = term.count * term.scale * a + rest;
      first[i] += here;
      second[i] += term.count * squared(term.scale * a) + 2 * rest * term.scale * a;
      slope[i] += term.rate * here;
    }
  }
  Values squares, roots, changes;
  for (std::size_t i = 0; i < kPoints; ++i) {
    squares[i] = at_least(2 * (s[i] * first[i] - k[i]), 1e-12);
    second[i] = at_least(second[i], 1e-300);
    changes[i] = at_least(slope[i], 0);
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    points.powers[i] = offset_ + first[i];
    roots[i] = std::copysign(std::sqrt(squares[i]), s[i]);
  }
  // Saddle point approximation: z = r + ln(u / r) / r, u = s sqrt(K'').
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double u = s[i] * std::sqrt(second[i]);
    points.scores[i] = roots[i] + fast_log(u / roots[i]) / roots[i];
  }
  // Crossings per step: exp(K - s y) / (2 pi) * sqrt(V / K'') * step.
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double rate = changes[i] / second[i];
    crossings[i] = fast_exp(-squares[i] / 2) / (2 * pi) * std::sqrt(rate) * stretches.step_s;
    turns[i] = stretches.step_s * std::sqrt(rate / 2) / (2 * pi);
  }
  points.scores[kMean] = skewness_ / 6;
  points.log_parts = log_parts(points.scores, crossings, turns, stretches.count);
  return points;
}

}  // namespace halocline::acoustics
