#include "acoustics/reception/link_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

#include "acoustics/reception/decoding.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr std::size_t kMediumStates = 8, kLevels = 4, kStrata = 32;
constexpr double kNegligible = 1e-12;  // of the power: of no effect
constexpr double kDbPerNeper = 10 / std::numbers::ln10;

double squared(double x) { return x * x; }

// The middles of strata of equal probability of a standard normal, scaled to its variance.
template <std::size_t count>
std::array<double, count> normal_strata() {
  std::array<double, count> strata{};
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double p = (2.0 * static_cast<double>(i) + 1) / count;
    strata[i] = std::numbers::sqrt2 * boost::math::erf_inv(p - 1);
    squares += squared(strata[i]) / count;
  }
  for (double& value : strata) value /= std::sqrt(squares);
  return strata;
}

// The slow states: levels of large-scale fading at which a packet's fate is computed, the strata between which it is
// interpolated (by Lagrange's polynomial), each with normals for what fades fast, and the medium's states.
struct SlowStates {
  std::array<double, kLevels> levels{-2.1, -0.7, 0.7, 2.1};  // standard deviations
  std::array<double, kStrata> strata = normal_strata<kStrata>();
  std::array<std::array<double, kLevels>, kStrata> weights{};
  std::array<Complex, kMediumStates> medium{};

  SlowStates() {
    for (std::size_t i = 0; i < kStrata; ++i) {
      for (std::size_t k = 0; k < kLevels; ++k) {
        weights[i][k] = 1;
        for (std::size_t n = 0; n < kLevels; ++n) {
          if (n != k) weights[i][k] *= (strata[i] - levels[n]) / (levels[k] - levels[n]);
        }
      }
    }
    const auto normals = normal_strata<kMediumStates>();
    constexpr std::array<std::size_t, kMediumStates> kOther{4, 1, 6, 3, 7, 0, 5, 2};  // nearly uncorrelated
    for (std::size_t i = 0; i < kMediumStates; ++i) {
      medium[i] = Complex(normals[i], normals[kOther[i]]) / std::numbers::sqrt2;
    }
  }
  // Normals of fast fading beside stratum i, in another order in each state: of the preamble, of even and odd blocks.
  double preamble(std::size_t i, std::size_t state) const {
    return strata[(9 * i + 4 * state + 12) % kStrata];
  }
  double block(std::size_t i, std::size_t state, std::size_t block) const {
    return strata[block % 2 == 0 ? (7 * i + 4 * state + 19) % kStrata : (13 * i + 4 * state + 18) % kStrata];
  }
};

const SlowStates& slow_states() {
  static const SlowStates states;
  return states;
}

// Share of its variance that the mean over a time keeps of a power whose autocorrelation is exp(-(tau / L)^2), for
// x = time / L: 1 - x^2 / 6 of short times, sqrt(pi) / x of long ones, within 6 % between.
double kept_variance(double x) { return 1 / std::sqrt(1 + x * x / pi); }

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

// Correlation of a power's parts between frequencies that are k spacings apart: sum of P exp(-j 2 pi k spacing delay).
using Correlation = std::array<Complex, kFrequencies>;
using Pressures = std::array<Complex, kFrequencies>;

void add_to(Correlation& correlation, double power, Complex turn) {
  Complex term = power;
  for (Complex& value : correlation) {
    value += term;
    term *= turn;
  }
}

// Mean over all pairs of frequencies of |correlation|^2.
double mean_square(const Correlation& correlation) {
  double sum = 0;
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    sum += (k == 0 ? 1.0 : 2.0) * static_cast<double>(kFrequencies - k) * std::norm(correlation[k]);
  }
  return sum / (kFrequencies * kFrequencies);
}

// K a, K_mn = E B_m B_n*.
Pressures times(const Correlation& correlation, const Pressures& a) {
  Pressures product{};
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n < kFrequencies; ++n) {
      product[m] += (n > m ? std::conj(correlation[n - m]) : correlation[m - n]) * a[n];
    }
  }
  return product;
}

// a^H b / 8^2.
double mean_product(const Pressures& a, const Pressures& b) {
  double sum = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) sum += (std::conj(a[m]) * b[m]).real();
  return sum / (kFrequencies * kFrequencies);
}

