// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/noise.h"

#include <algorithm>
#include <cmath>

#include "acoustics/math/frequency_band.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr Decibels kAbsent{-300};

// Spectrum level of rain, f in kHz (noise.h has the formula).
Decibels rain_level(double f, double rain_mm_per_h) {
  if (rain_mm_per_h <= 0) return kAbsent;
  return {42.4 + 15.4 * elementary::log10(rain_mm_per_h) - 10 * elementary::log10(1 + (f / 15) * (f / 15))};
}

Decibels place_level(double frequency_hz, const NoiseSources& sources) {
  if (sources.site) return sources.site->level(frequency_hz);
  return place_noise(sources.place, frequency_hz).value_or(kAbsent);
}

bool has_place(const NoiseSources& sources) { return sources.site || sources.place != NoisePlace::kOpen; }

// Power of all sources together, with their offset.
PowerRatio with_offset(PowerRatio power, const NoiseSources& sources) {
  return sources.offset_db == 0 ? power
                                : PowerRatio{power.value * to_power_ratio(Decibels{sources.offset_db}).value};
}

}  // namespace

NoiseComponents noise_components(double frequency_hz, const NoiseSources& sources) {
  // Coates 1990 as in Stojanovic 2006 (WUWNet); f in kHz, s shipping, w wind; dB re 1 uPa^2/Hz. Powers add.
  //   turbulence  17 - 30 log10 f
  //   shipping    40 + 20 (s - 0.5) + 26 log10 f - 60 log10(f + 0.03)
  //   wind        50 + 7.5 sqrt(w) + 20 log10 f - 40 log10(f + 0.4)
  //   thermal     -15 + 20 log10 f
  const double f = hz_to_khz(frequency_hz), log_f = elementary::log10(f);
  NoiseComponents n;
  n.turbulence = {17 - 30 * log_f};
  n.shipping = {40 + 20 * (sources.shipping - 0.5) + 26 * log_f - 60 * elementary::log10(f + 0.03)};
  n.wind = {50 + 7.5 * std::sqrt(sources.wind_mps) + 20 * log_f - 40 * elementary::log10(f + 0.4)};
  n.thermal = {-15 + 20 * log_f};
  n.rain = rain_level(f, sources.rain_mm_per_h);
  n.place = place_level(frequency_hz, sources);
  if (is_under_ice(sources.place)) n.wind = kAbsent;
  n.total_power = to_power_ratio(n.turbulence) + to_power_ratio(n.shipping) + to_power_ratio(n.wind) +
                  to_power_ratio(n.thermal);
  if (sources.rain_mm_per_h > 0) n.total_power = n.total_power + to_power_ratio(n.rain);
  if (has_place(sources)) n.total_power = n.total_power + to_power_ratio(n.place);
  if (sources.table) n.total_power = to_power_ratio(sources.table->level(frequency_hz));
  n.total_power = with_offset(n.total_power, sources);
  n.total = to_decibels(n.total_power);
  return n;
}

PowerRatio noise_power_density(double frequency_hz, const NoiseSources& sources) {
  return noise_components(frequency_hz, sources).total_power;
}

// Each component is monotonic in frequency or has one maximum: its minimum is at an end of the band. A
// spectrum measured at the place may have its least level anywhere.
PowerRatio least_noise_power_density(double low_hz, double high_hz, const NoiseSources& sources) {
  if (sources.table) return with_offset(to_power_ratio(sources.table->least_level(low_hz, high_hz)), sources);
  const NoiseComponents low = noise_components(low_hz, sources), high = noise_components(high_hz, sources);
  double density = 0;
  for (const auto component : {&NoiseComponents::turbulence, &NoiseComponents::shipping,
                               &NoiseComponents::wind, &NoiseComponents::thermal}) {
    density += to_power_ratio(std::min(low.*component, high.*component)).value;
  }
  if (sources.rain_mm_per_h > 0) density += to_power_ratio(std::min(low.rain, high.rain)).value;
  if (sources.site) {
    density += to_power_ratio(sources.site->least_level(low_hz, high_hz)).value;
  } else if (has_place(sources)) {
    density += to_power_ratio(std::min(low.place, high.place)).value;
  }
  return with_offset({density}, sources);
}

PowerRatio noise_power_over_band(double low_hz, double high_hz, const NoiseSources& sources) {
  double power = 0;
  for (const FrequencyNode& node : frequency_nodes(low_hz, high_hz)) {
    power += node.weight_hz * noise_power_density(node.frequency_hz, sources).value;
  }
  return {power};
}

Decibels noise_level_over_band(double low_hz, double high_hz, const NoiseSources& sources) {
  return to_decibels(noise_power_over_band(low_hz, high_hz, sources));
}

}  // namespace halocline::acoustics
