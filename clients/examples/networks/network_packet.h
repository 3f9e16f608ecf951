// SPDX-License-Identifier: BSD-3-Clause
// A packet of the network layer, as it travels in a modem's packet.
//
// | bytes | content (little-endian) |
// | --- | --- |
// | 0-3, 4-7 | id of the vehicle it comes from, and of the one it goes to; 0: all |
// | 8-11 | its number, counted by where it comes from |
// | 12-19 | simulation time at which it was offered, microseconds |
// | 20 | transmissions so far, without this one |
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace halocline::networks {

// What a MAC sends to a neighbour, or to all.
struct Frame {
  std::int32_t destination = 0;  // vehicle id; 0: all
  std::vector<std::uint8_t> bytes;
};

// The same behind a first byte that tells a protocol's packets apart.
Frame marked(std::uint8_t kind, const Frame& frame);

struct NetworkPacket {
  static constexpr std::size_t kHeaderBytes = 21;

  std::int32_t origin = 0, destination = 0;
  std::uint32_t number = 0;
  std::int64_t offered_utime = 0;
  std::uint8_t hops = 0;
  std::int32_t data_bytes = 0;  // of the user, whose contents mean nothing here
};

std::vector<std::uint8_t> encode(const NetworkPacket& packet);
// Empty for bytes that are too few.
[[nodiscard]] std::optional<NetworkPacket> decode_network_packet(std::span<const std::uint8_t> bytes);

}  // namespace halocline::networks
