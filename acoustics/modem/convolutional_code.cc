// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/convolutional_code.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr int kMaxJanusDistance = 28;
// Exponent beyond which exp(-x) is 0 in a double.
constexpr double kExponentOfZero = 745;

// Rates of error events per bit of the JANUS code at chips of 1 dB, 1.5 dB .. 6 dB (simulated decoder, see
// the header; the last two smoothed within their errors).
constexpr double kFirstRowDb = 1, kRowStepDb = 0.5;
constexpr std::array kEventRates{9.66e-2, 6.92e-2, 4.86e-2, 3.19e-2, 1.83e-2, 8.64e-3,
                                 3.42e-3, 9.61e-4, 2.30e-4, 3.20e-5, 3.60e-6};
constexpr double kLastRowDb = kFirstRowDb + kRowStepDb * (kEventRates.size() - 1);

// Paths that have reached one state of the trellis at one distance: their number, and their ones of
// information.
struct Bundle {
  double paths = 0;
  double information_ones = 0;
};
using Front = std::vector<std::vector<Bundle>>;  // [state][distance]

// A branch of the trellis: the state it leads to, and the ones that it sends.
struct Edge {
  unsigned to;
  int ones;
};

// The branch from `state` for the input `bit`.
Edge edge_of(const ConvolutionalCode& code, unsigned state, unsigned bit) {
  const unsigned word = (bit << (code.constraint_length - 1)) | state;
  const auto parity = [&](unsigned generator) { return std::popcount(word & generator) & 1; };
  return {word >> 1, parity(code.generators[0]) + parity(code.generators[1])};
}

// Extends the paths of `bundle` along a branch.
void extend(Front& to, const Edge& edge, const Bundle& bundle, int distance, unsigned bit) {
  const auto reached = static_cast<std::size_t>(distance + edge.ones);
  if (bundle.paths == 0 || reached >= to[edge.to].size()) return;
  Bundle& sum = to[edge.to][reached];
  sum.paths += bundle.paths;
  sum.information_ones += bundle.information_ones + bit * bundle.paths;
}

// Extends all paths of `now` by one bit into `next`, except those that have returned to state 0.
void step(const ConvolutionalCode& code, const Front& now, Front& next) {
  for (std::vector<Bundle>& state : next) std::fill(state.begin(), state.end(), Bundle{});
  for (unsigned state = 1; state < now.size(); ++state) {
    for (int distance = 0; distance < static_cast<int>(now[state].size()); ++distance) {
      const Bundle& bundle = now[state][static_cast<std::size_t>(distance)];
      for (const unsigned bit : {0u, 1u}) extend(next, edge_of(code, state, bit), bundle, distance, bit);
    }
  }
}

// True while paths are in states other than 0.
bool any_on_the_way(const Front& front) {
  return std::any_of(front.begin() + 1, front.end(), [](const std::vector<Bundle>& state) {
    return std::any_of(state.begin(), state.end(), [](const Bundle& b) { return b.paths > 0; });
  });
}

// Binomial coefficient n over k.
double binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;  // exact at every step below 2^53
  return value;
}

// Square-law sum of d chips (Proakis, 4th edition, section 12.1), half = d g / 2:
//   P2 = 2^(1-2d) e^-half sum_{k<d} half^k / k! sum_{n<d-k} C(2d-1, n).
double soft_without_fading(int d, double g) {
  const double half = d * g / 2;
  if (half > kExponentOfZero) return 0;
  std::vector<double> choices;  // choices[m] = sum over n <= m of C(2d-1, n)
  choices.reserve(static_cast<std::size_t>(d));
  for (int n = 0; n < d; ++n) choices.push_back((n ? choices.back() : 0) + binomial(2 * d - 1, n));
  double sum = 0, power = 1;  // power = half^k / k!
  for (int k = 0; k < d; ++k) {
    sum += power * choices[static_cast<std::size_t>(d - 1 - k)];
    power *= half / (k + 1);
  }
  return std::ldexp(elementary::exp(-half) * sum, 1 - 2 * d);
}

// Sum of d chips that fade independently (section 14.4):
//   P2 = p^d sum_{k<d} C(d-1+k, k) (1-p)^k.
double soft_in_rayleigh(int d, double p) {
  double sum = 0, power = 1;
  for (int k = 0; k < d; ++k, power *= 1 - p) sum += binomial(d - 1 + k, k) * power;
  return elementary::pow(p, d) * sum;
}

// Probability that more than half of d chips are wrong, with a tie decided at random (section 8.2):
//   P2 = sum_{k>d/2} C(d, k) p^k (1-p)^(d-k) + tie / 2.
double hard(int d, double p) {
  double sum = d % 2 == 0 ? binomial(d, d / 2) * elementary::pow(p * (1 - p), d / 2) / 2 : 0;
  for (int k = d / 2 + 1; k <= d; ++k)
    sum += binomial(d, k) * elementary::pow(p, k) * elementary::pow(1 - p, d - k);
  return sum;
}

