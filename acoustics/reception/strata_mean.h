// SPDX-License-Identifier: BSD-3-Clause
// Means over large-scale fading of what becomes of packets while the rest of their link's slow fading holds
// (acoustics/reception/link_prediction.h has the model).
//
// Levels of the bits are computed at few of kLevels of large-scale fading: the ratio to the mean noise and
// interference changes slowly with it, along a parabola where three levels tell no other. Where even the
// least is decoded, or the greatest lost, all are: ReceptionCurves::kCertain.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "acoustics/math/functions.h"
#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/packet_levels.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::acoustics {

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

// a + c - 2 b below which a, b and c, dB, lie on a parabola well enough to interpolate.
inline constexpr double kBentDb = 0.15;

// The parabola through `low` at -1, `middle` at 0 and `high` at 1.
inline double on_parabola(double low, double middle, double high, double x) {
  return middle + x * ((high - low) + x * (high + low - 2 * middle)) / 2;
}

class StrataMean {
 public:
  static constexpr std::size_t kLevels = 7;
  using Levels = std::array<Level, kLevels>;  // of the bits, from quiet to loud

  // `deviation` of large-scale fading, nepers of power; `curves` outlive it.
  StrataMean(double deviation, const ReceptionCurves& curves, const MeanSound& sound, double noise);

  // Noise at a level of large-scale fading, in units of the sound's loudness there; of phase-shift keying,
  // all that disturbs.
  double noise(std::size_t level) const { return noise_[level]; }
  // Preambles are surely found, bits surely right or surely not, whatever else fades.
  bool finds(const Level& preamble) const;
  bool decodes(const Level& bits) const {
    return bits.at(-widest_) - most_echoes_db_ > curves_.bits_flank().high_db;
  }
  bool loses(const Level& bits) const {
    return bits.at(widest_) - least_echoes_db_ < curves_.bits_flank().low_db;
  }
  // Those of one state; `at` computes one of them.
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
  // Parts of levels(): `begin`..`end` as that of `from`, by noise and interference; by those at 0, 3 and 6;
  // by 1 and 5, too.
  Levels& spread(Levels& bits, std::size_t from, std::size_t begin, std::size_t end) const;
  bool lie_on_parabola(const Levels& bits) const;
  Levels& fill_parabola(Levels& bits) const;
  Levels& fill_quartic(Levels& bits) const;
  // Adds what becomes of packets in a slow state that has this `share` of the probability; of phase-shift
  // keying the mean over the even strata of even states, the odd ones of odd. Normals of fast fading come in
  // another order in each state.
  void add(const Level& preamble, const Levels& bits, std::size_t state, double share);

  double acquisition_probability() const { return std::min(acquired_, 1.0); }  // sums of rounded parts
  double delivery_probability() const { return std::min(delivered_, 1.0); }

 private:
  static constexpr std::size_t kStrata = 32;
  using Strata = std::array<double, kStrata>;
  struct Block {
    double bits, wider;
  };
  struct Scores;
  static const Scores& scores();

  // The ratio, dB, that decides of a block, at those of the strata that take part in the state.
  void ratios_of_block(const Levels& bits, std::size_t state, std::size_t block, Strata& ratios_db) const;
  // Whether preambles are found.
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
  Strata preamble_db_{};  // noise and interference over large-scale fading
  double most_preamble_db_ = 0;
  Strata echoes_db_{};     // interference of the bits over its mean, as late echoes fade by themselves
  std::size_t turns_ = 1;  // of states among which the strata are divided
  double least_echoes_db_ = 0, most_echoes_db_ = 0;
  std::array<double, kLevels> noise_{}, disturbance_db_{};
  std::array<std::size_t, kStrata>
      below_{};  // of the strata, the level below; the part of the way to the next
  Strata parts_{};
  double widest_ = 0;  // score of what fades fast
  std::vector<Block> blocks_;
  double acquired_ = 0, delivered_ = 0;
};

}  // namespace halocline::acoustics
