// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/exponential_means.h"

#include <cmath>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/reception/signal_history.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr double kDbPerNeper = 10 / std::numbers::ln10;
// Bound of the exponent in the variance; no packet of such a state is lost.
constexpr double kMaxExponent = 300;
// Share of the cross terms of coherent paths that counts for errors of uncoded bits: our fit to simulated
// packets (tests/channel_server/packets/link_prediction_test.cc).
constexpr double kCrossTermShare = 1;

using Frequencies = std::array<double, kFrequencies>;

// Mean over the fast fading of exp(-scale power) at each frequency, times exp(least), and its variance.
struct Exponentials {
  double least = 0;  // common exponent, factored out: cells of high power underflow
  Frequencies means{}, variances{};
};

double mean_of(const std::array<double, kFrequencies>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / kFrequencies;
}

// Means for Rician powers, c the steady and d the diffuse power in units of 1 / scale:
//   E exp(-x) = exp(-c / (1 + d)) / (1 + d).
// The loops over the frequencies have no sums, so that compilers vectorise them.
HALOCLINE_VECTOR_CLONES
Exponentials of_rician(const BlockFading& block_fading, double scale, double fast) {
  Exponentials made;
  Frequencies c, b, losses, inverses;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    c[m] = scale * block_fading.steady[m];
    b[m] = scale * fast + scale * block_fading.varying[m];
    inverses[m] = 1 / (1 + b[m]);
    losses[m] = c[m] * inverses[m];
  }
  double least = losses[0];
  for (const double loss : losses) least = loss < least ? loss : least;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    const double twice = 1 / (1 + 2 * b[m]), exponent = 2 * (least - c[m] * twice);
    made.means[m] = fast_exp(least - losses[m]) * inverses[m];
    made.variances[m] =
        fast_exp(exponent < kMaxExponent ? exponent : kMaxExponent) * twice - made.means[m] * made.means[m];
  }
  made.least = least;
  return made;
}

// Corrects the means for uncoded bits: coherent paths interfere within a part of the band, and a bit is
// received at one frequency of the part. The power is taken to be S + sqrt(V) or S - sqrt(V) with equal
// probability, S^2 - V = constant^2; kCrossTermShare of the deviation counts (our fit).
HALOCLINE_VECTOR_CLONES
void add_cross_terms(const BlockFading& block_fading, double scale, double fast, Exponentials& made) {
  const double d = scale * fast, slower = scale / (1 + d);
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    const double constant = block_fading.steady[m],
                 varying = block_fading.varying[m] > 0 ? block_fading.varying[m] : 0;
    const double mean = slower * (constant + block_fading.varying[m]),
                 cross_term =
                     kCrossTermShare * slower * std::sqrt(varying * (2 * constant + block_fading.varying[m])),
                 deviation = cross_term < mean ? cross_term : mean;
    const double old = made.means[m];
    made.means[m] =
        (fast_exp(made.least - mean - deviation) + fast_exp(made.least - mean + deviation)) / 2 / (1 + d);
    made.variances[m] += old * old - made.means[m] * made.means[m];
  }
}

// Turns means and variances at single instants into those of the mean over a packet; `own` and `cross_terms`
// are the variance of its mean power. The fades that dominate the mean are deep, hence shorter than the
// coherence of the power in time and in frequency, which reduces the variance further (`shorter`).
HALOCLINE_VECTOR_CLONES
void finish_cells(const ExponentialMeans::Fast& fast, ExponentialMeans::Cells& cells) {
  const std::size_t count = cells.count;
  const double power = fast.power, own = fast.own, cross_terms = fast.cross_terms;
  for (std::size_t i = 0; i < count; ++i) {
    const double scale = cells.scale[i], block_fading = cells.block_power[i], d = scale * power;
    const double single = d * d + 2 * d * scale * block_fading,
                 kept = scale * scale * (own + cross_terms * block_fading);
    const double shorter = fast_exp(2.0 / 3 * fast_log((1 + 2 * d) / ((1 + d) * (1 + d))));
    const double of_mean = single > 0 ? kept / (single > 0 ? single : 1) : 0;
    cells.variance[i] *= of_mean * shorter / (cells.mean[i] * cells.mean[i]);
    cells.nepers[i] = cells.least[i] - fast_log(cells.mean[i]);
  }
}

// The effective ratio is log-normal: v = ln(1 + relative variance), its median is at nepers + v / 2.
HALOCLINE_VECTOR_CLONES
void effective_ratios(const ExponentialMeans::Cells& cells, ExponentialMeans::Ratios& ratios) {
  const std::size_t count = cells.count;
  for (std::size_t i = 0; i < count; ++i) {
    const double v = fast_log(1 + cells.variance[i]), nepers = cells.nepers[i] + v / 2;
    ratios.medians_db[i] = fast_decibels(nepers > 1e-12 ? nepers : 1e-12);
    ratios.deviations_db[i] = kDbPerNeper * std::sqrt(v > 0 ? v : 0) / nepers;
  }
}

}  // namespace

void ExponentialMeans::add(const BlockFading& block_fading, double scale) {
  Exponentials all = of_rician(block_fading, scale, fast_.power);
  if (fast_.cross_terms_within_parts) add_cross_terms(block_fading, scale, fast_.power, all);
  const std::size_t i = cells_.count++;
  cells_.scale[i] = scale;
  cells_.block_power[i] = block_fading.block_power;
  cells_.least[i] = all.least;
  cells_.mean[i] = mean_of(all.means);
  cells_.variance[i] = mean_of(all.variances);
}

void ExponentialMeans::finish() { finish_cells(fast_, cells_); }

ExponentialMeans::Ratios ExponentialMeans::ratios() const {
  Ratios ratios;
  effective_ratios(cells_, ratios);
  return ratios;
}

}  // namespace halocline::acoustics
