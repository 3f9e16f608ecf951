// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/transmission_loss.h"

#include "core/elementary.h"

namespace halocline::acoustics {

TransmissionLoss transmission_loss(double range_m, double spreading_exponent, double absorption_db_per_km) {
  if (range_m < kReferenceRange) return {};
  // TL = k 10 log(l) + alpha l / 1000 (Urick 1983, chapter 5; Stojanovic 2006).
  constexpr double kMetresPerKilometre = 1000;
  const Decibels spreading{spreading_exponent * 10 * elementary::log10(range_m)};
  const Decibels absorption{absorption_db_per_km * range_m / kMetresPerKilometre};
  return {spreading, absorption, spreading + absorption};
}

}  // namespace halocline::acoustics
