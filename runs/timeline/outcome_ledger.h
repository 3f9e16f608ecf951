// SPDX-License-Identifier: BSD-3-Clause
// Counts of packet outcomes: by outcome, by pair, by window of time, and by the propagation model that
// computed their paths.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "bus/messages/messages.h"

namespace halocline::clients {

inline constexpr std::size_t kOutcomes = 19;        // packet_outcome_t.RECEIVED to OUT_OF_WATER
inline constexpr std::size_t kReceiptResults = 12;  // modem_receipt_t.ACCEPTED to REFUSED_NO_MODEM
inline constexpr std::size_t kPropagations = 5;     // packet_outcome_t.STRAIGHT to RAYS_BEYOND_TERRAIN
// Counts indexed by packet_outcome_t.outcome.
using OutcomeCounts = std::array<std::int64_t, kOutcomes>;
// Counts indexed by packet_outcome_t.propagation_used.
using PropagationCounts = std::array<std::int64_t, kPropagations>;

// Counts of outcomes. A count is a number of receivers.
class OutcomeLedger {
 public:
  using Pair = std::pair<std::int32_t, std::int32_t>;  // ids of sender and receiver

  // Sums outcomes over windows of `window_us` > 0 of simulation time, by the instant of departure, us.
  explicit OutcomeLedger(std::int64_t window_us);

  // Adds an outcome once for each receiver that it represents; by pair only when it names one receiver, by
  // propagation unless it is OUT_OF_REACH. The caller leaves out repetitions.
  void add(const packet_outcome_t& outcome);

  const OutcomeCounts& total() const { return total_; }
  const std::map<Pair, OutcomeCounts>& by_pair() const { return by_pair_; }
  // Returns the counts of each window, keyed by its start, us.
  const std::map<std::int64_t, OutcomeCounts>& by_window() const { return by_window_; }
  const PropagationCounts& by_propagation() const { return by_propagation_; }

 private:
  std::int64_t window_us_;
  OutcomeCounts total_{};
  PropagationCounts by_propagation_{};
  std::map<Pair, OutcomeCounts> by_pair_;
  std::map<std::int64_t, OutcomeCounts> by_window_;
};

std::int64_t sum(const OutcomeCounts& counts);

// Returns the number of an outcome in a message that was checked already.
inline std::size_t number_of(const packet_outcome_t& outcome) {
  return static_cast<std::size_t>(static_cast<std::uint8_t>(outcome.outcome));
}

// Return the names of receipt results, packet outcomes and propagations ("straight", "rays", "straight
// without bottom") by number; "?" for an unknown number.
const char* receipt_name(std::size_t result);
const char* outcome_name(std::size_t outcome);
const char* propagation_name(std::size_t propagation);

}  // namespace halocline::clients
