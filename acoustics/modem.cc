#include "acoustics/modem.h"

#include <algorithm>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

constexpr double kBitsPerByte = 8;

}  // namespace

void validate(const Modem& modem) {
  require_in_range(modem.source_level.value, 0, 250, "source level", "dB re 1 uPa at 1 m");
  require_in_range(modem.least_receivable_level.value, -200, 250, "least receivable level", "dB re 1 uPa");
  require_in_range(modem.centre_frequency_hz, 10, 1e6, "centre frequency", "Hz");
  require_finite(modem.bandwidth_hz, "bandwidth");
  require(modem.bandwidth_hz > 0 && modem.bandwidth_hz < 2 * modem.centre_frequency_hz,
          "bandwidth is " + std::to_string(modem.bandwidth_hz) +
              " Hz; allowed is above 0 and below twice the centre frequency of " +
              std::to_string(modem.centre_frequency_hz) + " Hz");
  require_in_range(modem.directivity_index.value, 0, 40, "directivity index", "dB");
  require_in_range(modem.bit_rate_bps, 1e-3, 1e7, "bit rate", "bit/s");
  require_in_range(modem.packet_overhead.seconds(), 0, 60, "packet overhead", "s");
}

Modem generic_modem(Decibels strength, Decibels cut_off, double centre_frequency_hz, double bandwidth_hz) {
  Modem modem;
  modem.source_level = strength;
  modem.least_receivable_level = cut_off;
  modem.centre_frequency_hz = centre_frequency_hz;
  modem.bandwidth_hz = bandwidth_hz;
  validate(modem);
  return modem;
}

SimDuration packet_duration(const Modem& modem, std::size_t payload_bytes) {
  const double bits = static_cast<double>(payload_bytes) * kBitsPerByte;
  return modem.packet_overhead + SimDuration::from_seconds(bits / modem.bit_rate_bps);
}

bool bands_overlap(const Modem& one, const Modem& other) {
  return std::max(one.band().low_hz, other.band().low_hz) <
         std::min(one.band().high_hz, other.band().high_hz);
}

}  // namespace halocline::acoustics
