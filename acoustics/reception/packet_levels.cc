#include "acoustics/reception/packet_levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/reception/decoding.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr double kDbPerNeper = 10 / std::numbers::ln10;
constexpr double kMaxExponent = 300;  // of a ratio of variances: no packet of it is lost
constexpr double kLeastLoss = 1e-6;   // of packets
constexpr double kNarrow =
    0.15;  // deviation over mean, 0.65 dB: below, fading is less than the steps of the curve
// Our fits to judged packets (tests/channel_server/packets/link_prediction_test.cc): the softer the curve, the longer the
// fades that count, by 1 / dB; of the variance of errors, and of the beats of coherent paths, what counts for single errors.
constexpr double kSofter = 0.17, kErrorShare = 0.15, kBeatShare = 1;

constexpr double kMostScore = 6;
// By steps of 0.05, linear: within 1e-4.
double tabulated_probability(double score) {
  constexpr std::size_t kRows = 241;
  constexpr double kStep = 0.05;
  static const std::array<double, kRows> table = [] {
    std::array<double, kRows> made{};
    for (std::size_t i = 0; i < kRows; ++i) {
      made[i] = normal_probability(-kMostScore + kStep * static_cast<double>(i));
    }
    return made;
  }();
  const double place = (std::clamp(score, -kMostScore, kMostScore) + kMostScore) / kStep;
  const auto i = std::min(static_cast<std::size_t>(place), kRows - 2);
  return table[i] + (place - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

double halvings(double parts) {
  return std::clamp(fast_log(parts) / std::numbers::ln2, 0.0, ReceptionCurves::kHalvings - 1.001);
}

// Mean of exp(exponent - scale power) of a power that varies as S + sqrt(V) and S - sqrt(V), S^2 - V = constant^2, of which
// single errors feel a part (our fit): the signal is met at one place of each part of the band.
double of_beat(double constant, double varying, double scale, double exponent) {
  const double mean = scale * (constant + varying);
  const double swing =
      std::min(kBeatShare * scale * std::sqrt(std::max(varying, 0.0) * (2 * constant + varying)), mean);
  return (fast_exp(exponent - mean - swing) + fast_exp(exponent - mean + swing)) / 2;
}

double decibels(double power) { return fast_decibels(std::max(power, 1e-30)); }

}  // namespace

FadingSignal::FadingSignal(const BandLaw& low, const BandLaw& high,
                           const std::array<double, kFadeScores>& parts_low,
                           const std::array<double, kFadeScores>& parts_high)
    : mean_(low.mean()), deviation_(std::sqrt(high.variance())) {
  low_ = {low.points(), {}, parts_low};
  high_ = {high.points(), {}, parts_high};
  for (Side* side : {&low_, &high_}) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      side->logs[i] = side->points[i].power > 0 ? fast_log(side->points[i].power) : 0;
    }
  }
}

double FadingSignal::Side::score(double power, double log, std::size_t& above) const {
  while (above < kPoints && points[above].power <= power) ++above;
  if (above == 0) return -kMostScore;
  // Beyond the last point as between the last two.
  const std::size_t i = std::min(above, kPoints - 1);
  const BandPoint &low = points[i - 1], &high = points[i];
  if (!(high.power > low.power)) return kMostScore;
  const double part = low.power > 0 ? (log - logs[i - 1]) / (logs[i] - logs[i - 1])
                                    : (power - low.power) / (high.power - low.power);
  return low.score + part * (high.score - low.score);
}

double FadingSignal::Scores::next(double power, double log, double part) {
  const double low = signal_.low_.score(power, log, low_);
  return low + part * (signal_.high_.score(power, log, high_) - low);
}

double FadingSignal::parts(double score, double part) const {
  const double place = std::clamp(score - kLeastFadeScore, 0.0, kFadeScores - 1.001);
  const auto k = static_cast<std::size_t>(place);
  const auto at = [&](const Side& side) {
    return side.parts[k] + (place - static_cast<double>(k)) * (side.parts[k + 1] - side.parts[k]);
  };
  return std::max(at(low_) + part * (at(high_) - at(low_)), 1.0);
}