// What sounds in the window, on average over all fading.
struct MeanSound {
  Pressures steady{};                               // A_m
  Correlation medium{}, scattered{};                // [0] is the power
  double spread_hz = 0;                             // rms, of what is scattered
  double preamble_variance = 1, bits_variance = 1;  // shares that its mean over them keeps
  double untracked = 0;  // interference that fades as the signal does, in units of it
  double shared_fading = 0,
         own_fading = 0;  // its covariance with the signal and its variance, relative to the signal's
  double preamble_echoes = 0, bits_echoes = 0;  // late ones, on average over preamble and bits
};

double share_within(double begin_s, double end_s, double from_s, double to_s) {
  return to_s > from_s
             ? std::clamp((std::min(end_s, to_s) - std::max(begin_s, from_s)) / (to_s - from_s), 0.0, 1.0)
             : 0;
}

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                     const PacketTiming& timing) {
  const SoundPath &first = paths[lock.window.first], &strongest = paths[lock.window.strongest];
  const double spacing_hz = band.width_hz() / kFrequencies;
  const double kept = doppler_share(*lock.modem, strongest, band.centre_hz());
  const double preamble_s = timing.preamble.seconds(), end_s = timing.duration.seconds();
  MeanSound sound;
  double signal = 0, untracked = 0, squares = 0, products = 0, untracked_squares = 0, spread = 0,
         preamble_root = 0, bits_root = 0;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const SoundPath& path = paths[p];
    const double power = to_power_ratio(path.level).value, begin_s = path.delay_s - first.delay_s;
    if (const double late = lock.window.interference[p] * power; late > 0) {
      sound.preamble_echoes += late * share_within(begin_s, begin_s + end_s, 0, preamble_s);
      sound.bits_echoes += late * share_within(begin_s, begin_s + end_s, preamble_s, end_s);
    }
    const double within = squared(lock.window.weights[p]) * power;
    if (!(within > 0)) continue;
    const double of_path = within * kept * tracked_share(*lock.modem, path), rest = within - of_path;
    signal += of_path;
    untracked += rest;
    squares += of_path * of_path;
    products += of_path * rest;
    untracked_squares += rest * rest;
    const double excess_s = path.delay_s - strongest.delay_s;
    const Complex turn = std::polar(1.0, -2 * pi * std::fmod(spacing_hz * excess_s, 1.0));
    const double cycles = std::fmod((band.low_hz + spacing_hz / 2) * excess_s, 1.0);
    Complex pressure =
        std::polar(std::sqrt(of_path * path.fading.coherent), path.phase_rad - 2 * pi * cycles);
    for (Complex& sum : sound.steady) {
      sum += pressure;
      pressure *= turn;
    }
    // What is scattered so slowly that it holds through a packet fades as the medium does.
    const double rate = 2 * pi * path.fading.doppler_spread_hz;  // 1 / L of its power
    const double holds = 1 / (1 + squared(rate * (end_s - preamble_s)));
    const double scattered = of_path * path.fading.scattered * (1 - holds);
    add_to(sound.medium, of_path * (path.fading.medium + path.fading.scattered * holds), turn);
    add_to(sound.scattered, scattered, turn);
    spread += scattered * squared(path.fading.doppler_spread_hz);
    preamble_root += scattered * std::sqrt(kept_variance(rate * preamble_s));
    bits_root += scattered * std::sqrt(kept_variance(rate * (end_s - preamble_s)));
  }
  if (untracked > kNegligible * signal) {
    sound.untracked = untracked / signal;
    sound.shared_fading = products / squares / sound.untracked;
    sound.own_fading = untracked_squares / squares / squared(sound.untracked);
  }
  if (const double scattered = sound.scattered[0].real(); scattered > kNegligible * signal) {
    sound.spread_hz = std::sqrt(spread / scattered);
    sound.preamble_variance = squared(preamble_root / scattered);
    sound.bits_variance = squared(bits_root / scattered);
  }
  return sound;
}

// The same share for a power whose L is sqrt(2) times as long, and for a part of the time.
double of_longer(double kept) { return kept / std::sqrt(kept * kept + (1 - kept * kept) / 2); }
double of_part(double kept, double part) {
  return kept / std::sqrt(kept * kept + part * part * (1 - kept * kept));
}

