// SPDX-License-Identifier: BSD-3-Clause
// Lines that a Micromodem writes when a packet was received, or was lost after its detection.
//
// CARXP is written when a packet is detected, everything else at its last bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages/messages.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_reports.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Kinds of packets that the bus does not distinguish, by the number in their header.
enum class MicromodemKind {
  kPlain = 0,
  kCycle = 1,         // mini-packet that announces data at rate 0, or asks another modem for data
  kNewPing = 2,       // ping of the second generation
  kFlexible = 3,      // data
  kControl = 4,       // mini-packet: set a line of the receiving modem's connector
  kControlReply = 5,  // mini-packet: the line has been set
  kSleep = 6,         // mini-packet: sleep for a number of minutes
  kFramed = 7,        // data: flexible, of the newer command CCTFP
  kFramedMini = 8,    // like kFramed, with the mini-frame as its first frame
};
MicromodemKind kind_of(const modem_receive_t& packet);

// A data cycle: `source` sends `frames` frames to `destination` (addresses).
struct MicromodemCycle {
  std::int64_t command = 0, source = 0, destination = 0, rate = 0, wants_ack = 0, frames = 0;

  std::string fields() const;  // command,source,destination,rate,ack,frames
};

// Encodes a cycle packet of 13 bits, high to low: a flag that asks the receiver for data (1), the address
// that the data is for (5; 31 means the packet's sender), rate (3), acknowledgement (1), number of frames
// less one (3). `asker`: the sender's address, when the packet asks for data.
std::vector<std::uint8_t> cycle_packet(const MicromodemCycle& cycle, std::optional<std::int64_t> asker);
// Returns true when the packet can encode the destination of the data asked for.
bool can_be_asked_for(const MicromodemCycle& cycle, std::int64_t asker);
// Decodes a cycle packet; nothing when it holds no cycle. `sender` and `addressee` are those of the packet.
struct CyclePacket {
  MicromodemCycle cycle;
  bool asks_for_data = false;
};
std::optional<CyclePacket> cycle_in(const std::vector<std::uint8_t>& payload, std::int64_t sender,
                                    std::int64_t addressee);

// Encodes the 13 bits of a control packet: line (4), mode (4), argument (5); control_fields() decodes them to
// "line,mode,argument".
inline constexpr std::int64_t kMaxControlLine = 15, kMaxControlMode = 15, kMaxControlArgument = 31;
std::vector<std::uint8_t> control_packet(std::int64_t line, std::int64_t mode, std::int64_t argument);
std::string control_fields(const std::vector<std::uint8_t>& payload);

// Properties of the receiving modem.
struct Listener {
  ReporterState state;
  const AddressBook& addresses;
  std::int32_t broadcast;   // broadcast address
  bool reports_statistics;  // setting CST
  bool has_newer_lines;     // CARFP instead of CARDP
  bool has_base64;          // setting recv.base64data: data of flexible packets in base64

  std::int32_t address(std::int32_t vehicle_id) const;
};

// Returns the bodies of the sentences, in order, for a packet that was received, whole or in part. An answer
// to an own packet is reported by lines_of_ack(), lines_of_framed_ack() or ping_answer() instead.
std::vector<std::string> lines_of(const Listener& listener, const modem_receive_t& packet);
// Returns the sentences of an acknowledgement: one for each frame that it confirms.
std::vector<std::string> lines_of_ack(const Listener& listener, const modem_receive_t& ack);
// Returns the sentences of an acknowledgement to a packet of CCTFP: masks of its mini-frame and its data
// frames.
std::vector<std::string> lines_of_framed_ack(const Listener& listener, const modem_receive_t& ack,
                                             bool has_mini);
// Returns the sentence for the answer to a ping of the second generation.
std::string ping_answer(const Listener& listener, const modem_receive_t& answer, double one_way_s);
// Returns the sentences for a packet that was detected and lost; `arrival` is in time of the vehicle's clock.
std::vector<std::string> lines_of(const Listener& listener, const packet_outcome_t& loss, SimTime arrival);
// Appends CACST alone, when it is reported.
void add_statistics(const Listener& listener, const modem_receive_t& packet, std::vector<std::string>& lines);

}  // namespace halocline::modem_gateway
