// SPDX-License-Identifier: BSD-3-Clause
// Rates of a modem: the other waveforms that it also sends and receives, each with its number.
//
// A rate is a modem profile of its own (models/modems). A rate of the same family as the vehicle's modem
// differs only in bit rate, overhead, preamble, framing and code: the vehicle's values hold for everything
// else, and it is received like the modem's own rate. A rate of another family has its own band and
// reception; source level, least receivable level, directivity and beam are the vehicle's.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "acoustics/modem/modem.h"

namespace halocline::channel_server {

struct ModemRate {
  std::int32_t number = 0;             // 0..255; for a Micromodem, its packet type
  std::int32_t max_payload_bytes = 0;  // largest payload of one packet
  acoustics::Modem modem;
  bool operator==(const ModemRate&) const = default;
};

// Immutable set of rates; copies share the storage.
class RateSet {
 public:
  RateSet() = default;
  explicit RateSet(std::vector<ModemRate> rates)
      : rates_(std::make_shared<const std::vector<ModemRate>>(std::move(rates))) {}

  std::span<const ModemRate> all() const {
    return rates_ == nullptr ? std::span<const ModemRate>() : std::span<const ModemRate>(*rates_);
  }
  // Returns the first rate for which `fits(rate)` is true; null without one.
  template <class Predicate>
  const ModemRate* find(const Predicate& fits) const {
    const auto found = std::find_if(all().begin(), all().end(), fits);
    return found == all().end() ? nullptr : &*found;
  }
  bool operator==(const RateSet& other) const {
    return rates_ == other.rates_ || std::ranges::equal(all(), other.all());
  }

 private:
  std::shared_ptr<const std::vector<ModemRate>> rates_;  // null: no rates
};

// Returns the rates of a profile whose own modem is `profile`, as a vehicle whose modem is `own` has them.
RateSet rates_in_vehicle(const RateSet& rates, const acoustics::Modem& profile, const acoustics::Modem& own);

}  // namespace halocline::channel_server
