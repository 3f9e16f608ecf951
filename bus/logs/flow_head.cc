// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/flow_head.h"

#include "bus/logs/channel_types.h"
#include "bus/messages/message_codec.h"

namespace halocline::bus {

FlowType flow_type_of(std::string_view channel) {
  FlowType type;
  clients::with_type_of(channel, [&]<class Message>() {
    if constexpr (IsOfFlow<Message>) type = {Message::getHash(), IsPacketToSend<Message>};
  });
  return type;
}

std::optional<FlowHead> flow_head(const FlowType& type, std::span<const std::uint8_t> message) {
  if (type.fingerprint == 0 || message.size() < kFlowHeadBytes) return std::nullopt;
  if (int64_at(message, 0) != type.fingerprint) return std::nullopt;
  const FlowHead head{.session = int64_at(message, kSessionAt),
                      .sequence = int64_at(message, kSequenceAt),
                      .utime = int64_at(message, kUtimeAt),
                      .receiver = {},
                      .is_packet = type.is_packet_to_send};
  if (head.session == 0 && head.sequence == 0) return std::nullopt;
  return head;
}

}  // namespace halocline::bus
