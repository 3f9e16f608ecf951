// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/bit_error.h"

#include <cmath>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

// Q(sqrt(2 x)) = erfc(sqrt(x)) / 2.
double tail_of_root(double x) { return elementary::erfc(std::sqrt(x)) / 2; }

// (1 - s) / 2 with s = sqrt(g / (k + g)), written as (1 - s^2) / (2 (1 + s)) with 1 - s^2 = k / (k + g),
// which avoids cancellation and infinity over infinity.
double coherent_in_rayleigh(double k, double g) {
  return k / (k + g) / (2 * (1 + std::sqrt(1 / (1 + k / g))));
}

// Bit error rates without fading (Proakis, 4th edition, section 5.2): BPSK Q(sqrt(2 g)), DBPSK e^-g / 2,
// coherent BFSK Q(sqrt(g)), non-coherent BFSK e^(-g/2) / 2.
double error_without_fading(Modulation modulation, double g) {
  switch (modulation) {
    case Modulation::kBpsk:
      return tail_of_root(g);
    case Modulation::kDbpsk:
      return elementary::exp(-g) / 2;
    case Modulation::kCoherentBfsk:
      return tail_of_root(g / 2);
    case Modulation::kNoncoherentBfsk:
      break;
  }
  return elementary::exp(-g / 2) / 2;
}

// Means of the bit error rates over an exponentially distributed g (section 14.3):
//   BPSK           (1 - sqrt(g / (1 + g))) / 2      DBPSK              1 / (2 (1 + g))
//   coherent BFSK  (1 - sqrt(g / (2 + g))) / 2      non-coherent BFSK  1 / (2 + g)
double error_in_rayleigh(Modulation modulation, double g) {
  switch (modulation) {
    case Modulation::kBpsk:
      return coherent_in_rayleigh(1, g);
    case Modulation::kDbpsk:
      return 1 / (2 * (1 + g));
    case Modulation::kCoherentBfsk:
      return coherent_in_rayleigh(2, g);
    case Modulation::kNoncoherentBfsk:
      break;
  }
  return 1 / (2 + g);
}

}  // namespace

double bit_error_rate(Modulation modulation, Fading fading, PowerRatio eb_over_n0) {
  require(eb_over_n0.value >= 0, "Eb/N0 is a ratio of powers and must not be negative or NaN");
  return fading == Fading::kNone ? error_without_fading(modulation, eb_over_n0.value)
                                 : error_in_rayleigh(modulation, eb_over_n0.value);
}

double packet_error_rate(double bit_error_rate, std::int64_t bits) {
  require_in_range(bit_error_rate, 0, 1, "bit error rate", "");
  require(bits >= 0, "a packet has no negative number of bits");
  if (bits == 0) return 0;
  // 1 - (1 - p)^n
  return -elementary::expm1(static_cast<double>(bits) * elementary::log1p(-bit_error_rate));
}

}  // namespace halocline::acoustics