PacketLevels::PacketLevels(const ReceptionCurves& curves, const MeanSound& sound)
    : curves_(curves),
      sound_(sound),
      chip_(chip_energy(curves.modem()) / kEffectiveRatioBeta),
      bits_(static_cast<double>(curves.timing().information_bits)),
      bits_s_((curves.timing().duration - curves.timing().preamble).seconds()),
      coded_(is_coded_frequency_shift_keying(curves.modem().error_model)),
      collects_band_(!is_frequency_shift_keying(curves.modem().error_model)) {
  // The stretches of signal_history.h.
  stretches_ = std::clamp(std::ceil(4 * bits_s_ / coherence_time_of(sound.window_spread_hz)), 8.0, 64.0);
  const auto ratio_db = [&](double loss) { return curves.ratio_db_of(-loss / bits_); };
  if (collects_band_) {
    const ReceptionCurves::Parts& parts = curves.parts();
    softness_db_ = decibels(parts.thresholds.front() / parts.thresholds.back());
    low_threshold_ = parts.thresholds[5];
    high_threshold_ = parts.thresholds[1];
    for (std::size_t k = 0; k < between_.size(); ++k) {
      logs_[k] = std::log(parts.ratios[k]);
      between_[k] = std::clamp(
          std::log(parts.ratios[k] / low_threshold_) / std::log(high_threshold_ / low_threshold_), -0.5, 1.5);
    }
  } else if (!coded_) {
    const double low = std::pow(10, ratio_db(4) / 10);
    slope_ = std::log(20) / std::max(std::pow(10, ratio_db(0.2) / 10) - low, 1e-9);
    errors_at_zero_ = 4 * std::exp(slope_ * low);
  }
}

Level PacketLevels::preamble(double slow_power) const {
  const PowerLaw law = sound_.power(slow_power, sound_.preamble_variance);
  const double low = decibels(law.at(-1.5)), middle = decibels(law.at(0)), high = decibels(law.at(1.5));
  return {middle, (high - low) / 3, (high + low - 2 * middle) / 4.5};
}

// By the spread B of a power whose autocorrelation is exp(-(2 pi B tau)^2) and that changes as fast.
std::array<double, kFadeScores> PacketLevels::parts_of(const BandLaw& law, double threshold,
                                                       double slow_power) const {
  const SharedFading& shared = sound_.shared;
  const double squares = (shared.own + sound_.beats * slow_power / 2) * squared(sound_.spread_hz) +
                         threshold * (threshold * shared.yy_spread - 2 * shared.xy_spread);
  const double spread_hz = law.variance() > 0 ? std::sqrt(std::max(squares, 0.0) / law.variance()) : 0;
  return independent_parts(law.skewness(), stretches_, bits_s_ / stretches_ * spread_hz);
}

FadingSignal PacketLevels::fading_signal(double slow_power) const {
  const BandLaw low(sound_, low_threshold_, slow_power), high(sound_, high_threshold_, slow_power);
  return {low, high, parts_of(low, low_threshold_, slow_power), parts_of(high, high_threshold_, slow_power)};
}

// -ln of the chance of all bits where fading is less than the steps of ReceptionCurves::Parts: by Hermite's five points.
double PacketLevels::narrow_loss(const FadingSignal& signal, double disturbance) const {
  constexpr std::array<double, 5> kScores{-2.8569700138728056, -1.3556261799742659, 0, 1.3556261799742659,
                                          2.8569700138728056};
  constexpr std::array<double, 5> kWeights{0.011257411327720689, 0.22207592200561266, 0.53333333333333333,
                                           0.22207592200561266, 0.011257411327720689};
  const double parts = std::min(signal.parts(-1, 1), stretches_);
  double success = 0;
  for (std::size_t i = 0; i < kScores.size(); ++i) {
    const double ratio = (signal.mean() + kScores[i] * signal.deviation()) / disturbance;
    success += kWeights[i] * fast_exp(bits_ / parts * curves_.log_bit_success(ratio));
  }
  return -parts * fast_log(std::max(success, 1e-30));
}

// Of the parts of a packet that fade independently, each with its share of the bits, all have to be right.
Level PacketLevels::bits(const FadingSignal& signal, double disturbance) const {
  // From the one way to the other without a step.
  const double wide = std::clamp(2 - signal.deviation() / (kNarrow * signal.mean()), 0.0, 1.0);
  double loss_db = 0;
  if (wide > 0) loss_db += wide * decibels(std::max(narrow_loss(signal, disturbance), kLeastLoss));
  if (wide < 1) loss_db += (1 - wide) * decibels(std::max(wide_loss(signal, disturbance), kLeastLoss));
  const double ratio_db = curves_.ratio_db_of(-fast_power(loss_db) / bits_);
  return {std::min(ratio_db, decibels(signal.mean() / disturbance) + 3)};
}

