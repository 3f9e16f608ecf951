// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/channel_record.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/csv_table.h"

namespace halocline::acoustics {
namespace {

constexpr double kHighestRateHz = 1e7;

// Tolerance at the edges of the band, as a share of its width, for the rounding of carrier and rate.
constexpr double kEdgeTolerance = 1e-9;

std::string text_of(const Band& band) {
  return format_number(band.low_hz) + " to " + format_number(band.high_hz) + " Hz";
}

}  // namespace

void validate(const ChannelRecord& record) {
  const std::string& name = record.name;
  require_in_range(record.delay_rate_hz, 1, kHighestRateHz, name + ": params/fs_delay", "Hz");
  require_in_range(record.time_rate_hz, 1e-3, kHighestRateHz, name + ": params/fs_time", "Hz");
  require_in_range(record.carrier_hz, record.delay_rate_hz / 2, kHighestRateHz, name + ": params/fc", "Hz");
  require(record.delays >= 1 && record.delays <= kMaxRecordDelays && record.taps.size() <= kMaxRecordTaps,
          name + ": h_hat has " + std::to_string(record.delays) + " delays at " +
              std::to_string(record.instants()) + " instants; allowed are 1 to " +
              std::to_string(kMaxRecordDelays) + " delays and " + std::to_string(kMaxRecordTaps) +
              " values in all");
  require(record.taps.size() % record.delays == 0 && record.instants() >= 2,
          name + ": h_hat has " + std::to_string(record.instants()) + " instants; allowed are 2 and more");
  bool sounds = false;
  for (std::size_t i = 0; i < record.taps.size(); ++i) {
    const std::complex<float> tap = record.taps[i];
    require(std::isfinite(tap.real()) && std::isfinite(tap.imag()),
            name + ": h_hat at instant " + std::to_string(i / record.delays) + ", delay " +
                std::to_string(i % record.delays) + " is not finite; allowed are finite numbers");
    sounds = sounds || tap != std::complex<float>();
  }
  require(sounds, name + ": h_hat is 0 everywhere; allowed is a channel through which some sound comes");
}

bool holds(const ChannelRecord& record, const Band& band) {
  const Band known = record.band();
  const double tolerance_hz = kEdgeTolerance * record.delay_rate_hz;
  return band.low_hz >= known.low_hz - tolerance_hz && band.high_hz <= known.high_hz + tolerance_hz;
}

void require_holds(const ChannelRecord& record, const Band& band, const std::string& whose) {
  require(holds(record, band), record.name + ": was measured from " + text_of(record.band()) + "; " + whose +
                                   " has " + text_of(band) + "; allowed is a band within");
}

}  // namespace halocline::acoustics
