// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/capacity.h"

#include <numbers>

#include "acoustics/link/transmission_loss.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

// The signal-to-noise ratio (P/B) / (A(l, f) N(f)), a ratio of powers.
double density_ratio(const UniformLink& link, const Band& band, double frequency_hz) {
  const double f = hz_to_khz(frequency_hz);
  const double alpha = link.absorption.db_per_km(f * f);
  const TransmissionLoss loss = transmission_loss(link.range_m, link.spreading_exponent, alpha);
  const double received = to_power_ratio(link.source_level - loss.total).value / band.width_hz();
  return received / noise_power_density(frequency_hz, link.noise).value;
}

}  // namespace

double log2_of_1_plus(double x) { return elementary::log1p(x) * std::numbers::log2e; }

double capacity_bps(const UniformLink& link, const Band& band) {
  // Shannon's capacity over frequency (Stojanovic 2006; equation 8 of the 2010 IEEE SMC paper):
  //   C = integral of log2(1 + (P / B) / (A(l, f) N(f))) df.
  double bits = 0;
  for (const FrequencyNode& node : frequency_nodes(band.low_hz, band.high_hz)) {
    bits += node.weight_hz * log2_of_1_plus(density_ratio(link, band, node.frequency_hz));
  }
  return bits;
}

double narrowband_capacity_bps(const UniformLink& link, const Band& band) {
  return band.width_hz() * log2_of_1_plus(density_ratio(link, band, band.centre_hz()));
}

}  // namespace halocline::acoustics