double PacketLevels::wide_loss(const FadingSignal& signal, double disturbance) const {
  constexpr std::size_t kRatios = ReceptionCurves::kRatios;
  const ReceptionCurves::Parts& table = curves_.parts();
  std::array<double, kRatios> scores{}, below{};
  const double log = fast_log(disturbance);
  FadingSignal::Scores signal_scores(signal);
  for (std::size_t k = 0; k < kRatios; ++k) {
    scores[k] = signal_scores.next(table.ratios[k] * disturbance, logs_[k] + log, between_[k]);
    below[k] = tabulated_probability(scores[k]);
  }
  // The first ratio that is as much as the parts of fades to it need, between it and the one before.
  struct Margin {
    double parts, more;
  };
  const auto margin_at = [&](std::size_t k) {
    const double parts = std::min(signal.parts(scores[k], between_[k]), stretches_);
    return Margin{parts, logs_[k] - needed(parts)};
  };
  Margin low{1, 0}, high = margin_at(kRatios - 1);
  std::size_t least = 0, most = kRatios - 1;
  while (least < most) {
    const std::size_t middle = (least + most) / 2;
    const Margin here = margin_at(middle);
    (here.more >= 0 ? high : low) = here;
    (here.more >= 0 ? most : least) = here.more >= 0 ? middle : middle + 1;
  }
  const double between = most > 0 && high.more > 0 ? low.more / (low.more - high.more) : 1;
  const double parts = low.parts + between * (high.parts - low.parts);
  const double halved = halvings(1 + (parts - 1) / (1 + kSofter * softness_db_));
  const auto row = static_cast<std::size_t>(halved);
  double loss = 0;
  for (const std::size_t h : {row, row + 1}) {
    double success = below[0] * table.success[h][0] + (1 - below.back()) * table.success[h][kRatios];
    for (std::size_t k = 1; k < kRatios; ++k) {
      success += std::max(below[k] - below[k - 1], 0.0) * table.success[h][k];
    }
    const double share =
        h == row ? 1 - (halved - static_cast<double>(row)) : halved - static_cast<double>(row);
    loss -= share * static_cast<double>(1U << h) * fast_log(std::clamp(success, 1e-30, 1.0));
  }
  return loss;
}

// ln of the ratio that half of so many parts need.
double PacketLevels::needed(double parts) const {
  const double halved = halvings(parts);
  const auto low = static_cast<std::size_t>(halved);
  const auto& logs = curves_.parts().log_thresholds;
  return logs[low] + (halved - static_cast<double>(low)) * (logs[low + 1] - logs[low]);
}

Level PacketLevels::bits(const SlowSound& slow, double noise) const {
  const double power = slow.slow_power + sound_.scattered_power();
  const double disturbance = noise + sound_.bits_echoes + sound_.untracked * power;
  const Cells cells = cells_of(slow, (coded_ ? chip_ : slope_) / disturbance);
  if (coded_) {
    const double v = fast_log(1 + cells.variance), nepers = cells.nepers + v / 2;
    return {decibels(std::max(nepers, 1e-12) / chip_), kDbPerNeper * std::sqrt(v) / nepers};
  }
  // Errors of single bits, a exp(-slope ratio): as if their number were gamma distributed over the fading,
  // E exp(-X) = (1 + mean v)^(-1 / v). Its tail is longer: of its variance a part counts (our fit).
  const double errors = errors_at_zero_ * fast_exp(-cells.nepers), v = kErrorShare * cells.variance;
  const double loss = v > 1e-6 ? fast_log(1 + errors * v) / v : errors;
  return {std::min(curves_.ratio_db_of(-loss / bits_), decibels(power / disturbance))};
}

// Of exp(-scale power) over time and the band, each frequency Rician: E = exp(-c / (1 + d)) / (1 + d).
PacketLevels::Cells PacketLevels::cells_of(const SlowSound& slow, double scale) const {
  using Frequencies = std::array<double, kFrequencies>;
  const double d = scale * sound_.scattered_power();
  Frequencies c, b, losses, ones;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    c[m] = scale * slow.steady[m];
    b[m] = d + scale * slow.varying[m];
    losses[m] = c[m] / (1 + b[m]);
  }
  const double least = *std::min_element(losses.begin(), losses.end());  // taken out: loud cells underflow
  double mean = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    ones[m] = coded_ ? fast_exp(least - losses[m]) / (1 + b[m])
                     : of_beat(slow.steady[m], slow.varying[m], scale / (1 + d), least) / (1 + d);
    mean += ones[m] / kFrequencies;
  }
  const double nepers = least - fast_log(mean);
  const double single = d * d + 2 * d * scale * slow.slow_power;
  if (!(single > 0)) return {nepers, 0};
  double all = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    const double twice = 1 / (1 + 2 * b[m]);
    all += (fast_exp(std::min(2 * (least - c[m] * twice), kMaxExponent)) * twice - ones[m] * ones[m]) /
           kFrequencies;
  }
  const double of_mean =
      squared(scale) * sound_.power(slow.slow_power, sound_.bits_variance).variance / single;
  // Deep fades, which count most, are shorter than the power's coherence, in time and in frequency.
  const double shorter = fast_exp(2.0 / 3 * fast_log((1 + 2 * d) / squared(1 + d)));
  return {nepers, all * of_mean * shorter / (mean * mean)};
}

}  // namespace halocline::acoustics
