// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/stratified_average.h"

#include <cstdint>

#include "acoustics/math/fast_functions.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

// Gain of large-scale fading at the normal score z: exp(deviation z - deviation^2 / 2), deviation in nepers
// of power; its mean is 1.
double loudness(double deviation, double z) { return fast_exp(deviation * z - deviation * deviation / 2); }

using Strata = std::array<double, 32>;

// Adds to `power` a gamma variable of mean `mean` and relative variance `variance`, minus `less` times its
// mean, at normal scores z (Wilson and Hilferty 1931):
//   x = mean (1 - variance / 9 + z sqrt(variance) / 3)^3.
HALOCLINE_VECTOR_CLONES
void add_gamma(double mean, double variance, double less, const Strata& scores, Strata& power) {
  const double median = 1 - variance / 9, deviation = std::sqrt(variance) / 3;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double root = median + scores[i] * deviation, held = root > 0 ? root : 0;
    power[i] += mean * (held * held * held - less);
  }
}

HALOCLINE_VECTOR_CLONES
void set_decibels(const Strata& powers, Strata& levels_db) {
  for (std::size_t i = 0; i < powers.size(); ++i) levels_db[i] = fast_decibels(powers[i]);
}

// Noise at the given scores of large-scale fading, divided by its gain, plus the untracked power.
HALOCLINE_VECTOR_CLONES
void set_quiet(double noise, double deviation, double untracked, const Strata& scores, Strata& powers) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    powers[i] = noise / loudness(deviation, scores[i]) + untracked;
  }
}

HALOCLINE_VECTOR_CLONES
void exponentiate(std::size_t begin, std::size_t end, Strata& values) {
  for (std::size_t i = begin; i < end; ++i) values[i] = fast_exp(values[i]);
}

}  // namespace

// Strata of large-scale fading, each paired with normal scores of the late echoes and the fast fading.
struct StratifiedAverage::Scores {
  static constexpr std::size_t kOrders = 8;
  Strata strata = normal_strata<kStrata>();
  // Scores paired with stratum i: of late echoes; by state, of the preamble and of even and odd blocks.
  Strata echoes{};
  std::array<Strata, kOrders> preambles{};
  std::array<std::array<Strata, 2>, kOrders> blocks{};

  Scores() {
    for (std::size_t i = 0; i < kStrata; ++i) {
      echoes[i] = strata[(11 * i + 5) % kStrata];
      for (std::size_t state = 0; state < kOrders; ++state) {
        preambles[state][i] = strata[(9 * i + 4 * state + 12) % kStrata];
        blocks[state][0][i] = strata[(7 * i + 4 * state + 19) % kStrata];
        blocks[state][1][i] = strata[(13 * i + 4 * state + 18) % kStrata];
      }
    }
  }
};

const StratifiedAverage::Scores& StratifiedAverage::scores() {
  static const Scores scores;
  return scores;
}

StratifiedAverage::StratifiedAverage(double deviation, const ReceptionCurves& curves,
                                     const ReceptionStatistics& sound, double noise)
    : curves_(curves) {
  // Frequency-shift keying adds the untracked power of each state (packet_levels.cc).
  const bool collects = !is_frequency_shift_keying(curves.modem().error_model);
  const double untracked = sound.untracked * (sound.block_fading.mean + sound.fast);
  Strata quiet, all;
  set_quiet(noise, deviation, untracked, scores().strata, quiet);
  set_quiet(noise, deviation, collects ? untracked : 0, scores().strata, all);
  if (sound.preamble_echoes > 0) {
    add_gamma(sound.preamble_echoes, sound.preamble_echo_variance, 0, scores().echoes, quiet);
  }
  set_decibels(quiet, preamble_db_);
  most_preamble_db_ = *std::max_element(preamble_db_.begin(), preamble_db_.end());
  for (double& power : all) power += sound.late_echoes;
  if (sound.fading_echoes > 0) {
    add_gamma(sound.fading_echoes, sound.bits_echo_variance, 1, scores().echoes, all);
  }
  turns_ = collects ? 2 : 1;
  // Levels are equidistant in dB of all noise and interference, from the greatest to the least.
  Strata all_db;
  set_decibels(all, all_db);
  const auto [least, most] = std::minmax_element(all_db.begin(), all_db.end());
  const double step_db = (*most - *least) / (kLevels - 1);
  for (std::size_t k = 0; k < kLevels; ++k) {
    disturbance_db_[k] = *most - step_db * static_cast<double>(k);
    noise_[k] = fast_power(disturbance_db_[k]);
    if (!collects) disturbance_db_[k] = fast_decibels(noise_[k] + untracked);
  }
  Strata places{};
  for (std::size_t i = 0; i < kStrata && step_db > 1e-9; ++i) places[i] = (*most - all_db[i]) / step_db;
  set_places(places);
  const auto all_bits = static_cast<double>(curves.timing().information_bits);
  for (const std::int64_t bits : curves.blocks()) {
    const double part = static_cast<double>(bits) / all_bits, kept = sound.bits_variance;
    blocks_.push_back({static_cast<double>(bits), std::sqrt(reduction_of_part(kept, part) / kept)});
    widest_ = std::max(widest_, scores().strata.back() * blocks_.back().wider);
  }
}

