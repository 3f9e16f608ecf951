// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/packet_levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/prediction/equalizer_statistics.h"
#include "acoustics/prediction/exponential_means.h"
#include "acoustics/reception/decoding.h"
#include "core/elementary.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

constexpr double kMaxScore = 6;
constexpr double kMinLoss = 1e-6;  // probability of losing a packet
constexpr double kAlike = 0.02;    // share of the variance that has no effect
constexpr double kNoLoss = -5.5;   // normal score below which nothing is lost
constexpr int kRounds = 3, kRoundsOfGuess = 2;
constexpr double kSettled = 0.03;  // relative change of the parts at which the iteration stops
// Deviation over mean, 0.65 dB: fading below this is narrower than the steps of the reception curve.
constexpr double kNarrow = 0.15;
// Share of the variance of the number of errors that counts: our fit to simulated packets
// (tests/channel_server/packets/link_prediction_test.cc).
constexpr double kErrorShare = 0.15;

double halvings(double parts) {
  return std::clamp(fast_log(parts) / std::numbers::ln2, 0.0, ReceptionCurves::kHalvings - 1.001);
}

double decibels(double power) { return fast_decibels(std::max(power, 1e-30)); }

}  // namespace

FadingSignal::FadingSignal(const BandTerms& high, const std::optional<BandTerms>& low, double block_power,
                           const Stretches& stretches) {
  alike_ = !low || high.interference_share(block_power) < kAlike;
  const FadeStatistics law(high, block_power);
  mean_ = law.mean();
  sides_.back() = Side(high.threshold(), law, stretches);
  if (!alike_) sides_.front() = Side(low->threshold(), {*low, block_power}, stretches);
  narrow_parts_ = fast_exp(std::max(sides_.back().log_parts_at(std::max(mean_ - deviation(), 0.0)), 0.0));
}

FadingSignal::Side::Side(double at_threshold, const FadeStatistics& law, const Stretches& stretches)
    : threshold(at_threshold), deviation(std::sqrt(law.variance())), points(law.points(stretches)) {
  const FadeStatistics::Values& powers = points.powers;
  for (std::size_t k = 0; k < kPoints; ++k) logs[k] = fast_log(powers[k] > 1e-300 ? powers[k] : 1);
  for (std::size_t k = 1; k < kPoints; ++k) {
    const double rise = powers[k - 1] > 0 ? logs[k] - logs[k - 1] : powers[k] - powers[k - 1];
    rises[k] = rise > 0 ? 1 / rise : 0;
  }
}

// `above` holds a guess of the first point of greater power on entry, that point on return.
FadingSignal::Side::Place FadingSignal::Side::place(double power, double log_power,
                                                    std::size_t& above) const {
  const FadeStatistics::Values& powers = points.powers;
  while (above < kPoints && powers[above] <= power) ++above;
  while (above > 0 && powers[above - 1] > power) --above;
  if (above == 0) return {0, 0, 0};
  if (above == kPoints) return {kPoints - 1, kPoints - 1, 0};
  const std::size_t low = above - 1;
  return {low, above, (powers[low] > 0 ? log_power - logs[low] : power - powers[low]) * rises[above]};
}

HALOCLINE_VECTOR_CLONES
void FadingSignal::Side::at(const Thresholds& powers, States& states) const {
  Thresholds log_powers;
  for (std::size_t k = 0; k < kThresholds; ++k) log_powers[k] = fast_log(powers[k] > 1e-300 ? powers[k] : 1);
  std::size_t above = kPoints / 2;
  for (std::size_t k = 0; k < kThresholds; ++k) {
    const auto [low, high, part] = place(powers[k], log_powers[k], above);
    const double from = points.scores[low], parts = points.log_parts[low];
    states.scores[k] = above == 0         ? -kMaxScore
                       : above == kPoints ? kMaxScore
                                          : from + part * (points.scores[high] - from);
    states.parts[k] = parts + part * (points.log_parts[high] - parts);
  }
}

double FadingSignal::Side::log_parts_at(double power) const {
  std::size_t above = kPoints / 2;
  const auto [low, high, part] = place(power, fast_log(power > 1e-300 ? power : 1), above);
  return points.log_parts[low] + part * (points.log_parts[high] - points.log_parts[low]);
}