// Powers while the slow fading holds.
struct SlowSound {
  std::array<double, kFrequencies> steady{}, diffuse{};  // by frequency
  double mean = 0;                                       // of all, over the band
  double own = 0,
         mixed =
             0;  // variance of the mean over the band by what is scattered: alone, and with the steady part
};

SlowSound slow_sound(const MeanSound& sound, const Pressures& direction, Complex state) {
  SlowSound slow;
  Pressures steady{};
  const double medium = sound.medium[0].real(), scattered = sound.scattered[0].real();
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    steady[m] = sound.steady[m] + state * direction[m];
    slow.steady[m] = std::norm(steady[m]);
    slow.diffuse[m] = std::max(medium - std::norm(direction[m]), 0.0) + scattered;
    slow.mean += (slow.steady[m] + slow.diffuse[m]) / kFrequencies;
  }
  slow.own = mean_square(sound.scattered);
  slow.mixed = scattered > 0 ? 2 * mean_product(steady, times(sound.scattered, steady)) : 0;
  return slow;
}

// A level in dB over the fast fading, at the standard normal z: median + z deviation + z^2 curvature.
struct Level {
  double median_db = 0, deviation_db = 0, curvature_db = 0;
  double at(double z) const { return median_db + z * (deviation_db + z * curvature_db); }
};

// Of a gamma distributed power (Wilson and Hilferty 1931): x = mean (1 - v / 9 + z sqrt(v) / 3)^3, v its relative variance.
Level level_of(double mean, double relative_variance) {
  const double centre = std::max(1 - relative_variance / 9, 0.1);
  const double slope = std::sqrt(relative_variance) / 3 / centre;
  return {kDbPerNeper * (std::log(std::max(mean, 1e-30)) + 3 * std::log(centre)), 3 * kDbPerNeper * slope,
          -1.5 * kDbPerNeper * slope * slope};
}

// What a packet comes to in a slow state: ratios that count for the preamble and for the bits.
class PacketLevels {
 public:
  PacketLevels(const ReceptionCurves& curves, const MeanSound& sound)
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

  Level preamble(const SlowSound& slow, double noise) const {
    const double kept = sound_.preamble_variance;
    return ratio(slow.mean, kept * slow.own + of_longer(kept) * slow.mixed, noise + sound_.preamble_echoes);
  }
  Level bits(const SlowSound& slow, double noise) const {
    return coded_ ? interleaved(slow, noise) : Level{product(slow, noise)};
  }

 private:
  // Relative variance of the ratio: the signal's, less what the untracked part has in common with it.
  double relative_variance(double mean, double variance, double quiet) const {
    const double part = sound_.untracked * mean / (quiet + sound_.untracked * mean);
    return variance / squared(mean) *
           std::max(1 - 2 * part * sound_.shared_fading + part * part * sound_.own_fading, 0.0);
  }
  Level ratio(double mean, double variance, double quiet) const {
    return level_of(mean / (quiet + sound_.untracked * mean), relative_variance(mean, variance, quiet));
  }
  Level interleaved(const SlowSound& slow, double noise) const {
    const double disturbed = noise + sound_.bits_echoes + sound_.untracked * slow.mean;
    const double scale = chip_ / disturbed, scattered = scale * sound_.scattered[0].real();
    double mean = 0, all = 0, steady = 0;
    for (std::size_t m = 0; m < kFrequencies; ++m) {
      const double c = scale * slow.steady[m], d = scale * slow.diffuse[m];
      const double one = std::exp(-c / (1 + d)) / (1 + d);
      mean += one / kFrequencies;
      all += (std::exp(-2 * c / (1 + 2 * d)) / (1 + 2 * d) - one * one) / kFrequencies;
      steady += slow.steady[m] / kFrequencies;
    }
    mean = std::max(mean, 1e-300);
    const double single = scattered > 0 ? squared(scattered) + 2 * scattered * scale * steady : 0;
    const double kept = sound_.bits_variance;
    const double of_mean =
        single > 0 ? squared(scale) * (kept * slow.own + of_longer(kept) * slow.mixed) / single : 0;
    // Deep fades, which count most, are shorter than the power's coherence, in time and in frequency.
    const double shorter = std::cbrt(squared((1 + 2 * scattered) / squared(1 + scattered)));
    const double v = std::log1p(all * of_mean * shorter / (mean * mean));
    const double nepers = -std::log(mean) + v / 2;
    return {kDbPerNeper * std::log(std::max(nepers, 1e-12) / chip_), kDbPerNeper * std::sqrt(v) / nepers, 0};
  }

