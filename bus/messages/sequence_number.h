// SPDX-License-Identifier: BSD-3-Clause
// The sequence number of a message in its flow (channel, session), for message types that carry one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "bus/messages/messages.h"

namespace halocline::bus {

// A packet to send carries a number of its own. Its sender may repeat a SEND on purpose, on channel SEND, so
// a second copy there is accepted. A copy on REPAIR that was received before is a duplicate.
template <class Message>
concept IsPacketToSend = requires(const Message& m) {
  m.packet_sequence;
  m.payload_size;
  m.source_id;
  m.session;
}
&&!requires(const Message& m) { m.sequence; };

template <class Message>
concept IsOfFlow =
    !std::is_same_v<Message, flow_heartbeat_t> && (IsPacketToSend<Message> || requires(const Message& m) {
      m.session;
      m.sequence;
    });

// Byte offsets of utime, session and sequence: every message of a flow begins with them, after LCM's
// fingerprint.
inline constexpr std::size_t kUtimeAt = 8, kSessionAt = 16, kSequenceAt = 24, kFlowHeadBytes = 32;

template <class Message>
std::int64_t sequence_of(const Message& message) {
  if constexpr (IsPacketToSend<Message>) {
    return message.packet_sequence;
  } else {
    return message.sequence;
  }
}

// Returns the receiver of an OUTCOME, whose publishers share the receivers among them (session_watch.h);
// nothing for other types.
template <class Message>
std::optional<std::int32_t> receiver_of(const Message& message) {
  if constexpr (std::is_same_v<Message, packet_outcome_t>) return message.receiver_id;
  return std::nullopt;
}

// Position of a message in its flow.
struct FlowHead {
  std::int64_t session = 0, sequence = 0, utime = 0;
  std::optional<std::int32_t> receiver;  // set for an OUTCOME
  bool is_packet = false;                // a SEND
};
// Reads the head of an encoded message; nothing for a message that belongs to no flow.
using FlowOf =
    std::function<std::optional<FlowHead>(std::string_view channel, std::span<const std::uint8_t> message)>;

template <class Message>
FlowHead flow_head_of(const Message& message) {
  return {message.session, sequence_of(message), message.utime, receiver_of(message),
          IsPacketToSend<Message>};
}

}  // namespace halocline::bus