// Interpolates between the two thresholds at powers that are equally many deviations from the mean.
HALOCLINE_VECTOR_CLONES
FadingSignal::States FadingSignal::at(const ReceptionCurves::Thresholds& thresholds,
                                      double disturbance) const {
  const Side &low = sides_.front(), &high = sides_.back();
  States states;
  Thresholds powers, low_powers, shares;
  if (alike_) {
    for (std::size_t k = 0; k < kThresholds; ++k) powers[k] = fast_exp(thresholds.logs[k]) * disturbance;
    high.at(powers, states);
  } else {
    for (std::size_t k = 0; k < kThresholds; ++k) {
      const double threshold = fast_exp(thresholds.logs[k]);
      const double part = (threshold - low.threshold) / (high.threshold - low.threshold);
      const double below = threshold * disturbance - mean_,
                   deviation = low.deviation + part * (high.deviation - low.deviation),
                   deviations = below / deviation;
      low_powers[k] = mean_ + (deviation > 0 ? deviations * low.deviation : below);
      powers[k] = mean_ + (deviation > 0 ? deviations * high.deviation : below);
      shares[k] = part < 0 ? 0 : part > 1 ? 1 : part;
    }
    States others;
    low.at(low_powers, states);
    high.at(powers, others);
    for (std::size_t k = 0; k < kThresholds; ++k) {
      states.scores[k] += shares[k] * (others.scores[k] - states.scores[k]);
      states.parts[k] += shares[k] * (others.parts[k] - states.parts[k]);
    }
  }
  for (double& parts : states.parts) parts = fast_exp(parts > 0 ? parts : 0);
  return states;
}

PacketLevels::PacketLevels(const ReceptionCurves& curves, const ReceptionStatistics& sound)
    : curves_(curves),
      sound_(sound),
      chip_(chip_energy(curves.modem()) / kEffectiveRatioBeta),
      bits_(static_cast<double>(curves.timing().information_bits)),
      bits_s_((curves.timing().duration - curves.timing().preamble).seconds()),
      coded_(is_coded_frequency_shift_keying(curves.modem().error_model)),
      collects_band_(!is_frequency_shift_keying(curves.modem().error_model)),
      own_(sound.bits_variance * sound.own),
      cross_terms_(reduction_of_longer(sound.bits_variance) * sound.cross_terms) {
  // Number of stretches of the bits, as in signal_history.h.
  stretches_ = std::clamp(std::ceil(4 * bits_s_ / coherence_time_of(sound.window_spread_hz)), 8.0, 64.0);
  const auto ratio_db = [&](double loss) { return curves.ratio_db_of(-loss / bits_); };
  if (collects_band_) {
    high_.emplace(sound.equalizer, elementary::exp(curves.parts()[1].logs[4]));
    if (high_->most_interference_share() >= kAlike) {
      low_.emplace(sound.equalizer, elementary::exp(curves.parts()[5].logs[4]));
    }
    // Uncoded: -ln(1 - BER)^bits is fitted by a exp(-slope ratio) through losses of 4 and 0.2.
  } else if (!coded_) {
    const double low = elementary::exp10(ratio_db(4) / 10);
    slope_ = elementary::log(20) / std::max(elementary::exp10(ratio_db(0.2) / 10) - low, 1e-9);
    errors_at_zero_ = 4 * elementary::exp(slope_ * low);
  }
}

Level PacketLevels::preamble(double block_power) const {
  const GammaPower law = sound_.power(block_power, sound_.preamble_variance);
  const std::array<double, 3> powers = law.at(std::array{-1.5, 0.0, 1.5});
  const double low = decibels(powers[0]), middle = decibels(powers[1]), high = decibels(powers[2]);
  return {middle, (high - low) / 3, (high + low - 2 * middle) / 4.5};
}

FadingSignal PacketLevels::fading_signal(double block_power) const {
  return {*high_, low_, block_power, {stretches_, bits_s_ / stretches_}};
}

// Negative logarithm of the probability of all bits when fading is narrower than the steps of
// ReceptionCurves::Parts: a mean over the normal distribution by the five-point Gauss-Hermite rule.
double PacketLevels::narrow_loss(const FadingSignal& signal, double disturbance) const {
  constexpr std::array<double, 5> kScores{-2.8569700138728056, -1.3556261799742659, 0, 1.3556261799742659,
                                          2.8569700138728056};
  constexpr std::array<double, 5> kWeights{0.011257411327720689, 0.22207592200561266, 0.53333333333333333,
                                           0.22207592200561266, 0.011257411327720689};
  const double parts = std::min(signal.narrow_parts(), stretches_);
  std::array<double, kScores.size()> chances;
  for (std::size_t i = 0; i < kScores.size(); ++i) {
    const double ratio = (signal.mean() + kScores[i] * signal.deviation()) / disturbance;
    chances[i] = fast_decibels(ratio > 1e-30 ? ratio : 1e-30);
  }
  for (double& chance : chances) chance = bits_ / parts * curves_.log_bit_success_at(chance);
  for (double& chance : chances) chance = fast_exp(chance);
  double success = 0;
  for (std::size_t i = 0; i < kScores.size(); ++i) success += kWeights[i] * chances[i];
  return -parts * fast_log(std::max(success, 1e-30));
}

