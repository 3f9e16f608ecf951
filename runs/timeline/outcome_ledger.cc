// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/outcome_ledger.h"

#include <numeric>

#include "bus/messages/message_fields.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

constexpr auto& kReceiptNames = kModemReceiptReceiptResultNames;
constexpr auto& kOutcomeNames = kPacketOutcomeOutcomeNames;
constexpr auto& kPropagationNames = kPacketOutcomePropagationUsedNames;
static_assert(kReceiptNames.size() == kReceiptResults);
static_assert(kOutcomeNames.size() == kOutcomes);
static_assert(kPropagationNames.size() == kPropagations);
constexpr auto& kReasonNames = kPacketOutcomeLossReasonNames;
static_assert(kReasonNames.size() == kLossReasons);

template <std::size_t N>
const char* name_of(const std::array<const char*, N>& names, std::size_t number) {
  return number < N ? names[number] : "?";
}

}  // namespace

OutcomeLedger::OutcomeLedger(std::int64_t window_us) : window_us_(window_us) {
  require(window_us > 0, "the window must be above 0");
}

void OutcomeLedger::add(const packet_outcome_t& outcome) {
  const std::size_t number = number_of(outcome);
  const std::int64_t departure = outcome.departure_utime;
  const std::int64_t into_window = ((departure % window_us_) + window_us_) % window_us_;
  const std::int64_t receivers = outcome.num_receivers;
  total_.at(number) += receivers;
  by_window_[departure - into_window].at(number) += receivers;
  if (outcome.receiver_id != 0) by_pair_[{outcome.source_id, outcome.receiver_id}].at(number) += receivers;
  const ByteCounts bytes{receivers * outcome.payload_bytes, outcome.bytes_good};
  bytes_.sent += bytes.sent;
  bytes_.good += bytes.good;
  if (outcome.receiver_id != 0) {
    ByteCounts& of_pair = bytes_by_pair_[{outcome.source_id, outcome.receiver_id}];
    of_pair.sent += bytes.sent;
    of_pair.good += bytes.good;
  }
  by_reason_.at(static_cast<std::size_t>(static_cast<std::uint8_t>(outcome.loss_reason))) += receivers;
  if (outcome.outcome == packet_outcome_t::OUT_OF_REACH) return;  // no paths were computed
  by_propagation_.at(static_cast<std::size_t>(static_cast<std::uint8_t>(outcome.propagation_used))) +=
      receivers;
}

std::int64_t sum(const OutcomeCounts& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

const char* receipt_name(std::size_t result) { return name_of(kReceiptNames, result); }
const char* outcome_name(std::size_t outcome) { return name_of(kOutcomeNames, outcome); }
const char* loss_reason_name(std::size_t reason) { return name_of(kReasonNames, reason); }
const char* propagation_name(std::size_t propagation) { return name_of(kPropagationNames, propagation); }

}  // namespace halocline::clients
