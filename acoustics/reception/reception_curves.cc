// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/reception/reception_curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/modem/packet_format.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

// Bounds of the shares of lost parts for which ReceptionCurves::Parts has a ratio: finer where few are lost.
constexpr std::array<double, ReceptionCurves::kThresholds + 1> kLosses{0,   0.0004, 0.003, 0.015, 0.06,
                                                                       0.2, 0.5,    0.85,  1};

}  // namespace

ReceptionCurves::ReceptionCurves(const Modem& modem, std::size_t payload_bytes)
    : modem_(modem),
      timing_(packet_timing(modem, payload_bytes)),
      blocks_(data_format(modem, payload_bytes).blocks()) {
  for (std::size_t i = 0; i < kRows; ++i) {
    const PowerRatio sinr = to_power_ratio(Decibels{kMinDb + kStepDb * static_cast<double>(i)});
    acquisition_.push_back(acquisition_probability(modem, sinr));
    log_bit_success_.push_back(elementary::log1p(-bit_error_rate(modem, sinr)));
  }
  acquisition_flank_ = flank_of([&](std::size_t row) { return acquisition_[row]; });
  bits_flank_ = flank_of([&](std::size_t row) {
    return elementary::exp(static_cast<double>(timing_.information_bits) * log_bit_success_[row]);
  });
  parts_ = make_parts();
}

// Flank of a probability that never decreases over the rows.
template <typename Chance>
ReceptionCurves::Flank ReceptionCurves::flank_of(Chance chance) {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  std::size_t low = 0, high = kRows;  // first row that is not below the flank; first row above it
  while (low < kRows && chance(low) < kCertain) ++low;
  while (high > 0 && chance(high - 1) > 1 - kCertain) --high;
  const auto db = [](std::size_t row) { return kMinDb + kStepDb * static_cast<double>(row); };
  return {low == 0       ? -kNowhere
          : low == kRows ? kNowhere
                         : db(low - 1),
          high == kRows ? kNowhere
          : high == 0   ? -kNowhere
                        : db(high)};
}

const std::array<double, ReceptionCurves::kThresholds>& ReceptionCurves::threshold_shares() {
  static const std::array<double, kThresholds> shares = [] {
    std::array<double, kThresholds> made{};
    for (std::size_t k = 0; k < kThresholds; ++k) made[k] = kLosses[k + 1] - kLosses[k];
    return made;
  }();
  return shares;
}

// Mean of the ratios within each share of the losses, which fall from 1 to 0 over the ratio.
ReceptionCurves::Parts ReceptionCurves::make_parts() const {
  Parts parts;
  for (std::size_t h = 0; h < kHalvings; ++h) {
    const double bits = std::ldexp(static_cast<double>(timing_.information_bits), -static_cast<int>(h));
    const double lowest = 1 - elementary::exp(bits * log_bit_success_.front());
    std::array<double, kThresholds> weights{}, sums{};
    for (std::size_t i = 1; i < kRows; ++i) {
      const double above = -elementary::expm1(bits * log_bit_success_[i]) / lowest,
                   below = -elementary::expm1(bits * log_bit_success_[i - 1]) / lowest;
      const double log = std::numbers::ln10 / 10 * (kMinDb + kStepDb * (static_cast<double>(i) - 0.5));
      for (std::size_t k = 0; k < kThresholds; ++k) {
        const double share = std::min(below, kLosses[k + 1]) - std::max(above, kLosses[k]);
        if (!(share > 0)) continue;
        weights[k] += share;
        sums[k] += share * log;
      }
    }
    for (std::size_t k = 0; k < kThresholds; ++k) {
      parts[h].logs[k] = weights[k] > 0 ? sums[k] / weights[k] : std::numbers::ln10 / 10 * kMinDb;
    }
  }
  return parts;
}

double ReceptionCurves::decibels(double sinr) { return sinr > 1e-30 ? fast_decibels(sinr) : kMinDb; }

double ReceptionCurves::ratio_db_of(double log_bit_success) const {
  const auto above = std::upper_bound(log_bit_success_.begin(), log_bit_success_.end(), log_bit_success);
  if (above == log_bit_success_.begin()) return kMinDb;
  const auto row = static_cast<double>(above - log_bit_success_.begin()) - 1;
  if (above == log_bit_success_.end()) return kMinDb + kStepDb * row;
  const double rise = *above - *(above - 1);
  return kMinDb + kStepDb * (row + (log_bit_success - *(above - 1)) / rise);
}

}  // namespace halocline::acoustics
