// SPDX-License-Identifier: BSD-3-Clause
// The place of a message in its flow, read from its bytes: for programs that record or count messages and
// decode none.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "bus/sequence_number.h"

namespace halocline::bus {

// The messages of a channel that are numbered.
struct FlowType {
  std::int64_t fingerprint = 0;    // LCM's, of the channel's type; 0: no flow
  bool is_packet_to_send = false;  // a SEND, numbered and repeated by its sender as it likes
};
FlowType flow_type_of(std::string_view channel);

// Empty for a message of another type, and for one of a publisher that numbers none.
std::optional<FlowHead> flow_head(const FlowType& type, std::span<const std::uint8_t> message);

}  // namespace halocline::bus
