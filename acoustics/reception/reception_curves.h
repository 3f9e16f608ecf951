// SPDX-License-Identifier: BSD-3-Clause
// Reception curves of one modem for packets of one payload, tabulated so that a prediction costs
// microseconds.
//
// Probability of detecting the preamble and of a correct bit over the ratio of signal to noise and
// interference in the band, -40 to 60 dB in steps of 0.1 dB. Values are interpolated linearly (error below
// 1e-3 of probability); outside of the range the value of the nearest end holds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// Tables of one modem and payload. Functions of `sinr` take a power ratio, those of `sinr_db` decibels.
class ReceptionCurves {
 public:
  static constexpr std::size_t kHalvings = 7, kThresholds = 8;

  // Throws InvalidArgument under the conditions of packet_timing().
  ReceptionCurves(const Modem& modem, std::size_t payload_bytes);

  const Modem& modem() const { return modem_; }
  const PacketTiming& timing() const { return timing_; }
  // Information bits of each coded block.
  const std::vector<std::int64_t>& blocks() const { return blocks_; }

  double acquisition(double sinr) const { return acquisition_at(decibels(sinr)); }
  double acquisition_at(double sinr_db) const { return interpolated(acquisition_, sinr_db); }
  // ln(1 - BER), at most 0.
  double log_bit_success(double sinr) const { return log_bit_success_at(decibels(sinr)); }
  double log_bit_success_at(double sinr_db) const { return interpolated(log_bit_success_, sinr_db); }
  // Range of the ratio over which a probability changes, dB: below `low_db` it is less than kCertain, above
  // `high_db` more than 1 - kCertain. Infinite when no ratio of the table satisfies this.
  static constexpr double kCertain = 1e-4;
  struct Flank {
    double low_db = 0, high_db = 0;
  };
  const Flank& acquisition_flank() const { return acquisition_flank_; }
  const Flank& bits_flank() const { return bits_flank_; }  // for all information bits together
  // The ratio, dB, at which ln(1 - BER) equals `log_bit_success`.
  double ratio_db_of(double log_bit_success) const;
  // Loss of a part of a packet, 1 / 2^halvings of its bits: the ratio below which the part is lost, as a
  // discrete distribution of descending thresholds in nepers, each with its share (threshold_shares()).
  struct Thresholds {
    std::array<double, kThresholds> logs{};
  };
  static const std::array<double, kThresholds>& threshold_shares();
  using Parts = std::array<Thresholds, kHalvings>;
  const Parts& parts() const { return parts_; }

 private:
  static double decibels(double sinr);
  Parts make_parts() const;
  template <typename Chance>
  static Flank flank_of(Chance chance);
  static constexpr double kMinDb = -40, kStepDb = 0.1;
  static constexpr std::size_t kRows = 1001;
  static double interpolated(const std::vector<double>& table, double sinr_db) {
    constexpr double kMax = kRows - 1.000001;
    const double place = (sinr_db - kMinDb) * (1 / kStepDb), low = place > 0 ? place : 0,
                 held = low < kMax ? low : kMax;
    const auto row = static_cast<std::int32_t>(held);
    const double* here = table.data() + row;
    return here[0] + (held - row) * (here[1] - here[0]);
  }

  Modem modem_;
  PacketTiming timing_;
  std::vector<std::int64_t> blocks_;
  std::vector<double> acquisition_, log_bit_success_;
  Flank acquisition_flank_, bits_flank_;
  Parts parts_;
};

}  // namespace halocline::acoustics
