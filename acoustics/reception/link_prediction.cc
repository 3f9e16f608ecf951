#include "acoustics/reception/link_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/packet_levels.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kMediumStates = 8, kLevels = 4, kStrata = 32;

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

// Adds the mean over the strata of large-scale fading, between the levels at which the ratios are known.
class StrataMean {
 public:
  StrataMean(const ReceptionCurves& curves, double kept) : curves_(curves) {
    for (const std::int64_t bits : curves.blocks()) {
      const double part = static_cast<double>(bits) / static_cast<double>(curves.timing().information_bits);
      blocks_.push_back({static_cast<double>(bits), std::sqrt(kept_of_part(kept, part) / kept)});
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

// Without fading nothing varies but which echoes sound.
LinkPrediction predict_still(const std::vector<SoundPath>& paths, const Lock& lock, double noise,
                             const ReceptionCurves& curves) {
  const double preamble_s = curves.timing().preamble.seconds(), end_s = curves.timing().duration.seconds();
  const SignalHistory history = still_history(paths, lock, {preamble_s, end_s});
  const double signal = mean_signal(paths, lock.window);
  double preamble_echoes = 0, bits_echoes = 0, log_success = 0;
  for (std::size_t i = 0; i < history.stretches(); ++i) {
    const double seconds = history.edges_s[i + 1] - history.edges_s[i];
    if (history.edges_s[i + 1] <= preamble_s) {
      preamble_echoes += seconds / preamble_s * history.echoes[i];
      continue;
    }
    const double part = seconds / (end_s - preamble_s);
    bits_echoes += part * history.echoes[i];
    log_success += part * static_cast<double>(curves.timing().information_bits) *
                   curves.log_bit_success(signal / (noise + history.echoes[i]));
  }
  LinkPrediction prediction;
  prediction.sinr = signal / (noise + bits_echoes);
  prediction.acquisition_probability = curves.acquisition(signal / (noise + preamble_echoes));
  prediction.delivery_probability = prediction.acquisition_probability * std::exp(log_success);
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
  const BandPressures direction = sound.medium_direction();
  const PacketLevels packet(curves, sound);
  const StrataMean mean(curves, sound.bits_variance);
  // What changes as the ends sway holds through a packet too.
  const double deviation =
      std::hypot(std::numbers::ln10 / 10 * model.large_scale_db, std::sqrt(std::log1p(sound.sway_variance)));
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
  // Sums of rounded parts.
  prediction.acquisition_probability = std::min(prediction.acquisition_probability, 1.0);
  prediction.delivery_probability = std::min(prediction.delivery_probability, 1.0);
  return prediction;
}

LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths,
                            const Modem& receiver, const std::vector<LikelyWindow>& windows, const Band& band,
                            double noise, const ReceptionCurves& curves) {
  LinkPrediction mean;
  for (const LikelyWindow& likely : windows) {
    const Lock lock{&receiver, likely.window};
    const LinkPrediction one = predict_link(model, paths, lock, band, noise, curves);
    if (!model.enabled) return one;
    mean.sinr += likely.probability * one.sinr;
    mean.acquisition_probability += likely.probability * one.acquisition_probability;
    mean.delivery_probability += likely.probability * one.delivery_probability;
  }
  return mean;
}

}  // namespace halocline::acoustics
