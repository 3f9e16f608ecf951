// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/link_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/prediction/gamma_power.h"
#include "acoustics/prediction/medium_states.h"
#include "acoustics/prediction/packet_levels.h"
#include "acoustics/prediction/reception_statistics.h"
#include "acoustics/prediction/stratified_average.h"
#include "acoustics/reception/guard_window.h"
#include "core/elementary.h"
#include "core/random.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr std::size_t kPowers = 8, kPatterns = kMediumStates;
constexpr double kAlike = 0.03;  // block fading below this share of the signal counts as none

// States of the medium: normal scores of the block-fading power, and normal variables for its pressures.
struct BlockFadingStates {
  std::array<double, kPowers> powers = normal_strata<kPowers>();
  std::array<double, kPatterns> pattern_powers = normal_strata<kPatterns>();
  MediumNormals patterns{};

  BlockFadingStates() {
    for (std::size_t c = 0; c < 2 * kSignalFrequencies; ++c) add_coordinate(c);
  }
  // Fills coordinate `c` of the normal variables: each stratum once, in the order, of many random ones, whose
  // values and squares correlate least with the coordinates before.
  void add_coordinate(std::size_t c) {
    constexpr std::uint64_t kTrials = 300;
    const auto coordinate = [&](std::size_t k) -> std::array<double, kPatterns>& {
      return k % 2 == 0 ? patterns.re[k / 2] : patterns.im[k / 2];
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
          products += order[i] * coordinate(k)[i];
          squares += (squared(order[i]) - 1) * (2 * squared(coordinate(k)[i]) - 1);
        }
        correlated += squared(products) + squared(squares);
      }
      if (correlated < least) {
        least = correlated;
        best = order;
      }
    }
    for (std::size_t i = 0; i < kPatterns; ++i) coordinate(c)[i] = best[i] / std::numbers::sqrt2;
  }
};

const BlockFadingStates& block_fading_states() {
  static const BlockFadingStates states;
  return states;
}

// States of the medium over the band in order of ascending power, scaled to the strata of the block-fading
// power.
std::array<BlockFading, kPatterns> patterns_of(const ReceptionStatistics& sound) {
  const std::array<BlockFading, kPatterns> states = medium_states(sound, block_fading_states().patterns);
  std::array<BlockFading, kPatterns> patterns;
  std::array<std::size_t, kPatterns> order;
  for (std::size_t i = 0; i < kPatterns; ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return states[a].block_power < states[b].block_power; });
  const std::array<double, kPatterns> powers = sound.block_fading.at(block_fading_states().pattern_powers);
  for (std::size_t i = 0; i < kPatterns; ++i) {
    patterns[i] = states[order[i]];
    if (patterns[i].block_power > 0) patterns[i].scale(std::max(powers[i], 0.0) / patterns[i].block_power);
  }
  return patterns;
}

// Phase-shift keying: signals at the least, the median and the greatest block-fading power, each made when it
// is first asked for. They do not depend on the noise, so averages over several noises share them.
class PowerSignals {
 public:
  enum Power { kQuiet, kMedian, kLoud };
  PowerSignals(const PacketLevels& packet, GammaPower block_fading, double fast)
      : packet_(packet), fast_(fast) {
    alike_ = block_fading.variance < squared(kAlike * (block_fading.mean + fast));
    if (alike_) block_fading = {block_fading.mean};
    powers_ = block_fading.at(block_fading_states().powers);
    for (double& power : powers_) power = std::max(power, 0.0);
    median_ = std::max(block_fading.at(0), 0.0);
  }
  // True when the powers hardly differ.
  bool alike() const { return alike_; }
  const std::array<double, kPowers>& powers() const { return powers_; }
  double median() const { return median_; }
  double fast() const { return fast_; }
  const FadingSignal& at(Power power) {
    std::optional<FadingSignal>& signal = signals_[power];
    if (!signal)
      signal.emplace(packet_.fading_signal(power == kQuiet    ? powers_.front()
                                           : power == kMedian ? median_
                                                              : powers_.back()));
    return *signal;
  }

