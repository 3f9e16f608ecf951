#include "acoustics/reception/link_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include "acoustics/math/delay_profile.h"
#include "acoustics/math/functions.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/packet_levels.h"
#include "acoustics/reception/power_law.h"
#include "core/random.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kPowers = 8, kPatterns = 16, kLevels = 7, kStrata = 32;
constexpr double kAlike = 0.03;  // slow fading of less than this share of the signal counts as none

// The middles of strata of equal probability of a standard normal, scaled to its variance.
template <std::size_t count>
std::array<double, count> normal_strata() {
  std::array<double, count> strata{};
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double p = (static_cast<double>(i) + 0.5) / count;
    strata[i] = normal_quantile(p);
    squares += squared(strata[i]) / count;
  }
  for (double& value : strata) value /= std::sqrt(squares);
  return strata;
}

// The slow states: levels of large-scale fading at which a packet's fate is computed, the strata between which it is
// interpolated, each with normals for what fades fast, and the medium's states.
struct SlowStates {
  std::array<double, kLevels> levels{-2.4, -1.6, -0.8, 0, 0.8, 1.6, 2.4};  // standard deviations
  std::array<double, kStrata> strata = normal_strata<kStrata>();
  std::array<std::size_t, kStrata> below{};  // the level below, and how far between
  std::array<double, kStrata> part{};
  std::array<double, kPowers> powers = normal_strata<kPowers>();  // scores of the slow power
  std::array<double, kPatterns> pattern_powers = normal_strata<kPatterns>();
  std::array<BandPressures, kPatterns> patterns{};  // normals of the medium

  SlowStates() {
    for (std::size_t i = 0; i < kStrata; ++i) {
      const double place = (strata[i] - levels[0]) / (levels[1] - levels[0]);
      below[i] = static_cast<std::size_t>(place);
      part[i] = place - static_cast<double>(below[i]);
    }
    for (std::size_t c = 0; c < 2 * kSignalFrequencies; ++c) add_coordinate(c);
  }
  // Coordinate `c` of the patterns' normals: each stratum once, in the one of many random orders that is correlated least
  // with those before, by itself and by squares.
  void add_coordinate(std::size_t c) {
    constexpr std::uint64_t kTrials = 300;
    const auto value = [&](std::size_t i, std::size_t k) {
      return k % 2 == 0 ? patterns[i][k / 2].real() : patterns[i][k / 2].imag();
    };
    std::array<double, kPatterns> best{};
    double least = 1e300;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
      std::array<double, kPatterns> order = pattern_powers;
      for (std::size_t i = kPatterns - 1; i > 0; --i) {
        const DrawAddress address{.purpose = purpose_of("medium-states"), .which = (trial * 64 + c) * 64 + i};
        std::swap(order[i], order[bits_at(address) % (i + 1)]);
      }
      double correlated = 0;
      for (std::size_t k = 0; k < c; ++k) {
        double products = 0, squares = 0;
        for (std::size_t i = 0; i < kPatterns; ++i) {
          products += order[i] * value(i, k);
          squares += (squared(order[i]) - 1) * (2 * squared(value(i, k)) - 1);
        }
        correlated += squared(products) + squared(squares);
      }
      if (correlated < least) {
        least = correlated;
        best = order;
      }
    }
    for (std::size_t i = 0; i < kPatterns; ++i) {
      const double normal = best[i] / std::numbers::sqrt2;
      patterns[i][c / 2] += c % 2 == 0 ? Complex(normal, 0) : Complex(0, normal);
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

// One of the medium's states: the preamble's level, and the bits' ratios at kLevels of large-scale fading.
struct SlowLevels {
  Level preamble;
  std::array<Level, kLevels> bits;
};

// Means over the strata of large-scale fading.
class StrataMean {
 public:
  StrataMean(double deviation, const ReceptionCurves& curves, const MeanSound& sound, double signal,
             double noise)
      : curves_(curves) {
    const double echoes = sound.preamble_echoes + sound.untracked * signal;
    for (std::size_t i = 0; i < kStrata; ++i) {
      const double quiet = noise / loudness(deviation, slow_states().strata[i]);
      preamble_db_[i] = 10 * std::log10(quiet + echoes);
    }
    const auto all_bits = static_cast<double>(curves.timing().information_bits);
    for (const std::int64_t bits : curves.blocks()) {
      const double part = static_cast<double>(bits) / all_bits, kept = sound.bits_variance;
      blocks_.push_back({static_cast<double>(bits), std::sqrt(kept_of_part(kept, part) / kept)});
    }
  }
  // All sound is louder by this factor, at a score of large-scale fading of `deviation` nepers of power.
  static double loudness(double deviation, double z) {
    return std::exp(deviation * z - deviation * deviation / 2);
  }
  // Adds those in one of the medium's states.
  void add(const SlowLevels& levels, std::size_t state, std::size_t states,
           LinkPrediction& prediction) const {
    const double weight = 1.0 / static_cast<double>(kStrata * states);
    const SlowStates& slow = slow_states();
    for (std::size_t i = 0; i < kStrata; ++i) {
      const double acquired =
          curves_.acquisition_at(levels.preamble.at(slow.preamble(i, state)) - preamble_db_[i]);
      prediction.acquisition_probability += weight * acquired;
      double log_success = 0;
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const double z = slow.block(i, state, b) * blocks_[b].wider;
        log_success += blocks_[b].bits * curves_.log_bit_success_at(between(levels.bits, i, z));
      }
      prediction.delivery_probability += weight * acquired * std::exp(log_success);
    }
  }

 private:
  struct Block {
    double bits, wider;
  };
  static double between(const std::array<Level, kLevels>& levels, std::size_t i, double z) {
    const SlowStates& slow = slow_states();
    const double low = levels[slow.below[i]].at(z), high = levels[slow.below[i] + 1].at(z);
    return low + slow.part[i] * (high - low);
  }
  const ReceptionCurves& curves_;
  std::array<double, kStrata> preamble_db_{};  // noise and interference over large-scale fading
  std::vector<Block> blocks_;
};

// The medium's states over the band, the quietest first, with the strata of the slow power.
std::array<SlowSound, kPatterns> patterns_of(const MeanSound& sound) {
  const MediumStates medium(sound);
  const PowerLaw slow = sound.slow_power();
  std::array<SlowSound, kPatterns> patterns;
  for (std::size_t i = 0; i < kPatterns; ++i) patterns[i] = medium.state(slow_states().patterns[i]);
  std::sort(patterns.begin(), patterns.end(),
            [](const SlowSound& a, const SlowSound& b) { return a.slow_power < b.slow_power; });
  for (std::size_t i = 0; i < kPatterns; ++i) {
    const double power = std::max(slow.at(slow_states().pattern_powers[i]), 0.0);
    if (patterns[i].slow_power > 0) patterns[i].scale(power / patterns[i].slow_power);
  }
  return patterns;
}

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
  std::vector<WeightedDelay> delays;
  delays.reserve(paths.size());
  for (const SoundPath& path : paths) delays.push_back({path.delay_s, to_power_ratio(path.level).value});
  return delay_moments(delays).spread_s;
}

LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths, const Lock& lock,
                            const Band& band, double noise, const ReceptionCurves& curves) {
  if (paths.empty()) return {};
  if (!model.enabled) return predict_still(paths, lock, noise, curves);
  const MeanSound sound = mean_sound(paths, lock, band, curves.timing());
  const PacketLevels packet(curves, sound);
  const PowerLaw slow = sound.slow_power();
  const double signal = slow.mean + sound.scattered_power();
  // What changes as the ends sway holds through a packet too.
  const double deviation =
      std::hypot(std::numbers::ln10 / 10 * model.large_scale_db, std::sqrt(std::log1p(sound.sway_variance)));
  const StrataMean mean(deviation, curves, sound, signal, noise);
  std::array<double, kLevels> loudness{};
  for (std::size_t k = 0; k < kLevels; ++k) {
    loudness[k] = StrataMean::loudness(deviation, slow_states().levels[k]);
  }
  LinkPrediction prediction;
  SlowLevels levels;
  if (packet.collects_band()) {
    const double interference = sound.bits_echoes + sound.untracked * signal;
    const bool alike = slow.variance < squared(kAlike * signal);
    for (std::size_t i = 0; i < kPowers; ++i) {
      if (i == 0 || !alike) {
        const double power = alike ? slow.mean : std::max(slow.at(slow_states().powers[i]), 0.0);
        const FadingSignal fading = packet.fading_signal(power);
        levels.preamble = packet.preamble(power);
        for (std::size_t k = 0; k < kLevels; ++k) {
          levels.bits[k] = packet.bits(fading, noise / loudness[k] + interference);
        }
      }
      mean.add(levels, i, kPowers, prediction);
    }
  } else {
    const auto patterns = patterns_of(sound);
    for (std::size_t i = 0; i < kPatterns; ++i) {
      levels.preamble = packet.preamble(patterns[i].slow_power);
      for (std::size_t k = 0; k < kLevels; ++k)
        levels.bits[k] = packet.bits(patterns[i], noise / loudness[k]);
      mean.add(levels, i, kPatterns, prediction);
    }
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
