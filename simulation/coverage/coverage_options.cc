// SPDX-License-Identifier: BSD-3-Clause
// Parsing of the command line's quantities and depths.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <vector>

#include "core/check.h"
#include "core/csv_table.h"
#include "simulation/coverage/coverage.h"

namespace halocline::clients {
namespace {

constexpr std::array<QuantityMeaning, 6> kMeanings{{
    {CoverageQuantity::kDelivery, "delivery", "1", "delivery probability of a packet"},
    {CoverageQuantity::kSnr, "snr", "dB", "signal-to-noise ratio in the band"},
    {CoverageQuantity::kLevel, "level", "dB", "received level, re 1 uPa"},
    {CoverageQuantity::kDelay, "delay", "s", "travel time of sound"},
    {CoverageQuantity::kDeliveryLow, "delivery_low", "1", "delivery probability in one hour of ten"},
    {CoverageQuantity::kDeliveryHigh, "delivery_high", "1", "delivery probability in nine hours of ten"},
}};

constexpr std::size_t kMaxDepths = 1000;

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  if (text.ends_with(separator)) parts.emplace_back();
  return parts;
}

}  // namespace

const QuantityMeaning& meaning_of(CoverageQuantity quantity) {
  return kMeanings.at(static_cast<std::size_t>(quantity));
}

std::vector<CoverageQuantity> quantities_of(const std::string& names) {
  const std::string allowed =
      "; allowed are delivery, snr, level, delay, delivery_low and "
      "delivery_high, each once, with commas between";
  std::vector<CoverageQuantity> quantities;
  for (const std::string& name : parts_of(names, ',')) {
    const auto known = std::find_if(kMeanings.begin(), kMeanings.end(),
                                    [&](const QuantityMeaning& meaning) { return name == meaning.name; });
    require(known != kMeanings.end(), "--quantity names '" + name + "'" + allowed);
    require(std::find(quantities.begin(), quantities.end(), known->quantity) == quantities.end(),
            "--quantity names '" + name + "' twice" + allowed);
    quantities.push_back(known->quantity);
  }
  require(!quantities.empty(), "--quantity names none" + allowed);
  return quantities;
}

std::vector<double> depths_of(const std::string& text) {
  const std::string allowed = "--depths is '" + text +
                              "'; allowed is FIRST:LAST:STEP or one depth, metres below the surface, the "
                              "first from 0 to the last, the step above 0, 1000 depths at most";
  std::vector<double> numbers;
  for (const std::string& part : parts_of(text, ':')) {
    const auto number = parse_number(part);
    require(number.has_value(), allowed);
    numbers.push_back(*number);
  }
  if (numbers.size() == 1) numbers = {numbers[0], numbers[0], 1};
  require(numbers.size() == 3 && numbers[0] >= 0 && numbers[1] >= numbers[0] && numbers[2] > 0, allowed);
  const double steps = std::floor((numbers[1] - numbers[0]) / numbers[2] + 1e-9);
  require(steps < static_cast<double>(kMaxDepths), allowed);
  std::vector<double> depths;
  for (int i = 0; i <= static_cast<int>(steps); ++i) depths.push_back(numbers[0] + i * numbers[2]);
  return depths;
}

}  // namespace halocline::clients
