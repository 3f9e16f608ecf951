// SPDX-License-Identifier: BSD-3-Clause
// Averages of packet outcomes over large-scale fading, for a fixed state of the remaining block fading of the
// link (acoustics/prediction/link_prediction.h has the model).
//
// The ratio that decides on the bits, relative to the mean noise and interference, changes slowly with
// large-scale fading. It is computed at few of kLevels levels and interpolated on a parabola unless three
// levels show a bend. When even the quietest level is decoded, or even the loudest lost, so are all others;
// the limits are those of ReceptionCurves::kCertain.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "acoustics/math/functions.h"
#include "acoustics/prediction/packet_levels.h"
#include "acoustics/prediction/reception_statistics.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::acoustics {

// Midpoints of `count` strata of equal probability of a standard normal variable, scaled to variance 1.
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

// Limit of |a + c - 2 b|, dB, below which the levels a, b and c are close enough to a parabola to
// interpolate.
inline constexpr double kBentDb = 0.15;

// The parabola through `low` at -1, `middle` at 0 and `high` at 1, evaluated at `x`.
inline double on_parabola(double low, double middle, double high, double x) {
  return middle + x * ((high - low) + x * (high + low - 2 * middle)) / 2;
}

// Accumulates the probabilities of acquisition and delivery over the states of block fading.
class StratifiedAverage {
 public:
  static constexpr std::size_t kLevels = 7;
  using Levels = std::array<Level, kLevels>;  // levels of the bits, from the most disturbance to the least

  // `deviation` is the standard deviation of large-scale fading in nepers of power, `noise` the noise over
  // the band, uPa^2. `curves` must outlive it.
  StratifiedAverage(double deviation, const ReceptionCurves& curves, const ReceptionStatistics& sound,
                    double noise);

  // Noise over the gain of large-scale fading, with the late echoes, at a level of both together; in
  // phase-shift keying with the untracked power, too.
  double noise(std::size_t level) const { return noise_[level]; }
  // True when the preamble is certain to be detected, the bits certain to be correct, or certain to be lost,
  // for every stratum of the other fading.
  bool finds(const Level& preamble) const;
  bool decodes(const Level& bits) const { return bits.at(-widest_) > curves_.bits_flank().high_db; }
  bool loses(const Level& bits) const { return bits.at(widest_) < curves_.bits_flank().low_db; }
  // Levels of one state of block fading; `at(k)` computes the level `k`.
  template <typename At>
  Levels levels(At at) const {
    constexpr std::size_t kMiddle = kLevels / 2;
    Levels bits;
    bits.front() = at(0);
    if (decodes(bits.front())) return spread(bits, 0, 0, kLevels);
    bits.back() = at(kLevels - 1);
    if (loses(bits.back())) return spread(bits, kLevels - 1, 0, kLevels);
    bits[kMiddle] = at(kMiddle);
    if (lie_on_parabola(bits)) return fill_parabola(bits);
    if (!decodes(bits[kMiddle]) && !loses(bits[kMiddle])) {
      bits[1] = at(1);
      bits[kLevels - 2] = at(kLevels - 2);
      return fill_quartic(bits);
    }
    fill_between(0, kMiddle, bits, at);
    fill_between(kMiddle, kLevels - 1, bits, at);
    return bits;
  }
  // Steps of levels(): spread() copies the ratio at the level `from` to the levels `begin`..`end`, corrected
  // for noise and interference; fill_parabola() interpolates between levels 0, 3 and 6; fill_quartic() uses
  // levels 1 and 5 in addition.
  Levels& spread(Levels& bits, std::size_t from, std::size_t begin, std::size_t end) const;
  bool lie_on_parabola(const Levels& bits) const;
  Levels& fill_parabola(Levels& bits) const;
  Levels& fill_quartic(Levels& bits) const;
  // Adds the outcome of packets in a state of block fading of the probability `share`. In phase-shift keying
  // the mean is over the even strata for even states and the odd strata for odd ones. The normal scores of
  // fast fading are paired with the strata in a different order for each state.
  void add(const Level& preamble, const Levels& bits, std::size_t state, double share);

  double acquisition_probability() const { return std::min(acquired_, 1.0); }  // min: rounding may exceed 1
  double delivery_probability() const { return std::min(delivered_, 1.0); }

 private:
  static constexpr std::size_t kStrata = 32;
  using Strata = std::array<double, kStrata>;
  // A coded block: its bits, and the factor by which its deviation exceeds that of the whole packet.
  struct Block {
    double bits, wider;
  };
  struct Scores;
  static const Scores& scores();

  // Ratio that decides on a block, dB, at the strata that take part in the state.
  void ratios_of_block(const Levels& bits, std::size_t state, std::size_t block, Strata& ratios_db) const;
  // Probabilities of detecting the preamble at the strata that take part in the state.
  void acquisitions(const Level& preamble, std::size_t state, Strata& chances) const;
  void set_places(const Strata& places);

  template <typename At>
  void fill_between(std::size_t low, std::size_t high, Levels& bits, At at) const {
    if (high - low < 2) return;
    if (decodes(bits[low]) || loses(bits[high])) {
      spread(bits, decodes(bits[low]) ? low : high, low + 1, high);
      return;
    }
    const std::size_t middle = (low + high) / 2;
    bits[middle] = at(middle);
    fill_between(low, middle, bits, at);
    fill_between(middle, high, bits, at);
  }

  const ReceptionCurves& curves_;
  Strata preamble_db_{};  // noise and interference of the preamble at each stratum
  double most_preamble_db_ = 0;
  std::size_t turns_ = 1;  // number of state classes among which the strata alternate
  std::array<double, kLevels> noise_{}, disturbance_db_{};
  // The level below each stratum, and the fraction of the way to the next level.
  std::array<std::size_t, kStrata> below_{};
  Strata parts_{};
  double widest_ = 0;  // extreme score of the fast fading
  std::vector<Block> blocks_;
  double acquired_ = 0, delivered_ = 0;
};

}  // namespace halocline::acoustics
