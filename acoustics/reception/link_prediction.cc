#include "acoustics/reception/link_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include "acoustics/math/delay_profile.h"
#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/packet_levels.h"
#include "acoustics/reception/power_law.h"
#include "acoustics/reception/strata_mean.h"
#include "core/elementary.h"
#include "core/random.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kPowers = 8, kPatterns = 16;
constexpr double kAlike = 0.03;  // slow fading of less than this share of the signal counts as none

// The medium's states: scores of the slow power, and normals of its pressures.
struct SlowStates {
  std::array<double, kPowers> powers = normal_strata<kPowers>();
  std::array<double, kPatterns> pattern_powers = normal_strata<kPatterns>();
  std::array<BandPressures, kPatterns> patterns{};  // normals of the medium

  SlowStates() {
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
};

const SlowStates& slow_states() {
  static const SlowStates states;
  return states;
}

// The medium's states over the band, the quietest first, with the strata of the slow power.
std::array<SlowSound, kPatterns> patterns_of(const MeanSound& sound) {
  const MediumStates medium(sound);
  const PowerLaw slow = sound.slow;
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

// Phase-shift keying: levels by the slow power, which rises; computed at four scores, between them by the cubic through those.
// Where the quietest are decoded or the loudest lost, all are.
std::array<StrataMean::Levels, kPowers> levels_of(const PacketLevels& packet, const StrataMean& mean,
                                                  const PowerLaw& slow) {
  const auto& scores = slow_states().powers;
  std::array<StrataMean::Levels, kPowers> levels;
  std::array<double, StrataMean::kLevels>
      parts{};  // guessed as those of the power before, or else of the level before
  double last = 0;
  const auto compute = [&](std::size_t i) {
    const FadingSignal fading = packet.fading_signal(std::max(slow.at(scores[i]), 0.0));
    levels[i] = mean.levels([&](std::size_t k) {
      if (!(parts[k] > 0)) parts[k] = last;
      const Level bits = packet.bits(fading, mean.noise(k), parts[k]);
      last = parts[k];
      return bits;
    });
  };
  compute(0);
  if (!(slow.variance > 0) || mean.decodes(levels.front().front())) {
    std::fill(levels.begin() + 1, levels.end(), levels.front());
    return levels;
  }
  compute(kPowers - 1);
  if (mean.loses(levels.back().back())) {
    std::fill(levels.begin(), levels.end() - 1, levels.back());
    return levels;
  }
  constexpr std::array<std::size_t, 4> kComputed{0, 2, 5, kPowers - 1};
  compute(kComputed[1]);
  compute(kComputed[2]);
  for (const std::size_t i : {1, 3, 4, 6}) {
    for (const std::size_t from : kComputed) {
      double share = 1;  // Lagrange's
      for (const std::size_t other : kComputed) {
        if (other != from) share *= (scores[i] - scores[other]) / (scores[from] - scores[other]);
      }
      for (std::size_t k = 0; k < StrataMean::kLevels; ++k) {
        levels[i][k].median_db += share * levels[from][k].median_db;
      }
    }
  }
  return levels;
}

void add_powers(const PacketLevels& packet, const MeanSound& sound, StrataMean& mean) {
  const PowerLaw slow = sound.slow;
  const bool alike = slow.variance < squared(kAlike * (slow.mean + sound.fast));
  const PowerLaw powers = alike ? PowerLaw{slow.mean} : slow;
  const auto levels = levels_of(packet, mean, powers);
  Level preamble;
  for (std::size_t i = 0; i < kPowers; ++i) {
    if (i == 0 || (!alike && !mean.finds(preamble))) {
      preamble = packet.preamble(std::max(powers.at(slow_states().powers[i]), 0.0));
    }
    mean.add(preamble, levels[i], i, 1.0 / kPowers);
  }
}

// Frequency-shift keying: the middle level of each state; those on both sides of it as far from it as in the states nearest in
// power of those of which all are computed. Where those are certain, each state by itself.
std::array<StrataMean::Levels, kPatterns> levels_of(const PacketLevels& packet, const StrataMean& mean,
                                                    const std::array<SlowSound, kPatterns>& patterns) {
  constexpr std::size_t kMiddle = StrataMean::kLevels / 2, kApart = 5;
  const auto level = [&](std::size_t i) {
    return [&, i](std::size_t k) { return packet.bits(patterns[i], mean.noise(k)); };
  };
  std::array<StrataMean::Levels, kPatterns> levels;
  bool decoded = true, lost = true;
  for (std::size_t i = 0; i < kPatterns; i += kApart) {
    decoded = decoded && mean.decodes(level(i)(0));
    lost = lost && !decoded && mean.loses(level(i)(StrataMean::kLevels - 1));
    if (!decoded && !lost) break;
  }
  if (decoded || lost) {
    for (std::size_t i = 0; i < kPatterns; ++i) levels[i] = mean.levels(level(i));
    return levels;
  }
  for (std::size_t i = 0; i < kPatterns; i += kApart) levels[i] = mean.uncertain_levels(level(i));
  for (std::size_t i = 0; i < kPatterns; ++i) {
    if (i % kApart == 0) continue;
    const StrataMean::Levels &low = levels[i - i % kApart], &high = levels[i - i % kApart + kApart];
    const double part = static_cast<double>(i % kApart) / kApart;
    const Level middle = level(i)(kMiddle);
    const auto beside = [&](double one, double one_middle, double other, double other_middle) {
      return (1 - part) * (one - one_middle) + part * (other - other_middle);
    };
    for (std::size_t k = 0; k < StrataMean::kLevels; ++k) {
      levels[i][k] = {middle.median_db + beside(low[k].median_db, low[kMiddle].median_db, high[k].median_db,
                                                high[kMiddle].median_db),
                      middle.deviation_db + beside(low[k].deviation_db, low[kMiddle].deviation_db,
                                                   high[k].deviation_db, high[kMiddle].deviation_db)};
    }
  }
  return levels;
}

void add_patterns(const PacketLevels& packet, const MeanSound& sound, StrataMean& mean) {
  const auto patterns = patterns_of(sound);
  const auto levels = levels_of(packet, mean, patterns);
  Level preamble;
  for (std::size_t i = 0; i < kPatterns; ++i) {
    if (i == 0 || !mean.finds(preamble)) preamble = packet.preamble(patterns[i].slow_power);
    mean.add(preamble, levels[i], i, 1.0 / kPatterns);
  }
}

double sinr_of(const MeanSound& sound, double noise) {
  const double signal = sound.slow.mean + sound.fast;
  return signal / (noise + sound.bits_echoes + sound.untracked * signal);
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
  prediction.delivery_probability = prediction.acquisition_probability * elementary::exp(log_success);
  return prediction;
}

}  // namespace

double rms_delay_spread_s(const std::vector<SoundPath>& paths) {
  std::vector<WeightedDelay> delays;
  delays.reserve(paths.size());
  for (const SoundPath& path : paths) delays.push_back({path.delay_s, fast_power(path.level.value)});
  return delay_moments(delays).spread_s;
}

LinkPrediction predict_link(const FadingModel& model, const std::vector<SoundPath>& paths, const Lock& lock,
                            const Band& band, double noise, const ReceptionCurves& curves) {
  if (paths.empty()) return {};
  if (!model.enabled) return predict_still(paths, lock, noise, curves);
  const MeanSound sound = mean_sound(paths, lock, band, curves.timing());
  const PacketLevels packet(curves, sound);
  // What changes as the ends sway holds through a packet too.
  const double deviation = elementary::hypot(std::numbers::ln10 / 10 * model.large_scale_db,
                                             std::sqrt(elementary::log1p(sound.sway_variance)));
  StrataMean mean(deviation, curves, sound, noise);
  if (packet.collects_band()) {
    add_powers(packet, sound, mean);
  } else {
    add_patterns(packet, sound, mean);
  }
  return {sinr_of(sound, noise), mean.acquisition_probability(), mean.delivery_probability()};
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

double predicted_sinr(const FadingModel& model, const std::vector<SoundPath>& paths, const Modem& receiver,
                      const std::vector<LikelyWindow>& windows, const Band& band, double noise,
                      const ReceptionCurves& curves) {
  if (!model.enabled) return predict_link(model, paths, receiver, windows, band, noise, curves).sinr;
  double mean = 0;
  for (const LikelyWindow& likely : windows) {
    mean += likely.probability *
            sinr_of(mean_sound(paths, {&receiver, likely.window}, band, curves.timing()), noise);
  }
  return mean;
}

}  // namespace halocline::acoustics
