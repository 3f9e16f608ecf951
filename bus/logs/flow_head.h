// SPDX-License-Identifier: BSD-3-Clause
// Reads the position of a message in its flow from its bytes, for programs that record or count messages
// without decoding them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "bus/messages/sequence_number.h"

namespace halocline::bus {

// Properties of the numbered messages of a channel.
struct FlowType {
  std::int64_t fingerprint = 0;    // LCM's fingerprint of the channel's type; 0: not numbered
  bool is_packet_to_send = false;  // a SEND, numbered and repeated as its sender chooses
};
FlowType flow_type_of(std::string_view channel);

// Returns nothing for a message of another type, and for a publisher that does not number its messages.
std::optional<FlowHead> flow_head(const FlowType& type, std::span<const std::uint8_t> message);

}  // namespace halocline::bus
