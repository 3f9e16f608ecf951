// SPDX-License-Identifier: BSD-3-Clause
// Messages of the bus out of a fuzzer's bytes: a channel of the table, a name, and a body behind the
// fingerprint of the channel's type, so that the fuzzer need not find that.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "bus/messages/channel_table.h"
#include "bus/messages/message_codec.h"
#include "core/hash.h"
#include "tests/fuzz/fuzz_input.h"

namespace halocline::fuzz {

struct BusMessage {
  std::string channel;
  bus::Bytes bytes;
};

inline constexpr std::array<std::string_view, 6> kNames{"auv-1", "auv-2",   "channel-server",
                                                        "1",     "monitor", "not a name"};
// Of the byte before the body, beside the name: the body has a fingerprint of its own; it is a repair.
inline constexpr std::uint8_t kOwnFingerprint = 0x80, kRepairs = 0x40;

// Two bytes denote a type or a channel: a hash of its name, so that kept inputs mean the same when others
// come.
inline std::uint16_t key_of(std::string_view name) { return static_cast<std::uint16_t>(fnv1a(name)); }
// Of values that are sorted by their keys, the first whose key is not below; the first of all behind the
// last.
template <class Keyed>
const Keyed& with_key(const std::vector<Keyed>& sorted, std::uint16_t key) {
  const auto found =
      std::partition_point(sorted.begin(), sorted.end(), [&](const Keyed& one) { return one.key < key; });
  return found == sorted.end() ? sorted.front() : *found;
}

struct ChannelOfTable {
  std::uint16_t key;
  std::string name;  // or what it begins with
  bool is_family;
  std::int64_t fingerprint;
};

inline const std::vector<ChannelOfTable>& channels() {
  static const std::vector<ChannelOfTable> all = [] {
    std::vector<ChannelOfTable> found;
    bus::any_channel([&]<class Message>(const auto& channel) {
      if constexpr (std::is_convertible_v<decltype(channel), std::string_view>) {
        found.push_back({key_of(channel), std::string(channel), false, Message::getHash()});
      } else {
        found.push_back({key_of(channel.prefix), std::string(channel.prefix), true, Message::getHash()});
      }
      return false;
    });
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return found;
  }();
  return all;
}

inline bus::Bytes with_fingerprint(std::int64_t fingerprint, std::span<const std::uint8_t> body) {
  bus::Bytes bytes;
  bus::append_uint32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(fingerprint) >> 32), bytes);
  bus::append_uint32(static_cast<std::uint32_t>(fingerprint), bytes);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

// Channel, name, and a block.
inline BusMessage bus_message_from(Input& input) {
  const ChannelOfTable& channel = with_key(channels(), input.number<std::uint16_t>());
  const auto flags = input.number();
  BusMessage message{channel.name, {}};
  if (channel.is_family) message.channel += kNames[(flags & 0x3f) % kNames.size()];
  if ((flags & kRepairs) != 0) message.channel = std::string(bus::channels::kRepair.prefix) + message.channel;
  const auto body = input.block();
  message.bytes = (flags & kOwnFingerprint) != 0 ? bus::Bytes(body.begin(), body.end())
                                                 : with_fingerprint(channel.fingerprint, body);
  return message;
}

}  // namespace halocline::fuzz
