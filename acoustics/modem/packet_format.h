// SPDX-License-Identifier: BSD-3-Clause
// How the information bits of a packet are divided: a header that everything needs, then frames with a CRC
// each.
//
// A receiver needs the header and keeps each frame whose CRC is right. Bits lie evenly after the preamble,
// the header first; each block ends with the code's tail (FrameLayout::tail_bits), which takes time and
// carries nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// The most frames of any packet: a bit each in the mask of those that were right.
inline constexpr std::size_t kMaxFrames = 32;

struct PacketFormat {
  std::int64_t header_bits = 0;
  std::vector<std::int64_t>
      frame_bits;  // before coding; at least one frame, of 0 bits in a packet without payload

  std::int64_t information_bits() const;
  // Information bits of the coded blocks: header and frames that hold any.
  std::vector<std::int64_t> blocks() const;
};

// A payload as the modem divides it: in whole frames, or in one that holds it all. Throws InvalidArgument
// where it exceeds max_payload_bytes.
PacketFormat data_format(const Modem& modem, std::size_t payload_bytes);

// Bytes of the payload in each frame of data_format().
std::vector<std::int32_t> frame_bytes_of(const Modem& modem, std::size_t payload_bytes);

// Frames with these bytes of the payload; those of a modem with frames are sent whole. None where the modem
// has no such frames: too many, or too large.
std::optional<PacketFormat> framed_format(const Modem& modem, std::span<const std::int32_t> frame_bytes);

// A mini-packet: no header, one frame. None where the modem has none.
std::optional<PacketFormat> mini_format(const Modem& modem);

// How such a packet occupies the water:
//   duration = overhead + sum over blocks of (bits + tail) / bit rate.
PacketTiming packet_timing(const Modem& modem, const PacketFormat& format);

}  // namespace halocline::acoustics