 private:
  const PacketLevels& packet_;
  std::array<double, kPowers> powers_;
  double median_ = 0, fast_;
  bool alike_ = false;
  std::array<std::optional<FadingSignal>, 3> signals_;
};

// Phase-shift keying: levels for each block-fading power, in ascending order. They are computed at the least,
// the median and the greatest power; between them the ratio to the mean power lies on the parabola through
// those three. If the strongest state is lost, or the weakest decoded, so are all.
std::array<StratifiedAverage::Levels, kPowers> levels_of(const PacketLevels& packet,
                                                         const StratifiedAverage& mean,
                                                         PowerSignals& signals) {
  const std::array<double, kPowers>& powers = signals.powers();
  const double median = signals.median(), fast = signals.fast();
  // Parts of a packet: the guess is the result for the previous power, or else for the previous level.
  std::array<double, StratifiedAverage::kLevels> parts{};
  double last = 0;
  const auto levels_at = [&](PowerSignals::Power power) {
    const FadingSignal& fading = signals.at(power);
    return mean.levels([&](std::size_t k) {
      if (!(parts[k] > 0)) parts[k] = last;
      const Level bits = packet.bits(fading, mean.noise(k), parts[k]);
      last = parts[k];
      return bits;
    });
  };
  std::array<StratifiedAverage::Levels, kPowers> levels;
  const auto in_db = [&](double power) { return fast_decibels(std::max(power + fast, 1e-30)); };
  const auto are_lost = [&](const StratifiedAverage::Levels& of_loudest) {
    return mean.loses(of_loudest.back());
  };
  // An upper bound of the level: fading does not improve the bits by more than kMaxGainDb.
  StratifiedAverage::Levels most{};
  most.back().median_db =
      in_db(powers.back()) - fast_decibels(mean.noise(most.size() - 1)) + PacketLevels::kMaxGainDb;
  if (are_lost(most)) {
    levels.fill(mean.spread(most, most.size() - 1, 0, most.size() - 1));
    return levels;
  }
  // Evaluates the more likely outcome first: the other end is then rarely needed.
  const bool likely_lost = packet.is_likely_lost(median, mean.noise(StratifiedAverage::kLevels / 2));
  StratifiedAverage::Levels loud;
  if (likely_lost) {
    levels.fill(loud = levels_at(PowerSignals::kLoud));
    if (are_lost(loud)) return levels;
  }
  const StratifiedAverage::Levels quiet = levels_at(PowerSignals::kQuiet);
  levels.fill(quiet);
  if (!(powers.back() > powers.front()) || mean.decodes(quiet.front())) return levels;
  if (!likely_lost) {
    loud = levels_at(PowerSignals::kLoud);
    if (are_lost(loud)) {
      levels.fill(loud);
      return levels;
    }
  }
  const StratifiedAverage::Levels middle = levels_at(PowerSignals::kMedian);
  const auto& scores = block_fading_states().powers;
  const double quiet_db = in_db(powers.front()), middle_db = in_db(median), loud_db = in_db(powers.back());
  for (std::size_t i = 1; i < kPowers; ++i) {
    const double here_db = in_db(powers[i]);
    for (std::size_t k = 0; k < StratifiedAverage::kLevels; ++k) {
      levels[i][k].median_db =
          here_db + on_parabola(quiet[k].median_db - quiet_db, middle[k].median_db - middle_db,
                                loud[k].median_db - loud_db, scores[i] / scores.back());
    }
  }
  return levels;
}

void add_powers(const PacketLevels& packet, PowerSignals& signals, StratifiedAverage& mean) {
  const auto levels = levels_of(packet, mean, signals);
  Level preamble;
  for (std::size_t i = 0; i < kPowers; ++i) {
    if (i == 0 || (!signals.alike() && !mean.finds(preamble))) {
      preamble = packet.preamble(signals.powers()[i]);
    }
    mean.add(preamble, levels[i], i, 1.0 / kPowers);
  }
}

