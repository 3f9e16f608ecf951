// SPDX-License-Identifier: BSD-3-Clause
// Maps a channel to its message type, for programs that read all channels of a log.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "bus/messages/channel_family.h"
#include "bus/messages/channel_table.h"
#include "bus/messages/message_codec.h"
#include "core/names.h"

namespace halocline::clients {

inline bool is_on(std::string_view channel, std::string_view name) { return channel == name; }
inline bool is_on(std::string_view channel, const bus::Family& family) {
  return channel.starts_with(family.prefix) && is_valid_name(channel.substr(family.prefix.size()));
}

// Returns the channel whose message a REPAIR channel carries; any other channel unchanged.
inline std::string_view without_repair(std::string_view channel) {
  constexpr std::string_view kRepair = bus::channels::kRepair.prefix;
  while (channel.starts_with(kRepair)) channel.remove_prefix(kRepair.size());
  return channel;
}

// Calls `f.template operator()<Message>()` with the message type of `channel` (of the repaired channel, for
// REPAIR); returns false for an unknown channel.
template <class Function>
bool with_type_of(std::string_view channel, Function&& f) {
  return bus::any_channel([&]<class Message>(const auto& ours) {
    if (!is_on(without_repair(channel), ours)) return false;
    f.template operator()<Message>();
    return true;
  });
}

// Returns the part of a channel before its dot; the whole name if it has none.
inline std::string_view family_of(std::string_view channel) { return channel.substr(0, channel.find('.')); }

// Decodes bytes as bus::Bus does, without counting or reporting; returns false when they are not a valid
// Message.
template <class Message>
[[nodiscard]] bool decode_checked(const std::vector<std::uint8_t>& bytes, Message& message) {
  return bus::decode(bytes, message).empty();
}

}  // namespace halocline::clients
