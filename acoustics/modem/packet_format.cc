// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/packet_format.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::acoustics {
namespace {

constexpr std::int64_t kBitsPerByte = 8;

// Transmitted bits of a frame of `bytes`: modems with frames send whole frames.
std::int64_t bits_of_frame(const FrameLayout& layout, std::int64_t bytes) {
  return kBitsPerByte * (layout.frame_bytes > 0 ? layout.frame_bytes : bytes);
}

}  // namespace

std::int64_t PacketFormat::information_bits() const {
  return std::accumulate(frame_bits.begin(), frame_bits.end(), header_bits);
}

std::vector<std::int64_t> PacketFormat::blocks() const {
  std::vector<std::int64_t> blocks;
  if (header_bits > 0) blocks.push_back(header_bits);
  for (const std::int64_t bits : frame_bits) {
    if (bits > 0) blocks.push_back(bits);
  }
  return blocks;
}

std::vector<std::int32_t> frame_bytes_of(const Modem& modem, std::size_t payload_bytes) {
  require(payload_bytes <= max_payload_bytes(modem), "a payload of " + std::to_string(payload_bytes) +
                                                         " bytes; allowed is at most " +
                                                         std::to_string(max_payload_bytes(modem)));
  auto left = static_cast<std::int32_t>(payload_bytes);
  const std::int32_t most = modem.layout.frame_bytes > 0 ? modem.layout.frame_bytes : left;
  std::vector<std::int32_t> frames;
  do {
    frames.push_back(std::min(left, most));
    left -= frames.back();
  } while (left > 0);
  return frames;
}

PacketFormat data_format(const Modem& modem, std::size_t payload_bytes) {
  PacketFormat format{modem.layout.header_bits, {}};
  for (const std::int32_t bytes : frame_bytes_of(modem, payload_bytes)) {
    format.frame_bits.push_back(payload_bytes > 0 ? bits_of_frame(modem.layout, bytes) : 0);
  }
  return format;
}

std::optional<PacketFormat> framed_format(const Modem& modem, std::span<const std::int32_t> frame_bytes) {
  const FrameLayout& layout = modem.layout;
  const std::size_t most_frames =
      layout.frame_bytes > 0 ? static_cast<std::size_t>(layout.max_frames) : kMaxFrames;
  if (frame_bytes.empty() || frame_bytes.size() > most_frames) return std::nullopt;
  PacketFormat format{layout.header_bits, {}};
  std::int64_t sum = 0;
  for (const std::int32_t bytes : frame_bytes) {
    if (bytes < 0 || (layout.frame_bytes > 0 && bytes > layout.frame_bytes)) return std::nullopt;
    format.frame_bits.push_back(bits_of_frame(layout, bytes));
    sum += bytes;
  }
  if (sum > kMaxPayloadBytes) return std::nullopt;
  return format;
}

std::optional<PacketFormat> mini_format(const Modem& modem) {
  if (modem.layout.mini_packet_bits == 0) return std::nullopt;
  return PacketFormat{0, {modem.layout.mini_packet_bits}};
}

PacketTiming packet_timing(const Modem& modem, const PacketFormat& format) {
  std::int64_t bits = 0;
  for (const std::int64_t block : format.blocks()) bits += block + modem.layout.tail_bits;
  return {modem.packet_overhead + SimDuration::from_seconds(static_cast<double>(bits) / modem.bit_rate_bps),
          modem.preamble, format.information_bits()};
}

}  // namespace halocline::acoustics