// Frequency-shift keying: levels of the bits, computed for many states together.
class StateLevels {
 public:
  StateLevels(const PacketLevels& packet, const StratifiedAverage& mean,
              const std::array<BlockFading, kPatterns>& states)
      : packet_(packet), mean_(mean), states_(states) {}

  std::array<StratifiedAverage::Levels, kPatterns> levels{};

  // Computes level `k` of these states.
  void compute(std::span<const std::size_t> states, std::size_t k) {
    std::array<PacketLevels::StateAndNoise, kPatterns> cases{};
    std::array<Level, kPatterns> made;
    for (std::size_t i = 0; i < states.size(); ++i) cases[i] = {&states_[states[i]], mean_.noise(k)};
    packet_.bits(std::span(cases).first(states.size()), std::span(made).first(states.size()));
    for (std::size_t i = 0; i < states.size(); ++i) levels[states[i]][k] = made[i];
  }
  // Computes all levels of state `i`: from level `k` when that is certain, otherwise one by one.
  void compute_unless(bool certain, std::size_t i, std::size_t k) {
    if (certain) {
      mean_.spread(levels[i], k, 0, StratifiedAverage::kLevels);
    } else {
      levels[i] = mean_.levels([&](std::size_t at) { return packet_.bits(states_[i], mean_.noise(at)); });
    }
  }

 private:
  const PacketLevels& packet_;
  const StratifiedAverage& mean_;
  const std::array<BlockFading, kPatterns>& states_;
};

// Frequency-shift keying: the middle level is computed for each state. The levels on both sides of it differ
// from it as in the nearest of four states of which all are computed, interpolated by index. If levels of all
// four are certain to be decoded or lost, each state is computed on its own.
std::array<StratifiedAverage::Levels, kPatterns> levels_of(
    const PacketLevels& packet, const StratifiedAverage& mean,
    const std::array<BlockFading, kPatterns>& patterns) {
  constexpr std::size_t kMiddle = StratifiedAverage::kLevels / 2, kLast = StratifiedAverage::kLevels - 1,
                        kApart = 5;
  constexpr std::array<std::size_t, 4> kComputed{0, 5, 10, 15};
  constexpr std::array<std::size_t, 12> kOthers{1, 2, 3, 4, 6, 7, 8, 9, 11, 12, 13, 14};
  StateLevels all(packet, mean, patterns);
  auto& levels = all.levels;
  all.compute(kComputed, 0);
  if (std::all_of(kComputed.begin(), kComputed.end(),
                  [&](std::size_t i) { return mean.decodes(levels[i][0]); })) {
    all.compute(kOthers, 0);
    for (std::size_t i = 0; i < kPatterns; ++i) all.compute_unless(mean.decodes(levels[i][0]), i, 0);
    return levels;
  }
  all.compute(kComputed, kLast);
  if (std::all_of(kComputed.begin(), kComputed.end(),
                  [&](std::size_t i) { return mean.loses(levels[i][kLast]); })) {
    all.compute(kOthers, kLast);
    for (std::size_t i = 0; i < kPatterns; ++i) all.compute_unless(mean.loses(levels[i][kLast]), i, kLast);
    return levels;
  }
  all.compute(kComputed, kMiddle);
  all.compute(kOthers, kMiddle);
  std::array<std::size_t, kComputed.size()> bent{};
  std::size_t bent_count = 0;
  for (const std::size_t i : kComputed) {
    if (mean.lie_on_parabola(levels[i])) {
      mean.fill_parabola(levels[i]);
    } else {
      bent[bent_count++] = i;
    }
  }
  for (const std::size_t k : {std::size_t{1}, kLast - 1}) all.compute(std::span(bent).first(bent_count), k);
  for (std::size_t i = 0; i < bent_count; ++i) mean.fill_quartic(levels[bent[i]]);
  for (const std::size_t i : kOthers) {
    const StratifiedAverage::Levels &low = levels[i - i % kApart], &high = levels[i - i % kApart + kApart];
    const double part = static_cast<double>(i % kApart) / kApart;
    const Level middle = levels[i][kMiddle];
    const auto beside = [&](double one, double one_middle, double other, double other_middle) {
      return (1 - part) * (one - one_middle) + part * (other - other_middle);
    };
    for (std::size_t k = 0; k < StratifiedAverage::kLevels; ++k) {
      levels[i][k] = {middle.median_db + beside(low[k].median_db, low[kMiddle].median_db, high[k].median_db,
                                                high[kMiddle].median_db),
                      middle.deviation_db + beside(low[k].deviation_db, low[kMiddle].deviation_db,
                                                   high[k].deviation_db, high[kMiddle].deviation_db)};
    }
  }
  return levels;
}

