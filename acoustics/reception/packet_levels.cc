#include "acoustics/reception/packet_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "acoustics/reception/decoding.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr double kDbPerNeper = 10 / std::numbers::ln10;
constexpr double kMaxExponent = 300;  // of a ratio of variances: no packet of it is lost

double squared(double x) { return x * x; }

// Gauss-Hermite nodes of a standard normal (Abramowitz and Stegun 1964, table 25.10, scaled).
struct Node {
  double z, weight;
};
constexpr std::array<Node, 5> kFive{{{-2.8569700138728056, 0.011257411327720689},
                                     {-1.3556261799742659, 0.22207592200561266},
                                     {0, 0.53333333333333333},
                                     {1.3556261799742659, 0.22207592200561266},
                                     {2.8569700138728056, 0.011257411327720689}}};

// P(X < x) of a gamma distributed X of shape k: the series, or Wilson and Hilferty 1931 where it is accurate.
double gamma_below(double k, double x) {
  if (k > 4) {
    const double z = 3 * std::sqrt(k) * (std::cbrt(x / k) - 1 + 1 / (9 * k));
    return std::erfc(-z / std::numbers::sqrt2) / 2;
  }
  if (x > k + 12) return 1;
  double term = 1, sum = 1;
  for (int n = 1; n < 60 && term > 1e-4 * sum; ++n) sum += term *= x / (k + n);
  return std::min(std::exp(k * std::log(x) - x) / std::tgamma(k + 1) * sum, 1.0);
}

// Of a power of mean 1 whose part `constant` stays and whose rest is gamma distributed (Wilson and Hilferty 1931),
//   x = mean (1 - v / 9 + z sqrt(v) / 3)^3, v the relative variance,
// in dB by the parabola through z = -1.5, 0 and 1.5.
Level level_of(double mean_db, double variance, double constant) {
  if (!(variance > 1e-9)) return {mean_db};
  const double rest = std::max(1 - constant, 1e-6), root = std::sqrt(variance) / rest;
  const auto at = [&](double z) {
    const double x = std::max(1 - root * root / 9 + z * root / 3, 0.05);
    return kDbPerNeper * std::log(constant + rest * x * x * x);
  };
  const double low = at(-1.5), middle = at(0), high = at(1.5);
  return {mean_db + middle, (high - low) / 3, (high + low - 2 * middle) / 4.5};
}

}  // namespace

PacketLevels::PacketLevels(const ReceptionCurves& curves, const MeanSound& sound)
    : curves_(curves),
      sound_(sound),
      chip_(chip_energy(curves.modem()) / kEffectiveRatioBeta),
      bits_(static_cast<double>(curves.timing().information_bits)),
      coded_(is_coded_frequency_shift_keying(curves.modem().error_model)),
      collects_band_(!is_frequency_shift_keying(curves.modem().error_model)) {
  // The stretches of signal_history.h.
  const double bits_s = (curves.timing().duration - curves.timing().preamble).seconds();
  stretches_ = std::clamp(std::ceil(4 * bits_s / coherence_time_of(sound.spread_hz)), 8.0, 64.0);
  const double step = bits_s / stretches_ * sound.spread_hz;
  crossings_ = 2 * std::sqrt(pi) * step;
  const auto ratio_of = [&](double loss, double bits) {
    return std::pow(10, curves.ratio_db_of(-loss / bits) / 10);
  };
  if (collects_band_) {
    fade_bits_ = std::max(bits_ / stretches_ * std::min(stretches_, 1 / -std::expm1(-3 * crossings_)), 2.0);
    threshold_ = ratio_of(-std::log(0.5), fade_bits_);
    width_ = std::log(ratio_of(-std::log(0.84), fade_bits_) / ratio_of(-std::log(0.16), fade_bits_)) / 2;
  } else if (!coded_) {
    const double low = ratio_of(4, bits_);
    slope_ = std::log(20) / std::max(ratio_of(0.2, bits_) - low, 1e-9);
    errors_at_zero_ = 4 * std::exp(slope_ * low);
  }
}

Level PacketLevels::preamble(const SlowSound& slow, double noise) const {
  const double kept = sound_.preamble_variance, quiet = noise + sound_.preamble_echoes;
  const double variance = kept * slow.own + kept_of_longer(kept) * slow.mixed;
  return level_of(mean_db(slow, quiet), relative_variance(slow.mean, variance, quiet),
                  slow.constant / slow.mean);
}

Level PacketLevels::bits(const SlowSound& slow, double noise) const {
  return coded_ ? interleaved(slow, noise) : Level{product(slow, noise)};
}

// Relative variance of the ratio: the signal's, less what the untracked part has in common with it.
double PacketLevels::relative_variance(double mean, double variance, double quiet) const {
  const double part = sound_.untracked * mean / (quiet + sound_.untracked * mean);
  return variance / squared(mean) *
         std::max(1 - 2 * part * sound_.shared_fading + part * part * sound_.own_fading, 0.0);
}

double PacketLevels::mean_db(const SlowSound& slow, double quiet) const {
  return kDbPerNeper * std::log(std::max(slow.mean / (quiet + sound_.untracked * slow.mean), 1e-30));
}

