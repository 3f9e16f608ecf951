// SPDX-License-Identifier: BSD-3-Clause
// The lines that a Micromodem writes when something was received, or lost after its detection.
//
// CARXP comes when a packet is detected, all else with its last bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_reports.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Kinds of packets that the bus does not know, by the number in their header.
enum class MicromodemKind {
  kPlain = 0,
  kCycle = 1,         // mini-packet that announces data at rate 0, or asks another modem for data
  kNewPing = 2,       // the second generation's
  kFlexible = 3,      // data
  kControl = 4,       // mini-packet: set a line of the modem it is for
  kControlReply = 5,  // mini-packet: it is set
  kSleep = 6,         // mini-packet: sleep for so many minutes
  kFramed = 7,        // data: flexible, of the newer command
  kFramedMini = 8,    // the same, its first frame the mini-frame
};
MicromodemKind kind_of(const modem_receive_t& packet);

// A data cycle: `source` sends `frames` frames to `destination` (addresses).
struct MicromodemCycle {
  std::int64_t command = 0, source = 0, destination = 0, rate = 0, wants_ack = 0, frames = 0;

  std::string fields() const;  // command,source,destination,rate,ack,frames
};

// A cycle packet of 13 bits: whether it asks its receiver for data, to which address (5 bits; 31 for the
// packet's sender), rate (3), acknowledgement (1), frames less one (3). `asker`: its sender's address, where
// it asks.
std::vector<std::uint8_t> cycle_packet(const MicromodemCycle& cycle, std::optional<std::int64_t> asker);
// Whether the packet has room for the destination of what is asked for.
bool can_be_asked_for(const MicromodemCycle& cycle, std::int64_t asker);
// `sender`, `addressee`: of the packet. None where it holds no cycle.
struct CyclePacket {
  MicromodemCycle cycle;
  bool asks_for_data = false;
};
std::optional<CyclePacket> cycle_in(const std::vector<std::uint8_t>& payload, std::int64_t sender,
                                    std::int64_t addressee);

// The 13 bits of a control packet: line (4), mode (4), argument (5), and back as "line,mode,argument".
inline constexpr std::int64_t kMaxControlLine = 15, kMaxControlMode = 15, kMaxControlArgument = 31;
std::vector<std::uint8_t> control_packet(std::int64_t line, std::int64_t mode, std::int64_t argument);
std::string control_fields(const std::vector<std::uint8_t>& payload);

// Of the modem that receives.
struct Listener {
  ReporterState state;
  const AddressBook& addresses;
  std::int32_t broadcast;   // address that stands for all
  bool reports_statistics;  // setting CST
  bool has_newer_lines;     // CARFP in the place of CARDP
  bool has_base64;          // data of flexible packets in base64, setting recv.base64data

  std::int32_t address(std::int32_t vehicle_id) const;
};

// Bodies of sentences, in their order, for a packet that was received, whole or in part. An answer to an own
// packet is the door's.
std::vector<std::string> lines_of(const Listener& listener, const modem_receive_t& packet);
// Of an acknowledgement: the frames that it says were right.
std::vector<std::string> lines_of_ack(const Listener& listener, const modem_receive_t& ack);
// The same for a packet of CCTFP: masks of its mini-frame and of its data frames.
std::vector<std::string> lines_of_framed_ack(const Listener& listener, const modem_receive_t& ack,
                                             bool has_mini);
// Of the answer to a ping of the second generation.
std::string ping_answer(const Listener& listener, const modem_receive_t& answer, double one_way_s);
// For a packet that was detected and lost; `arrival` by the vehicle's clock.
std::vector<std::string> lines_of(const Listener& listener, const packet_outcome_t& loss, SimTime arrival);
// CACST alone, where it is reported.
void add_statistics(const Listener& listener, const modem_receive_t& packet, std::vector<std::string>& lines);

}  // namespace halocline::modem_gateway
