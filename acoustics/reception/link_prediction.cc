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

constexpr std::size_t kFrequencies = kSignalFrequencies, kStrata = 24, kPairing = 5;
constexpr double kCertain = 1e-100;    // of exp(-gamma / beta): no bit is wrong
constexpr double kNegligible = 1e-12;  // of the power: of no effect
constexpr double kIndependentAfter =
    1.2533;  // coherence times: sqrt(pi / 2), of the power's Gaussian correlation

double squared(double x) { return x * x; }

// Normal quantiles of the middles of strata of equal probability.
const std::array<double, kStrata>& normal_strata() {
  static const std::array<double, kStrata> table = [] {
    std::array<double, kStrata> quantiles{};
    for (std::size_t i = 0; i < kStrata; ++i) {
      quantiles[i] =
          std::numbers::sqrt2 * boost::math::erf_inv((2.0 * static_cast<double>(i) + 1) / kStrata - 1);
    }
    return quantiles;
  }();
  return table;
}

// Gauss-Hermite nodes of a standard normal (Abramowitz and Stegun 1964, table 25.10, scaled).
struct Node {
  double z, weight;
};
constexpr std::array<Node, 3> kThree{
    {{-1.7320508075688772, 1.0 / 6}, {0, 2.0 / 3}, {1.7320508075688772, 1.0 / 6}}};
constexpr std::array<Node, 5> kFive{{{-2.8569700138728056, 0.011257411327720689},
                                     {-1.3556261799742659, 0.22207592200561266},
                                     {0, 0.53333333333333333},
                                     {1.3556261799742659, 0.22207592200561266},
                                     {2.8569700138728056, 0.011257411327720689}}};

// A power of `mean` and `variance`, gamma distributed, at the normal quantile z: Wilson and Hilferty 1931,
// x = mean (1 - 1 / (9 k) + z / (3 sqrt(k)))^3 with k = mean^2 / variance.
class FadingPower {
 public:
  FadingPower(double mean, double variance)
      : mean_(mean), spread_(mean > 0 ? std::sqrt(variance) / mean : 0) {}
  double at(double z) const {
    const double root = std::max(1 - spread_ * spread_ / 9 + z * spread_ / 3, 0.0);
    return mean_ * root * root * root;
  }

 private:
  double mean_, spread_;  // 1 / sqrt(k)
};

// A log-normal value likewise.
class LogNormal {
 public:
  LogNormal(double mean, double variance) {
    const double v = mean > 0 ? std::log1p(variance / (mean * mean)) : 0;
    deviation_ = std::sqrt(v);
    median_ = mean * std::exp(-v / 2);
  }
  double at(double z) const { return median_ * std::exp(deviation_ * z); }

 private:
  double median_, deviation_;
};

// What sounds in the window, on average over all fading.
struct MeanSound {
  std::array<double, kFrequencies> steady{};  // |A_m|^2
  double medium = 0, scattered = 0, echoes = 0;
  double slow_variance = 0;    // of the mean over the band of steady and medium, by the medium
  double frequency_spans = 1;  // n_f
  double slow() const {
    double sum = medium;
    for (const double power : steady) sum += power / kFrequencies;
    return sum;
  }
};

// Correlation of a power's parts between frequencies that are k spacings apart: sum of P exp(-j 2 pi k spacing delay).
using Correlation = std::array<Complex, kFrequencies>;

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

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band) {
  const SoundPath& strongest = paths[lock.window.strongest];
  const double spacing_hz = band.width_hz() / kFrequencies;
  const double kept = doppler_share(*lock.modem, strongest, band.centre_hz());
  MeanSound sound;
  std::array<Complex, kFrequencies> steady{};
  Correlation medium{}, scattered{};
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const SoundPath& path = paths[p];
    const double power = to_power_ratio(path.level).value, tracked = tracked_share(*lock.modem, path);
    const double within = squared(lock.window.weights[p]) * power;
    sound.echoes += lock.window.interference[p] * power + within * (1 - tracked * kept);
    const double signal = within * tracked * kept;
    if (!(signal > 0)) continue;
    const double excess_s = path.delay_s - strongest.delay_s;
    const Complex turn = std::polar(1.0, -2 * pi * std::fmod(spacing_hz * excess_s, 1.0));
    const double cycles = std::fmod((band.low_hz + spacing_hz / 2) * excess_s, 1.0);
    Complex pressure = std::polar(std::sqrt(signal * path.fading.coherent), path.phase_rad - 2 * pi * cycles);
    for (Complex& sum : steady) {
      sum += pressure;
      pressure *= turn;
    }
    add_to(medium, signal * path.fading.medium, turn);
    add_to(scattered, signal * path.fading.scattered, turn);
  }
  for (std::size_t m = 0; m < kFrequencies; ++m) sound.steady[m] = std::norm(steady[m]);
  sound.medium = medium[0].real();
  sound.scattered = scattered[0].real();
  // Var of the mean over m of |A_m + B_m|^2 = mean over m, n of 2 Re(A_m* A_n K_mn) + |K_mn|^2, K_mn = E B_m B_n*.
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n < kFrequencies; ++n) {
      const Complex k = n >= m ? std::conj(medium[n - m]) : medium[m - n];
      sound.slow_variance += 2 * (std::conj(steady[m]) * steady[n] * k).real() / squared(kFrequencies);
    }
  }
  sound.slow_variance = std::max(sound.slow_variance, 0.0) + mean_square(medium);
  if (sound.scattered > kNegligible * sound.slow())
    sound.frequency_spans = squared(sound.scattered) / mean_square(scattered);
  return sound;
}

