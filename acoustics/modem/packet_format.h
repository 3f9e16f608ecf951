// SPDX-License-Identifier: BSD-3-Clause
// Division of a packet's information bits: a header that everything depends on, then frames with a CRC each.
//
// A receiver needs the header, and keeps each frame whose CRC is right. Bits are spread evenly over the time
// after the preamble, the header first. Each block ends with the code's tail (FrameLayout::tail_bits), which
// takes time and carries no information.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// Maximum number of frames of any packet: each has a bit in the mask of correct frames.
inline constexpr std::size_t kMaxFrames = 32;

// Information bits of a packet, before coding.
struct PacketFormat {
  std::int64_t header_bits = 0;
  // One frame or more; a single one of 0 bits in a packet without payload.
  std::vector<std::int64_t> frame_bits;

  std::int64_t information_bits() const;
  // Information bits of the coded blocks: the header and the frames, each if it has any bits.
  std::vector<std::int64_t> blocks() const;
};

// Format of a data packet as the modem divides it: in whole frames, or in a single one without frames. Throws
// InvalidArgument when the payload exceeds max_payload_bytes().
PacketFormat data_format(const Modem& modem, std::size_t payload_bytes);

// Bytes of payload in each frame of data_format().
std::vector<std::int32_t> frame_bytes_of(const Modem& modem, std::size_t payload_bytes);

// Format of a packet whose frames have the given bytes of payload; a modem with frames sends them whole.
// nullopt when the modem does not allow them: too many, or too large.
std::optional<PacketFormat> framed_format(const Modem& modem, std::span<const std::int32_t> frame_bytes);

// Format of a mini-packet: one frame without header. nullopt when the modem has none.
std::optional<PacketFormat> mini_format(const Modem& modem);

// Timing of a packet of any format:
//   duration = overhead + sum over blocks of (bits + tail) / bit rate.
PacketTiming packet_timing(const Modem& modem, const PacketFormat& format);

}  // namespace halocline::acoustics
