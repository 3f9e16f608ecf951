// SPDX-License-Identifier: BSD-3-Clause
// How many packets had which outcome: counted by outcome, pair and window of time, and by what their paths
// were computed with.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "bus/messages.h"

namespace halocline::clients {

inline constexpr std::size_t kOutcomes = 18;        // packet_outcome_t.RECEIVED to NO_POWER
inline constexpr std::size_t kReceiptResults = 12;  // modem_receipt_t.ACCEPTED to REFUSED_NO_MODEM
inline constexpr std::size_t kPropagations = 5;     // packet_outcome_t.STRAIGHT to RAYS_BEYOND_TERRAIN
using OutcomeCounts = std::array<std::int64_t, kOutcomes>;          // by packet_outcome_t.outcome
using PropagationCounts = std::array<std::int64_t, kPropagations>;  // by packet_outcome_t.propagation_used

class OutcomeLedger {
 public:
  using Pair = std::pair<std::int32_t, std::int32_t>;  // ids of sender and receiver

  // Outcomes are summed over windows of `window_us` > 0 of simulation time, by the instant of departure.
  explicit OutcomeLedger(std::int64_t window_us);

  // Counts each of its receivers, by pair only where there is one; it is for the caller to leave out
  // repetitions.
  void add(const packet_outcome_t& outcome);

  const OutcomeCounts& total() const { return total_; }
  const std::map<Pair, OutcomeCounts>& by_pair() const { return by_pair_; }
  const std::map<std::int64_t, OutcomeCounts>& by_window() const { return by_window_; }  // by its start, us
  const PropagationCounts& by_propagation() const { return by_propagation_; }

 private:
  std::int64_t window_us_;
  OutcomeCounts total_{};
  PropagationCounts by_propagation_{};
  std::map<Pair, OutcomeCounts> by_pair_;
  std::map<std::int64_t, OutcomeCounts> by_window_;
};

std::int64_t sum(const OutcomeCounts& counts);

// The number of an outcome in a message that was checked.
inline std::size_t number_of(const packet_outcome_t& outcome) {
  return static_cast<std::size_t>(static_cast<std::uint8_t>(outcome.outcome));
}

// Names of receipt results, packet outcomes and propagations ("straight", "rays", "straight without bottom"),
// by their number; "?" for others.
const char* receipt_name(std::size_t result);
const char* outcome_name(std::size_t outcome);
const char* propagation_name(std::size_t propagation);

}  // namespace halocline::clients
