// SPDX-License-Identifier: BSD-3-Clause
// How a modem sends what is requested: at which of its rates, and how the packet is divided.
//
// Without a rate in the request a packet goes at the modem's own rate; one of a kind that this has not, at
// the rate of the least number that has it (a Micromodem's mini-packets are frequency-shift keying). Kinds:
//   data        header and frames of the payload
//   ping        likewise; its answer has no payload
//   ack         a mini-packet where a rate has these, else data of one bit for each frame acknowledged, in
//               whole bytes
//   mini        one block of `mini_packet_bits`, no header; 13 bits of them are the payload's
//   JANUS       the header alone, whose `application_bits` are the payload's; with cargo, a second frame
//               follows
// A payload of bits lies in whole bytes, the high byte first, in their lowest bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/modem_schedule.h"

namespace halocline::channel_server {

// Of a Micromodem's mini-packet (WHOI's command CCMUC).
inline constexpr std::size_t kMiniPayloadBits = 13;

struct Framing {
  SendResult problem = SendResult::kAccepted;  // kNoRate, kNoKind or kTooLarge: all else is of no consequence
  std::int32_t rate_number = 0;
  acoustics::Modem modem;  // as which it sends
  acoustics::PacketFormat format;
  std::vector<std::int32_t> frame_bytes;  // of the payload
  acoustics::PacketTiming timing = {};
};

Framing framing_of(const VehicleModem& vehicle, const SendRequest& request);

}  // namespace halocline::channel_server