// Union bound of error events of the JANUS code in white noise: sum over d of a_d P2(d).
double event_bound(double chip_snr) {
  double sum = 0;
  for (const SpectrumTerm& term : janus_spectrum())
    sum += term.paths * soft_without_fading(term.distance, chip_snr);
  return sum;
}

// Pairwise error P2(d): the probability that a path at distance d is preferred to the correct one.
double pairwise_error(int d, Decision decision, Fading fading, PowerRatio chip_snr) {
  const double p = bit_error_rate(Modulation::kNoncoherentBfsk, fading, chip_snr);
  if (decision == Decision::kHard) return hard(d, p);
  return fading == Fading::kNone ? soft_without_fading(d, chip_snr.value) : soft_in_rayleigh(d, p);
}

}  // namespace

std::vector<SpectrumTerm> distance_spectrum(const ConvolutionalCode& code, int max_distance) {
  require_in_range(code.constraint_length, 2, 16, "constraint length", "");
  require_in_range(max_distance, 1, 60, "greatest distance", "");
  const unsigned states = 1u << (code.constraint_length - 1);
  for (const unsigned generator : code.generators) {
    require(generator > 0 && generator < 2 * states, "a generator is longer than the constraint length");
  }
  // Terms of the transfer function T(D, N) of the trellis (Proakis, 4th edition, section 8.2): a_d is the
  // coefficient of D^d in T(D, 1), B_d that in dT/dN at N = 1. They are summed bit by bit over all paths that
  // leave state 0 and return once.
  const auto distances = static_cast<std::size_t>(max_distance) + 1;
  Front front(states, std::vector<Bundle>(distances)), next = front;
  extend(front, edge_of(code, 0, 1), {1, 0}, 0, 1);
  std::vector<Bundle> back(distances);
  // A path that adds no distance for as many bits as there are states has followed a loop of distance 0.
  const std::size_t longest = (distances + 1) * states;
  for (std::size_t bits = 1; any_on_the_way(front); ++bits) {
    require(bits < longest, "the code is catastrophic: endless paths of finite distance");
    step(code, front, next);
    front.swap(next);
    for (std::size_t d = 0; d < distances; ++d) {
      back[d].paths += front[0][d].paths;
      back[d].information_ones += front[0][d].information_ones;
    }
  }
  std::vector<SpectrumTerm> terms;
  for (std::size_t d = 0; d < distances; ++d) {
    if (back[d].paths > 0) terms.push_back({static_cast<int>(d), back[d].paths, back[d].information_ones});
  }
  return terms;
}

const std::vector<SpectrumTerm>& janus_spectrum() {
  static const std::vector<SpectrumTerm> spectrum = distance_spectrum(kJanusCode, kMaxJanusDistance);
  return spectrum;
}

double union_bound(const std::vector<SpectrumTerm>& spectrum, Decision decision, Fading fading,
                   PowerRatio chip_snr) {
  // P_b <= sum over d of B_d P2(d) (Proakis, 4th edition, section 8.2).
  double sum = 0;
  for (const SpectrumTerm& term : spectrum) {
    sum += term.information_ones * pairwise_error(term.distance, decision, fading, chip_snr);
  }
  return sum;
}

double janus_error_events(PowerRatio chip_snr) {
  require(chip_snr.value >= 0, "a signal-to-noise ratio must not be negative or NaN");
  static const double first_row = to_power_ratio(Decibels{kFirstRowDb}).value,
                      last_row = to_power_ratio(Decibels{kLastRowDb}).value;
  // 1/2 exp(-rise g), through the first row.
  static const double rise = elementary::log(0.5 / kEventRates.front()) / first_row;
  static const double last_bound = event_bound(last_row);
  if (chip_snr.value <= first_row) return 0.5 * elementary::exp(-rise * chip_snr.value);
  if (chip_snr.value >= last_row) return kEventRates.back() * event_bound(chip_snr.value) / last_bound;
  const double place = (to_decibels(chip_snr).value - kFirstRowDb) / kRowStepDb;
  const std::size_t row = std::min(static_cast<std::size_t>(std::max(place, 0.0)), kEventRates.size() - 2);
  const double part = place - static_cast<double>(row);
  return elementary::exp((1 - part) * elementary::log(kEventRates[row]) +
                         part * elementary::log(kEventRates[row + 1]));
}

double janus_error_events_rayleigh(PowerRatio mean_chip_snr) {
  require(mean_chip_snr.value >= 0, "a signal-to-noise ratio must not be negative or NaN");
  return janus_error_events(
      {kEffectiveRatioBeta * elementary::log1p(mean_chip_snr.value / kEffectiveRatioBeta)});
}

double coded_bit_error_rate(const std::vector<SpectrumTerm>& spectrum, Decision decision, Fading fading,
                            PowerRatio chip_snr) {
  return std::min(0.5, union_bound(spectrum, decision, fading, chip_snr));
}

}  // namespace halocline::acoustics