void add_patterns(const PacketLevels& packet, const std::array<BlockFading, kPatterns>& patterns,
                  StratifiedAverage& mean) {
  const auto levels = levels_of(packet, mean, patterns);
  Level preamble;
  for (std::size_t i = 0; i < kPatterns; ++i) {
    if (i == 0 || !mean.finds(preamble)) preamble = packet.preamble(patterns[i].block_power);
    mean.add(preamble, levels[i], i, 1.0 / kPatterns);
  }
}

// Likewise from half of the states, each in the place of two: for the quantiles over hours.
void add_few_patterns(const PacketLevels& packet, const std::array<BlockFading, kPatterns>& patterns,
                      StratifiedAverage& mean) {
  constexpr std::array<std::size_t, 8> kFew{0, 3, 4, 7, 8, 11, 12, 15};
  Level preamble;
  for (const std::size_t i : kFew) {
    const auto levels = mean.levels([&](std::size_t at) { return packet.bits(patterns[i], mean.noise(at)); });
    if (i == kFew.front() || !mean.finds(preamble)) preamble = packet.preamble(patterns[i].block_power);
    mean.add(preamble, levels, i, 1.0 / kFew.size());
  }
}

// States of block fading of a link, which do not depend on the noise.
struct BlockStates {
  std::optional<PowerSignals> powers;                          // phase-shift keying
  std::optional<std::array<BlockFading, kPatterns>> patterns;  // frequency-shift keying

  BlockStates(const PacketLevels& packet, const ReceptionStatistics& sound) {
    if (packet.collects_band()) {
      powers.emplace(packet, sound.block_fading, sound.fast);
    } else {
      patterns = patterns_of(sound);
    }
  }
};

// Delivery where the margin is shifted; `now` is that without a shift, which is the answer where nothing is
// left to be lost or gained. `shifted` holds no states yet.
double shifted_delivery(const PacketLevels& packet, BlockStates& states, double shift_db, double now,
                        StratifiedAverage shifted) {
  constexpr double kSettled = 0.002;
  if (shift_db < 0 ? now < kSettled : now > 1 - kSettled) return now;
  if (states.powers) {
    add_powers(packet, *states.powers, shifted);
  } else {
    add_few_patterns(packet, *states.patterns, shifted);
  }
  const double then = shifted.delivery_probability();
  return shift_db < 0 ? std::min(then, now) : std::max(then, now);
}

// Prediction without fading: only the set of echoes present varies.
LinkPrediction predict_still(const std::vector<Arrival>& paths, const Synchronisation& sync, double noise,
                             const ReceptionCurves& curves) {
  const double preamble_s = curves.timing().preamble.seconds(), end_s = curves.timing().duration.seconds();
  const SignalHistory history = still_history(paths, sync, {preamble_s, end_s});
  const double signal = mean_signal(paths, sync.window), per_channel = 1 / history.receiver.channels;
  double preamble_echoes = 0, bits_echoes = 0, log_success = 0;
  for (std::size_t i = 0; i < history.stretches(); ++i) {
    const double seconds = history.edges_s[i + 1] - history.edges_s[i];
    if (history.edges_s[i + 1] <= preamble_s) {
      preamble_echoes += seconds / preamble_s * per_channel * history.echoes[i];
      continue;
    }
    const double part = seconds / (end_s - preamble_s);
    bits_echoes += part * per_channel * history.echoes[i];
    log_success += part * static_cast<double>(curves.timing().information_bits) *
                   curves.log_bit_success(signal / (noise + per_channel * history.echoes[i]));
  }
  LinkPrediction prediction;
  prediction.sinr = signal / (noise + bits_echoes);
  prediction.acquisition_probability = curves.acquisition(signal / (noise + preamble_echoes));
  prediction.delivery_probability = prediction.acquisition_probability * elementary::exp(log_success);
  prediction.delivery_low = prediction.delivery_high = prediction.delivery_probability;
  prediction.disturbances = {.noise = noise / signal, .late_echoes = bits_echoes / signal};
  return prediction;
}

}  // namespace

