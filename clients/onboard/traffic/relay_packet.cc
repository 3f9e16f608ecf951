// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/traffic/relay_packet.h"

#include "core/hash.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kHopsAt = 1, kOriginAt = 2, kDestinationAt = 6, kNumberAt = 10, kSumAt = 12;

void put(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t get(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint32_t{bytes[at + i]} << (8 * i);
  return value;
}

// Hash of everything that relays do not change, except for the hash itself.
std::uint16_t sum_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t sum = fnv1a(bytes.first(kHopsAt));
  sum = fnv1a(bytes.subspan(kOriginAt, kSumAt - kOriginAt), sum);
  sum = fnv1a(bytes.subspan(RelayPacket::kHeaderBytes), sum);
  return static_cast<std::uint16_t>(sum);
}

bool is_kind(std::uint8_t byte) {
  return byte >= static_cast<std::uint8_t>(RelayKind::kData) &&
         byte <= static_cast<std::uint8_t>(RelayKind::kConfirmation);
}

}  // namespace

std::vector<std::uint8_t> encode(const RelayPacket& packet) {
  std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(packet.kind),
                                  static_cast<std::uint8_t>(packet.hops_allowed << 4 | packet.hops_left)};
  put(bytes, static_cast<std::uint32_t>(packet.origin), 4);
  put(bytes, static_cast<std::uint32_t>(packet.destination), 4);
  put(bytes, packet.number, 2);
  put(bytes, 0, 2);
  bytes.insert(bytes.end(), packet.payload.begin(), packet.payload.end());
  const std::uint16_t sum = sum_of(bytes);
  bytes[kSumAt] = static_cast<std::uint8_t>(sum);
  bytes[kSumAt + 1] = static_cast<std::uint8_t>(sum >> 8);
  return bytes;
}

std::optional<RelayPacket> decode_relay_packet(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < RelayPacket::kHeaderBytes || !is_kind(bytes[0])) return std::nullopt;
  if (get(bytes, kSumAt, 2) != sum_of(bytes)) return std::nullopt;
  const auto payload = bytes.subspan(RelayPacket::kHeaderBytes);
  return RelayPacket{static_cast<RelayKind>(bytes[0]),
                     bytes[kHopsAt] >> 4,
                     bytes[kHopsAt] & 0xf,
                     static_cast<std::int32_t>(get(bytes, kOriginAt, 4)),
                     static_cast<std::int32_t>(get(bytes, kDestinationAt, 4)),
                     static_cast<std::uint16_t>(get(bytes, kNumberAt, 2)),
                     {payload.begin(), payload.end()}};
}

}  // namespace halocline::clients
