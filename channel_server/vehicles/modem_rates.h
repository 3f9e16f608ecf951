// SPDX-License-Identifier: BSD-3-Clause
// The rates of a modem: the other waveforms that it also sends and receives, each by its number.
//
// A rate is a profile of its own (models/modems). Of one family with the vehicle's modem it differs in bit
// rate, overhead, preamble, framing and code alone: the vehicle's numbers hold for all else, and it is
// received as the modem's own rate is. A rate of another family has its own band and reception; source level,
// least receivable level, directivity and beam are the vehicle's.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "acoustics/modem/modem.h"

namespace halocline::channel_server {

struct ModemRate {
  std::int32_t number = 0;             // 0..255; of a Micromodem that of its packet type
  std::int32_t max_payload_bytes = 0;  // of one packet
  acoustics::Modem modem;
  bool operator==(const ModemRate&) const = default;
};

// A value; copies share what they hold.
class RateSet {
 public:
  RateSet() = default;
  explicit RateSet(std::vector<ModemRate> rates)
      : rates_(std::make_shared<const std::vector<ModemRate>>(std::move(rates))) {}

  std::span<const ModemRate> all() const {
    return rates_ == nullptr ? std::span<const ModemRate>() : std::span<const ModemRate>(*rates_);
  }
  // The first for which `fits(rate)`; null without one.
  template <class Predicate>
  const ModemRate* find(const Predicate& fits) const {
    const auto found = std::find_if(all().begin(), all().end(), fits);
    return found == all().end() ? nullptr : &*found;
  }
  bool operator==(const RateSet& other) const {
    return rates_ == other.rates_ || std::ranges::equal(all(), other.all());
  }

 private:
  std::shared_ptr<const std::vector<ModemRate>> rates_;  // null: none
};

// The rates of a profile whose own modem is `profile`, in a vehicle whose modem is `own`.
RateSet rates_in_vehicle(const RateSet& rates, const acoustics::Modem& profile, const acoustics::Modem& own);

}  // namespace halocline::channel_server