// Negative logarithm of the probability of all bits, which are divided among the independently fading parts
// of a packet.
double PacketLevels::loss(const FadingSignal& signal, double disturbance, double& parts) const {
  // Blends narrow_loss() and wide_loss() so that there is no step between them.
  const double narrow = std::clamp(2 - signal.deviation() / (kNarrow * signal.mean()), 0.0, 1.0);
  if (!(narrow > 0)) return std::max(wide_loss(signal, disturbance, parts), kMinLoss);
  double loss_db = narrow * decibels(std::max(narrow_loss(signal, disturbance), kMinLoss));
  if (narrow < 1)
    loss_db += (1 - narrow) * decibels(std::max(wide_loss(signal, disturbance, parts), kMinLoss));
  return fast_power(loss_db);
}

Level PacketLevels::bits(const FadingSignal& signal, double disturbance, double& parts) const {
  constexpr double kMinLate = 0.05;
  double all = loss(signal, disturbance, parts);
  // The bits that precede the late echoes are free of their interference.
  const double late = sound_.late_echoes, before = (1 - sound_.late_share);
  if (before * late > kMinLate * disturbance) {
    const double alone = std::max(disturbance - late, kMinLate * disturbance);
    all = sound_.late_share * all + before * loss(signal, alone, parts);
  }
  const double ratio_db = curves_.ratio_db_of(-all / bits_);
  return {std::min(ratio_db, decibels(signal.mean() / disturbance) + kMaxGainDb)};
}

bool PacketLevels::is_likely_lost(double block_power, double disturbance) const {
  return decibels((block_power + sound_.fast) / disturbance) < curves_.bits_flank().high_db;
}

// Negative logarithm of the probability of all bits when fading is wide: iterates the number of independent
// parts, on which the thresholds depend.
double PacketLevels::wide_loss(const FadingSignal& signal, double disturbance, double& parts) const {
  const auto& shares = ReceptionCurves::threshold_shares();
  const int rounds = parts > 0 ? kRoundsOfGuess : kRounds;
  if (!(parts > 0)) parts = std::sqrt(stretches_);
  double loss = 0;
  for (int i = 0; i < rounds; ++i) {
    const FadingSignal::States states = signal.at(thresholds(parts), disturbance);
    const double guess = parts;
    double below = 0, sum = 1e-12 * parts, weight = 1e-12;
    for (std::size_t k = 0; k < ReceptionCurves::kThresholds; ++k) {
      if (states.scores[k] < kNoLoss) break;  // the thresholds descend: later ones are not reached either
      const double share = shares[k] * tabulated_probability(states.scores[k]);
      below += share;
      weight += share;
      sum += share * std::min(states.parts[k], stretches_);
    }
    parts = sum / weight;
    loss = -parts * fast_log(std::max(1 - below, 1e-30));
    if (std::abs(parts - guess) < kSettled * guess) break;
  }
  return loss;
}

ReceptionCurves::Thresholds PacketLevels::thresholds(double parts) const {
  const double halved = halvings(parts);
  const auto i = static_cast<std::size_t>(halved);
  const ReceptionCurves::Thresholds &low = curves_.parts()[i], &high = curves_.parts()[i + 1];
  const double part = halved - static_cast<double>(i);
  ReceptionCurves::Thresholds between;
  for (std::size_t k = 0; k < ReceptionCurves::kThresholds; ++k) {
    between.logs[k] = low.logs[k] + part * (high.logs[k] - low.logs[k]);
  }
  return between;
}

Level PacketLevels::bits(const BlockFading& block_fading, double noise) const {
  const StateAndNoise state{&block_fading, noise};
  Level level;
  bits({&state, 1}, {&level, 1});
  return level;
}

void PacketLevels::bits(std::span<const StateAndNoise> states, std::span<Level> levels) const {
  ExponentialMeans cells({sound_.fast, own_, cross_terms_, !coded_});
  std::array<double, ExponentialMeans::kMax> ratios;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BlockFading& block_fading = *states[i].block_fading;
    const double power = block_fading.block_power + sound_.fast;
    const double disturbance = states[i].noise + sound_.untracked * power;
    ratios[i] = power / disturbance;
    cells.add(block_fading, (coded_ ? chip_ : slope_) / disturbance);
  }
  cells.finish();
  if (coded_) {
    const ExponentialMeans::Ratios effective = cells.ratios();
    for (std::size_t i = 0; i < states.size(); ++i) {
      levels[i] = {effective.medians_db[i] - decibels(chip_), effective.deviations_db[i]};
    }
    return;
  }
  // Uncoded bits: the number of errors a exp(-slope ratio) is treated as gamma distributed over the fading,
  //   E exp(-X) = (1 + mean v)^(-1 / v).
  // Its true tail is longer, so that only kErrorShare of its variance counts (our fit).
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double errors = errors_at_zero_ * fast_exp(-cells.nepers(i)), v = kErrorShare * cells.variance(i);
    const double loss = v > 1e-6 ? fast_log(1 + errors * v) / v : errors;
    levels[i] = {std::min(curves_.ratio_db_of(-loss / bits_), decibels(ratios[i]))};
  }
}

}  // namespace halocline::acoustics
