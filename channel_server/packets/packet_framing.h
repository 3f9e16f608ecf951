// SPDX-License-Identifier: BSD-3-Clause
// The framing of a requested packet: the modem's rate at which it is sent, and its division into frames.
//
// A request without a rate uses the modem's own rate. When that rate has no packets of the requested kind,
// the rate of the lowest number that has them is used (a Micromodem's mini-packets are frequency-shift
// keying). Kinds:
//   data        header and frames of the payload
//   ping        as data; its answer has no payload
//   ack         a mini-packet if a rate has these, else data with one bit for each acknowledged frame, in
//               whole bytes
//   mini        one block of `mini_packet_bits` without a header; 13 of the bits carry the payload
//   JANUS       the header alone, whose `application_bits` carry the payload; with cargo, a second frame
//               follows
// A payload of bits is stored in whole bytes, the high byte first, right-aligned in the lowest bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/modem_schedule.h"

namespace halocline::channel_server {

// Payload bits of a Micromodem's mini-packet (WHOI's command CCMUC).
inline constexpr std::size_t kMiniPayloadBits = 13;

// A requested packet as the modem sends it, or why the modem cannot send it.
struct Framing {
  // kNoRate, kNoKind or kTooLarge leave the other members without meaning.
  SendResult problem = SendResult::kAccepted;
  std::int32_t rate_number = 0;
  acoustics::Modem modem;  // the modem's parameters at that rate, and the requested source level
  acoustics::PacketFormat format;
  std::vector<std::int32_t> frame_bytes;  // payload bytes in each frame
  acoustics::PacketTiming timing = {};
};

// Returns the framing of a request by the modem that the vehicle carries.
Framing framing_of(const VehicleModem& vehicle, const SendRequest& request);

}  // namespace halocline::channel_server
