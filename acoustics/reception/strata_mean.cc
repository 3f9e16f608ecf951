#include "acoustics/reception/strata_mean.h"

#include <cstdint>

#include "acoustics/math/fast_functions.h"

namespace halocline::acoustics {
namespace {

// All sound is louder by this factor, at a score of large-scale fading of `deviation` nepers of power.
double loudness(double deviation, double z) { return fast_exp(deviation * z - deviation * deviation / 2); }

// A gamma distribution of mean 1 at a normal score (Wilson and Hilferty 1931).
double gamma_at(double variance, double score) {
  const double root = 1 - variance / 9 + score * std::sqrt(variance) / 3;
  return root > 0 ? root * root * root : 0;
}

}  // namespace

// The levels, and the strata between which they are interpolated, each with normals for what fades fast.
struct StrataMean::Scores {
  std::array<double, kLevels> levels{-2.4, -1.6, -0.8, 0, 0.8, 1.6, 2.4};  // standard deviations
  std::array<double, kStrata> strata = normal_strata<kStrata>();
  // Beside stratum i: of late echoes; of the preamble, of even and odd blocks.
  double echoes(std::size_t i) const { return strata[(11 * i + 5) % kStrata]; }
  double preamble(std::size_t i, std::size_t state) const {
    return strata[(9 * i + 4 * state + 12) % kStrata];
  }
  double block(std::size_t i, std::size_t state, std::size_t block) const {
    return strata[block % 2 == 0 ? (7 * i + 4 * state + 19) % kStrata : (13 * i + 4 * state + 18) % kStrata];
  }
};

const StrataMean::Scores& StrataMean::scores() {
  static const Scores scores;
  return scores;
}

StrataMean::StrataMean(double deviation, const ReceptionCurves& curves, const MeanSound& sound, double noise)
    : curves_(curves) {
  const double untracked = sound.untracked * (sound.slow.mean + sound.fast);
  std::array<double, kStrata> mean_db{};
  for (std::size_t i = 0; i < kStrata; ++i) {
    const double quiet = noise / loudness(deviation, scores().strata[i]) + untracked,
                 score = scores().echoes(i);
    preamble_db_[i] =
        fast_decibels(quiet + sound.preamble_echoes * gamma_at(sound.preamble_echo_variance, score));
    const double mean = quiet + sound.late_echoes,
                 echoes = sound.fading_echoes * (gamma_at(sound.bits_echo_variance, score) - 1);
    mean_db[i] = fast_decibels(mean);
    echoes_db_[i] = fast_decibels((mean + echoes) / mean);
  }
  if (is_frequency_shift_keying(curves.modem().error_model)) {
    const auto& levels = scores().levels;
    for (std::size_t k = 0; k < kLevels; ++k) {
      noise_[k] = noise / loudness(deviation, levels[k]);
      disturbance_db_[k] = fast_decibels(noise_[k] + sound.late_echoes + untracked);
    }
    for (std::size_t i = 0; i < kStrata; ++i)
      places_[i] = (scores().strata[i] - levels[0]) / (levels[1] - levels[0]);
    const auto [least, most] = std::minmax_element(echoes_db_.begin(), echoes_db_.end());
    least_echoes_db_ = *least;
    most_echoes_db_ = *most;
  } else {
    turns_ = 2;
    // The levels are those of all that disturbs, from the most to the least.
    for (std::size_t i = 0; i < kStrata; ++i) mean_db[i] += echoes_db_[i];
    echoes_db_.fill(0);
    const auto [least, most] = std::minmax_element(mean_db.begin(), mean_db.end());
    const double step_db = (*most - *least) / (kLevels - 1);
    for (std::size_t k = 0; k < kLevels; ++k) {
      disturbance_db_[k] = *most - step_db * static_cast<double>(k);
      noise_[k] = fast_power(disturbance_db_[k]);
    }
    for (std::size_t i = 0; i < kStrata; ++i)
      places_[i] = step_db > 1e-9 ? std::clamp((*most - mean_db[i]) / step_db, 0.0, kLevels - 1.001) : 0;
  }
  const auto all_bits = static_cast<double>(curves.timing().information_bits);
  for (const std::int64_t bits : curves.blocks()) {
    const double part = static_cast<double>(bits) / all_bits, kept = sound.bits_variance;
    blocks_.push_back({static_cast<double>(bits), std::sqrt(kept_of_part(kept, part) / kept)});
    widest_ = std::max(widest_, scores().strata.back() * blocks_.back().wider);
  }
}

bool StrataMean::finds(const Level& preamble) const {
  const double z = scores().strata.back();
  return std::min(preamble.at(-z), preamble.at(z)) -
             *std::max_element(preamble_db_.begin(), preamble_db_.end()) >
         curves_.acquisition_flank().high_db;
}

StrataMean::Levels& StrataMean::spread(Levels& bits, std::size_t from, std::size_t begin,
                                       std::size_t end) const {
  const Level level = bits[from];
  for (std::size_t k = begin; k < end; ++k) {
    bits[k] = level;
    bits[k].median_db += disturbance_db_[from] - disturbance_db_[k];
  }
  return bits;
}

bool StrataMean::lie_on_parabola(const Levels& bits) const {
  const auto at = [&](std::size_t k) { return bits[k].median_db + disturbance_db_[k]; };
  return std::abs(at(0) + at(kLevels - 1) - 2 * at(kLevels / 2)) < kBentDb;
}

StrataMean::Levels& StrataMean::fill_parabola(Levels& bits) const {
  constexpr std::size_t kMiddle = kLevels / 2, kLast = kLevels - 1;
  const Level low = bits.front(), middle = bits[kMiddle], high = bits.back();
  for (std::size_t k = 0; k < kLevels; ++k) {
    const double x = static_cast<double>(k) / kMiddle - 1;
    bits[k].median_db =
        on_parabola(low.median_db + disturbance_db_[0], middle.median_db + disturbance_db_[kMiddle],
                    high.median_db + disturbance_db_[kLast], x) -
        disturbance_db_[k];
    bits[k].deviation_db = on_parabola(low.deviation_db, middle.deviation_db, high.deviation_db, x);
  }
  return bits;
}

// Lagrange's, through levels 0, 1, 3, 5 and 6.
StrataMean::Levels& StrataMean::fill_quartic(Levels& bits) const {
  constexpr std::array<std::size_t, 5> kFrom{0, 1, 3, 5, 6};
  constexpr std::array<double, 5> kShares{-2.0 / 15, 3.0 / 5, 2.0 / 3, -1.0 / 5, 1.0 / 15};  // of level 2
  Level low{-disturbance_db_[2]}, high{-disturbance_db_[4]};
  for (std::size_t i = 0; i < kFrom.size(); ++i) {
    const Level &one = bits[kFrom[i]], &other = bits[kLevels - 1 - kFrom[i]];
    low.median_db += kShares[i] * (one.median_db + disturbance_db_[kFrom[i]]);
    low.deviation_db += kShares[i] * one.deviation_db;
    high.median_db += kShares[i] * (other.median_db + disturbance_db_[kLevels - 1 - kFrom[i]]);
    high.deviation_db += kShares[i] * other.deviation_db;
  }
  bits[2] = low;
  bits[4] = high;
  return bits;
}

void StrataMean::add(const Level& preamble, const Levels& bits, std::size_t state, double share) {
  const bool found = finds(preamble), lost = loses(bits.back()), decoded = decodes(bits.front());
  if (found && (lost || decoded)) {
    acquired_ += share;
    delivered_ += decoded ? share : 0;
    return;
  }
  const Scores& normals = scores();
  const std::size_t count = kStrata / turns_;
  std::array<double, kStrata> acquired, logs{};
  for (std::size_t j = 0, i = state % turns_; j < count; ++j, i += turns_) {
    acquired[j] =
        found ? 1 : curves_.acquisition_at(preamble.at(normals.preamble(i, state)) - preamble_db_[i]);
  }
  for (std::size_t b = 0; b < blocks_.size() && !lost && !decoded; ++b) {
    for (std::size_t j = 0, i = state % turns_; j < count; ++j, i += turns_) {
      const auto below = static_cast<std::size_t>(places_[i]);
      const double part = places_[i] - static_cast<double>(below),
                   z = normals.block(i, state, b) * blocks_[b].wider;
      const double low = bits[below].at(z), high = bits[below + 1].at(z);
      logs[j] += blocks_[b].bits * curves_.log_bit_success_at(low + part * (high - low) - echoes_db_[i]);
    }
  }
  for (double& chance : logs) chance = fast_exp(chance);
  const double weight = share / static_cast<double>(count);
  for (std::size_t j = 0; j < count; ++j) {
    acquired_ += weight * acquired[j];
    if (!lost) delivered_ += weight * acquired[j] * logs[j];
  }
}

}  // namespace halocline::acoustics