// The fast fading of one packet while the slow one holds.
class PacketChances {
 public:
  PacketChances(const ReceptionCurves& curves, const MeanSound& sound, double noise, double coherence_s)
      : curves_(curves),
        sound_(sound),
        noise_(noise),
        interleaved_(is_coded_frequency_shift_keying(curves.modem().error_model)),
        collects_band_(!is_frequency_shift_keying(curves.modem().error_model)) {
    const double preamble_s = curves.timing().preamble.seconds();
    const double bits_s = (curves.timing().duration - curves.timing().preamble).seconds();
    const auto spans = [&](double time_s) {
      return std::max(1.0, time_s / (kIndependentAfter * coherence_s));
    };
    preamble_spans_ = spans(preamble_s) * sound.frequency_spans;
    time_spans_ = spans(bits_s);
  }

  // With all sound louder by `factor` and the steady part by `slow` besides.
  double acquisition(double factor, double slow) const {
    const double steady = factor * slow * sound_.slow(), fast = factor * sound_.scattered;
    const FadingPower signal(steady + fast, (2 * steady * fast + fast * fast) / preamble_spans_);
    double sum = 0;
    for (const Node& node : kThree) {
      sum += node.weight * curves_.acquisition(signal.at(node.z) / disturbance(factor));
    }
    return sum;
  }
  double success(double factor, double slow) const {
    return interleaved_ ? interleaved_success(factor, slow) : product_success(factor, slow);
  }

 private:
  double disturbance(double factor) const { return noise_ + factor * sound_.echoes; }

  double interleaved_success(double factor, double slow) const {
    const double chip = chip_energy(curves_.modem()) / disturbance(factor) / kEffectiveRatioBeta;
    const double d = chip * factor * sound_.scattered;
    double mean = 0, square = 0;
    for (const double steady : sound_.steady) {
      const double c = chip * factor * slow * (steady + sound_.medium);
      mean += std::exp(-c / (1 + d)) / (1 + d) / kFrequencies;
      square += std::exp(-2 * c / (1 + 2 * d)) / (1 + 2 * d) / kFrequencies;
    }
    if (mean < kCertain) return 1;
    double sum = 0;
    // Blocks are long against the coherence time or share its state: each has its part of the spans.
    const double spans = std::max(1.0, time_spans_ / static_cast<double>(curves_.blocks().size()));
    const LogNormal average(mean, std::max(square - mean * mean, 0.0) / (spans * sound_.frequency_spans));
    for (const Node& node : kThree) {
      const double ratio = -kEffectiveRatioBeta * std::log(std::clamp(average.at(node.z), 1e-300, 1.0));
      double log_success = 0;
      for (const std::int64_t bits : curves_.blocks()) {
        log_success +=
            static_cast<double>(bits) * curves_.log_bit_success(ratio / chip_energy(curves_.modem()));
      }
      sum += node.weight * std::exp(log_success);
    }
    return sum;
  }

  double product_success(double factor, double slow) const {
    const double fast = factor * sound_.scattered, disturbed = disturbance(factor);
    const double spans = collects_band_ ? time_spans_ : time_spans_ * sound_.frequency_spans;
    const double bits = static_cast<double>(curves_.timing().information_bits) / spans;
    double chance = 0;
    const auto add = [&](double steady, double variance_share, double weight) {
      const FadingPower signal(steady + fast, (2 * steady * fast + fast * fast) * variance_share);
      for (const Node& node : kFive) {
        chance +=
            weight * node.weight * std::exp(bits * curves_.log_bit_success(signal.at(node.z) / disturbed));
      }
    };
    if (collects_band_) {
      add(factor * slow * sound_.slow(), 1 / sound_.frequency_spans, 1);
    } else {
      for (const double steady : sound_.steady) {
        add(factor * slow * (steady + sound_.medium), 1, 1.0 / kFrequencies);
      }
    }
    return std::pow(chance, spans);
  }

  const ReceptionCurves& curves_;
  const MeanSound& sound_;
  double noise_;
  bool interleaved_, collects_band_;
  double preamble_spans_ = 1, time_spans_ = 1;
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
  const MeanSound sound = mean_sound(paths, lock, band);
  const double slow = sound.slow();
  LinkPrediction prediction;
  prediction.sinr = (slow + sound.scattered) / (noise + sound.echoes);
  // Large scale on everything, the medium on the steady part: each by strata, paired so that both are spread evenly.
  const double deviation = std::numbers::ln10 / 10 * model.large_scale_db;
  const double medium = slow > kNegligible * sound.scattered ? sound.slow_variance / (slow * slow) : 0;
  const FadingPower steady(1, medium);
  const PacketChances chances(curves, sound, noise, coherence_time_s(paths, lock.window));
  for (std::size_t i = 0; i < kStrata; ++i) {
    const double factor = std::exp(deviation * normal_strata()[i] - deviation * deviation / 2);
    const double of_steady = steady.at(normal_strata()[(kPairing * i + kPairing / 2) % kStrata]);
    const double acquired = chances.acquisition(factor, of_steady);
    prediction.acquisition_probability += acquired / kStrata;
    if (acquired > 1e-9)
      prediction.delivery_probability += acquired * chances.success(factor, of_steady) / kStrata;
  }
  return prediction;
}

}  // namespace halocline::acoustics
