// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/half_delivery.h"

#include "core/elementary.h"

namespace halocline::acoustics {

std::optional<Decibels> half_delivery_sinr(const Modem& modem, std::size_t payload_bytes) {
  constexpr double kMin_db = -60, kMax_db = 60, kError_db = 1e-3, kHalf = 0.5;
  const auto bits = static_cast<double>(packet_timing(modem, payload_bytes).information_bits);
  const auto delivers_half = [&](double sinr_db) {
    const PowerRatio sinr = to_power_ratio(Decibels{sinr_db});
    // Probability of delivery, P = P_acquired (1 - BER)^bits.
    return acquisition_probability(modem, sinr) *
               elementary::exp(bits * elementary::log1p(-bit_error_rate(modem, sinr))) >=
           kHalf;
  };
  double low_db = kMin_db, high_db = kMax_db;
  if (delivers_half(low_db) || !delivers_half(high_db)) return std::nullopt;
  while (high_db - low_db > kError_db) {
    const double middle_db = (low_db + high_db) / 2;
    (delivers_half(middle_db) ? high_db : low_db) = middle_db;
  }
  return Decibels{high_db};
}

}  // namespace halocline::acoustics