  // Uncoded or coherent: the constant ratio, dB, that loses the packet as often; no more than the mean.
  double product(const SlowSound& slow, double noise) const {
    const double loss = collects_band_ ? fades(slow, noise) : errors(slow, noise);
    const double mean = slow.mean / (noise + sound_.bits_echoes + sound_.untracked * slow.mean);
    const double mean_db = 10 * std::log10(std::max(mean, 1e-30));
    return std::min(curves_.ratio_db_of(-loss / bits_), mean_db);
  }
  // -ln of the chance that the power of the band does not fall below what its bits need.
  double fades(const SlowSound& slow, double noise) const {
    const double quiet = noise + sound_.bits_echoes, variance = slow.own + slow.mixed;
    const double mean = slow.mean / (quiet + sound_.untracked * slow.mean), least = threshold_ / mean;
    const double v = relative_variance(slow.mean, variance, quiet);
    double loss = 0;  // of a stretch
    if (v < 1.0 / 8) {
      const Level level = level_of(mean, v);
      double chance = 0;
      for (const Node& node : kFive) {
        chance += node.weight * std::exp(fade_bits_ * curves_.log_bit_success_at(level.at(node.z)));
      }
      loss = -std::log(std::clamp(chance, 1e-300, 1.0));
    } else {
      const double below = std::max(below_threshold(v, least), below_linear(slow.mean, variance, quiet));
      loss = -std::log1p(-std::min(below, 1 - 1e-12));
    }
    return loss * (1 + (stretches_ - 1) * std::exp(-loss) * again(v, least));
  }
  // P(X < least) of a gamma distributed X of mean 1, the threshold spread by its width.
  double below_threshold(double v, double least) const {
    if (v >= 1.0 / 8) return gamma_below(1 / v, least / v * std::exp(squared(width_) / v / 2));
    const double wide = v + squared(width_);
    return gamma_below(1 / wide, least / wide);
  }
  // Of signal less threshold times untracked below threshold times the rest: exact of parts that all are above 0.
  double below_linear(double mean, double variance, double quiet) const {
    const double part = threshold_ * sound_.untracked;
    if (part >= 1) return 1;
    const double v = variance / squared(mean) *
                     (1 - 2 * part * sound_.shared_fading + part * part * sound_.own_fading) /
                     squared(1 - part);
    return below_threshold(std::max(v, 1e-3), threshold_ * quiet / (mean * (1 - part)));
  }
  // The chance that the next stretch is above the threshold, of one below (Rice 1944: crossings a second by the time below).
  double again(double v, double least) const {
    if (!(v > 0)) return 0;
    const double x = std::min(least / (1 + v), 1.0);
    return -std::expm1(-1.3 * crossings_ / std::sqrt(v * least) * (1 - x + std::sqrt(2 * v / pi)));
  }
  // Errors of single bits, a exp(-slope ratio), on average over each frequency's Rician fading: they are far apart.
  double errors(const SlowSound& slow, double noise) const {
    const double scale = slope_ / (noise + sound_.bits_echoes + sound_.untracked * slow.mean);
    double loss = 0;
    for (std::size_t m = 0; m < kFrequencies; ++m) {
      const double d = scale * sound_.scattered[0].real();
      const double c = scale * (slow.steady[m] + slow.diffuse[m]) - d;
      loss += errors_at_zero_ * std::exp(-c / (1 + d)) / (1 + d) / kFrequencies;
    }
    return loss;
  }

  const ReceptionCurves& curves_;
  const MeanSound& sound_;
  double chip_, bits_;
  bool coded_, collects_band_;
  double stretches_ = 1, crossings_ = 0;  // of the bits; of a threshold, in each
  double fade_bits_ = 0, threshold_ = 0,
         width_ = 0;  // bits that fade together; the ratio that half of them need
  double slope_ = 0, errors_at_zero_ = 0;
};

