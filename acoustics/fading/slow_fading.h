// SPDX-License-Identifier: BSD-3-Clause
// Slow fading: the level of a link changes over hours, by tides and by the day, beside its large-scale fading
// over minutes (acoustics/fading/link_fading.h).
//
// Model, dB, of an unordered pair of vehicles:
//   Y(t) = G(t) + A_t cos(2 pi (t / 44714.16 s + u_t)) + A_d cos(2 pi (t / 86400 s + u_d)) - m
// G is a Gauss-Markov process (core/gauss_markov.h) of standard deviation sigma and correlation time T, exact
// at multiples of 65.536 s and linear between them (off by 0.07 dB rms at 3 dB and 6 h); A_t
// and A_d are the amplitudes of the semidiurnal lunar tide (M2) and of the day, u_t and u_d phases drawn for
// the pair. The mean -m preserves the mean power: sigma^2 ln(10) / 20 for G, 10 log10 I0(A ln(10) / 10) for a
// cosine. All draws are addressed by seed and pair: a value depends on neither the order nor the number of
// calls. The sizes are choices: at sea, detections and packets have three to seven times the binomial
// variance over bins of two hours, correlated by 0.2 to 0.65 from one bin to the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>

#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

// Parameters of Y.
struct SlowFading {
  double deviation_db = 0;  // standard deviation of G, 0..20
  double time_s = 21600;    // correlation time of G, 0.1..1e6
  double tidal_db = 0;      // A_t, 0..20
  double daily_db = 0;      // A_d, 0..20

  bool any() const { return deviation_db > 0 || tidal_db > 0 || daily_db > 0; }
  // Standard deviation of Y over days, dB.
  double rms_db() const;
  bool operator==(const SlowFading&) const = default;
};

// Throws InvalidArgument, naming the field, unless every field is in range.
void validate(const SlowFading& model);

// Two vehicles, the lower identifier first; both directions of a link share Y.
struct SlowPair {
  std::uint64_t seed = 0;
  std::uint32_t lower_id = 0, higher_id = 0;
};

// Y of a pair at `at`; 0 without slow fading.
Decibels slow_level(const SlowFading& model, const SlowPair& pair, SimTime at);

// The same for many pairs over time: keeps the draws about the latest instant of each of kMaxPairs pairs, so
// that an instant near it costs two cosines. Results do not depend on it. Not thread-safe.
class SlowLevels {
 public:
  static constexpr std::size_t kMaxPairs = 100'000;

  explicit SlowLevels(const SlowFading& model) : model_(model) {}
  Decibels at(const SlowPair& pair, SimTime at);

  // Draws of one pair: the number of the multiple at or before an instant, G there and at the next, and the
  // phases in turns.
  struct Draws {
    std::int64_t step = -1;
    double from_db = 0, to_db = 0, tide = 0, day = 0;
  };

 private:
  SlowFading model_;
  std::map<std::tuple<std::uint64_t, std::uint32_t, std::uint32_t>, Draws> kept_;
};

// Margin of a link over its noise, Y - Z, below which it lies for one hour in ten and for nine in ten, dB
// relative to that of the mean powers; Z is the change of the noise (acoustics/noise/noise_variation.h).
struct MarginQuantiles {
  double low_db = 0, high_db = 0;
};

// Quantiles of Y - Z over time and phases for a noise of standard deviation `noise_spread_db`, 0..30, within
// 0.01 dB; both 0 when nothing varies.
MarginQuantiles margin_quantiles(const SlowFading& model, double noise_spread_db);

}  // namespace halocline::acoustics