void StratifiedAverage::set_places(const Strata& places) {
  for (std::size_t i = 0; i < kStrata; ++i) {
    const double held = std::clamp(places[i], 0.0, kLevels - 1.001);
    below_[i] = static_cast<std::size_t>(held);
    parts_[i] = held - static_cast<double>(below_[i]);
  }
}

bool StratifiedAverage::finds(const Level& preamble) const {
  const double z = scores().strata.back();
  return std::min(preamble.at(-z), preamble.at(z)) - most_preamble_db_ > curves_.acquisition_flank().high_db;
}

StratifiedAverage::Levels& StratifiedAverage::spread(Levels& bits, std::size_t from, std::size_t begin,
                                                     std::size_t end) const {
  const Level level = bits[from];
  for (std::size_t k = begin; k < end; ++k) {
    bits[k] = level;
    bits[k].median_db += disturbance_db_[from] - disturbance_db_[k];
  }
  return bits;
}

bool StratifiedAverage::lie_on_parabola(const Levels& bits) const {
  const auto at = [&](std::size_t k) { return bits[k].median_db + disturbance_db_[k]; };
  return std::abs(at(0) + at(kLevels - 1) - 2 * at(kLevels / 2)) < kBentDb;
}

StratifiedAverage::Levels& StratifiedAverage::fill_parabola(Levels& bits) const {
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

// Lagrange polynomial through the levels 0, 1, 3, 5 and 6.
StratifiedAverage::Levels& StratifiedAverage::fill_quartic(Levels& bits) const {
  constexpr std::array<std::size_t, 5> kFrom{0, 1, 3, 5, 6};
  constexpr std::array<double, 5> kShares{-2.0 / 15, 3.0 / 5, 2.0 / 3, -1.0 / 5,
                                          1.0 / 15};  // weights for level 2
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

void StratifiedAverage::ratios_of_block(const Levels& bits, std::size_t state, std::size_t block,
                                        Strata& ratios_db) const {
  const Strata& normals = scores().blocks[state % Scores::kOrders][block % 2];
  const double wider = blocks_[block].wider;
  for (std::size_t j = 0, i = state % turns_; i < kStrata; ++j, i += turns_) {
    const Level &low = bits[below_[i]], &high = bits[below_[i] + 1];
    const double median = low.median_db + parts_[i] * (high.median_db - low.median_db),
                 deviation = low.deviation_db + parts_[i] * (high.deviation_db - low.deviation_db);
    ratios_db[j] = median + normals[i] * wider * deviation;
  }
}

void StratifiedAverage::acquisitions(const Level& preamble, std::size_t state, Strata& chances) const {
  const Strata& normals = scores().preambles[state % Scores::kOrders];
  for (std::size_t j = 0, i = state % turns_; i < kStrata; ++j, i += turns_) {
    chances[j] = curves_.acquisition_at(preamble.at(normals[i]) - preamble_db_[i]);
  }
}

void StratifiedAverage::add(const Level& preamble, const Levels& bits, std::size_t state, double share) {
  const bool found = finds(preamble), lost = loses(bits.back()), decoded = decodes(bits.front());
  if (found && (lost || decoded)) {
    acquired_ += share;
    delivered_ += decoded ? share : 0;
    return;
  }
  const std::size_t count = kStrata / turns_;
  Strata acquired, ratios_db, chances{};
  acquired.fill(1);
  if (!found) acquisitions(preamble, state, acquired);
  // Strata before `begin` are lost, those from `end` on decoded.
  std::size_t begin = lost ? count : blocks_.size() == 1 ? count : 0, end = lost ? count : 0;
  for (std::size_t b = 0; b < blocks_.size() && !lost && !decoded; ++b) {
    ratios_of_block(bits, state, b, ratios_db);
    std::size_t first = 0, last = count;
    while (first < count && !(ratios_db[first] > curves_.bits_flank().low_db)) ++first;
    while (last > 0 && !(ratios_db[last - 1] < curves_.bits_flank().high_db)) --last;
    begin = std::min(begin, first);
    end = std::max(end, last);
    for (std::size_t j = begin; j < last; ++j) {
      chances[j] += blocks_[b].bits * curves_.log_bit_success_at(ratios_db[j]);
    }
  }
  if (decoded) begin = 0;
  exponentiate(begin, end, chances);
  double all = 0, right = 0;
  for (std::size_t j = 0; j < count; ++j) all += acquired[j];
  for (std::size_t j = begin; j < end; ++j) right += acquired[j] * chances[j];
  for (std::size_t j = std::max(begin, end); j < count; ++j) right += acquired[j];
  const double weight = share / static_cast<double>(count);
  acquired_ += weight * all;
  delivered_ += weight * right;
}

}  // namespace halocline::acoustics
