// SPDX-License-Identifier: BSD-3-Clause
// Packet that other vehicles relay, in its transmitted form: a header before the payload.
//
// | bytes | content (little-endian)                                                |
// | ----- | ---------------------------------------------------------------------- |
// | 0     | kind: 0xF2 data, 0xF3 data to be confirmed, 0xF4 confirmation          |
// | 1     | transmissions end to end: allowed (high 4 bits) and left (low 4 bits)  |
// | 2-5   | id of the vehicle of origin                                            |
// | 6-9   | id of the destination vehicle; 0: all                                  |
// | 10-11 | number, counted by the origin, modulo 65536                            |
// | 12-13 | FNV-1a of bytes 0, 2-11 and of the payload, lowest 16 bits             |
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "core/archive.h"

namespace halocline::clients {

enum class RelayKind : std::uint8_t { kData = 0xF2, kDataToConfirm = 0xF3, kConfirmation = 0xF4 };

struct RelayPacket {
  static constexpr std::size_t kHeaderBytes = 14;
  static constexpr int kMaxHops = 15;

  RelayKind kind = RelayKind::kData;
  int hops_allowed = 1;  // transmissions from end to end, 1 to kMaxHops
  int hops_left = 0;     // transmissions left after this one, 0 to kMaxHops - 1
  std::int32_t origin = 0;
  std::int32_t destination = 0;  // kBroadcastId: all
  std::uint16_t number = 0;
  std::vector<std::uint8_t> payload = {};

  // Returns the fields that distinguish it from all other packets, however often it is transmitted.
  auto name() const { return std::tuple(origin, destination, kind == RelayKind::kConfirmation, number); }
  bool operator==(const RelayPacket&) const = default;
  void archive(Archive& a) { a(kind, hops_allowed, hops_left, origin, destination, number, payload); }
};

std::vector<std::uint8_t> encode(const RelayPacket& packet);

// Returns nothing for bytes that are not such a packet.
[[nodiscard]] std::optional<RelayPacket> decode_relay_packet(std::span<const std::uint8_t> bytes);

}  // namespace halocline::clients
