#include "acoustics/reception/reception_curves.h"

#include <algorithm>
#include <cmath>

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
}

double ReceptionCurves::decibels(double sinr) { return sinr > 0 ? 10 * std::log10(sinr) : kLeastDb; }

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