Level PacketLevels::interleaved(const SlowSound& slow, double noise) const {
  const double disturbed = noise + sound_.bits_echoes + sound_.untracked * slow.mean;
  const double scale = chip_ / disturbed, scattered = scale * sound_.scattered_power();
  double least = std::numeric_limits<double>::infinity();  // exponent, taken out: loud cells underflow
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    least = std::min(least, scale * slow.steady[m] / (1 + scale * slow.diffuse[m]));
  }
  double mean = 0, all = 0, steady = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    const double c = scale * slow.steady[m], d = scale * slow.diffuse[m];
    const double one = std::exp(least - c / (1 + d)) / (1 + d);
    mean += one / kFrequencies;
    all += (std::exp(std::min(2 * least - 2 * c / (1 + 2 * d), kMaxExponent)) / (1 + 2 * d) - one * one) /
           kFrequencies;
    steady += slow.steady[m] / kFrequencies;
  }
  const double single = scattered > 0 ? squared(scattered) + 2 * scattered * scale * steady : 0;
  const double kept = sound_.bits_variance;
  const double of_mean =
      single > 0 ? squared(scale) * (kept * slow.own + kept_of_longer(kept) * slow.mixed) / single : 0;
  // Deep fades, which count most, are shorter than the power's coherence, in time and in frequency.
  const double shorter = std::cbrt(squared((1 + 2 * scattered) / squared(1 + scattered)));
  const double v = std::log1p(all * of_mean * shorter / (mean * mean));
  const double nepers = least - std::log(mean) + v / 2;
  return {kDbPerNeper * std::log(std::max(nepers, 1e-12) / chip_), kDbPerNeper * std::sqrt(v) / nepers, 0};
}

// Uncoded or coherent: the constant ratio, dB, that loses the packet as often; no more than the mean.
double PacketLevels::product(const SlowSound& slow, double noise) const {
  const double loss = collects_band_ ? fades(slow, noise) : errors(slow, noise);
  return std::min(curves_.ratio_db_of(-loss / bits_), mean_db(slow, noise + sound_.bits_echoes));
}

// -ln of the chance that the power of the band does not fall below what its bits need.
double PacketLevels::fades(const SlowSound& slow, double noise) const {
  const double quiet = noise + sound_.bits_echoes, variance = slow.own + slow.mixed;
  const double mean = slow.mean / (quiet + sound_.untracked * slow.mean),
               constant = slow.constant / slow.mean;
  const double v = relative_variance(slow.mean, variance, quiet), least = threshold_ / mean;
  double loss = 0;  // of a stretch
  if (v < 1.0 / 8) {
    const Level level = level_of(mean_db(slow, quiet), v, constant);
    double chance = 0;
    for (const Node& node : kFive) {
      chance += node.weight * std::exp(fade_bits_ * curves_.log_bit_success_at(level.at(node.z)));
    }
    loss = -std::log(std::clamp(chance, 1e-300, 1.0));
  } else {
    const double below =
        std::max(below_threshold(v, least, constant), below_linear(slow.mean, variance, quiet, constant));
    loss = -std::log1p(-std::min(below, 1 - 1e-12));
  }
  return loss * (1 + (stretches_ - 1) * std::exp(-loss) * again(v, least));
}

// P(X < least) of an X as in level_of(), the threshold spread by its width.
double PacketLevels::below_threshold(double v, double least, double constant) const {
  const double rest = std::max(1 - constant, 1e-6), x = (least - constant) / rest,
               of_rest = v / (rest * rest);
  if (!(x > 0)) return 0;
  if (of_rest >= 1.0 / 8) {
    return gamma_below(1 / of_rest, x / of_rest * std::exp(squared(width_) / of_rest / 2));
  }
  const double wide = of_rest + squared(width_);
  return gamma_below(1 / wide, x / wide);
}

// Of signal less threshold times untracked below threshold times the rest: exact of parts that all are above 0.
double PacketLevels::below_linear(double mean, double variance, double quiet, double constant) const {
  const double part = threshold_ * sound_.untracked;
  if (part >= 1) return 1;
  const double v = variance / squared(mean) *
                   (1 - 2 * part * sound_.shared_fading + part * part * sound_.own_fading) /
                   squared(1 - part);
  return below_threshold(std::max(v, 1e-3), threshold_ * quiet / (mean * (1 - part)), constant);
}

// The chance that the next stretch is above the threshold, of one below (Rice 1944: crossings a second by the time below).
double PacketLevels::again(double v, double least) const {
  if (!(v > 0)) return 0;
  const double x = std::min(least / (1 + v), 1.0);
  return std::min(8 * v, 1.0) *
         -std::expm1(-1.3 * crossings_ / std::sqrt(v * least) * (1 - x + std::sqrt(2 * v / pi)));
}

// Errors of single bits, a exp(-slope ratio), on average over each frequency's Rician fading: they are far apart.
double PacketLevels::errors(const SlowSound& slow, double noise) const {
  const double scale = slope_ / (noise + sound_.bits_echoes + sound_.untracked * slow.mean);
  double loss = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    const double d = scale * sound_.scattered_power();
    const double c = scale * (slow.steady[m] + slow.diffuse[m]) - d;
    loss += errors_at_zero_ * std::exp(-c / (1 + d)) / (1 + d) / kFrequencies;
  }
  return loss;
}

}  // namespace halocline::acoustics