LinkPrediction predict_link(const FadingModel& model, const std::vector<Arrival>& paths,
                            const Synchronisation& sync, const Band& band, double noise,
                            const ReceptionCurves& curves, const MarginShifts& shifts) {
  if (paths.empty()) return {};
  noise *= noise_factor(*sync.modem);
  if (!model.enabled) return predict_still(paths, sync, noise, curves);
  const ReceptionStatistics sound = reception_statistics(paths, sync, band, curves.timing());
  const PacketLevels packet(curves, sound);
  // Platform jitter is constant through a packet, so its variance adds to that of large-scale fading.
  const double deviation = elementary::hypot(std::numbers::ln10 / 10 * model.large_scale_db,
                                             std::sqrt(elementary::log1p(sound.jitter_variance)));
  BlockStates states(packet, sound);
  StratifiedAverage mean(deviation, curves, sound, noise);
  if (states.powers) {
    add_powers(packet, *states.powers, mean);
  } else {
    add_patterns(packet, *states.patterns, mean);
  }
  const double now = mean.delivery_probability();
  LinkPrediction prediction{sinr_of(sound, noise),        mean.acquisition_probability(), now, now, now,
                            disturbances_of(sound, noise)};
  if (!shifts.any()) return prediction;
  const auto at = [&](double shift_db) {
    return shifted_delivery(packet, states, shift_db, now,
                            {deviation, curves, sound, noise * fast_power(-shift_db)});
  };
  prediction.delivery_low = at(shifts.low_db);
  prediction.delivery_high = at(shifts.high_db);
  return prediction;
}

LinkPrediction predict_link(const FadingModel& model, const std::vector<Arrival>& paths,
                            const Modem& receiver, const std::vector<LikelyWindow>& windows, const Band& band,
                            double noise, const ReceptionCurves& curves, const MarginShifts& shifts) {
  LinkPrediction mean, best;
  for (const LikelyWindow& likely : windows) {
    const Synchronisation sync{&receiver, likely.window};
    const bool is_best = &likely == &windows.front();
    const LinkPrediction one =
        predict_link(model, paths, sync, band, noise, curves, is_best ? shifts : MarginShifts());
    if (!model.enabled) return one;
    if (is_best) best = one;
    mean.sinr += likely.probability * one.sinr;
    mean.acquisition_probability += likely.probability * one.acquisition_probability;
    mean.delivery_probability += likely.probability * one.delivery_probability;
    mean.disturbances.add(likely.probability, one.disturbances);
  }
  mean.delivery_low = mean.delivery_high = mean.delivery_probability;
  if (!shifts.any()) return mean;
  // The other windows lose and gain in proportion.
  const double now = best.delivery_probability, all = mean.delivery_probability;
  if (now > 0) mean.delivery_low = all * (best.delivery_low / now);
  mean.delivery_high = now < 1 ? std::max(1 - (1 - all) * ((1 - best.delivery_high) / (1 - now)), all) : all;
  return mean;
}

double predicted_sinr(const FadingModel& model, const std::vector<Arrival>& paths, const Modem& receiver,
                      const std::vector<LikelyWindow>& windows, const Band& band, double noise,
                      const ReceptionCurves& curves) {
  if (!model.enabled) return predict_link(model, paths, receiver, windows, band, noise, curves).sinr;
  double mean = 0;
  for (const LikelyWindow& likely : windows) {
    mean += likely.probability *
            sinr_of(reception_statistics(paths, {&receiver, likely.window}, band, curves.timing()),
                    noise * noise_factor(receiver));
  }
  return mean;
}

}  // namespace halocline::acoustics
