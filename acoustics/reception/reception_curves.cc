#include "acoustics/reception/reception_curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acoustics/math/fast_functions.h"
#include "acoustics/reception/decoding.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kLeastDb = -40, kStepDb = 0.1;
constexpr std::size_t kRows = 1001;

}  // namespace

ReceptionCurves::ReceptionCurves(const Modem& modem, std::size_t payload_bytes)
    : modem_(modem),
      timing_(packet_timing(modem, payload_bytes)),
      blocks_(coded_blocks(modem, timing_.information_bits)) {
  for (std::size_t i = 0; i < kRows; ++i) {
    const PowerRatio sinr = to_power_ratio(Decibels{kLeastDb + kStepDb * static_cast<double>(i)});
    acquisition_.push_back(acquisition_probability(modem, sinr));
    log_bit_success_.push_back(std::log1p(-bit_error_rate(modem, sinr)));
  }
  acquisition_flank_ = flank_of([&](std::size_t row) { return acquisition_[row]; });
  bits_flank_ = flank_of([&](std::size_t row) {
    return std::exp(static_cast<double>(timing_.information_bits) * log_bit_success_[row]);
  });
  parts_ = make_parts();
}

// Of a chance that never falls.
template <typename Chance>
ReceptionCurves::Flank ReceptionCurves::flank_of(Chance chance) {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  std::size_t low = 0, high = kRows;  // rows below the flank; the first above it
  while (low < kRows && chance(low) < kCertain) ++low;
  while (high > 0 && chance(high - 1) > 1 - kCertain) --high;
  const auto db = [](std::size_t row) { return kLeastDb + kStepDb * static_cast<double>(row); };
  return {low == 0       ? -kNowhere
          : low == kRows ? kNowhere
                         : db(low - 1),
          high == kRows ? kNowhere
          : high == 0   ? -kNowhere
                        : db(high)};
}

ReceptionCurves::Parts ReceptionCurves::make_parts() const {
  const auto bits_of = [&](std::size_t halvings) {
    return static_cast<double>(timing_.information_bits) / std::exp2(static_cast<double>(halvings));
  };
  Parts parts;
  std::array<double, kHalvings> thresholds_db{};
  for (std::size_t h = 0; h < kHalvings; ++h) {
    thresholds_db[h] = ratio_db_of(-std::log(2) / bits_of(h));
    parts.thresholds[h] = std::pow(10, thresholds_db[h] / 10);
    parts.log_thresholds[h] = std::log(parts.thresholds[h]);
  }
  const double low_db = thresholds_db.back() - 4, high_db = thresholds_db.front() + 2.5;
  std::array<double, kRatios> ratios_db{};
  for (std::size_t k = 0; k < kRatios; ++k) {
    ratios_db[k] = low_db + (high_db - low_db) * static_cast<double>(k) / (kRatios - 1);
    parts.ratios[k] = std::pow(10, ratios_db[k] / 10);
  }
  constexpr int kSteps = 20;
  for (std::size_t h = 0; h < kHalvings; ++h) {
    const auto mean = [&](double from_db, double to_db) {
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        sum += std::exp(bits_of(h) * log_bit_success_at(from_db + (to_db - from_db) * (i + 0.5) / kSteps));
      }
      return sum / kSteps;
    };
    for (std::size_t k = 0; k <= kRatios; ++k) {
      parts.success[h][k] = k == 0         ? mean(ratios_db[0] - 3, ratios_db[0])
                            : k == kRatios ? mean(ratios_db.back(), ratios_db.back() + 3)
                                           : mean(ratios_db[k - 1], ratios_db[k]);
    }
  }
  return parts;
}

double ReceptionCurves::decibels(double sinr) { return sinr > 1e-30 ? fast_decibels(sinr) : kLeastDb; }

double ReceptionCurves::interpolated(const std::vector<double>& table, double sinr_db) {
  const double place = (sinr_db - kLeastDb) / kStepDb;
  if (!(place > 0)) return table.front();
  if (place >= static_cast<double>(kRows - 1)) return table.back();
  const auto row = static_cast<std::size_t>(place);
  return table[row] + (place - static_cast<double>(row)) * (table[row + 1] - table[row]);
}

double ReceptionCurves::ratio_db_of(double log_bit_success) const {
  const auto above = std::upper_bound(log_bit_success_.begin(), log_bit_success_.end(), log_bit_success);
  if (above == log_bit_success_.begin()) return kLeastDb;
  const auto row = static_cast<double>(above - log_bit_success_.begin()) - 1;
  if (above == log_bit_success_.end()) return kLeastDb + kStepDb * row;
  const double rise = *above - *(above - 1);
  return kLeastDb + kStepDb * (row + (log_bit_success - *(above - 1)) / rise);
}

}  // namespace halocline::acoustics
