// The sequence number of a message in its flow (channel, session), for message types that carry one.
#pragma once

#include <cstdint>
#include <type_traits>

#include "bus/messages.h"

namespace halocline::bus {

// A packet is numbered by its own sequence, because a SEND is repeated on purpose.
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

template <class Message>
std::int64_t sequence_of(const Message& message) {
  if constexpr (IsPacketToSend<Message>) {
    return message.packet_sequence;
  } else {
    return message.sequence;
  }
}

}  // namespace halocline::bus
