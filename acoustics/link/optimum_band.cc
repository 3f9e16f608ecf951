// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/optimum_band.h"

#include <cmath>

#include "acoustics/link/transmission_loss.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kLowestHz = 1;  // limits of the search: beyond them turbulence or thermal noise dominates
constexpr double kHighestHz = 1e7;
const double kBandEdgeDb = 10 * elementary::log10(2.0);  // "3 dB" edge: twice the minimum
constexpr int kBisections = 64;                      // reduces 16 nepers to below one unit in the last place
constexpr double kGoldenShare = 0.3819660112501051;  // (3 - sqrt 5) / 2

// Loss A(l, f) and noise N(f), as ratios of powers.
class Channel {
 public:
  explicit Channel(const OptimumBandQuestion& question) : q_(question) {}
  double loss(double frequency_hz) const {
    const double f = hz_to_khz(frequency_hz);
    const double alpha = q_.absorption.db_per_km(f * f);
    return to_power_ratio(transmission_loss(q_.range_m, q_.spreading_exponent, alpha).total).value;
  }
  double noise(double frequency_hz) const { return noise_power_density(frequency_hz, q_.noise).value; }
  // The product in decibels: the ratio overflows where absorption is extreme.
  double loss_and_noise_db(double frequency_hz) const {
    const double f = hz_to_khz(frequency_hz);
    const double alpha = q_.absorption.db_per_km(f * f);
    return transmission_loss(q_.range_m, q_.spreading_exponent, alpha).total.value +
           noise_components(frequency_hz, q_.noise).total.value;
  }
  double loss_and_noise(double frequency_hz) const { return loss(frequency_hz) * noise(frequency_hz); }

 private:
  const OptimumBandQuestion& q_;
};

// Bisects for the x between `inside` and `outside` at which the predicate `holds`, true inside, becomes
// false.
template <typename Predicate>
double boundary(double inside, double outside, const Predicate& holds) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = std::sqrt(inside * outside);
    (holds(middle) ? inside : outside) = middle;
  }
  return inside;
}

// Slope of A N over log f: the step is small relative to its curvature and large relative to rounding.
double slope_db(const Channel& channel, double frequency_hz) {
  constexpr double kStep = 1e-4;
  return channel.loss_and_noise_db(frequency_hz * (1 + kStep)) -
         channel.loss_and_noise_db(frequency_hz / (1 + kStep));
}

// Brackets the minimum by golden section, then finds the root of the slope.
double minimum_frequency(const Channel& channel) {
  double a = elementary::log(kLowestHz), b = elementary::log(kHighestHz);
  while (b - a > 0.1) {
    const double left = a + kGoldenShare * (b - a), right = b - kGoldenShare * (b - a);
    if (channel.loss_and_noise_db(elementary::exp(left)) <
        channel.loss_and_noise_db(elementary::exp(right))) {
      b = right;
    } else {
      a = left;
    }
  }
  return boundary(elementary::exp(a), elementary::exp(b), [&](double f) { return slope_db(channel, f) < 0; });
}

// The band about the optimum within which A N is at most `level_db`.
Band band_below(const Channel& channel, double optimum_hz, double level_db) {
  const auto inside = [&](double f) { return channel.loss_and_noise_db(f) <= level_db; };
  return {boundary(optimum_hz, kLowestHz, inside), boundary(optimum_hz, kHighestHz, inside)};
}

template <typename Function>
double integrate_over(const Band& band, const Function& function) {
  double sum = 0;
  for (const FrequencyNode& node : frequency_nodes(band.low_hz, band.high_hz)) {
    sum += node.weight_hz * function(node.frequency_hz);
  }
  return sum;
}

// Flat spectrum S(f) = P / B (Stojanovic 2006): SNR = (P / B) integral(1 / A) / integral(N).
BandPlan flat_plan(const Channel& channel, const Band& band, double snr) {
  const double noise = integrate_over(band, [&](double f) { return channel.noise(f); });
  const double gain = integrate_over(band, [&](double f) { return 1 / channel.loss(f); });
  const double density = snr * noise / gain;  // P / B
  const double bits =
      integrate_over(band, [&](double f) { return log2_of_1_plus(density / channel.loss_and_noise(f)); });
  return {band, to_decibels(PowerRatio{density * band.width_hz()}), bits};
}

// Water-filling, S(f) = K - A N: SNR = integral(K / A - N) / integral(N) for the level K of `level_db`.
double water_filling_snr(const Channel& channel, const Band& band, double level_db) {
  const double level = to_power_ratio(Decibels{level_db}).value;
  const double signal =
      integrate_over(band, [&](double f) { return level / channel.loss(f) - channel.noise(f); });
  return signal / integrate_over(band, [&](double f) { return channel.noise(f); });
}

BandPlan water_filling_plan(const Channel& channel, double optimum_hz, double snr) {
  const double min_db = channel.loss_and_noise_db(optimum_hz);
  double low = min_db, high = min_db + 300;  // dB; the SNR grows with the level of the water
  while (high - low > 1e-12 * std::abs(high)) {
    const double middle = (low + high) / 2;
    (water_filling_snr(channel, band_below(channel, optimum_hz, middle), middle) < snr ? low : high) = middle;
  }
  const Band band = band_below(channel, optimum_hz, high);
  const double level = to_power_ratio(Decibels{high}).value;
  const double power = integrate_over(band, [&](double f) { return level - channel.loss_and_noise(f); });
  const double bits =
      integrate_over(band, [&](double f) { return elementary::log2(level / channel.loss_and_noise(f)); });
  return {band, to_decibels(PowerRatio{power}), bits};
}

}  // namespace

OptimumBand optimum_band(const OptimumBandQuestion& question) {
  require_in_range(question.range_m, 1, 1e6, "range", "m");
  const Channel channel(question);
  const double snr = to_power_ratio(question.target_snr).value;
  const double optimum = minimum_frequency(channel);
  const double least = channel.loss_and_noise_db(optimum);
  const Band flat = band_below(channel, optimum, least + kBandEdgeDb);
  return {optimum, {least}, flat_plan(channel, flat, snr), water_filling_plan(channel, optimum, snr)};
}

}  // namespace halocline::acoustics
