// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/networks/network_packet.h"

#include <type_traits>

namespace halocline::networks {
namespace {

template <class Integer>
void put(Integer value, std::vector<std::uint8_t>& bytes) {
  auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
  for (std::size_t i = 0; i < sizeof(Integer); ++i)
    bytes.push_back(static_cast<std::uint8_t>(std::uint64_t{bits} >> (8 * i)));
}

template <class Integer>
Integer take(std::span<const std::uint8_t>& bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Integer); ++i) bits |= std::uint64_t{bytes[i]} << (8 * i);
  bytes = bytes.subspan(sizeof(Integer));
  return static_cast<Integer>(bits);
}

}  // namespace

MacFrame marked(std::uint8_t kind, const MacFrame& frame) {
  MacFrame whole{frame.destination, {kind}};
  whole.bytes.insert(whole.bytes.end(), frame.bytes.begin(), frame.bytes.end());
  return whole;
}

std::vector<std::uint8_t> encode(const NetworkPacket& packet) {
  std::vector<std::uint8_t> bytes;
  put(packet.origin, bytes);
  put(packet.destination, bytes);
  put(packet.number, bytes);
  put(packet.offered_utime, bytes);
  put(packet.hops, bytes);
  bytes.resize(NetworkPacket::kHeaderBytes + static_cast<std::size_t>(packet.data_bytes));
  return bytes;
}

std::optional<NetworkPacket> decode_network_packet(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < NetworkPacket::kHeaderBytes) return std::nullopt;
  NetworkPacket packet;
  packet.data_bytes = static_cast<std::int32_t>(bytes.size() - NetworkPacket::kHeaderBytes);
  packet.origin = take<std::int32_t>(bytes);
  packet.destination = take<std::int32_t>(bytes);
  packet.number = take<std::uint32_t>(bytes);
  packet.offered_utime = take<std::int64_t>(bytes);
  packet.hops = take<std::uint8_t>(bytes);
  return packet;
}

}  // namespace halocline::networks
