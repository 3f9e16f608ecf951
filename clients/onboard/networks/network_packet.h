// SPDX-License-Identifier: BSD-3-Clause
// Packet of the network layer, as a modem's packet carries it.
//
// | bytes    | content (little-endian)                                    |
// | -------- | ---------------------------------------------------------- |
// | 0-3, 4-7 | ids of the vehicles that it comes from and goes to; 0: all |
// | 8-11     | number of the packet, counted by its origin                |
// | 12-19    | simulation time at which it was offered, microseconds      |
// | 20       | transmissions so far, without this one                     |
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace halocline::networks {

// MacFrame that a MAC sends to a neighbour, or to all.
struct MacFrame {
  std::int32_t destination = 0;  // vehicle id; 0: all
  std::vector<std::uint8_t> bytes;
};

// Returns a frame with a byte in front, which tells the types of a protocol's packets apart.
MacFrame marked(std::uint8_t kind, const MacFrame& frame);

struct NetworkPacket {
  static constexpr std::size_t kHeaderBytes = 21;

  std::int32_t origin = 0, destination = 0;
  std::uint32_t number = 0;
  std::int64_t offered_utime = 0;
  std::uint8_t hops = 0;
  std::int32_t data_bytes = 0;  // bytes of user data, whose contents are not used
};

std::vector<std::uint8_t> encode(const NetworkPacket& packet);
// Returns nothing when there are too few bytes.
[[nodiscard]] std::optional<NetworkPacket> decode_network_packet(std::span<const std::uint8_t> bytes);

}  // namespace halocline::networks