// Adds the mean over the strata of large-scale fading, between the levels at which the ratios are known.
class StrataMean {
 public:
  StrataMean(const ReceptionCurves& curves, double kept) : curves_(curves) {
    for (const std::int64_t bits : curves.blocks()) {
      const double part = static_cast<double>(bits) / static_cast<double>(curves.timing().information_bits);
      blocks_.push_back({static_cast<double>(bits), std::sqrt(of_part(kept, part) / kept)});
    }
  }
  // In one of the medium's states.
  void add(const std::array<Level, kLevels>& preamble, const std::array<Level, kLevels>& bits,
           std::size_t state, LinkPrediction& prediction) const {
    constexpr double kWeight = 1.0 / (kStrata * kMediumStates);
    const SlowStates& slow = slow_states();
    for (std::size_t i = 0; i < kStrata; ++i) {
      const double acquired = curves_.acquisition_at(between(preamble, i, slow.preamble(i, state)));
      prediction.acquisition_probability += kWeight * acquired;
      double log_success = 0;
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const double z = slow.block(i, state, b) * blocks_[b].wider;
        log_success += blocks_[b].bits * curves_.log_bit_success_at(between(bits, i, z));
      }
      prediction.delivery_probability += kWeight * acquired * std::exp(log_success);
    }
  }

 private:
  struct Block {
    double bits, wider;
  };
  static double between(const std::array<Level, kLevels>& levels, std::size_t i, double z) {
    double db = 0;
    for (std::size_t k = 0; k < kLevels; ++k) db += slow_states().weights[i][k] * levels[k].at(z);
    return db;
  }
  const ReceptionCurves& curves_;
  std::vector<Block> blocks_;
};

LinkPrediction predict_still(const std::vector<SoundPath>& paths, const Lock& lock, double noise,
                             const ReceptionCurves& curves) {
  LinkPrediction prediction;
  prediction.sinr = mean_signal(paths, lock.window) / (noise + mean_interference(paths, lock.window));
  prediction.acquisition_probability = curves.acquisition(prediction.sinr);
  prediction.delivery_probability =
      prediction.acquisition_probability * std::exp(static_cast<double>(curves.timing().information_bits) *
                                                    curves.log_bit_success(prediction.sinr));
  return prediction;
}

}  // namespace

double rms_delay_spread_s(const std::vector<SoundPath>& paths) {
  double power = 0, first = 0, second = 0;
  for (const SoundPath& path : paths) {
    const double p = to_power_ratio(path.level).value, delay_s = path.delay_s - paths.front().delay_s;
    power += p;
    first += p * delay_s;
    second += p * delay_s * delay_s;
  }
  return power > 0 ? std::sqrt(std::max(second / power - squared(first / power), 0.0)) : 0;
}

LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths, const Lock& lock,
                            const Band& band, double noise, const ReceptionCurves& curves) {
  if (paths.empty()) return {};
  if (!model.enabled) return predict_still(paths, lock, noise, curves);
  const MeanSound sound = mean_sound(paths, lock, band, curves.timing());
  // The medium's pressures that change the power most: K A / sqrt(A^H K A).
  Pressures direction = times(sound.medium, sound.steady);
  const double along = mean_product(sound.steady, direction) * kFrequencies * kFrequencies;
  for (Complex& value : direction) value *= along > 0 ? 1 / std::sqrt(along) : 0;
  const PacketLevels packet(curves, sound);
  const StrataMean mean(curves, sound.bits_variance);
  const double deviation = std::numbers::ln10 / 10 * model.large_scale_db;
  LinkPrediction prediction;
  double signal = 0;
  for (std::size_t i = 0; i < kMediumStates; ++i) {
    const SlowSound slow = slow_sound(sound, direction, slow_states().medium[i]);
    signal += slow.mean / kMediumStates;
    std::array<Level, kLevels> preamble, bits;
    for (std::size_t k = 0; k < kLevels; ++k) {
      // All sound is louder by a factor: as if the noise were weaker.
      const double factor = std::exp(deviation * slow_states().levels[k] - deviation * deviation / 2);
      preamble[k] = packet.preamble(slow, noise / factor);
      bits[k] = packet.bits(slow, noise / factor);
    }
    mean.add(preamble, bits, i, prediction);
  }
  prediction.sinr = signal / (noise + sound.bits_echoes + sound.untracked * signal);
  return prediction;
}

}  // namespace halocline::acoustics
